"""Mean, spread and shape: the statistics that are smooth functions of the moments.

Each is a value and its gradient in the means of z, z², z³, z⁴ (see `moments`); errors follow by the delta method and
hold for any distribution with the moments they use (twice the order of the statistic). Intervals take Student's t
with one degree of freedom less than there are independent units: trials, effective trials, or replicates.

All take `values` (n,), `weights` (n,) nonnegative importance weights, `replicate` (n,) integer ids, and raise
ValueError for values that are not finite. Without trials the value is nan.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from xlmc.statistics.estimate import LEAST_DOF, Estimate, with_error, with_relative_error
from xlmc.statistics.sample import Sample, Values

__all__ = [
    "coefficient_of_variation",
    "kurtosis",
    "mean",
    "mean_standard_error",
    "skewness",
    "standard_deviation",
    "variance",
]

Gradient = tuple[float, float, float, float]


def mean(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Arithmetic mean; for independent trials its error is s/√n.

    >>> mean([1.0, 2.0, 3.0]).value
    2.0
    >>> mean([]).value
    nan
    """
    sample = Sample.of(values, weights, replicate)
    error = sample.moments.scale * _error(sample, (1.0, 0.0, 0.0, 0.0))
    return with_error(sample.moments.mean, error, sample.dof, confidence, sample.n)


def variance(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Sample variance, nan where it is too large for a number; divided by n − 1 as Excel's VAR.S;
    with weights by the effective size less one; of replicates
    the mean square about the mean, and the squared error of the mean.

    Error from the fourth moment, for independent trials Var(s²) ≈ (m₄ − s⁴(n − 3)/(n − 1))/n. One trial has none: nan.

    >>> round(variance([1.0, 2.0, 4.0]).value, 12)
    2.333333333333
    """
    sample = Sample.of(values, weights, replicate)
    value = _deviation(sample) * _deviation(sample)
    if math.isinf(value):  # too large for a number
        return Estimate(np.nan, n=sample.n)
    error = value * _relative_error_of_variance(sample)
    return with_relative_error(value, error, sample.dof, confidence, sample.n)


def standard_deviation(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Square root of the sample variance, as Excel's STDEV.S."""
    sample = Sample.of(values, weights, replicate)
    value = _deviation(sample)
    error = 0.5 * value * _relative_error_of_variance(sample)
    return with_relative_error(value, error, sample.dof, confidence, sample.n)


def coefficient_of_variation(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Standard deviation over mean, with the sign of the mean; nan where the mean is 0."""
    sample = Sample.of(values, weights, replicate)
    m = sample.moments
    if m.mean == 0.0:
        return Estimate(np.nan, n=sample.n)
    value = _deviation(sample) / m.mean
    error = abs(value) * _error(sample, (-m.scale / m.mean, 0.5, 0.0, 0.0))
    return with_error(value, error, sample.dof, confidence, sample.n)


def skewness(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """m₃/m₂^1.5 from the moments divided by n (normal 0); nan where all values are equal."""
    sample = Sample.of(values, weights, replicate)
    m = sample.moments
    if sample.n < 3:  # two values are always symmetric: that is no measurement
        return Estimate(m.skewness, n=sample.n)
    error = _error(sample, (-3.0, -1.5 * m.skewness, 1.0, 0.0))
    return with_error(m.skewness, error, sample.dof, confidence, sample.n)


def kurtosis(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """m₄/m₂² from the moments divided by n (normal 3); nan where all values are equal."""
    sample = Sample.of(values, weights, replicate)
    m = sample.moments
    if sample.n < 4:  # up to three values the kurtosis is a constant, 1 or 1.5
        return Estimate(m.kurtosis, n=sample.n)
    error = _error(sample, (-4.0 * m.skewness, -2.0 * m.kurtosis, 0.0, 1.0))
    return with_error(m.kurtosis, error, sample.dof, confidence, sample.n)


def mean_standard_error(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """The standard error of the mean as a statistic of its own, s/√n for independent trials, with its own error."""
    sample = Sample.of(values, weights, replicate)
    if sample.dof < LEAST_DOF:
        return Estimate(np.nan, n=sample.n)
    value = sample.moments.scale * _error(sample, (1.0, 0.0, 0.0, 0.0))
    return with_relative_error(value, value * sample.moments.noise, sample.dof, confidence, sample.n)


def _error(sample: Sample, gradient: Gradient) -> float:
    """Delta method: the standard error of a function of the moments with this gradient."""
    g = np.asarray(gradient)
    return float(np.sqrt(np.maximum(g @ sample.moments.covariance @ g, 0.0)))


def _deviation(sample: Sample) -> float:
    """Square root of the sample variance, which for very large or small units could not be formed first.

    The mean square about the sample's own mean falls short of the variance by what the mean itself varies: s²/n for
    independent trials, which dividing by n − 1 makes good; between replicates the squared error of the mean, which
    stratified trials make much smaller than that.
    """
    if sample.effective <= 1.0:
        return float("nan")
    if sample.group is not None and sample.dof >= LEAST_DOF:
        return sample.moments.scale * math.sqrt(1.0 + float(sample.moments.covariance[0, 0]))
    return sample.moments.scale * math.sqrt(sample.effective / (sample.effective - 1.0))


def _relative_error_of_variance(sample: Sample) -> float:
    """The delta method, and what estimating the mean adds to it: negligible but for a handful of trials."""
    if sample.dof < LEAST_DOF:
        return float("nan")
    about_the_mean = _error(sample, (1.0, 0.0, 0.0, 0.0)) ** 4 * 2.0 * sample.dof / sample.units
    return float(np.hypot(_error(sample, (0.0, 1.0, 0.0, 0.0)), about_the_mean**0.5))
