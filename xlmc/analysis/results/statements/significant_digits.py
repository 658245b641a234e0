"""Shares and ranges in no more digits than their errors support."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Decimal
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import count_text, fixed_text, is_far, number_text, styled_text
from xlmc.montecarlo.statistics import Estimate, probability_between

if TYPE_CHECKING:
    from xlmc.montecarlo.statistics import Sample

__all__ = ["EVEN", "RoundedRange", "percent_text", "reach_text", "rounded_range", "rounded_value", "surely_above"]

EVEN: Final = 0.5
"""Even odds: above it something is more probable than not."""

_DIGITS, _SINGLE_DIGITS = 6, 12
"""Significant digits of a number without an error; and of one that is the same in all trials and has few decimals."""

_LAST_BITS = 1e-12
"""By how much a multiple of a resolution may be off, relative to it."""

_WIDEST = 17
"""Digits before or after the point beyond which a number is written with a power of ten, and not rounded."""


@dataclass(frozen=True, slots=True)
class RoundedRange:
    """A central range, or one side of it, in words that people can quote.

    Attributes:
        low, high: its rounded ends; infinite where one side alone is stated.
        low_text, high_text: the same in words.
        share: of the accepted trials from `low` to `high`, ends included.
    """

    low: float
    high: float
    low_text: str
    high_text: str
    share: Estimate

    def words(self, units: str, first: str = "from", last: str = "to") -> str:
        """`from 22 to 24 mph`; `at least 22 mph` or `at most 24 mph` where one side alone is stated."""
        if not self.low_text:
            return f"at most {self.high_text}{units}"
        if not self.high_text:
            return f"at least {self.low_text}{units}"
        return f"{first} {self.low_text} {last} {self.high_text}{units}"


def rounded_range(
    sample: Sample,
    ends: tuple[Estimate | None, Estimate | None],
    nominal: float,
    resolution: float | None = None,
    form: Form = PLAIN,
) -> RoundedRange | None:
    """Round a range so that what is said of it holds for its ends as they are printed.

    Each end is rounded to the nearest multiple of the resolution, or of a finer or coarser unit that the errors of the
    ends support. If the range then holds less than `nominal` of the trials, or if `nominal` is above one half and the
    95 % interval of its share is not, ends are rounded outwards, and moved out unit by unit until both hold. A single
    value is rounded in words alone. None if there are no trials.

    Args:
        sample: the accepted trials.
        ends: of the range; None for an end that is not stated.
        nominal: the share that it holds.
        resolution: the step of the ends, which is used unless their errors are larger.
        form: how the ends are written.
    """
    known = [end for end in ends if end is not None]
    if any(math.isnan(end.value) for end in known):
        return None
    resolution = form.step(max((end.error or 0.0 for end in known), default=0.0)) or resolution
    rounding = _Rounding(sample, ends, _unit(known, resolution), form)
    value = known[0].value
    if len(known) > 1 and value == known[1].value and (resolution is None or _is_multiple(value, resolution)):
        return rounding.single(value)
    if rounded := _least(rounding, _NEAREST_FIRST, nominal):
        return rounded
    return _widened(rounding, nominal) or _least(rounding, [(0, 0)], nominal, claimed=False)


Steps = tuple[int | None, int | None]
"""How many units outwards of the end rounded outwards, on either side; None for the nearest multiple."""

_NEAREST_FIRST: Final[tuple[Steps, ...]] = ((None, None), (None, 0), (0, None), (0, 0))


@dataclass(frozen=True, slots=True)
class _Rounding:
    """Ranges about two ends, or one, in steps of a unit; without a unit in six digits, and not wider."""

    sample: Sample
    ends: tuple[Estimate | None, Estimate | None]
    unit: Decimal | None
    form: Form

    def single(self, value: float) -> RoundedRange:
        """Return the range of one value, which its text alone rounds."""
        rounded = _round(value, self.unit, ROUND_HALF_EVEN, _SINGLE_DIGITS)
        if _decimals(rounded) > _DIGITS:
            rounded = _round(value, self.unit, ROUND_HALF_EVEN).normalize()
        text = _text(rounded, self.form)
        return RoundedRange(value, value, text, text, probability_between(self.sample, value, value))

    def range(self, steps: Steps) -> RoundedRange:
        """Return the range with its ends so many steps out."""
        low, high = self._alike(self._end(0, steps[0]), self._end(1, steps[1]))
        first, last = -math.inf if low is None else float(low), math.inf if high is None else float(high)
        share = probability_between(self.sample, first, max(first, last))
        first_text, last_text = ("" if end is None else _text(end, self.form) for end in (low, high))
        return RoundedRange(first, last, first_text, last_text, share)

    def _end(self, side: int, steps: int | None) -> Decimal | None:
        end, outwards = self.ends[side], (ROUND_FLOOR, ROUND_CEILING)[side]
        if end is None:
            return None
        if steps is None:
            return _round(end.value, self.unit or self._six_digits, ROUND_HALF_EVEN)
        if self.unit is None:
            whole = self.sample.x[(0, -1)[side]]
            return _round(float(whole) if steps else end.value, self._six_digits, outwards)
        return _round(end.value, self.unit, outwards) + (-1, 1)[side] * steps * self.unit

    @property
    def _six_digits(self) -> Decimal | None:
        """The last of six digits of the larger of two ends without an error; None for one end."""
        sizes = [_size(end.value) for end in self.ends if end is not None]
        return (
            Decimal(1).scaleb(max(sizes) + 1 - _DIGITS) if len(sizes) > 1 and max(map(abs, sizes)) < _WIDEST else None
        )

    def _alike(self, low: Decimal | None, high: Decimal | None) -> tuple[Decimal | None, Decimal | None]:
        """Write two ends without an error with as few decimals as both need."""
        if self.unit is not None or low is None or high is None or self._six_digits is None:
            return low, high
        unit = Decimal(1).scaleb(min(0, *(int(end.normalize().as_tuple().exponent) for end in (low, high))))
        return low.quantize(unit), high.quantize(unit)

    def is_whole(self, rounded: RoundedRange) -> bool:
        """Whether the range holds every trial."""
        return bool(rounded.low <= self.sample.x[0] and rounded.high >= self.sample.x[-1])


def _least(rounding: _Rounding, steps: Iterable[Steps], nominal: float, *, claimed: bool = True) -> RoundedRange | None:
    """Return the range with the least share of those that hold what is said of them; of equal ones the first."""
    every = dict.fromkeys(rounding.range(each) for each in steps)
    roundeds = [each for each in every if not claimed or _holds(each.share, nominal)]
    return min(roundeds, key=lambda each: each.share.value, default=None)


def _holds(share: Estimate, nominal: float) -> bool:
    """Whether a share is at least the nominal one and, where that is above one half, surely so."""
    return share.value >= nominal and (nominal <= EVEN or surely_above(share, EVEN))


def surely_above(share: Estimate, bound: float) -> bool:
    """Whether the whole 95 % interval of a share lies above a bound."""
    return (share.value if share.interval is None else share.interval[0]) > bound


def _widened(rounding: _Rounding, nominal: float) -> RoundedRange | None:
    """Return the narrowest range, with ends as many steps out on both sides or one step less, that holds; None if none
    is.

    The number of steps is doubled until a range holds, and then the least is sought.
    """
    least, most = 0, 1
    while not _holds((rounded := rounding.range((most, most))).share, nominal):
        if rounding.is_whole(rounded):
            return None
        least, most = most, 2 * most
    while most - least > 1:
        middle = (least + most) // 2
        least, most = (least, middle) if _holds(rounding.range((middle, middle)).share, nominal) else (middle, most)
    return _least(rounding, [(most - 1, most), (most, most - 1), (most, most)], nominal)


def rounded_value(estimate: Estimate, resolution: float | None = None, form: Form = PLAIN) -> tuple[float, str]:
    """Write a number in the digits that its error and the resolution support, and the same in words; not for nan.

    >>> rounded_value(Estimate(11.8435, 0.019))
    (11.84, '11.84')
    >>> rounded_value(Estimate(11.8435, 0.019), 0.5)
    (12.0, '12.0')
    """
    value = _round(estimate.value, _unit([estimate], form.step(estimate.error or 0.0) or resolution), ROUND_HALF_EVEN)
    return float(value), _text(value, form)


def percent_text(share: Estimate) -> str:
    """Write a share in percent with its error to one digit, to two for a 1; as a bound for none or all of the trials.

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
        return f"{number_text(100.0 * share.value, 3)} %"
    error = 100.0 * share.error
    mantissa, _, exponent = f"{error:.0e}".partition("e")
    decimals = max(0, -int(exponent) + (mantissa == "1"))
    return f"{fixed_text(100.0 * share.value, decimals)} % ± {fixed_text(error, decimals)} %"


