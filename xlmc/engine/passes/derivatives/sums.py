"""Sums, means, products, extremes and deviations of many numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.passes.derivatives.jet import Jet, align, by_value, chain, concatenate, flat
from xlmc.engine.passes.derivatives.numerical import by_differences
from xlmc.engine.passes.derivatives.rules import Operand, Outcome, rule
from xlmc.excel.functions import Function
from xlmc.excel.functions.values import ERROR, NUMBER, Bools, Floats, Value

__all__: list[str] = []


def _counted(operands: Sequence[Operand]) -> tuple[list[Jet], list[Bools]]:
    """Return the cells of each operand, `(n, m)`, and which count: all that is given directly, and the numbers of
    ranges.
    """
    jets, counts = [], []
    for value, jet in operands:
        in_range = value.numbers.ndim == 3
        counted = value.kinds == NUMBER if in_range else value.kinds < ERROR
        jets.append(flat(jet, value))
        counts.append(np.broadcast_to(counted, value.shape).reshape(value.shape[0], -1))
    return jets, counts


def _only(jet: Jet, counts: Bools) -> Jet:
    """Return the cells that count, 0 instead of the others."""
    return jet.each(lambda part, _: np.where(counts, part, 0.0))


def _total(operands: Sequence[Operand]) -> Jet:
    total = Jet.still(np.zeros(1))
    for jet, counts in zip(*_counted(operands), strict=True):
        total = total + _only(jet, counts).total()
    return total


def _count(operands: Sequence[Operand]) -> Floats:
    return np.asarray(sum((counts.sum(axis=1) for counts in _counted(operands)[1]), np.zeros(1)), np.float64)


@rule("SUM")
def sum_(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Sum."""
    return Outcome(_total(operands))


