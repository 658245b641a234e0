"""Means other than the arithmetic one, and the shape of a sample. Letters: n trials, k numbers of a trial.

`AVERAGEA` and its like count everything in a range but blanks: TRUE as 1, FALSE and texts as 0. In an array that is no
range they count less: see `array_values`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np

from xlmc.excel.functions.facts import EmptyCells, Facts, Repeats
from xlmc.excel.functions.lookup.picked_cells import flatten_cells
from xlmc.excel.functions.math.aggregate import maximum, minimum
from xlmc.excel.functions.math.rounding import int_
from xlmc.excel.functions.registry import Anything, Cells, Function, Kind, Number, Numbers, excel
from xlmc.excel.functions.samples import Sample, at_each, join_samples, mean_of, row_sums, spread_of
from xlmc.excel.functions.values import BLANK, DIV0, LOGICAL, NUM, TEXT, Bools, Floats, Value

__all__ = ["array_values"]


@excel("AVEDEV", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
def average_deviation(x: Floats, counts: Bools) -> Floats:
    """Mean distance from the mean; `#NUM!` of nothing."""
    _, distance, k = mean_of(x, counts)
    return np.where(k > 0, row_sums(np.abs(distance)) / np.maximum(k, 1.0), NUM)


@excel("DEVSQ", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT, measures=True))
def squared_deviations(x: Floats, counts: Bools) -> Floats:
    """Sum of the squared distances from the mean; `#NUM!` of nothing."""
    total, k = spread_of(x, counts)
    return np.where(k > 0, total, NUM)


def _all_positive(x: Floats, counts: Bools) -> Bools:
    return np.asarray(counts.any(axis=1) & ((x > 0) | ~counts).all(axis=1))


@excel("GEOMEAN", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
def geometric_mean(x: Floats, counts: Bools) -> Floats:
    """Geometric mean; `#NUM!` unless all numbers are above 0."""
    logarithms = np.log(np.where(counts & (x > 0), x, 1.0))
    mean = row_sums(logarithms) / np.maximum(counts.sum(axis=1), 1)
    return np.where(_all_positive(x, counts), np.exp(mean), NUM)


@excel("HARMEAN", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
def harmonic_mean(x: Floats, counts: Bools) -> Floats:
    """Harmonic mean; `#NUM!` unless all numbers are above 0."""
    inverses = np.where(counts & (x > 0), 1 / np.where(x > 0, x, 1.0), 0.0)
    total = row_sums(inverses)
    return np.where(_all_positive(x, counts), counts.sum(axis=1) / np.where(total > 0, total, 1.0), NUM)


def _standardized(x: Floats, counts: Bools, lost: int) -> tuple[Floats, Floats, Bools]:
    """Distances from the mean in standard deviations, how many numbers, and whether they differ: (n, k), (n,), (n,)."""
    _, distance, k = mean_of(x, counts)
    variance = row_sums(distance * distance) / np.maximum(k - lost, 1.0)
    differ = variance > 0
    return distance / np.sqrt(np.where(differ, variance, 1.0))[:, None], k, differ


@excel("SKEW", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
def skewness(x: Floats, counts: Bools) -> Floats:
    """Skewness, estimated from a sample; `#DIV/0!` of fewer than three numbers, or of equal ones."""
    z, k, differ = _standardized(x, counts, 1)
    enough = (k > 2) & differ
    k = np.where(enough, k, 3.0)
    return np.where(enough, row_sums(z * z * z) * k / ((k - 1) * (k - 2)), DIV0)


@excel("SKEW.P", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED))
def population_skewness(x: Floats, counts: Bools) -> Floats:
    """Skewness of a whole population; `#DIV/0!` of fewer than three numbers, or of equal ones."""
    z, k, differ = _standardized(x, counts, 0)
    return np.where((k > 2) & differ, row_sums(z * z * z) / np.maximum(k, 1.0), DIV0)


@excel("KURT", Numbers, facts=Facts(empty_cells=EmptyCells.IGNORED, repeats=Repeats.NUMBERS_COUNT))
def kurtosis(x: Floats, counts: Bools) -> Floats:
    """Excess kurtosis, estimated from a sample; `#DIV/0!` of fewer than four numbers, or of equal ones."""
    z, k, differ = _standardized(x, counts, 1)
    enough = (k > 3) & differ
    k = np.where(enough, k, 4.0)
    fourth = row_sums(z * z * z * z) * k * (k + 1) / ((k - 1) * (k - 2) * (k - 3))
    return np.where(enough, fourth - 3 * (k - 1) * (k - 1) / ((k - 2) * (k - 3)), DIV0)


@excel("TRIMMEAN", Cells, Number, facts=Facts(empty_cells=EmptyCells.IGNORED))
@at_each()
def trimmed_mean(sample: Sample, share: Floats) -> Floats:
    """Mean without a share of the numbers, half of them from each end, rounded down; `#NUM!` of nothing."""
    inside = (share >= 0) & (share < 1) & (sample.size > 0)
    cut = int_(sample.size * np.where(inside, share, 0.0) / 2)
    ordered, index = sample.ordered(), np.arange(float(sample.x.shape[1]))
    columns = [_mean_between(ordered, index, gone[:, None], sample.size) for gone in cut.T]
    return np.where(inside, np.stack(columns, axis=1), NUM)


def _mean_between(ordered: Floats, index: Floats, cut: Floats, size: Floats) -> Floats:
    inner = (index >= cut) & (index < size - cut)
    return row_sums(np.where(inner, ordered, 0.0)) / np.maximum(row_sums(inner.astype(np.float64)), 1.0)


def _sample_of_all(value: Value) -> Sample:
    """All values of one argument but blanks of a range: TRUE as 1, FALSE and texts as 0."""
    in_range = value.numbers.ndim == 3
    x, errors = (value.numbers, value.errors) if in_range else value.to_numbers()
    counts = ((value.kinds != BLANK) | (not in_range)) & (errors == 0)
    return Sample(flatten_cells(x, value), flatten_cells(counts, value), flatten_cells(errors, value))


def _register(
    name: str, meaning: str, body: Callable[[Floats, Bools], Floats], repeats: Repeats = Repeats.REFUSED
) -> None:
    """Register a function of all values, (n, k) and which of them count -> (n,)."""

    def apply(*values: Value) -> Value:
        sample = join_samples([_sample_of_all(value) for value in values])
        return Value.of_numbers(body(sample.x, sample.counts), sample.errors)

    apply.__doc__ = meaning
    facts = Facts(empty_cells=EmptyCells.IGNORED, repeats=repeats, ends_suffice=repeats is Repeats.ONCE)
    excel(name, Cells(repeat=True), facts=facts)(apply)


def _average(x: Floats, counts: Bools) -> Floats:
    mean, _, k = mean_of(x, counts)
    return np.where(k > 0, mean, DIV0)


def _variance(x: Floats, counts: Bools) -> Floats:
    total, k = spread_of(x, counts)
    return np.where(k > 1, total / np.maximum(k - 1, 1.0), DIV0)


def _population_variance(x: Floats, counts: Bools) -> Floats:
    total, k = spread_of(x, counts)
    return np.where(k > 0, total / np.maximum(k, 1.0), DIV0)


def _root(variance: Callable[[Floats, Bools], Floats]) -> Callable[[Floats, Bools], Floats]:
    def deviation(x: Floats, counts: Bools) -> Floats:
        values = variance(x, counts)
        return np.where(values >= 0, np.sqrt(np.where(values >= 0, values, 0.0)), DIV0)

    return deviation


_register("AVERAGEA", "Mean; `#DIV/0!` of nothing.", _average)
_register("MAXA", "Largest; 0 of nothing.", maximum, Repeats.ONCE)
_register("MINA", "Smallest; 0 of nothing.", minimum, Repeats.ONCE)
_register("VARA", "Variance, estimated from a sample; `#DIV/0!` of fewer than two.", _variance)
_register("VARPA", "Variance of the values themselves; `#DIV/0!` of nothing.", _population_variance)
_register("STDEVA", "Standard deviation, from a sample; `#DIV/0!` of fewer than two.", _root(_variance))
_register("STDEVPA", "Standard deviation of the values themselves; `#DIV/0!` of nothing.", _root(_population_variance))


@cache
def array_values(count_texts: bool, spills: bool = False) -> Function:
    """Return the function that leaves of an array what `AVERAGEA` and its like count: numbers, and texts if
    `count_texts`.

    Excel does not count logicals there, and texts only in AVERAGEA, as the authors of ClosedXML measured.
    """
    body = partial(_array_values, count_texts=count_texts)
    return Function("an array's values", (Anything,), body, Kind.ANY, facts=Facts(spills=spills, unrounded=True))


def _array_values(cells: Value, count_texts: bool) -> Value:
    ignored = cells.kinds == LOGICAL if count_texts else (cells.kinds == LOGICAL) | (cells.kinds == TEXT)
    kinds = np.where(ignored, np.uint8(BLANK), cells.kinds).astype(np.uint8)
    return Value(np.where(ignored, 0.0, cells.numbers), kinds, cells.texts)
