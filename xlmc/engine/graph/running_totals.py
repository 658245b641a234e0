"""Running totals: `SUM(B$1:B9)` beside `SUM(B$1:B8)` is made of that sum and one more cell, to the last bit.

Formulas filled down over n rows, each over a range that begins (or ends) where those of the others do, then cost n
steps instead of n²/2. All such ranges are known before the first is lowered: their order does not matter.

A range that begins where others do is folded from its first cell on, as one that stands alone is: the same bits. One
that ends where many others do, as `SUM(B8:B$5000)` filled down, is folded from its last row to its first. Extremes and
counts are the same either way; a sum, mean or product may differ by its rounding. Either way the first error counts.

The largest, the smallest and the product of no numbers are 0; but this 0 must not count when numbers follow. So up to
the first cell that is surely a number, such a fold gives a blank while there are no numbers.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Range
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.math.aggregate import RUNNING, SO_FAR
from xlmc.excel.functions.values import ERROR, NUMBER, constant

__all__ = ["FOLDS", "PAIRED_OR_COUNTED", "RunningTotals"]

PAIRED_OR_COUNTED: Final = frozenset({"SUMPRODUCT", "COUNT"})
"""Functions of ranges that are no fold of one set, for which other nodes may stand."""

FOLDS: Final = frozenset({"SUM", "COUNT", "COUNTA", "AVERAGE", *SO_FAR})
"""Functions of which the result for a longer range follows from that for a shorter one."""

_SHORTEST: Final = 16
"""The fewest cells of a range that is worth looking up."""

_LONG: Final = 64
"""From this number of varying cells on, they are added one by one, and need not wait for each other."""

_MOST_FOLDS: Final = 4
"""Ranges, of one function, that a cell is folded in one by one."""

_SHORT: Final = 32
"""Products of numbers in two or more ranges that are added up one by one."""

_NUMBERS: Final = "how many are numbers where none is an error"

_MANY_UPWARDS: Final = 64
"""The fewest ranges ending at one cell that are folded upwards together; fewer are cheap enough one by one."""


class RunningTotals:
    """The folds of long ranges met so far.

    Args:
        dag: takes the nodes.
        trees: the formulas that may hold such ranges.
        cell: gives the node of a cell.
    """

    def __init__(self, dag: Dag, trees: Iterable[ir.Expression], cell: Callable[[Cell], int]) -> None:
        self._dag, self._cell = dag, cell
        self._known: dict[tuple[int, ...], int] = {}
        self._states: dict[tuple[str, bool, Area], int] = {}
        self._folds: Counter[tuple[Function, int]] = Counter()
        self._made: dict[tuple[str, Area], int] = {}
        self._ranges = _RunningRanges(trees, FOLDS)

    def of_area(self, name: str, area: Area, alone: Callable[[], int]) -> int:
        """Fold an area.

        Args:
            name: of the function, one of `FOLDS`.
            area: its only argument.
            alone: makes it where the area begins and ends where no others do.
        """
        if (name, area) not in self._made:
            chained = self._ranges.chain(area, by_rows=False) is not None
            self._made[name, area] = self._chain(name, area) if chained else alone()
        return self._made[name, area]

    def _chain(self, name: str, area: Area) -> int:
        """Fold an area of a chain."""
        if name == "AVERAGE":
            return self._dag.add(Apply(REGISTRY["/"], (self._state("SUM", area), self._state(_NUMBERS, area))))
        state = self._state(name, area)
        if name not in SO_FAR or self._dag.types[state] is Kind.NUMBER:
            return state
        return self._dag.add(Apply(REGISTRY[name], (self._dag.add(Range(((state,),))),)))

    def _state(self, name: str, area: Area) -> int:
        """Fold an area up to its last step; the folds of all shorter areas of its chain are noted as well."""
        chain = self._ranges.chain(area, by_rows=name in ("SUM", "PRODUCT"))
        assert chain is not None
        known = self._states
        made = chain.length
        while made > 0 and (name, chain.upwards, chain.areas[made - 1]) not in known:
            made -= 1
        state = known[name, chain.upwards, chain.areas[made - 1]] if made else None
        for at in range(made, chain.length):
            state = self._join(name, state, self._cells(chain, at), chain.upwards)
            known[name, chain.upwards, chain.areas[at]] = state
        assert state is not None
        return state

    def _cells(self, chain: _Chain, at: int) -> list[int]:
        """Return the cells that an area of a chain has beyond the one before."""
        area = chain.areas[at]
        more = _new_cells(chain.areas[at - 1], area, upwards=chain.upwards) if at else area
        return [self._cell(cell) for cell in more.cells()]

    def _join(self, name: str, before: int | None, cells: list[int], upwards: bool) -> int:
        """Continue the fold with more cells, which stand behind those of `before`, or in front of them if `upwards`."""
        if name == _NUMBERS:
            return self._add_to(before, self._how_many(cells))
        if name in ("COUNT", "COUNTA"):
            return self._add_to(before, self._apply_to_row(REGISTRY[name], cells))
        if before is None:
            return self._apply_to_row(self._function(name, cells), cells)
        if all(map(self._never_counts, cells)):
            return before
        if name == "SUM" or self._dag.types[before] is Kind.NUMBER:
            range_ = self._row(cells)
            function = RUNNING.get(name, REGISTRY[name])
            return self._dag.add(Apply(function, (range_, before) if upwards else (before, range_)))
        both = [*cells, before] if upwards else [before, *cells]
        return self._apply_to_row(self._function(name, both), both)

    def _function(self, name: str, cells: Sequence[int]) -> Function:
        """Return the function that folds cells: the one of that name where a cell is surely a number, else its
        `SO_FAR`.
        """
        surely = name == "SUM" or any(self._dag.types[cell] is Kind.NUMBER for cell in cells)
        return RUNNING.get(name, REGISTRY[name]) if surely else SO_FAR[name]

    def _apply_to_row(self, function: Function, cells: Sequence[int]) -> int:
        return self._dag.add(Apply(function, (self._row(cells),)))

    def _row(self, cells: Sequence[int]) -> int:
        return self._dag.add(Range((tuple(cells),)))

    def _add_to(self, before: int | None, more: int) -> int:
        return more if before is None else self._dag.add(Apply(REGISTRY["+"], (before, more)))

    def _how_many(self, cells: Sequence[int]) -> int:
        surely = sum(self._dag.types[cell] is Kind.NUMBER for cell in cells)
        node = self._dag.constant(constant(float(surely)))
        maybe = [cell for cell in cells if self._dag.types[cell] is Kind.ANY and not self._never_counts(cell)]
        return self._add_to(node, self._apply_to_row(REGISTRY["COUNT"], maybe)) if maybe else node

    def _never_counts(self, cell: int) -> bool:
        """Whether a cell is known to be neither a number nor an error."""
        node = self._dag.nodes[cell]
        return isinstance(node, Constant) and NUMBER < int(node.value.kinds.flat[0]) < ERROR

    def apply(self, function: Function, arguments: tuple[int, ...]) -> int:
        """Make the node of a function whose arguments are one set, or of one of `PAIRED_OR_COUNTED`."""
        node = Apply(function, arguments)
        cells = self._column(function, arguments)
        before = None if cells is None else self._known.get(cells[:-1])
        if cells is not None:
            last = arguments if before is None else (before, self._row(cells[-1:]))
            node = Apply(RUNNING[function.name], last)
        folded = self._stand_in(function, arguments) if before is None else None
        node_id = self._dag.add(node)
        if cells is not None:
            self._known[cells] = node_id
        if folded is not None and folded < node_id and type(self._dag.nodes[node_id]) is not Constant:
            self._dag.folded[node_id] = folded  # a node that was there before keeps its own
        return node_id

    def _stand_in(self, function: Function, arguments: Sequence[int]) -> int | None:
        """Return the node that stands for the function on the fast path; otherwise None."""
        match function.name:
            case "SUMPRODUCT":
                return self._fold_products(arguments)
            case "AVERAGE" | "COUNT":
                count = self._count(arguments)
                if count is None or function.name == "COUNT":
                    return count
                total = self.apply(REGISTRY["SUM"], tuple(arguments))
                return self._dag.add(Apply(REGISTRY["/"], (total, count)))
            case _:
                return self._fold(function, arguments)

    def _count(self, arguments: Sequence[int]) -> int | None:
        """Count the number cells of ranges without errors; None if the count may vary or there are no ranges."""
        parts = [self._dag.nodes[argument] for argument in arguments]
        if not all(isinstance(part, Range) for part in parts):
            return None
        cells = [cell for part in parts if isinstance(part, Range) for row in part.rows for cell in row]
        numbers = [cell for cell in cells if not self._never_counts(cell)]
        if not numbers or not all(self._dag.types[cell] is Kind.NUMBER for cell in numbers):
            return None
        return self._dag.constant(constant(float(len(numbers))))

    def _fold_products(self, arguments: Sequence[int]) -> int | None:
        """Sum the products of short ranges of numbers, product by product; None of other arguments.

        The careful path does not take it: an error in a later cell of the first range counts before one in the second.
        """
        sizes = {self._dag.sizes[argument] for argument in arguments}
        ranges = [self._numbers_of(argument) for argument in arguments]
        if len(sizes) > 1 or not all(0 < len(cells) <= _SHORT for cells in ranges):
            return None
        total = None
        for factors in zip(*ranges, strict=True):
            product = factors[0]
            for factor in factors[1:]:
                product = self._dag.add(Apply(REGISTRY["*"], (product, factor)))
            total = self._add_to(total, product)
        return total

    def _numbers_of(self, argument: int) -> list[int]:
        """Return the cells of a range, each of which is a number unless it is an error; none where another may be
        there.

        None of a long constant either: each of its numbers would become a node.
        """
        node = self._dag.nodes[argument]
        if isinstance(node, Range):
            cells = [cell for row in node.rows for cell in row]
            return cells if all(self._dag.types[cell] is Kind.NUMBER for cell in cells) else []
        if not isinstance(node, Constant) or node.value.numbers.size > _SHORT or (node.value.kinds != NUMBER).any():
            return []
        return [self._dag.constant(constant(number)) for number in node.value.numbers.ravel().tolist()]

    def _column(self, function: Function, arguments: tuple[int, ...]) -> tuple[int, ...] | None:
        """Return the cells of the only argument where it is one long column."""
        if function.name != "SUM" or len(arguments) != 1:
            return None
        node = self._dag.nodes[arguments[0]]
        if not isinstance(node, Range) or len(node.rows) < _SHORTEST or len(node.rows[0]) > 1:
            return None
        return tuple([cell for (cell,) in node.rows])

    def _fold(self, function: Function, arguments: Sequence[int]) -> int | None:
        """Fold a long set so that it goes on as soon as the next cell is there: cells need not wait for the last one.

        The careful path does not take it: an overflow on the way would hide the error of a later cell.
        """
        parts = [self._dag.nodes[argument] for argument in arguments]
        folds = function.takes_sets and function.ufunc is not None and function.returns is Kind.NUMBER
        if not folds or not all(isinstance(part, Range) for part in parts):
            return None
        cells = [cell for part in parts if isinstance(part, Range) for row in part.rows for cell in row]
        cells = [cell for cell in cells if not self._never_counts(cell)]
        if not self._is_worth_folding(function, cells):
            return None
        self._folds.update((function, cell) for cell in cells)
        pieces: list[list[int]] = [[]]
        for cell in cells:
            pieces[-1].append(cell)
            if type(self._dag.nodes[cell]) is not Constant:
                pieces.append([])
        state = self._apply_to_row(function, pieces[0])
        for piece in pieces[1:]:
            if piece:
                state = self._dag.add(Apply(function, (state, self._row(piece))))
        return state

    def _is_worth_folding(self, function: Function, cells: Sequence[int]) -> bool:
        """Whether all are numbers, many of them vary, and few other ranges have them: not those of a moving average."""
        varying = sum(type(self._dag.nodes[cell]) is not Constant for cell in cells)
        if varying < _LONG or not all(self._dag.types[cell] is Kind.NUMBER for cell in cells):
            return False
        return max(self._folds[function, cell] for cell in (cells[0], cells[-1])) < _MOST_FOLDS


@dataclass(frozen=True, slots=True)
class _Chain:
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

    def __getitem__(self, at: int) -> Area:  # type: ignore[override]  # never a slice
        if self.longest.rows == 1:
            return replace(self.longest, left=self.longest.right - at)
        return replace(self.longest, top=self.longest.bottom - at)


class _RunningRanges:
    """The ranges that formulas give to some functions as their only argument.

    Args:
        trees: of the formulas.
        names: of the functions.
    """

    def __init__(self, trees: Iterable[ir.Expression], names: Collection[str]) -> None:
        areas = {area for tree in trees for area in _find_folded(tree, names) if area.rows * area.columns >= _SHORTEST}
        self._down, self._up = _group(areas, _start, 2), _group(areas, _end, _MANY_UPWARDS)

    def chain(self, area: Area, *, by_rows: bool) -> _Chain | None:
        """Return the chain that an area is part of; None if it is to be taken by itself.

        Args:
            area: which may be in no group.
            by_rows: go upwards row by row, so that the steps do not depend on which ranges there are.
        """
        for groups, key, upwards in ((self._down, _start(area), False), (self._up, _end(area), True)):
            group = groups.get(key)
            if group is None:
                continue
            at = bisect_left(group, _length(area), key=_length)
            if at < len(group) and group[at] == area:
                if upwards and by_rows:
                    return _Chain(_Rows(area), _length(area), True)
                return _Chain(group, at + 1, upwards)
        return None


def _new_cells(before: Area, after: Area, *, upwards: bool) -> Area:
    """Return the cells of the later of two areas of a chain that the earlier has not."""
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


def _group(areas: Iterable[Area], key: Callable[[Area], _Key], fewest: int) -> dict[_Key, list[Area]]:
    """Areas of one key, from the shortest to the longest, where there are enough of them."""
    groups: defaultdict[_Key, list[Area]] = defaultdict(list)
    for area in areas:
        groups[key(area)].append(area)
    return {of: sorted(group, key=_length) for of, group in groups.items() if len(group) >= fewest}


def _find_folded(tree: ir.Expression, names: Collection[str]) -> Iterator[Area]:
    """Return the areas that are the only argument of one of the functions."""
    match tree:
        case ir.Unary(_, operand):
            yield from _find_folded(operand, names)
        case ir.Binary():
            first, rest = ir.chain(tree)
            for part in (first, *(right for _, right in rest)):
                yield from _find_folded(part, names)
        case ir.Call(name, (Area() as area,)) if name in names:
            yield area.filled
        case ir.Call(_, arguments):
            for part in arguments:
                yield from _find_folded(part, names)
        case ir.Let(bindings, body):
            for part in (*(value for _, value in bindings), body):
                yield from _find_folded(part, names)
        case ir.Lambda(_, body):
            yield from _find_folded(body, names)
        case ir.Invoke(function, arguments):
            for part in (function, *arguments):
                yield from _find_folded(part, names)
        case _:
            return
