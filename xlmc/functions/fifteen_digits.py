"""Excel's 15 digits: how it compares numbers, and what it makes of the last sum of a formula.

`=`, `<>`, `<`, `<=`, `>` and `>=` compare both numbers rounded to 15 significant decimal digits, halves away from zero:
0.1+0.2 equals 0.3. Numbers of the same digits are equal; all others are ordered as they are. What is below 2^-1022 in
size is 0. Doubles were tried in Excel for where its answer changes (Apache POI, `NumberComparisonExamples`): the rule
gives each of these 33 steps to the last bit.

Digits are counted only where they may matter. All doubles that are equal to a constant lie between two, so that to
compare with the constant is to compare with one of these. Of two numbers that vary, their difference nearly always
tells that they are not equal.

Of the `+` or `-` that a formula ends with, Excel makes 0 where the result cancels but for the last bits:

    0 where |result| < 8 units in the last digit of the first number

It was found by trying numbers in Excel: `n` units with n from 1 to 7 give 0, 8 do not, at sizes from 1E-7 to 1E308
(joeu2004 and J. W. Lewis, microsoft.public.excel.worksheet.functions, April 2009; S. Byrne, Stack Overflow 40293983,
2016, who names the first number). Microsoft says no more than "at or very close to zero" (article 78113). A result that
is too small a number for Excel is 0, too; see `denormals`.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.budget import work_arrays
from xlmc.functions.denormals import TINIEST
from xlmc.functions.facts import Facts
from xlmc.functions.number_text import shown
from xlmc.functions.registry import Function, Kind, Number
from xlmc.functions.values import Bools, Floats

__all__ = [
    "COMPARISONS",
    "EIGHT_UNITS",
    "NEAR",
    "SETTLED",
    "TWINS",
    "Comparison",
    "Settled",
    "equals",
    "keep",
    "never_cancels",
]

NEAR: Final = 1.01e-14
"""As a share of either of two numbers: those that are equal at 15 digits differ by no more."""

_FARTHEST: Final = 128
"""Doubles between which and a number there is one of other digits."""

TWINS: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "=", "<>": "<>"}
"""What the second number is to the first, where that is to it what stands on the left."""


def _alike(x: float, y: float) -> bool:
    """Whether two finite numbers are equal at 15 digits."""
    x, y = (0.0 if abs(number) < TINIEST else number for number in (x, y))
    return x == y or shown(x) == shown(y)


@lru_cache(maxsize=4096)
def equals(number: float) -> tuple[float, float]:
    """The least and the largest double that are equal to a number at 15 digits; of one that is not finite, itself.

    >>> equals(0.3)[0] < 0.3 < 0.1 + 0.2 <= equals(0.3)[1]
    True
    """
    if not math.isfinite(number):
        return number, number
    if number < 0.0:
        least, most = equals(-number)
        return -most, -least
    if number < TINIEST:
        most = math.nextafter(TINIEST, 0.0)
        return -most, most
    return _end(number, -1), _end(number, 1)


def _end(number: float, way: int) -> float:
    """The last double above, or below, that is equal to a positive number."""
    (bits,) = struct.unpack("<q", struct.pack("<d", number))  # doubles are in the order of their bits

    def at(steps: int) -> float:
        (found,) = struct.unpack("<d", struct.pack("<q", bits + way * steps))
        return float(found)

    near, far = 0, _FARTHEST
    while far - near > 1:
        middle = (near + far) // 2
        found = at(middle)
        if math.isfinite(found) and _alike(found, number):
            near = middle
        else:
            far = middle
    return at(near)


@dataclass(frozen=True, slots=True)
class Comparison:
    """Compares at 15 digits, called as a ufunc of two arrays is."""

    symbol: str
    plain: np.ufunc
    nin: int = 2

    def __call__(self, x: Any, y: Any, out: Bools | None = None) -> Bools:
        """Of numbers whose shapes go together."""
        if np.size(y) == 1:
            return _with_constant(self.symbol, x, equals(_only(y)), out)
        if np.size(x) == 1:
            return _with_constant(TWINS[self.symbol], y, equals(_only(x)), out)
        found: Bools = self.plain(x, y, out=out)
        equal = _nearly_equal(x, y)
        if equal is not None:
            found[equal] = self.symbol in ("=", "<=", ">=")
        return found


def _only(number: Any) -> float:
    return float(np.asarray(number).reshape(-1)[0])


def _with_constant(symbol: str, x: Any, equal: tuple[float, float], out: Bools | None) -> Bools:
    """How `x` compares with a constant, given between which doubles all lie that are equal to that."""
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
            found = np.asarray(np.greater_equal(x, least, out=out))
            return np.asarray(np.logical_and(found, np.less_equal(x, most), out=found))
        case _:
            found = np.asarray(np.less(x, least, out=out))
            return np.asarray(np.logical_or(found, np.greater(x, most), out=found))


def _nearly_equal(x: Floats, y: Floats) -> tuple[NDArray[np.intp], ...] | None:
    """Where numbers differ and are equal at 15 digits all the same; None where none are."""
    largest = max(-float(x.min(initial=0.0)), float(x.max(initial=0.0)))
    apart = _apart(x, y)
    near = apart <= NEAR * largest + TINIEST
    if not near.any():
        return None
    x, y = np.broadcast_arrays(x, y)
    indices = np.nonzero(near & (x != y))
    pairs = zip(x[indices].tolist(), y[indices].tolist(), strict=True)
    alike = np.array([abs(a - b) <= NEAR * abs(a) + TINIEST and _alike(a, b) for a, b in pairs], bool)
    return tuple(index[alike] for index in indices) if alike.any() else None


def _apart(x: Floats, y: Floats) -> Floats:
    """The sizes of the differences, in memory that is soon written to again."""
    if x.shape == y.shape:
        (work,) = work_arrays(x.size, 1)
        work = work.reshape(x.shape)
        return np.abs(np.subtract(x, y, out=work), out=work)
    return np.abs(x - y)


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
"""The share above which a result is no matter of the last bits, even where its bounds are rounded."""


@dataclass(frozen=True, slots=True)
class Settled:
    """Makes the last sum of a formula what Excel makes of it, called as a ufunc of two arrays is.

    The second may be the memory that the result goes to.

    Args:
        largest: the size that the first number never exceeds, but for rounding, where that is known beforehand.
    """

    largest: float | None = None
    nin: ClassVar[int] = 2

    def __call__(self, result: Any, first: Any, out: Floats | None = None) -> Floats:
        """0 where the sum is within the last bits of the first number, else the sum."""
        result, first = np.asarray(result), np.asarray(first)
        limit = 2.0 * EIGHT_UNITS * (_size(first) if self.largest is None else self.largest)
        dust = None if _is_far_from_0(result, max(limit, TINIEST)) else _dust(result, first)
        if out is None:
            found: Floats = np.array(result if dust is None else np.broadcast_to(result, dust.shape))
        else:
            found = out
            if found is not result:
                np.copyto(found, result)
        if dust is not None:
            found[dust] = 0.0
        return found


def _size(x: Floats) -> float:
    return max(-float(x.min(initial=0.0)), float(x.max(initial=0.0)))


def _is_far_from_0(result: Floats, limit: float) -> bool:
    """Whether each result is of this size or larger."""
    below = np.count_nonzero(result < limit)
    return below == 0 or bool(below == np.count_nonzero(result <= -limit))


def _dust(result: Floats, first: Floats) -> Bools:
    """Where the result is nothing but the last bits of the first number."""
    _, exponents = np.frexp(first)
    eight = np.where(first == 0, 0.0, np.ldexp(0.5 * EIGHT_UNITS, exponents))
    return np.asarray(np.abs(result) < np.maximum(eight, TINIEST))


def keep(result: Floats, first: Floats, out: Floats) -> Floats:
    """The sum as it is, where that is known to be no matter of the last bits."""
    if out is not result:
        np.copyto(out, result)
    return out


def never_cancels(result: tuple[float, float], first: tuple[float, float], second: tuple[float, float] | None) -> bool:
    """Whether bounds tell that no result is 0 but for the last bits.

    Args:
        result: of the sum.
        first: of the number in it that comes first.
        second: of the number that is added to it, if it is a sum and not a difference.
    """
    if second is not None and (min(*first, *second) >= 0 or max(*first, *second) <= 0):
        return True
    limit = max(_SURELY * max(abs(first[0]), abs(first[1])), TINIEST)
    return result[0] > limit or result[1] < -limit


_SETTLES: Final = Settled()

SETTLED: Final = Function(
    "settled", (Number, Number), _SETTLES, Kind.NUMBER, ufunc=_SETTLES, facts=Facts(never_errs=True)
)
"""The function of a sum, and of the number in it that comes first."""
