"""Matrices, one for each trial: (n, r, c); sums over pairs of cells; and the sum of a power series.

Letters: n trials, k cells of a range. A cell of a matrix that is no number, a blank too, makes the result `#VALUE!`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.arguments import (
    align_ranges,
    error_where,
    errors_unless_range,
    first_error,
    first_error_in_row,
    require_same_in_all_trials,
    whole_numbers,
    with_errors,
)
from xlmc.excel.functions.budget import ask_for_cells, ask_for_work
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.lookup.picked_cells import cell_of, flatten_cells, transpose_cells
from xlmc.excel.functions.registry import Anything, Arrays, Cells, Kind, Ranges, excel
from xlmc.excel.functions.samples import row_sums
from xlmc.excel.functions.toolpak import OneCell, strict_numbers
from xlmc.excel.functions.values import BLANK, DIV0, ERROR, NUM, NUMBER, Codes, Floats, Value, constant

__all__: list[str] = []

_WIDEST: Final = 16384
"""The columns of a worksheet."""


def _matrix(value: Value) -> tuple[Floats, Codes]:
    """Return the numbers, and the first error of each trial, which broadcasts over the matrix: (n, r, c), (n, 1, 1)."""
    cells = value.as_range()
    other = np.where(cells.kinds >= ERROR, cells.kinds - np.uint8(ERROR), np.uint8(ErrorCode.VALUE))
    codes = np.where(cells.kinds == NUMBER, np.uint8(0), other).astype(np.uint8)
    return np.broadcast_to(cells.numbers, cells.shape), first_error_in_row(flatten_cells(codes, cells))[:, None, None]


@excel("MMULT", Arrays, Arrays, returns=Kind.ANY, facts=Facts(spills=True))
def product(left: Value, right: Value) -> Value:
    """Matrix product, (n, r, k) by (n, k, c); `#VALUE!` where the sizes do not go together.

    Products are added from left to right, each trial by itself, so that no bit depends on the other trials.
    """
    (a, a_errors), (b, b_errors) = _matrix(left), _matrix(right)
    if a.shape[2] != b.shape[1]:
        return with_errors(
            constant(ErrorCode.VALUE), first_error(errors_unless_range(left), errors_unless_range(right))
        )
    n, rows, columns = max(a.shape[0], b.shape[0]), a.shape[1], b.shape[2]
    ask_for_cells(n, rows, columns)
    ask_for_work(n * rows * a.shape[2] * columns)
    total = a[:, :, :1] * b[:, :1, :]
    for i in range(1, a.shape[2]):
        total = total + a[:, :, i : i + 1] * b[:, i : i + 1, :]
    return Value.of_numbers(total, np.where(a_errors > 0, a_errors, b_errors).astype(np.uint8))


@excel("MDETERM", Arrays)
def determinant(matrix: Value) -> Value:
    """Return the determinant; `#VALUE!` unless the matrix is square."""
    a, errors = _matrix(matrix)
    if a.shape[1] != a.shape[2]:
        return constant(ErrorCode.VALUE)
    work, sign = _eliminate(a)
    pivots = np.diagonal(work, axis1=1, axis2=2)
    return Value.of_numbers(sign * np.multiply.accumulate(pivots, axis=1)[:, -1], errors[:, 0, 0])


@excel("MINVERSE", Arrays, returns=Kind.ANY, facts=Facts(spills=True))
def inverse(matrix: Value) -> Value:
    """Inverse; `#VALUE!` unless the matrix is square, `#NUM!` where it is singular."""
    a, errors = _matrix(matrix)
    size = a.shape[1]
    if size != a.shape[2]:
        return constant(ErrorCode.VALUE)
    work, _ = _eliminate(np.concatenate([a, np.broadcast_to(np.eye(size), a.shape)], axis=2))
    pivots = np.diagonal(work, axis1=1, axis2=2)[:, :, None]
    regular = (pivots != 0).all(axis=1, keepdims=True)
    return Value.of_numbers(np.where(regular, work[:, :, size:] / pivots, NUM), errors)


def _eliminate(matrix: Floats) -> tuple[Floats, Floats]:
    """Make a diagonal of the matrix's first columns; the sign is -1 where an odd number of rows was exchanged.

    Shapes: (n, r, c) -> (n, r, c), (n,).

    Gauss and Jordan's elimination; the pivot is the largest of its column, as in LAPACK.
    """
    ask_for_work(matrix.size * matrix.shape[1])
    work, sign = matrix.copy(), np.ones(matrix.shape[0])
    trials = np.arange(matrix.shape[0])
    for i in range(matrix.shape[1]):
        best = i + np.abs(work[:, i:, i]).argmax(axis=1)
        work[trials, i], work[trials, best] = work[trials, best], work[trials, i]
        pivot = work[:, i, i]
        factors = work[:, :, i] / np.where(pivot == 0, 1.0, pivot)[:, None]
        factors[:, i] = 0.0
        work = work - factors[:, :, None] * work[:, i : i + 1, :]
        sign = np.where(best == i, sign, -sign)
    return work, sign


@excel("MUNIT", Anything, returns=Kind.ANY, facts=Facts(spills=True))
def unit_matrix(dimension: Value) -> Value:
    """Return the unit matrix; `#VALUE!` of no rows, or of more than a sheet has columns.

    Raises:
        ShapeVaries: the size is not the same in every trial.
    """
    size, errors = whole_numbers(cell_of(dimension, 0, 0))
    outside = error_where((size < 1) | (size > _WIDEST), ErrorCode.VALUE)
    refused = first_error(errors, outside)
    common = int(require_same_in_all_trials(np.where(refused > 0, 0.0, size)))
    if not common:
        return Value.of_numbers(np.zeros(refused.shape), refused)
    ask_for_cells(1, common, common)
    return Value.of_numbers(np.eye(common)[None])


@excel("TRANSPOSE", Cells(ranges=Ranges.SINGLE), returns=Kind.ANY, facts=Facts(spills=True))
def transpose(cells: Value) -> Value:
    """Rows as columns: (n, r, c) -> (n, c, r)."""
    return transpose_cells(cells.as_range())


def _cells(value: Value) -> tuple[Floats, Codes]:
    """Return the numbers and kinds of a range, or of one value, cell by cell: (n, k), (n, k)."""
    return flatten_cells(value.numbers, value), flatten_cells(value.kinds, value)


def _sum_over_pairs(x: Value, y: Value, term: Callable[[Floats, Floats], Floats]) -> Value:
    """Sum of `term` over the pairs in which both are numbers; `#N/A` for unequal counts, `#DIV/0!` of no pair."""
    (left, left_kinds), (right, right_kinds) = _cells(x), _cells(y)
    if left.shape[1] != right.shape[1]:
        return with_errors(constant(ErrorCode.NA), first_error(errors_unless_range(x), errors_unless_range(y)))
    counts = (left_kinds == NUMBER) & (right_kinds == NUMBER)
    total = row_sums(np.where(counts, term(left, right), 0.0))
    kinds = np.concatenate(np.broadcast_arrays(left_kinds, right_kinds), axis=1)
    errors = first_error_in_row(np.where(kinds >= ERROR, kinds - np.uint8(ERROR), np.uint8(0)).astype(np.uint8))
    return Value.of_numbers(np.where(counts.any(axis=1), total, DIV0), errors)


@excel("SUMX2MY2", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
def sum_of_differences_of_squares(x: Value, y: Value) -> Value:
    """Sum of x² - y²."""
    return _sum_over_pairs(x, y, lambda a, b: a * a - b * b)


@excel("SUMX2PY2", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
def sum_of_sums_of_squares(x: Value, y: Value) -> Value:
    """Sum of x² + y²."""
    return _sum_over_pairs(x, y, lambda a, b: a * a + b * b)


@excel("SUMXMY2", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
def sum_of_squares_of_differences(x: Value, y: Value) -> Value:
    """Sum of (x - y)²."""
    return _sum_over_pairs(x, y, lambda a, b: (a - b) * (a - b))


@excel("SERIESSUM", OneCell, OneCell, OneCell, Cells)
def series_sum(x: Value, first: Value, step: Value, coefficients: Value) -> Value:
    """Sum of a·x^first + b·x^(first + step) + …, the coefficients read row by row; a blank one is 0.

    As everywhere in Excel, 0^0 is `#NUM!`.
    """
    values = align_ranges(x, first, step)
    (base, _), (power, _), (more, _) = numbers = [strict_numbers(value) for value in values]
    factors, kinds = _cells(coefficients)
    other = np.where(kinds >= ERROR, kinds - np.uint8(ERROR), np.uint8(ErrorCode.VALUE))
    refused = first_error_in_row(np.where((kinds == NUMBER) | (kinds == BLANK), np.uint8(0), other).astype(np.uint8))
    spread = (-1,) + (1,) * (values[0].numbers.ndim - 1)
    total = np.zeros(spread[1:] or 1)
    for i in range(factors.shape[1]):
        total = total + factors[:, i].reshape(spread) * _power_of(base, power + i * more)
    return Value.of_numbers(total, first_error(*(codes for _, codes in numbers), refused.reshape(spread)))


def _power_of(base: Floats, exponent: Floats) -> Floats:
    return np.where((base == 0) & (exponent == 0), NUM, np.float_power(base, exponent))