@rule("AVERAGE")
def average(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Mean."""
    return Outcome(_total(operands).times(1 / _count(operands)))


@rule("SUMSQ")
def sum_of_squares(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Sum of squares."""
    return Outcome(_total_of([jet * jet for jet in _cells(operands)]))


def _cells(operands: Sequence[Operand]) -> list[Jet]:
    return [_only(jet, counts) for jet, counts in zip(*_counted(operands), strict=True)]


def _total_of(jets: Sequence[Jet]) -> Jet:
    total = Jet.still(np.zeros(1))
    for jet in jets:
        total = total + jet.total()
    return total


def _squares(operands: Sequence[Operand]) -> Jet:
    """Sum of the squared distances from the mean."""
    jets, counts = _counted(operands)
    mean = _total(operands).times(1 / _count(operands)).each(lambda part, _: part[..., None])
    distances = [_only(jet - mean, counted) for jet, counted in zip(jets, counts, strict=True)]
    return _total_of([jet * jet for jet in distances])


@rule("VAR.S", "VAR.P", "DEVSQ")
def variance(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Mean squared distance from the mean, or the sum of them."""
    count = _count(operands)
    weight = {"VAR.S": 1 / (count - 1), "VAR.P": 1 / count, "DEVSQ": np.ones(1)}[function.name]
    return Outcome(_squares(operands).times(weight))


@rule("STDEV.S", "STDEV.P", why="all the numbers are equal there")
def deviation(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Differentiate the standard deviation."""
    count = _count(operands)
    return Outcome(_squares(operands).times(1 / (count - 1 if function.name == "STDEV.S" else count)).sqrt())


@rule("PRODUCT", "PRODUCT so far")
def product(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Product: each number times that of all others, without a division, which might be by 0."""
    jets, counts = _counted(operands)
    running = Jet.still(np.ones(1))
    for jet, counted in zip(jets, counts, strict=True):
        whole = jet.spread()
        for column in range(counted.shape[1]):
            one = whole.each(lambda part, _, column=column: part[..., column])  # type: ignore[misc]  # mypy sees two arguments
            factor = chain(np.where(counted[:, column], one.x, 1.0), [one], [np.where(counted[:, column], 1.0, 0.0)])
            running = running * factor
    return Outcome(running)


@rule("MIN", "MAX", "MIN so far", "MAX so far", why="two of the numbers are equal there, and do not change alike")
def extreme(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Return the derivatives of the cell that is the largest or smallest."""
    jet, counts = _side_by_side(*_counted(operands))
    return Outcome(*by_value(jet, counts, np.broadcast_to(result.numbers, jet.x.shape[:1])))


@rule("LARGE", "SMALL", why="two of the numbers are equal there, and do not change alike")
def ranked(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Return the derivatives of the cell of that rank, if it is a single rank that no assumption changes."""
    if operands[1].jet.active or result.numbers.ndim != 1:
        return by_differences(function, result, operands)
    jet, counts = _side_by_side(*_counted(operands[:1]))
    return Outcome(*by_value(jet, counts, np.broadcast_to(result.numbers, jet.x.shape[:1])))


@rule("MEDIAN", why="two of the numbers are equal there, and do not change alike")
def median(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Return the derivatives of the middle number, or the mean of those of the two in the middle."""
    jet, counts = _side_by_side(*_counted(operands))
    ordered = np.sort(np.where(counts, jet.x, np.inf), axis=1)
    k = counts.sum(axis=1)
    trials = np.arange(k.size)
    low, first = by_value(jet, counts, ordered[trials, np.maximum(k - 1, 0) // 2])
    high, last = by_value(jet, counts, ordered[trials, np.minimum(k // 2, ordered.shape[1] - 1)])
    return Outcome((low + high).times(0.5), first * counts.shape[1] + last)


def _side_by_side(jets: Sequence[Jet], counts: Sequence[Bools]) -> tuple[Jet, Bools]:
    """All cells in one row, `(n, m)`."""
    n = max(jet.x.shape[0] for jet in jets)
    tall: list[NDArray[np.bool_]] = [np.broadcast_to(part, (n, part.shape[1])) for part in counts]
    return concatenate(align(jets), n), np.concatenate(tall, axis=1)


@rule("SUMPRODUCT")
def sum_product(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Sum of products; what is no number is 0."""
    product = Jet.still(np.ones((1, 1)))
    for value, jet in operands:
        ranged, cells = value.as_range(), jet.as_range()
        counted = np.broadcast_to(ranged.kinds == NUMBER, ranged.shape).reshape(ranged.shape[0], -1)
        product = product * _only(flat(cells, ranged), counted)
    return Outcome(product.total())


@rule("MMULT")
def matrix_product(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Differentiate sums of products of rows and columns."""
    left, right = (jet.as_range().spread() for _, jet in operands)
    rows = left.each(lambda part, _: part[..., :, :, None])
    columns = right.each(lambda part, _: part[..., None, :, :])
    product = (rows * columns).spread()
    return Outcome(product.each(lambda part, _: part.sum(axis=-2)))


@rule("SUMIF", "SUMIFS", "AVERAGEIF", "AVERAGEIFS", why="what decides which cells count has no derivative there")
def conditional(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Differentiate sums and means, linear in their cells: the function itself is called with the cells'
    derivatives.
    """
    alone = function.name in ("SUMIF", "AVERAGEIF")
    cells = operands[2 if alone and len(operands) > 2 else 0]
    values = [operand.value for operand in operands]
    n = result.shape[0]

    def of(part: NDArray[np.float64], axes: int) -> NDArray[np.float64]:
        if not axes:
            return part
        lead = part.shape[:axes]
        rows = np.broadcast_to(part, (*lead, n, *cells.value.shape[1:])).reshape(-1, n, *cells.value.shape[1:])
        sums = [_sum_of(function, values, 2 if alone else 0, row, cells) for row in rows]
        return np.asarray(sums).reshape(*lead, *result.shape)

    return Outcome(replace(cells.jet.each(of), x=result.numbers))


def _sum_of(function: Function, values: Sequence[Value], slot: int, row: Floats, cells: Operand) -> Floats:
    """Call the function with other numbers in its cells; errors, which infinite numbers cause, become NaN."""
    own = Value(row, cells.value.kinds, cells.value.texts)
    given = [*values[:slot], own, *values[slot + 1 :]]
    value = function(given)
    return np.where(value.kinds >= ERROR, np.nan, value.numbers)
