"""Sums, counts, means and extremes of the cells whose neighbours meet criteria. See `criteria` for these.

A criterion may differ between trials, and so may any cell. A criterion that is many cells in an array formula gives as
many results. Letters: n trials, k cells of a range.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import errors_unless_range, first_error, first_error_in_row, with_errors
from xlmc.excel.functions.criteria import which_meet
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.lookup.picked_cells import arrange, by_portions, cell_of, flatten_cells, map_parts
from xlmc.excel.functions.math.aggregate import average, maximum, minimum, sum_
from xlmc.excel.functions.registry import Anything, Cells, excel
from xlmc.excel.functions.values import BLANK, NUMBER, Bools, Floats, Value, constant

__all__ = ["Reduce", "fold_of_numbers"]

Reduce = Callable[[Value, Bools], Value]
"""One number per trial, from a range (n, r, c) and which of its cells, (n, k), meet all criteria."""


def _count(cells: Value, matching: Bools) -> Value:
    return Value.of_numbers(matching.sum(axis=1).astype(np.float64))


def fold_of_numbers(fold: Callable[[Floats, Bools], Floats]) -> Reduce:
    """Make a `Reduce` of a function of numbers: it takes the numbers among the cells, and gives an error among them."""

    def reduce(cells: Value, matching: Bools) -> Value:
        counts = matching & (flatten_cells(cells.kinds, cells) == NUMBER)
        errors = np.where(matching, flatten_cells(cells.errors, cells), np.uint8(0))
        return Value.of_numbers(fold(flatten_cells(cells.numbers, cells), counts), first_error_in_row(errors))

    return reduce


_SUM: Final = fold_of_numbers(sum_)
_AVERAGE: Final = fold_of_numbers(average)
_MAXIMUM: Final = fold_of_numbers(maximum)
_MINIMUM: Final = fold_of_numbers(minimum)


def _conditional(values: Value, pairs: Sequence[Value], reduce: Reduce, date1904: bool) -> Value:
    """Reduce the cells of `values` where each range of `pairs` meets the criterion behind it."""
    criteria = pairs[1::2]
    everything = (values, *pairs[::2])
    cells = [value.as_range() for value in everything]
    errors = first_error(*(errors_unless_range(value) for value in everything))
    if len({value.shape[1:] for value in cells}) > 1 or len(pairs) % 2:
        return with_errors(constant(ErrorCode.VALUE), errors)
    shape = np.broadcast_shapes(*(criterion.shape[1:] for criterion in criteria))
    width = cells[0].shape[1] * cells[0].shape[2]

    def compute(values: Value, *others: Value) -> Value:
        ranges, criteria = others[: len(cells) - 1], others[len(cells) - 1 :]
        matching = np.ones((1, width), bool)
        for cells_, criterion in zip(ranges, criteria, strict=True):
            matching = matching & which_meet(criterion, cells_, date1904=date1904)
        return reduce(values, matching)

    if not shape:
        return with_errors(by_portions(compute, [*cells, *criteria], width), errors)
    results = [
        by_portions(compute, [*cells, *(cell_of(criterion, *index) for criterion in criteria)], width)
        for index in np.ndindex(*shape)
    ]
    return with_errors(arrange(results, *shape), errors.reshape(-1, 1, 1))


def _reduce_beside(values: Value | None, cells: Value, criterion: Value, reduce: Reduce, date1904: bool) -> Value:
    """Reduce the range `values`, cut or extended to the size of `cells`; or the cells themselves."""
    if values is None:
        return _conditional(cells, (cells, criterion), reduce, date1904)
    _, rows, columns = cells.as_range().shape
    result = _conditional(_resized(values.as_range(), rows, columns), (cells, criterion), reduce, date1904)
    errors = first_error(errors_unless_range(cells), errors_unless_range(values))
    return with_errors(result, errors if result.numbers.ndim == 1 else errors.reshape(-1, 1, 1))


def _resized(values: Value, rows: int, columns: int) -> Value:
    """Return the range that has the same top left cell and another size.

    Cells that it lacks count as empty. Excel goes on to the cells below and to the right, so the caller gives the range
    in its full size, as far as the used part of the sheet goes.
    """
    cut = map_parts(values, lambda part: part[:, :rows, :columns])
    edges = ((0, 0), (0, rows - cut.shape[1]), (0, columns - cut.shape[2]))
    texts = None if cut.texts is None else np.pad(cut.texts, edges, constant_values="")
    return Value(np.pad(cut.numbers, edges), np.pad(cut.kinds, edges, constant_values=BLANK), texts)


@excel("COUNTIF", Cells, Anything, dated=True, facts=Facts(exact_steps=True))
def count_if(cells: Value, criterion: Value, *, date1904: bool = False) -> Value:
    """How many cells meet the criterion."""
    return _conditional(cells, (cells, criterion), _count, date1904)


@excel("COUNTIFS", Cells(repeat=True), Anything(repeat=True), dated=True, facts=Facts(exact_steps=True))
def count_ifs(*pairs: Value, date1904: bool = False) -> Value:
    """Count the positions at which all ranges meet the criteria that follow them."""
    return _conditional(pairs[0], pairs, _count, date1904)


@excel("SUMIF", Cells, Anything, Cells(default=None), dated=True, facts=Facts(empty_cells=EmptyCells.IGNORED))
def sum_if(cells: Value, criterion: Value, values: Value | None = None, *, date1904: bool = False) -> Value:
    """Sum of the numbers beside the cells that meet the criterion, or of these cells."""
    return _reduce_beside(values, cells, criterion, _SUM, date1904)


@excel(
    "SUMIFS", Cells, Cells(repeat=True), Anything(repeat=True), dated=True, facts=Facts(empty_cells=EmptyCells.PAIRED)
)
def sum_ifs(values: Value, *pairs: Value, date1904: bool = False) -> Value:
    """Sum of the numbers where all ranges meet the criteria behind them."""
    return _conditional(values, pairs, _SUM, date1904)


@excel("AVERAGEIF", Cells, Anything, Cells(default=None), dated=True, facts=Facts(empty_cells=EmptyCells.IGNORED))
def average_if(cells: Value, criterion: Value, values: Value | None = None, *, date1904: bool = False) -> Value:
    """Mean of the numbers beside the cells that meet the criterion, or of these cells; `#DIV/0!` of none."""
    return _reduce_beside(values, cells, criterion, _AVERAGE, date1904)


@excel(
    "AVERAGEIFS",
    Cells,
    Cells(repeat=True),
    Anything(repeat=True),
    dated=True,
    facts=Facts(empty_cells=EmptyCells.PAIRED),
)
def average_ifs(values: Value, *pairs: Value, date1904: bool = False) -> Value:
    """Mean of the numbers where all ranges meet the criteria behind them; `#DIV/0!` of none."""
    return _conditional(values, pairs, _AVERAGE, date1904)


@excel(
    "MAXIFS", Cells, Cells(repeat=True), Anything(repeat=True), dated=True, facts=Facts(empty_cells=EmptyCells.PAIRED)
)
def maximum_ifs(values: Value, *pairs: Value, date1904: bool = False) -> Value:
    """Largest number where all ranges meet the criteria behind them; 0 of none."""
    return _conditional(values, pairs, _MAXIMUM, date1904)


@excel(
    "MINIFS", Cells, Cells(repeat=True), Anything(repeat=True), dated=True, facts=Facts(empty_cells=EmptyCells.PAIRED)
)
def minimum_ifs(values: Value, *pairs: Value, date1904: bool = False) -> Value:
    """Smallest number where all ranges meet the criteria behind them; 0 of none."""
    return _conditional(values, pairs, _MINIMUM, date1904)
