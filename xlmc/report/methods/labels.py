"""Where the words at the ends of lines stand: in a column at the right, apart from each other, in the lines' order."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["spread"]


def spread(heights: Sequence[float], apart: float, bottom: float, top: float) -> list[float]:
    """Heights that are at least so far apart, in the same order, each as near to what it was as the others allow.

    Args:
        heights: falling, or in the order in which labels shall stand from the top.
        apart: the least distance; less where there is not room enough.
        bottom: of the column.
        top: likewise.

    >>> spread([5.0, 5.0, 1.0], 1.0, 0.0, 10.0)
    [5.5, 4.5, 1.0]
    """
    if not heights:
        return []
    step = min(apart, (top - bottom) / max(len(heights) - 1, 1))
    groups: list[tuple[float, int]] = []  # the middle of labels that touch each other, and how many there are
    for height in heights:
        middle, count = height, 1
        while groups and groups[-1][0] - groups[-1][1] * step / 2.0 < middle + count * step / 2.0:
            other, more = groups.pop()
            middle, count = (other * more + middle * count) / (more + count), more + count
        groups.append((middle, count))
    found = [middle + (count - 1) * step / 2.0 - place * step for middle, count in groups for place in range(count)]
    return _inside(found, step, bottom, top)


def _inside(heights: list[float], step: float, bottom: float, top: float) -> list[float]:
    """The same, pushed back from both ends."""
    found = []
    limit = top
    for height in heights:
        found.append(min(height, limit))
        limit = found[-1] - step
    limit = bottom
    for place in range(len(found) - 1, -1, -1):
        found[place] = max(found[place], limit)
        limit = found[place] + step
    return found
