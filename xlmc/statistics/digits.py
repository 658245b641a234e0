"""How many digits of a number mean anything: print no more than the standard error supports."""

from __future__ import annotations

import math

from xlmc.statistics.estimate import Estimate

__all__ = ["format_estimate", "supported_digits"]

MOST_DIGITS = 15  # all that a double holds for certain


def supported_digits(estimate: Estimate) -> int | None:
    """Decimals for the value printed alone: the last one is good to ± 1 with 95 % confidence (2 errors ≤ 1 unit).

    Negative for tens, hundreds, …; None where no error limits the digits.

    >>> supported_digits(Estimate(17.0213, error=0.0023))
    2
    """
    if not estimate.error:
        return None
    return math.floor(-math.log10(2.0 * estimate.error))


def format_estimate(value: float, error: float | None) -> str:
    """The error to two significant digits and the value to the same decimal; six digits where there is no error.

    >>> format_estimate(17.02134, 0.00231)
    '17.0213 ± 0.0023'
    >>> format_estimate(48211.3, 870.0)
    '48210 ± 870'
    >>> format_estimate(17.02134, None)
    '17.0213'
    """
    if error is None or not math.isfinite(value):
        return f"{value:.6g}"
    if error == 0.0:
        return f"{value:.6g} ± 0"
    size = _exponent(max(abs(value), error))
    if not -4 <= size < MOST_DIGITS:
        scaled = format_estimate(value / 10.0**size, error / 10.0**size)
        return f"({scaled})e{size:+03d}"
    decimals = 1 - _exponent(error)
    if decimals + size >= MOST_DIGITS:  # an error below the last bit of the value
        return f"{value:.{MOST_DIGITS}g} ± {error:.1e}"
    return f"{_rounded(value, decimals)} ± {_rounded(error, decimals)}"


def _exponent(number: float) -> int:
    """The power of ten of a number rounded to two digits: 0.00996 -> -2."""
    return int(f"{number:.1e}".partition("e")[2])


def _rounded(number: float, decimals: int) -> str:
    return f"{round(number, decimals) + 0.0:.{max(decimals, 0)}f}"  # + 0.0: no negative zero
