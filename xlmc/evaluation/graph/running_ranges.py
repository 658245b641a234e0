"""Ranges that begin, or end, where others do: those of formulas filled down, as `B$1:B9` and `B9:B$5000` are."""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from xlmc.address import Area
from xlmc.formula import ir

__all__ = ["Chain", "RunningRanges", "added"]

_SHORTEST: Final = 16
"""Cells of a range worth looking up."""

_MANY_UPWARDS: Final = 64
"""Ranges that end at one cell from which on they are taken upwards: fewer are no burden, each taken by itself."""


@dataclass(frozen=True, slots=True)
class Chain:
    """An area as the last of several, each with all cells of the one before and some more.

    Attributes:
        areas: from the shortest to the longest, which may be longer than the area that was asked for.
        length: how many of them, the area asked for being the last.
        upwards: whether they end at one cell, so that each begins above the one before; else they begin at one cell.
    """

    areas: Sequence[Area]
    length: int
    upwards: bool


@dataclass(frozen=True, slots=True)
class _Rows(Sequence[Area]):
    """The areas that end where one does, each a row (or cell) longer than the one before."""

    longest: Area

    def __len__(self) -> int:
        return _length(self.longest)

    def __getitem__(self, at: int) -> Area:  # type: ignore[override]
        if self.longest.rows == 1:
            return replace(self.longest, left=self.longest.right - at)
        return replace(self.longest, top=self.longest.bottom - at)


class RunningRanges:
    """The ranges that formulas give to some functions as their only argument.

    Args:
        trees: of the formulas.
        names: of the functions.
    """

    def __init__(self, trees: Iterable[ir.Expression], names: Collection[str]) -> None:
        areas = {area for tree in trees for area in _folded(tree, names) if area.rows * area.columns >= _SHORTEST}
        self._down, self._up = _grouped(areas, _start, 2), _grouped(areas, _end, _MANY_UPWARDS)

    def chain(self, area: Area, *, by_rows: bool) -> Chain | None:
        """The chain that an area is part of; None where it is to be taken by itself.

        Args:
            area: which may be in no group.
            by_rows: upwards, step by single rows, so that the steps do not depend on which ranges there are.
        """
        for groups, key, upwards in ((self._down, _start(area), False), (self._up, _end(area), True)):
            group = groups.get(key)
            if group is None:
                continue
            at = bisect_left(group, _length(area), key=_length)
            if at < len(group) and group[at] == area:
                if upwards and by_rows:
                    return Chain(_Rows(area), _length(area), True)
                return Chain(group, at + 1, upwards)
        return None


def added(before: Area, after: Area, *, upwards: bool) -> Area:
    """The cells of the later of two areas of a chain that the earlier has not."""
    if after.rows == 1:
        return replace(after, right=before.left - 1) if upwards else replace(after, left=before.right + 1)
    return replace(after, bottom=before.top - 1) if upwards else replace(after, top=before.bottom + 1)


def _length(area: Area) -> int:
    return area.columns if area.rows == 1 else area.rows


_Key = tuple[object, ...]


def _start(area: Area) -> _Key:
    return (area.sheet, area.top, area.left, None if area.rows == 1 else area.right)


def _end(area: Area) -> _Key:
    return (area.sheet, area.bottom, area.right, None if area.rows == 1 else area.left)


def _grouped(areas: Iterable[Area], key: Callable[[Area], _Key], fewest: int) -> dict[_Key, list[Area]]:
    """Areas of one key, from the shortest to the longest, where there are enough of them."""
    groups: defaultdict[_Key, list[Area]] = defaultdict(list)
    for area in areas:
        groups[key(area)].append(area)
    return {of: sorted(group, key=_length) for of, group in groups.items() if len(group) >= fewest}


def _folded(tree: ir.Expression, names: Collection[str]) -> Iterator[Area]:
    """The areas that are the only argument of one of the functions."""
    match tree:
        case ir.Unary(_, operand):
            yield from _folded(operand, names)
        case ir.Binary():
            first, rest = ir.chain(tree)
            for part in (first, *(right for _, right in rest)):
                yield from _folded(part, names)
        case ir.Call(name, (Area() as area,)) if name in names:
            yield area.filled
        case ir.Call(_, arguments):
            for part in arguments:
                yield from _folded(part, names)
        case ir.Let(bindings, body):
            for part in (*(value for _, value in bindings), body):
                yield from _folded(part, names)
        case ir.Lambda(_, body):
            yield from _folded(body, names)
        case ir.Invoke(function, arguments):
            for part in (function, *arguments):
                yield from _folded(part, names)
        case _:
            return
