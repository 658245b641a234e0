"""Tests of hypotheses: the probability of a difference as large as the one found, or larger, by chance. n trials."""

from __future__ import annotations

import numpy as np

from xlmc.excel.functions.arguments import first_error
from xlmc.excel.functions.facts import EmptyCells, Facts
from xlmc.excel.functions.registry import Arrays, Cells, Number, excel
from xlmc.excel.functions.samples import (
    Sample,
    at_each,
    mean_of,
    pairs_of,
    points_of,
    restore_shape,
    row_sums,
    sample_of,
)
from xlmc.excel.functions.statistical.beta_distributions import f_above, f_below, t_outside
from xlmc.excel.functions.statistical.gamma_distributions import chi_square_above
from xlmc.excel.functions.values import DIV0, NA, NUM, Floats, Value

__all__: list[str] = []


def _summary(sample: Sample) -> tuple[Floats, Floats, Floats]:
    """Mean, sum of the squared distances from it, and how many numbers: (n,) each."""
    mean, distance, k = mean_of(sample.x, sample.counts)
    return mean, row_sums(distance * distance), k


def _one_unless_positive(x: Floats) -> Floats:
    return np.where(x > 0, x, 1.0)


def _two_sided(difference: Floats, error: Floats, freedom: Floats) -> Floats:
    """Two-sided probability of a difference with that standard error; `#DIV/0!` where that is 0 or undefined: (n,)."""
    proper = (error > 0) & (freedom > 0)
    t = np.abs(difference) / _one_unless_positive(error)
    return np.where(proper, t_outside(t, _one_unless_positive(freedom)), DIV0)


def _paired(first: Value, second: Value) -> Floats:
    pairs = pairs_of(first, second)
    if pairs is None:
        return np.full(1, NA)
    x, y, counts, _ = pairs
    mean, total, k = _summary(Sample(x - y, counts, np.zeros((1, 1), np.uint8)))
    return _two_sided(mean, np.sqrt(total / _one_unless_positive(k - 1) / _one_unless_positive(k)), k - 1)


def _pooled(one: Sample, other: Sample) -> Floats:
    """Student's test of two samples of equal variance."""
    (mean1, total1, k1), (mean2, total2, k2) = _summary(one), _summary(other)
    freedom = np.where((k1 > 1) & (k2 > 1), k1 + k2 - 2, 0.0)
    variance = (total1 + total2) / _one_unless_positive(freedom)
    return _two_sided(
        mean1 - mean2, np.sqrt(variance * (1 / _one_unless_positive(k1) + 1 / _one_unless_positive(k2))), freedom
    )


def _unpooled(one: Sample, other: Sample) -> Floats:
    """Welch's test of two samples, with Satterthwaite's degrees of freedom, which need not be whole."""
    (mean1, total1, k1), (mean2, total2, k2) = _summary(one), _summary(other)
    enough = (k1 > 1) & (k2 > 1)
    part1, part2 = (
        total / _one_unless_positive(k - 1) / _one_unless_positive(k) for total, k in ((total1, k1), (total2, k2))
    )
    below = part1 * part1 / _one_unless_positive(k1 - 1) + part2 * part2 / _one_unless_positive(k2 - 1)
    freedom = np.where(enough, (part1 + part2) * (part1 + part2) / _one_unless_positive(below), 0.0)
    return _two_sided(mean1 - mean2, np.sqrt(part1 + part2), freedom)


