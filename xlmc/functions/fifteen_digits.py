"""Numbers as Excel's comparisons see them: with 15 significant digits.

`=`, `<>`, `<`, `<=`, `>` and `>=` compare both numbers rounded to 15 significant decimal digits, halves away from zero:
0.1+0.2 equals 0.3. Numbers of the same digits are equal; all others are ordered as they are. What is below 2^-1022 in
size is 0. Doubles were tried in Excel for where its answer changes (Apache POI, `NumberComparisonExamples`): the rule
gives each of these 33 steps to the last bit.

Digits are counted only where they may matter. All doubles that are equal to a constant lie between two, so that to
compare with the constant is to compare with one of these. Of two numbers that vary, their difference nearly always
tells that they are not equal.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.functions.denormals import TINIEST
from xlmc.functions.number_text import shown
from xlmc.functions.values import Bools, Floats
from xlmc.functions.work_memory import work_arrays

__all__ = ["COMPARISONS", "NEAR", "TWINS", "Comparison", "equals"]

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
    (place,) = struct.unpack("<q", struct.pack("<d", number))  # doubles are in the order of their bits

    def at(steps: int) -> float:
        (found,) = struct.unpack("<d", struct.pack("<q", place + way * steps))
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
    places = np.nonzero(near & (x != y))
    pairs = zip(x[places].tolist(), y[places].tolist(), strict=True)
    alike = np.array([abs(a - b) <= NEAR * abs(a) + TINIEST and _alike(a, b) for a, b in pairs], bool)
    return tuple(place[alike] for place in places) if alike.any() else None


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
