"""A number and how well it is known: its value, standard error and interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.number_text import format_estimate

__all__ = ["Estimate", "finite", "finite_json", "supported_digits"]

LEAST_DOF = 1.0 - 1e-9
"""Fewer degrees of freedom give no error; the margin is for the rounding of an effective sample size."""

LENGTHENED = 0.15
"""Intervals are longer by this share of the skewness, because a sample shows too little of it."""


@dataclass(frozen=True, slots=True, repr=False)
class Estimate:
    """One printed number, in the unit of the values it came from.

    The error is Monte Carlo error alone: what another seed would change. It says nothing of the inputs or the model.

    Attributes:
        value: the point estimate; nan where it does not exist.
        error: its standard error; None for extremes and with too few trials.
        interval: its confidence interval, 95 % unless asked otherwise; an end is infinite where the sample cannot
            bound it, as in the far tail of a small sample.
        n: the trials it rests on.

    >>> Estimate(11.77412, 0.0418)
    11.774 ± 0.042
    """

    value: float
    error: float | None = None
    interval: tuple[float, float] | None = None
    n: int = 0

    def __repr__(self) -> str:
        """Write the value with its error, as results show it."""
        return format_estimate(self.value, self.error)


def finite(value: float | None) -> float | None:
    """Return the number; None if it is NaN or infinite, which JSON does not have.

    >>> finite(1), finite(math.nan), finite(None)
    (1.0, None, None)
    """
    return None if value is None or not math.isfinite(value) else float(value)


def with_error(value: float, error: float, dof: float, confidence: float, n: int, skewness: float = 0.0) -> Estimate:
    """Make an estimate with the interval value ± t·error; no error if there are fewer than two independent units.

    Args:
        value: the number.
        error: its standard error.
        dof: independent units minus one.
        confidence: the probability that the interval holds the truth.
        n: trials.
        skewness: that of the number from run to run; it makes the interval longer on one side.
    """
    checkpoint()
    if dof < LEAST_DOF or not (math.isfinite(value) and math.isfinite(error)):
        return Estimate(value, n=n)
    low, high = t_range(dof, confidence, skewness)
    return Estimate(value, error, (value - high * error, value - low * error), n)


def with_relative_error(
    value: float, error: float, dof: float, confidence: float, n: int, skewness: float = 0.0
) -> Estimate:
    """Do as `with_error` for a positive number: the interval is that of the logarithm, so that it stays positive."""
    plain = with_error(value, error, dof, confidence, n)
    if plain.interval is None or error == 0.0:
        return plain
    low, high = t_range(dof, confidence, skewness)
    with np.errstate(over="ignore"):  # two trials at a confidence near 1 reach infinity, and that is the answer
        ends = value / np.exp(high * error / value), value * np.exp(-low * error / value)
    return Estimate(value, error, (float(ends[0]), float(ends[1])), n)


def t_range(dof: float, confidence: float, skewness: float = 0.0) -> tuple[float, float]:
    """Return the two numbers between which (estimate − truth)/error lies with this confidence.

    They are quantiles of Student's t, with Hall's correction for an estimate that is skewed from run to run: with r a
    sixth of the skewness, t + 2 r t² + 4/3 r² t³ + r is nearly symmetric. Neither is nearer to 0 than without skewness.
    """
    t = t_quantile(dof, confidence)
    if skewness == 0.0:
        return -t, t
    longer, r = t * (1.0 + LENGTHENED * abs(skewness)), skewness / 6.0
    return min(-longer, _invert_cubic(-longer, r)), max(longer, _invert_cubic(longer, r))


def _invert_cubic(y: float, r: float) -> float:
    """Return the t at which Hall's cubic is y: ((1 + 2 r t)³ − 1)/(6 r) + r."""
    inner = 6.0 * r * (y - r)
    if abs(inner) < 1e-3:  # where the difference of cube roots would lose digits
        return float(math.expm1(math.log1p(inner) / 3.0) / (2.0 * r))
    return float((math.cbrt(1.0 + inner) - 1.0) / (2.0 * r))


def t_quantile(dof: float, confidence: float) -> float:
    """Return the two-sided quantile of Student's t; with infinite `dof`, that of the normal distribution."""
    from scipy.special import stdtrit

    return float(stdtrit(dof, 1.0 - one_tail(confidence)))


def one_tail(confidence: float) -> float:
    """Return the probability beyond either end of the interval.

    Raises:
        ValueError: the confidence is not between 0 and 1.
    """
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"a confidence lies between 0 and 1, not at {confidence}")
    return (1.0 - confidence) / 2.0


def supported_digits(estimate: Estimate) -> int | None:
    """Return the decimals of a value printed alone: the last is good to ± 1 with 95 % confidence (2 errors ≤ 1 unit).

    The number is negative for tens, hundreds, …, and None if no error limits the digits.

    >>> supported_digits(Estimate(17.0213, error=0.0023))
    2
    """
    if not estimate.error:
        return None
    return math.floor(-math.log10(2.0 * estimate.error))


def finite_json(value: object) -> object:
    """Return a value with null for each number that JSON cannot hold."""
    match value:
        case float():
            return finite(value)
        case dict():
            return {key: finite_json(each) for key, each in value.items()}
        case list() | tuple():
            return [finite_json(each) for each in value]
        case _:
            return value
