"""How a sheet is laid on paper: upright or across, how large, and where further pages begin.

All lengths are in points. What is laid out fits both A4 and letter. A sheet is as wide as its page; its letters, which
are of 11 points on the sheet, then have 6.6 points or more on paper if the sheet is no wider than `MOST_UPRIGHT` or
`MOST_ACROSS`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

__all__ = ["MARGINS", "MOST_ACROSS", "MOST_UPRIGHT", "SMALLEST", "Layout", "lay_out"]

MARGINS: Final = {"left": 0.3, "right": 0.3, "top": 0.4, "bottom": 0.4}
"""In inches; the head and the foot of the page stand within them."""

SMALLEST: Final = 0.6
"""The scale below which no sheet is printed that could be printed larger."""

_SIDES, _ENDS = 72.0 * (MARGINS["left"] + MARGINS["right"]), 72.0 * (MARGINS["top"] + MARGINS["bottom"])
_UPRIGHT: Final = (8.27 * 72.0 - _SIDES, (11.0 * 72.0 - _ENDS) / (8.5 * 72.0 - _SIDES))
_ACROSS: Final = (11.0 * 72.0 - _SIDES, (8.27 * 72.0 - _ENDS) / (11.69 * 72.0 - _SIDES))
"""The width within the margins, of the narrower paper, letter or A4, and the height as a part of the width, of the one
that is lower for its width: what is wide is printed larger on the wider paper, and has fewer rows there."""

MOST_UPRIGHT: Final = _UPRIGHT[0] / SMALLEST
MOST_ACROSS: Final = _ACROSS[0] / SMALLEST
"""The widest sheets."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Where a sheet's pages begin.

    Attributes:
        upright: whether its pages are higher than wide.
        breaks: the rows that begin a further page.
        whole: whether all of it is one page, fitted to its height too.
        scale: of what is printed.
        pages: how many there are; a part that has no room on one is broken by the program that prints.
    """

    upright: bool
    breaks: tuple[int, ...]
    whole: bool
    scale: float
    pages: int


def lay_out(
    width: float, heights: Sequence[float], begins: Sequence[int], repeated: float = 0.0, *, whole: bool = True
) -> Layout:
    """Find the layout of fewest pages whose letters can be read, and of these the one with the largest letters.

    Several pages are as wide as the sheet; one may be smaller, to have room for all rows.

    Args:
        width: of the sheet.
        heights: of its rows.
        begins: the rows that may begin a further page.
        repeated: the height of the rows that stand on top of each further page.
        whole: whether it may be fitted to the height of one page.
    """
    layouts = [
        _on(page, width, heights, begins, repeated, upright=upright, whole=whole)
        for page, upright in ((_UPRIGHT, True), (_ACROSS, False))
    ]
    readable = [each for each in layouts if each.scale >= SMALLEST]
    if readable:
        return min(readable, key=lambda each: (each.pages, -each.scale))
    return max(layouts, key=lambda each: each.scale)


def _on(
    page: tuple[float, float],
    width: float,
    heights: Sequence[float],
    begins: Sequence[int],
    repeated: float,
    *,
    upright: bool,
    whole: bool,
) -> Layout:
    """Return the layout on pages of a width, in points, and a height as a part of it."""
    across = min(1.0, page[0] / width)
    room = page[1] * max(width, page[0])
    both = min(across, across * room / max(sum(heights), 1.0))
    if whole and (both >= SMALLEST or both == across):
        return Layout(upright, (), whole=True, scale=both, pages=1)
    breaks, pages = _breaks(room, heights, begins, repeated)
    return Layout(upright, tuple(breaks), whole=False, scale=across, pages=pages)


def _breaks(room: float, heights: Sequence[float], begins: Sequence[int], repeated: float) -> tuple[list[int], int]:
    """Return the rows that begin a page and the number of pages; parts between `begins` stay together if they fit."""
    edges = [0, *sorted({row for row in begins if 0 < row < len(heights)}), len(heights)]
    breaks: list[int] = []
    filled, pages = 0.0, 1
    for start, end in pairwise(edges):
        part = sum(heights[start:end])
        if filled and filled + part > room:
            breaks.append(start)
            filled, pages = repeated, pages + 1
        filled += part
        while filled > room:
            filled, pages = filled - max(room - repeated, 1.0), pages + 1
    return breaks, pages
