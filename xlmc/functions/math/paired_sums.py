"""Sums over pairs of cells, and of a power series. Letters: n trials, k cells of a range."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.functions.arguments import direct_errors, earliest, first_errors, leveled, with_errors
from xlmc.functions.facts import EmptyCells, Facts
from xlmc.functions.lookup.picking import flattened
from xlmc.functions.registry import Arrays, Cells, excel
from xlmc.functions.toolpak import OneCell, strict_numbers
from xlmc.functions.values import BLANK, DIV0, ERROR, NUMBER, Codes, Floats, Value, constant

__all__: list[str] = []


def _cells(value: Value) -> tuple[Floats, Codes]:
    """The numbers and kinds of a range, or of one value, cell by cell: (n, k), (n, k)."""
    return flattened(value.numbers, value), flattened(value.kinds, value)


def _over_pairs(x: Value, y: Value, term: Callable[[Floats, Floats], Floats]) -> Value:
    """Sum of `term` over the places where both are numbers; `#N/A` for unequal counts, `#DIV/0!` of no pair."""
    (left, left_kinds), (right, right_kinds) = _cells(x), _cells(y)
    if left.shape[1] != right.shape[1]:
        return with_errors(constant(ErrorCode.NA), earliest(direct_errors(x), direct_errors(y)))
    counts = (left_kinds == NUMBER) & (right_kinds == NUMBER)
    total = np.add.accumulate(np.where(counts, term(left, right), 0.0), axis=1)[:, -1]
    kinds = np.concatenate(np.broadcast_arrays(left_kinds, right_kinds), axis=1)
    errors = first_errors(np.where(kinds >= ERROR, kinds - np.uint8(ERROR), np.uint8(0)).astype(np.uint8))
    return Value.of_numbers(np.where(counts.any(axis=1), total, DIV0), errors)


@excel("SUMX2MY2", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
def sum_of_differences_of_squares(x: Value, y: Value) -> Value:
    """Sum of x² - y²."""
    return _over_pairs(x, y, lambda a, b: a * a - b * b)


@excel("SUMX2PY2", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
def sum_of_sums_of_squares(x: Value, y: Value) -> Value:
    """Sum of x² + y²."""
    return _over_pairs(x, y, lambda a, b: a * a + b * b)


@excel("SUMXMY2", Arrays, Arrays, facts=Facts(empty_cells=EmptyCells.PAIRED))
def sum_of_squares_of_differences(x: Value, y: Value) -> Value:
    """Sum of (x - y)²."""
    return _over_pairs(x, y, lambda a, b: (a - b) * (a - b))


@excel("SERIESSUM", OneCell, OneCell, OneCell, Cells)
def series_sum(x: Value, first: Value, step: Value, coefficients: Value) -> Value:
    """Sum of a·x^first + b·x^(first + step) + …, the coefficients read row by row; a blank one is 0."""
    values = leveled(x, first, step)
    (base, _), (power, _), (more, _) = numbers = [strict_numbers(value) for value in values]
    factors, kinds = _cells(coefficients)
    other = np.where(kinds >= ERROR, kinds - np.uint8(ERROR), np.uint8(ErrorCode.VALUE))
    refused = first_errors(np.where((kinds == NUMBER) | (kinds == BLANK), np.uint8(0), other).astype(np.uint8))
    spread = (-1,) + (1,) * (values[0].numbers.ndim - 1)
    total = np.zeros(spread[1:] or 1)
    for i in range(factors.shape[1]):
        total = total + factors[:, i].reshape(spread) * np.float_power(base, power + i * more)
    return Value.of_numbers(total, earliest(*(codes for _, codes in numbers), refused.reshape(spread)))
