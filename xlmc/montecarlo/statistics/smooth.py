"""Mean, spread and shape: the statistics that are smooth functions of the moments.

Each has a value and a gradient in the means of z, z², z³, z⁴ (see `moments`). The delta method gives the errors, which
hold for any distribution with the moments they use (twice the order of the statistic). Intervals take Student's t
with one degree of freedom less than there are independent units: trials, effective trials, or replicates. Those of
mean, variance, standard deviation and coefficient of variation allow for skewed errors: see `pulls`.

All take `values` (n,), `weights` (n,) nonnegative importance weights, `replicate` (n,) integer ids, and raise
ValueError for values that are not finite. Without trials the value is nan.
"""

from __future__ import annotations

import math
from typing import Final, Protocol

import numpy as np
from numpy.typing import ArrayLike

from xlmc.montecarlo.statistics.estimate import LEAST_DOF, Estimate, with_error, with_relative_error
from xlmc.montecarlo.statistics.heavy_tails import decides_spread
from xlmc.montecarlo.statistics.pulls import (
    Pull,
    beyond_reach,
    few_decide,
    replicate_skewness,
    step_error,
    trial_error,
    trial_skewness,
    wider,
)
from xlmc.montecarlo.statistics.sample import Sample, Values
from xlmc.montecarlo.statistics.yes_no import (
    coefficient_of_share,
    deviation_of_share,
    share_of_ones,
    variance_of_share,
)

__all__ = [
    "coefficient_of_variation",
    "errors_from_trials",
    "kurtosis",
    "mean",
    "mean_standard_error",
    "skewness",
    "standard_deviation",
    "too_short",
    "variance",
]

Gradient = tuple[float, float, float, float]


class MakeEstimate(Protocol):
    """A function that makes an estimate, as `with_error` does."""

    def __call__(
        self, value: float, error: float, dof: float, confidence: float, n: int, skewness: float = 0.0, /
    ) -> Estimate: ...


MEAN: Final[Pull] = (1.0, 0.0)
SQUARE: Final[Pull] = (0.0, 1.0)
"""The pull of the variance, in units of the variance, and of the standard deviation, in units of half of it."""


