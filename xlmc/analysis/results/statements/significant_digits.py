"""Shares and ranges in no more digits than their errors support."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Decimal
from typing import TYPE_CHECKING

from xlmc.montecarlo.statistics import Estimate, probability_between

if TYPE_CHECKING:
    from xlmc.montecarlo.statistics import Sample

__all__ = ["RoundedRange", "percent_text", "reach_text", "rounded_range", "rounded_value"]

_DIGITS, _SINGLE_DIGITS = 6, 12
"""Significant digits of a number without an error; and of one that is the same in all trials."""

_WIDEST = 17
"""Digits before or after the point beyond which a number is written with a power of ten, and not rounded."""


@dataclass(frozen=True, slots=True)
class RoundedRange:
    """A central range in words that people can quote.

    Attributes:
        low, high: its rounded ends.
        low_text, high_text: the same in words.
        share: of the accepted trials from `low` to `high`, ends included.
    """

    low: float
    high: float
    low_text: str
    high_text: str
    share: Estimate


def rounded_range(sample: Sample, ends: tuple[Estimate, Estimate], nominal: float) -> RoundedRange | None:
    """The central range with its ends in the digits that the errors of both support, so that it still holds its share.

    Each end is rounded to the nearest number, unless the range would then hold less than `nominal` of the trials: then
    one end, or both, are rounded outwards. A single value is rounded in words alone. None where there are no trials.
    """
    low, high = (end.value for end in ends)
    if math.isnan(low) or math.isnan(high):
        return None
    decimals = _common_decimals(*ends)
    if low == high:
        text = _text(_round(low, decimals, ROUND_HALF_EVEN, _SINGLE_DIGITS))
        return RoundedRange(low, high, text, text, probability_between(sample, low, high))
    best: RoundedRange | None = None
    for down, up in ((False, False), (False, True), (True, False), (True, True)):
        first = _round(low, decimals, ROUND_FLOOR if down else ROUND_HALF_EVEN)
        last = _round(high, decimals, ROUND_CEILING if up else ROUND_HALF_EVEN)
        share = probability_between(sample, float(first), float(last))
        found = RoundedRange(float(first), float(last), _text(first), _text(last), share)
        if share.value >= nominal and (best is None or share.value < best.share.value):
            best = found
    return best if best is not None else found


def rounded_value(found: Estimate) -> tuple[float, str]:
    """A number in the digits that its error supports, and the same in words; not for nan.

    >>> rounded_value(Estimate(11.8435, 0.019))
    (11.84, '11.84')
    """
    value = _round(found.value, _common_decimals(found), ROUND_HALF_EVEN)
    return float(value), _text(value)


def percent_text(share: Estimate) -> str:
    """A share in percent with its error to one digit, to two where that is a 1; a bound for none or all of the trials.

    >>> percent_text(Estimate(0.14213, 0.0042, n=7000))
    '14.2 % ± 0.4 %'
    >>> from xlmc.montecarlo.statistics import proportion
    >>> percent_text(proportion(0, 30_000))
    '0 of 30,000 trials; at most 0.013 % with 95 % confidence'
    """
    if math.isnan(share.value):
        return "no trials"
    if share.value in (0.0, 1.0):
        return _bound(share)
    if share.error is None:
        return f"{100.0 * share.value:.3g} %"
    error = 100.0 * share.error
    mantissa, _, exponent = f"{error:.0e}".partition("e")
    decimals = max(0, -int(exponent) + (mantissa == "1"))
    return f"{100.0 * share.value:.{decimals}f} % ± {error:.{decimals}f} %"


def _bound(share: Estimate) -> str:
    trials = f"0 of {share.n:,} trials" if share.value == 0.0 else f"all {share.n:,} trials"
    reach = reach_text(share)
    return f"{trials}; {reach} with 95 % confidence" if reach else trials


def reach_text(share: Estimate) -> str:
    """How far a share of none or all of the trials may be from 0 or 1; empty where that is not known.

    >>> from xlmc.montecarlo.statistics import proportion
    >>> reach_text(proportion(0, 5)), reach_text(proportion(5, 5))
    ('at most 46 %', 'at least 54 %')
    """
    if share.interval is None:
        return ""
    low, high = share.interval
    reach = Decimal(repr(100.0 * (high if share.value == 0.0 else 1.0 - low)))
    if not reach:
        return ""
    reach = reach.quantize(Decimal(1).scaleb(reach.adjusted() - 1), ROUND_CEILING)
    return f"at most {reach:f} %" if share.value == 0.0 else f"at least {100 - reach:f} %"


def _common_decimals(*ends: Estimate) -> int | None:
    """How many decimals: the finest unit that is at least half the largest error; None where there is no error."""
    errors = [end.error for end in ends if end.error]
    return math.floor(-math.log10(max(errors) / 2.0)) if errors else None


def _size(value: float) -> int:
    """The power of ten of a number: 0.02 -> -2."""
    return Decimal(repr(value)).adjusted() if value else 0


def _round(value: float, decimals: int | None, rounding: str, significant: int = _DIGITS) -> Decimal:
    exact, size = Decimal(repr(value)), _size(value)
    digits = significant - 1 - size if decimals is None else decimals
    if max(abs(digits), abs(size)) > _WIDEST:
        return exact
    found = exact.quantize(Decimal(1).scaleb(-digits), rounding)
    return found.normalize() if decimals is None else found


def _text(value: Decimal) -> str:
    if value and abs(value.adjusted()) > _DIGITS:
        return f"{value:.{len(value.as_tuple().digits) - 1}e}"
    return f"{value if value else abs(value):,f}"
