"""Excel's 15 digits: how it compares numbers, and when the last sum of a formula becomes 0.

`=`, `<>`, `<`, `<=`, `>` and `>=` compare both numbers rounded to 15 significant decimal digits, halves away from zero:
0.1+0.2 equals 0.3. Numbers with the same digits are equal; all others compare as doubles. A number below 2^-1022 in
size is 0. The doubles at which Excel's answer changes are known for 33 numbers (Apache POI,
`NumberComparisonExamples`): this rule gives all of them to the last bit.

Numbers are rounded only where it may matter. The doubles that are equal to a constant form a range, so a comparison
with the constant is one with an end of that range. Two numbers that vary are nearly always so far apart that their
difference shows they are not equal.

If a formula ends with a `+` or `-` that cancels all but the last bits, Excel gives 0:

    0 where |result| < 8 units in the last digit of the first number

This was found by trying numbers in Excel: `n` units with n from 1 to 7 give 0, 8 do not, at sizes from 1E-7 to 1E308
(joeu2004 and J. W. Lewis, microsoft.public.excel.worksheet.functions, April 2009; S. Byrne, Stack Overflow 40293983,
2016, who names the first number). Microsoft says no more than "at or very close to zero" (article 78113). A result that
is too small a number for Excel is 0, too; see `denormals`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.excel.functions.budget import work_arrays
from xlmc.excel.functions.denormals import TINIEST
from xlmc.excel.functions.facts import Facts
from xlmc.excel.functions.number_text import round_to_15_digits
from xlmc.excel.functions.registry import Function, Kind, Number
from xlmc.excel.functions.values import Bools, Floats

__all__ = [
    "COMPARISONS",
    "EIGHT_UNITS",
    "EXCHANGED",
    "NEAR",
    "SNAP_TO_ZERO",
    "Comparison",
    "SnapToZero",
    "copy_sum",
    "equal_range",
    "never_cancels",
]

Bounds = tuple[float, float]
"""The least and the largest number; one may be infinite."""

NEAR: Final = 1.01e-14
"""Two numbers that are equal at 15 digits differ by at most this share of either."""

_FARTHEST: Final = 128
"""Within this many doubles above or below a number, its 15 digits change."""

EXCHANGED: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "=", "<>": "<>"}
"""Each comparison, and the one that gives the same answer with the two numbers exchanged."""


def _are_equal(x: float, y: float) -> bool:
    """Return whether two finite numbers are equal at 15 digits."""
    x, y = (0.0 if abs(number) < TINIEST else number for number in (x, y))
    return x == y or round_to_15_digits(x) == round_to_15_digits(y)


@lru_cache(maxsize=4096)
def equal_range(number: float) -> tuple[float, float]:
    """Return the least and the largest double that are equal to a number at 15 digits.

    For an infinity or NaN, both are the number itself.

    >>> equal_range(0.3)[0] < 0.3 < 0.1 + 0.2 <= equal_range(0.3)[1]
    True
    """
    if not math.isfinite(number):
        return number, number
    if number < 0.0:
        least, most = equal_range(-number)
        return -most, -least
    if number < TINIEST:
        most = math.nextafter(TINIEST, 0.0)
        return -most, most
    return _last_equal(number, -1), _last_equal(number, 1)


def _last_equal(number: float, sign: int) -> float:
    """Return the last double above (`sign` 1) or below (-1) that is equal to a positive number."""
    (bits,) = struct.unpack("<q", struct.pack("<d", number))  # doubles are in the order of their bits

    def at(steps: int) -> float:
        (value,) = struct.unpack("<d", struct.pack("<q", bits + sign * steps))
        return float(value)

    near, far = 0, _FARTHEST
    while far - near > 1:
        middle = (near + far) // 2
        result = at(middle)
        if math.isfinite(result) and _are_equal(result, number):
            near = middle
        else:
            far = middle
    return at(near)


@dataclass(frozen=True, slots=True)
class Comparison:
    """Compares two arrays at 15 digits, and is called like a ufunc.

    Args:
        symbol: of the comparison.
        plain: the comparison of all bits.
        largest: the size that one of the numbers never exceeds (rounding apart), if that is known beforehand.
    """

    symbol: str
    plain: np.ufunc
    largest: float | None = None
    nin: ClassVar[int] = 2

    def within(self, first: Bounds | None, second: Bounds | None) -> Comparison:
        """Return the same comparison for numbers that have these bounds; None are unknown bounds."""
        return replace(self, largest=_least_size(first, second))

    def __call__(self, x: Any, y: Any, out: Bools | None = None) -> Bools:
        """Compare numbers whose shapes broadcast."""
        if np.size(y) == 1:
            return _compare_with_constant(self.symbol, x, equal_range(_only(y)), out)
        if np.size(x) == 1:
            return _compare_with_constant(EXCHANGED[self.symbol], y, equal_range(_only(x)), out)
        limit = NEAR * (_size(x) if self.largest is None else 2.0 * self.largest) + TINIEST
        apart = _subtract(x, y)
        above = np.greater(apart, limit, out=out)
        if np.count_nonzero(above) + np.count_nonzero(apart < -limit) == apart.size:
            return _from_above(self.symbol, above)
        mask: Bools = self.plain(x, y, out=out)
        mask[_find_equal(x, y, np.abs(apart, out=apart) <= limit)] = self.symbol in ("=", "<=", ">=")
        return mask


def _from_above(symbol: str, above: Bools) -> Bools:
    """Fill `above`, which says where x > y, with the comparison of numbers that differ everywhere."""
    match symbol:
        case "<" | "<=":
            np.logical_not(above, out=above)
        case "=" | "<>":
            above.fill(symbol == "<>")
    return above


def _only(number: Any) -> float:
    return float(np.asarray(number).reshape(-1)[0])


def _compare_with_constant(symbol: str, x: Any, equal: tuple[float, float], out: Bools | None) -> Bools:
    """Compare `x` with a constant, of which the least and the largest equal double are given."""
    least, most = equal
    match symbol:
        case "<":
            return np.asarray(np.less(x, least, out=out))
        case "<=":
            return np.asarray(np.less_equal(x, most, out=out))
        case ">":
            return np.asarray(np.greater(x, most, out=out))
        case ">=":
            return np.asarray(np.greater_equal(x, least, out=out))
        case "=":
            values = np.asarray(np.greater_equal(x, least, out=out))
            return np.asarray(np.logical_and(values, np.less_equal(x, most), out=values))
        case _:
            values = np.asarray(np.less(x, least, out=out))
            return np.asarray(np.logical_or(values, np.greater(x, most), out=values))


def _find_equal(x: Floats, y: Floats, near: Bools) -> tuple[NDArray[np.intp], ...]:
    """Return the indices of numbers that differ but are equal at 15 digits, all of them among those that are near."""
    x, y = np.broadcast_arrays(x, y)
    indices = np.nonzero(near & (x != y))
    pairs = zip(x[indices].tolist(), y[indices].tolist(), strict=True)
    alike = np.array([abs(a - b) <= NEAR * abs(a) + TINIEST and _are_equal(a, b) for a, b in pairs], bool)
    return tuple(index[alike] for index in indices)


def _subtract(x: Floats, y: Floats) -> Floats:
    """Return x - y, in memory that the next call writes to again."""
    if x.shape != y.shape:
        return np.asarray(x - y)
    (work,) = work_arrays(x.size, 1)
    return np.subtract(x, y, out=work.reshape(x.shape))


COMPARISONS: Final[Mapping[str, Comparison]] = {
    symbol: Comparison(symbol, plain)
    for symbol, plain in (
        ("=", np.equal),
        ("<>", np.not_equal),
        ("<", np.less),
        ("<=", np.less_equal),
        (">", np.greater),
        (">=", np.greater_equal),
    )
}


EIGHT_UNITS: Final = 2.0**-49
"""Eight units in the last digit, as a share of a power of two."""

_SURELY: Final = 2.0**-30
"""A result above this share is surely more than the last bits, even if its bounds are rounded."""


@dataclass(frozen=True, slots=True)
class SnapToZero:
    """Sets the last sum of a formula to 0 where Excel does; called like a ufunc with the sum and its first number.

    The result may be written over either.

    Args:
        largest: the size that the first number never exceeds (rounding apart), if that is known beforehand.
    """

    largest: float | None = None
    nin: ClassVar[int] = 2

    @classmethod
    def within(cls, first: Bounds | None, second: Bounds | None) -> SnapToZero:
        """Return the snap for sums of numbers, or differences, that have these bounds; None are unknown bounds.

        Where all but the last bits cancel, the first number is less than twice the second.
        """
        least = _least_size(first, second)
        return cls(None if least is None else 2.0 * least)

    def __call__(self, result: Any, first: Any, out: Floats | None = None) -> Floats:
        """Return 0 where the sum is only the last bits of the first number, else the sum."""
        result, first = np.asarray(result), np.asarray(first)
        limit = 2.0 * EIGHT_UNITS * (_size(first) if self.largest is None else self.largest)
        last_bits = None if _is_far_from_0(result, max(limit, TINIEST)) else _is_last_bits(result, first)
        if out is None:
            values: Floats = np.array(result if last_bits is None else np.broadcast_to(result, last_bits.shape))
        else:
            values = out
            if values is not result:
                np.copyto(values, result)
        if last_bits is not None:
            values[last_bits] = 0.0
        return values


def _size(x: Floats) -> float:
    least, most = np.minimum.reduce(x, axis=None, initial=0.0), np.maximum.reduce(x, axis=None, initial=0.0)
    return max(-float(least), float(most))


def _least_size(*bounds: Bounds | None) -> float | None:
    """Return the least size that one of some numbers never exceeds, by the bounds that are known."""
    least = min((max(map(abs, ends)) for ends in bounds if ends is not None), default=math.inf)
    return least if least < math.inf else None


def _is_far_from_0(result: Floats, limit: float) -> bool:
    """Return whether all results are at least this large, all positive or all negative."""
    below = np.count_nonzero(result < limit)
    return below == 0 or bool(below == np.count_nonzero(result <= -limit))


def _is_last_bits(result: Floats, first: Floats) -> Bools:
    """Return where the result is only the last bits of the first number."""
    _, exponents = np.frexp(first)
    eight = np.where(first == 0, 0.0, np.ldexp(0.5 * EIGHT_UNITS, exponents))
    return np.asarray(np.abs(result) < np.maximum(eight, TINIEST))


def copy_sum(result: Floats, first: Floats, out: Floats) -> Floats:
    """Return the sum as it is: for sums that are known to be more than the last bits."""
    if out is not result:
        np.copyto(out, result)
    return out


def never_cancels(result: Bounds, first: Bounds, second: Bounds | None) -> bool:
    """Return whether the bounds show that no sum is only the last bits of its first number.

    Args:
        result: the bounds of the sum.
        first: the bounds of its first number.
        second: the bounds of the number that is added; None if it is subtracted.
    """
    if second is not None and (min(*first, *second) >= 0 or max(*first, *second) <= 0):
        return True
    limit = max(_SURELY * max(abs(first[0]), abs(first[1])), TINIEST)
    return result[0] > limit or result[1] < -limit


_SNAP: Final = SnapToZero()

SNAP_TO_ZERO: Final = Function(
    "snap to zero", (Number, Number), _SNAP, Kind.NUMBER, ufunc=_SNAP, facts=Facts(never_errs=True)
)
"""The function takes a sum, and the first number of that sum."""