def mean(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Arithmetic mean; for independent trials its error is s/√n, and of zeros and ones it is a share: see `yes_no`.

    >>> mean([1.0, 2.0, 3.0]).value
    2.0
    >>> mean([]).value
    nan
    """
    sample = Sample.of(values, weights, replicate)
    if (estimate := share_of_ones(sample, confidence)) is not None:
        return estimate
    m = sample.moments
    return _estimate(sample, m.mean, m.scale, MEAN, _error(sample, (*MEAN, 0.0, 0.0)), confidence, with_error)


def variance(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Sample variance, divided by n − 1 as Excel's VAR.S, or with weights by the effective size minus one.

    With replicates it is the mean square about the mean plus the squared error of the mean. It is nan for one trial,
    or if it is too large for a number. Its error comes from the fourth moment; for independent trials
    Var(s²) ≈ (m₄ − s⁴(n − 3)/(n − 1))/n.

    >>> round(variance([1.0, 2.0, 4.0]).value, 12)
    2.333333333333
    """
    sample = Sample.of(values, weights, replicate)
    value = _deviation(sample) * _deviation(sample)
    if math.isinf(value):  # too large for a number
        return Estimate(np.nan, n=sample.n)
    if (estimate := share_of_ones(sample, confidence)) is not None:
        return variance_of_share(estimate, value, confidence)
    error = _relative_error_of_variance(sample)
    return _estimate(sample, value, value, SQUARE, error, confidence, with_relative_error)


def standard_deviation(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Square root of the sample variance, as Excel's STDEV.S."""
    sample = Sample.of(values, weights, replicate)
    value = _deviation(sample)
    if (estimate := share_of_ones(sample, confidence)) is not None:
        return deviation_of_share(estimate, value, confidence)
    error = _relative_error_of_variance(sample)
    return _estimate(sample, value, 0.5 * value, SQUARE, error, confidence, with_relative_error)


def coefficient_of_variation(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """Divide the standard deviation by the mean, with the sign of the mean; nan where the mean is 0."""
    sample = Sample.of(values, weights, replicate)
    m = sample.moments
    if m.mean == 0.0:
        return Estimate(np.nan, n=sample.n)
    value = _deviation(sample) / m.mean
    if (estimate := share_of_ones(sample, confidence)) is not None:
        return coefficient_of_share(estimate, value, confidence)
    sign = math.copysign(1.0, value)
    pull = -sign * m.scale / m.mean, sign * 0.5
    return _estimate(sample, value, abs(value), pull, _error(sample, (*pull, 0.0, 0.0)), confidence, with_error)


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
    """Return the standard error of the mean as a statistic, s/√n for independent trials, with its own error."""
    sample = Sample.of(values, weights, replicate)
    if sample.dof < LEAST_DOF:
        return Estimate(np.nan, n=sample.n)
    if sample.yes_no and sample.x[0] == sample.x[-1]:  # all agree, and another seed may have one that does not
        return Estimate(mean(sample).error or math.nan, n=sample.n)
    value = sample.moments.scale * _error(sample, (1.0, 0.0, 0.0, 0.0))
    return with_relative_error(value, value * sample.moments.noise, sample.dof, confidence, sample.n)


def errors_from_trials(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None
) -> list[str]:
    """Name which of mean and standard deviation have the error of independent trials although there are replicates."""
    sample = Sample.of(values, weights, replicate)
    if sample.group is None or sample.dof < LEAST_DOF or sample.n < 2 or sample.yes_no:
        return []
    n = sample.effective
    return [name for name, pull in _NAMED.items() if few_decide(trial_skewness(sample.moments, pull, n), n)]


def too_short(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> list[str]:
    """Name which of mean and standard deviation may have too short an interval, because the tail is heavy."""
    sample = Sample.of(values, weights, replicate)
    if sample.n < 2 or sample.yes_no:
        return []
    m, x = sample.moments, sample.even
    short = {name: beyond_reach(m, pull, sample.effective) for name, pull in _NAMED.items()}
    short["standard deviation"] |= decides_spread(x, m.mean, m.scale, m.kurtosis)
    return [name for name, is_short in short.items() if is_short]


_NAMED: Final = {"mean": MEAN, "standard deviation": SQUARE}


def _estimate(
    sample: Sample, value: float, size: float, pull: Pull, error: float, confidence: float, make: MakeEstimate
) -> Estimate:
    """Estimate a number from the pull of the trials or replicates; see `pulls`.

    Args:
        sample: the trials.
        value: the number.
        size: the unit of the pull.
        pull: the factors of z and z².
        error: the error of the number over `size`.
        confidence: the confidence of the interval.
        make: the function that makes the estimate.
    """
    n, m = sample.effective, sample.moments
    if sample.dof < LEAST_DOF or not m.scale > 0.0:
        return make(value, size * error, sample.dof, confidence, sample.n)
    of_trials = trial_skewness(m, pull, n)
    if sample.group is None:
        return make(value, size * error, sample.dof, confidence, sample.n, of_trials)
    estimate = make(value, size * error, sample.dof, confidence, sample.n, replicate_skewness(m, pull))
    if sample.n > sample.groups:  # there is more than one trial in a replicate
        step = step_error(sample.x, m, pull, sample.groups, n, confidence)
        estimate = wider(estimate, make(value, size * step, sample.dof, confidence, sample.n))
    if not few_decide(of_trials, n):
        return estimate
    return wider(estimate, make(value, size * trial_error(m, pull, n), n - 1.0, confidence, sample.n, of_trials))


def _error(sample: Sample, gradient: Gradient) -> float:
    """Return the standard error of a function of the moments with this gradient: the delta method."""
    g = np.asarray(gradient)
    return float(np.sqrt(np.maximum(g @ sample.moments.covariance @ g, 0.0)))


def _deviation(sample: Sample) -> float:
    """Return the root of the sample variance; of very large or small values the variance itself might not be a number.

    The mean square about the sample's own mean is less than the variance by the variance of that mean. For independent
    trials it is s²/n, and dividing by n − 1 corrects for it; for replicates it is the squared error of the mean, which
    is much smaller if the trials are stratified.
    """
    if sample.effective <= 1.0:
        return float("nan")
    if sample.group is not None and sample.dof >= LEAST_DOF:
        return sample.moments.scale * math.sqrt(1.0 + float(sample.moments.covariance[0, 0]))
    return sample.moments.scale * math.sqrt(sample.effective / (sample.effective - 1.0))


def _relative_error_of_variance(sample: Sample) -> float:
    """Return the delta method's error with what estimating the mean adds, which is negligible but for a few trials."""
    if sample.dof < LEAST_DOF:
        return float("nan")
    about_the_mean = _error(sample, (1.0, 0.0, 0.0, 0.0)) ** 4 * 2.0 * sample.dof / sample.units
    return float(np.hypot(_error(sample, (0.0, 1.0, 0.0, 0.0)), about_the_mean**0.5))