@excel("T.TEST", Arrays, Arrays, Number, Number, aliases=("TTEST",), facts=Facts(empty_cells=EmptyCells.PAIRED))
def t_test(first: Value, second: Value, tails: Value, kind: Value) -> Value:
    """Probability that means lie so far apart: 1 or 2 tails; of pairs (1), equal variances (2) or unequal ones (3).

    `#N/A` for pairs from ranges of unequal size, `#DIV/0!` of fewer than two numbers or where nothing varies.
    """
    one, other = sample_of(first), sample_of(second)
    (sides, kinds), codes, shape = points_of(tails, kind)
    sides, kinds = np.floor(sides), np.floor(kinds)
    result = np.full((1, 1), NUM)
    for number, values in enumerate((_paired(first, second), _pooled(one, other), _unpooled(one, other)), start=1):
        result = np.where(kinds == number, values[:, None], result)
    halved = np.where((sides == 1) & (result >= 0), result / 2, result)
    result = np.where((sides == 1) | (sides == 2), halved, NUM)
    return restore_shape(result, first_error(one.errors[:, None], other.errors[:, None], *codes), shape)


@excel("F.TEST", Arrays, Arrays, aliases=("FTEST",), facts=Facts(empty_cells=EmptyCells.PAIRED))
def f_test(first: Value, second: Value) -> Value:
    """Two-sided probability that variances differ so much; `#DIV/0!` of fewer than two numbers, or of equal ones."""
    one, other = sample_of(first), sample_of(second)
    (_, total1, k1), (_, total2, k2) = _summary(one), _summary(other)
    proper = (k1 > 1) & (k2 > 1) & (total1 > 0) & (total2 > 0)
    m, n = np.where(proper, k1 - 1, 1.0), np.where(proper, k2 - 1, 1.0)
    ratio = np.where(proper, total1, 1.0) / m / (np.where(proper, total2, 1.0) / n)
    smaller = np.minimum(f_below(ratio, m, n), f_above(ratio, m, n))
    return Value.of_numbers(np.where(proper, 2 * smaller, DIV0), first_error(one.errors, other.errors))


def _freedom_of_table(rows: int, columns: int) -> int:
    """Degrees of freedom of a table of counts, which may have one row or one column."""
    return (rows - 1) * (columns - 1) if min(rows, columns) > 1 else max(rows, columns) - 1


@excel("CHISQ.TEST", Arrays, Arrays, aliases=("CHITEST",))
def chi_square_test(actual: Value, expected: Value) -> Value:
    """Probability that counts lie so far from those expected.

    `#N/A` for unequal sizes or one cell, `#DIV/0!` where 0 is expected.
    """
    pairs = pairs_of(actual, expected)
    freedom = _freedom_of_table(*actual.as_range().shape[1:])
    if pairs is None or freedom == 0:
        return Value.of_numbers(np.full(1, NA), first_error(sample_of(actual).errors, sample_of(expected).errors))
    values, wanted, counts, errors = pairs
    divisor = np.where(counts & (wanted != 0), wanted, 1.0)
    total = row_sums(np.where(counts, (values - wanted) / divisor * (values - wanted), 0.0))
    result = np.where(total >= 0, chi_square_above(np.maximum(total, 0.0), np.asarray(float(freedom))), NUM)
    return Value.of_numbers(np.where((counts & (wanted == 0)).any(axis=1), DIV0, result), errors)


@excel("Z.TEST", Cells, Number, Number(default=None), aliases=("ZTEST",), facts=Facts(empty_cells=EmptyCells.IGNORED))
@at_each()
def z_test(sample: Sample, centre: Floats, deviation: Floats | None = None) -> Floats:
    """Probability of a mean above the sample's, if the true mean is `centre`; `#N/A` of nothing.

    If the standard deviation is left out, it is that of the sample: `#DIV/0!` of fewer than two numbers, or of equal
    ones.
    """
    from scipy.special import ndtr

    mean, total, k = (part[:, None] for part in _summary(sample))
    own = np.where(k > 1, np.sqrt(total / _one_unless_positive(k - 1)), 0.0)
    spread = own if deviation is None else deviation
    error = np.where(k > 0, DIV0 if deviation is None else NUM, NA)
    z = (mean - centre) / (_one_unless_positive(spread) / np.sqrt(_one_unless_positive(k)))
    return np.where((spread > 0) & (k > 0), ndtr(-z), error)