def _bound(share: Estimate) -> str:
    trials = f"{'0 of' if share.value == 0.0 else 'all'} {count_text(share.n)} trials"
    if share.n == 1:
        trials = "0 of 1 trial" if share.value == 0.0 else "the only trial"
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
    of_none = share.value == 0.0
    return f"{'at most' if of_none else 'at least'} {styled_text(reach if of_none else 100 - reach, 'f')} %"


def _unit(ends: Sequence[Estimate], resolution: float | None) -> Decimal | None:
    """Return the finest power of ten that is at least half the largest error, or the resolution if that is not finer.

    None if there is neither.
    """
    errors = [end.error for end in ends if end.error]
    supported = Decimal(1).scaleb(-math.floor(-math.log10(max(errors) / 2.0))) if errors else None
    if resolution is None:
        return supported
    asked = Decimal(repr(resolution)).normalize()
    return asked if supported is None or asked >= Decimal(repr(max(errors) / 2.0)) else max(asked, supported)


def _is_multiple(value: float, resolution: float) -> bool:
    """Whether a number is a multiple of the resolution, but for the last bits."""
    steps = value / resolution
    return abs(steps - round(steps)) <= _LAST_BITS * max(1.0, abs(steps))


def _size(value: float) -> int:
    """Return the power of ten of a number: 0.02 -> -2."""
    return Decimal(repr(value)).adjusted() if value else 0


def _round(value: float, unit: Decimal | None, rounding: str, significant: int = _DIGITS) -> Decimal:
    exact, size = Decimal(repr(value)), _size(value)
    step = Decimal(1).scaleb(size + 1 - significant) if unit is None else unit
    if max(abs(step.adjusted()), abs(size)) > _WIDEST:
        return exact
    number = (exact / step).quantize(Decimal(1), rounding) * step
    return number.normalize() if unit is None else number


def _text(value: Decimal, form: Form) -> str:
    if form.kind is not Kind.DATE and is_far(form.factor * float(value)):
        return styled_text(float(value), f".{len(value.as_tuple().digits) - 1}e")
    return form.number(float(value), max(_decimals(value) - round(math.log10(form.factor)), 0))


def _decimals(value: Decimal) -> int:
    exponent = value.as_tuple().exponent
    return -exponent if isinstance(exponent, int) else 0
