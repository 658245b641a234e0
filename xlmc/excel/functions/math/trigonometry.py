"""Angles and hyperbolic functions. Angles are in radians.

On processors with AVX-512, NumPy computes the tangent of eight numbers at a time, but sine and cosine one by one. There
this module makes sine and cosine of tangents, within 4 units in the last digit of the exact values; on other processors
it uses NumPy's own, within 1 unit. The choice depends on the processor alone, never on how many angles there are.

    T = tan(x/2), sin x = 2T / (1 + T²), cos x = sin x / tan x

The cosine as (1 - T²) / (1 + T²) would be quicker and loses digits where it is small.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.excel.functions.budget import work_arrays
from xlmc.excel.functions.facts import Domain, Facts
from xlmc.excel.functions.registry import Number, excel
from xlmc.excel.functions.values import DIV0, NUM, Bools, Floats

__all__ = ["Within", "sine_and_cosine"]

_LIMIT: Final = 2.0**27
"""Excel refuses the sine and its kin of larger angles, with `#NUM!`."""


@dataclass(frozen=True, slots=True)
class Within:
    """A guard: all numbers lie between -limit and limit."""

    limit: float

    def __call__(self, x: Floats) -> bool:
        """Whether all numbers lie there; NaN does not."""
        least, most = np.minimum.reduce(x, axis=None, initial=0.0), np.maximum.reduce(x, axis=None, initial=0.0)
        return bool(least > -self.limit and most < self.limit)

    def surely(self, low: float, high: float) -> bool:
        """Whether all numbers between these two lie there, and those that rounding puts past them."""
        return -0.5 * self.limit < low and high < 0.5 * self.limit


def _tangent_is_fast() -> bool:
    result = np.lib.introspect.opt_func_info(func_name="^tan$", signature="^float64$").get("tan", {})
    return any("X86_V4" in target["current"] or "AVX512" in target["current"] for target in result.values())


BY_TANGENTS: Final = _tangent_is_fast()


def sine_and_cosine(x: Floats, sine: Floats, cosine: Floats, work: Floats) -> None:
    """Compute the sine and the cosine of the same angles.

    Args:
        x: radians, `(n,)`.
        sine: `(n,)`, for the result.
        cosine: `(n,)`, for the result.
        work: `(n,)`, overwritten. None of the four arrays may overlap another.
    """
    if not BY_TANGENTS:
        np.sin(x, out=sine)
        np.cos(x, out=cosine)
        return
    _sine(x, sine, work)
    _cosine(x, sine, cosine, work)


def _sine(x: Floats, out: Floats, work: Floats) -> None:
    np.multiply(x, 0.5, out=out)
    np.tan(out, out=out)
    np.multiply(out, out, out=work)
    np.add(work, 1.0, out=work)
    np.add(out, out, out=out)
    np.divide(out, work, out=out)


def _cosine(x: Floats, sine: Floats, out: Floats, work: Floats) -> None:
    np.tan(x, out=out)
    np.add(out, _TINY, out=out)
    np.add(sine, _TINY, out=work)
    np.divide(work, out, out=out)


_TINY: Final = 1.1e-301
"""Makes 1 of 0 / 0 at an angle of 0, and changes no other quotient."""


class _Tangents:
    """The sine or the cosine, called as a ufunc is: `out` may be `x` itself."""

    nin: Final = 1

    def __init__(self, plain: np.ufunc, by_tangents: Callable[[Floats, Floats], None]) -> None:
        self._plain, self._by_tangents = plain, by_tangents

    def __call__(self, *x: Floats, out: Floats | None = None) -> Floats:
        """Return the function of one array of radians, of any shape."""
        if not BY_TANGENTS:
            return np.asarray(self._plain(*x, out=out))
        angles = np.ascontiguousarray(x[0], dtype=np.float64)
        own = np.empty_like(angles) if out is None else out
        self._by_tangents(angles.reshape(-1), own.reshape(-1))
        return own


def _sine_alone(x: Floats, out: Floats) -> None:
    _sine(x, out, *work_arrays(x.size, 1))


def _cosine_alone(x: Floats, out: Floats) -> None:
    sine, work = work_arrays(x.size, 2)
    _sine(x, sine, work)
    _cosine(x, sine, out, work)


_SINE: Final = _Tangents(np.sin, _sine_alone)
_COSINE: Final = _Tangents(np.cos, _cosine_alone)


excel("ASIN", Number, ufunc=np.arcsin, facts=Facts(domain=Domain(-1.0, 1.0)))(np.arcsin)
excel("ACOS", Number, ufunc=np.arccos, facts=Facts(domain=Domain(-1.0, 1.0)))(np.arccos)
excel("ATAN", Number, ufunc=np.arctan)(np.arctan)
excel("SINH", Number, ufunc=np.sinh)(np.sinh)
excel("COSH", Number, ufunc=np.cosh)(np.cosh)
excel("TANH", Number, ufunc=np.tanh, facts=Facts(result_range=(-1.0, 1.0)))(np.tanh)
excel("ASINH", Number, ufunc=np.arcsinh)(np.arcsinh)
excel("ACOSH", Number, ufunc=np.arccosh, facts=Facts(domain=Domain(1.0)))(np.arccosh)
excel("ATANH", Number, ufunc=np.arctanh, facts=Facts(domain=Domain(-1.0, 1.0)))(np.arctanh)
# x·(π/180) is to the bit what Excel gives, and NumPy's own functions are several times slower
excel("RADIANS", Number, ufunc=np.radians, facts=Facts(factor=np.pi / 180))(np.radians)
excel("DEGREES", Number, ufunc=np.degrees, facts=Facts(factor=180 / np.pi))(np.degrees)


def _is_small(x: Floats) -> Bools:
    return np.abs(x) < _LIMIT


_ALL_SMALL: Final = Within(_LIMIT)


@excel("SIN", Number, ufunc=_SINE, guard=_ALL_SMALL, facts=Facts(measures=True, result_range=(-1.0, 1.0)))
def sin(x: Floats) -> Floats:
    """Sine."""
    return np.where(_is_small(x), _SINE(x), NUM)


@excel("COS", Number, ufunc=_COSINE, guard=_ALL_SMALL, facts=Facts(measures=True, result_range=(-1.0, 1.0)))
def cos(x: Floats) -> Floats:
    """Cosine."""
    return np.where(_is_small(x), _COSINE(x), NUM)


@excel("TAN", Number, ufunc=np.tan, guard=_ALL_SMALL, facts=Facts(measures=True))
def tan(x: Floats) -> Floats:
    """Tangent."""
    return np.where(_is_small(x), np.tan(x), NUM)


@excel("SEC", Number)
def sec(x: Floats) -> Floats:
    """1 / cosine."""
    return np.where(_is_small(x), 1 / np.cos(x), NUM)


@excel("CSC", Number)
def csc(x: Floats) -> Floats:
    """1 / sine; `#DIV/0!` at 0."""
    return np.where(x == 0, DIV0, np.where(_is_small(x), 1 / np.sin(x), NUM))


@excel("COT", Number)
def cot(x: Floats) -> Floats:
    """1 / tangent; `#DIV/0!` at 0."""
    return np.where(x == 0, DIV0, np.where(_is_small(x), 1 / np.tan(x), NUM))


@excel("ATAN2", Number, Number)
def atan2(x: Floats, y: Floats) -> Floats:
    """Angle of the point (x, y), above -π and up to π: x comes first; `#DIV/0!` at (0, 0).

    Excel has one zero only, so that the point (-1, -0.0) lies at π: adding 0 takes the sign off.
    """
    return np.where((x == 0) & (y == 0), DIV0, np.arctan2(y + 0.0, x + 0.0))


@excel("ACOT", Number)
def acot(x: Floats) -> Floats:
    """Angle between 0 and π of a cotangent."""
    return np.asarray(np.arctan2(1.0, x))


@excel("ACOTH", Number)
def acoth(x: Floats) -> Floats:
    """Inverse hyperbolic cotangent; `#NUM!` from -1 to 1."""
    outside = np.abs(x) > 1
    return np.where(outside, np.arctanh(1 / np.where(outside, x, 2.0)), NUM)


@excel("COTH", Number)
def coth(x: Floats) -> Floats:
    """Hyperbolic cotangent; `#DIV/0!` at 0."""
    return np.where(x == 0, DIV0, 1 / np.tanh(np.where(x == 0, 1.0, x)))


@excel("SECH", Number)
def sech(x: Floats) -> Floats:
    """1 / hyperbolic cosine, in a form that cannot overflow."""
    e = np.exp(-np.abs(x))
    return np.asarray(2 * e / (1 + e * e))


@excel("CSCH", Number)
def csch(x: Floats) -> Floats:
    """1 / hyperbolic sine, in a form that cannot overflow; `#DIV/0!` at 0."""
    size = np.where(x == 0, 1.0, np.abs(x))
    return np.where(x == 0, DIV0, np.copysign(2 * np.exp(-size) / -np.expm1(-2 * size), x))


@excel("PI")
def pi() -> Floats:
    """π."""
    return np.full(1, np.pi)
