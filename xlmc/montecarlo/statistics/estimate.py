"""A number and how well it is known: its value, standard error and interval, and how many digits are printed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from xlmc.montecarlo.interruption import checkpoint

__all__ = ["Estimate", "finite", "finite_json", "format_estimate", "supported_digits", "two_digit_exponent"]

LEAST_DOF = 1.0 - 1e-9
"""Fewer degrees of freedom give no error; the margin is for the rounding of an effective sample size."""

LENGTHENED = 0.15
"""Intervals are longer by this share of the skewness, because a sample shows too little of it."""

MOST_DIGITS = 15  # all that a double holds for certain
_EXACT_DIGITS = range(6, 13)  # of a value whose error is 0
_NOISE = 1e-9  # share of such a value that may come from rounding in formulas


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


def format_estimate(value: float, error: float | None) -> str:
    """Write the error to two significant digits and the value to the same decimal.

    A value whose error is not known has six digits; one whose error is 0, as a constant's, has more where it needs
    them.

    >>> format_estimate(17.02134, 0.00231)
    '17.0213 ± 0.0023'
    >>> format_estimate(48211.3, 870.0)
    '48210 ± 870'
    >>> format_estimate(17.02134, None)
    '17.0213'
    >>> format_estimate(1234567.8, 0.0), format_estimate(0.1 + 0.2, 0.0)
    ('1234567.8 ± 0', '0.3 ± 0')
    """
    if error is None or not math.isfinite(value):
        return f"{value:.6g}"
    if error == 0.0:
        return f"{_exact_text(value)} ± 0"
    size = two_digit_exponent(max(abs(value), error))
    if not -4 <= size < MOST_DIGITS:
        scaled = format_estimate(value / 10.0**size, error / 10.0**size)
        return f"({scaled})e{size:+03d}"
    decimals = 1 - two_digit_exponent(error)
    if decimals + size >= MOST_DIGITS:  # an error below the last bit of the value
        return f"{value:.{MOST_DIGITS}g} ± {error:.1e}"
    return f"{_write_rounded(value, decimals)} ± {_write_rounded(error, decimals)}"


def _exact_text(value: float) -> str:
    """Return the fewest digits, six or more, that say what the value is, up to rounding in formulas."""
    texts = [f"{value:.{digits}g}" for digits in _EXACT_DIGITS]
    return next((text for text in texts if abs(float(text) - value) <= _NOISE * abs(value)), texts[-1])


def two_digit_exponent(number: float) -> int:
    """Return the power of ten of a number rounded to two digits: 0.00996 -> -2."""
    return int(f"{number:.1e}".partition("e")[2])


def _write_rounded(number: float, decimals: int) -> str:
    return f"{round(number, decimals) + 0.0:.{max(decimals, 0)}f}"  # + 0.0: no negative zero


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
