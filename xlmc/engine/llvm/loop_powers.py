"""Exponentials, logarithms and powers in the loop, within 1 ulp; straight-line code, without tables.

A number is 2^k·m with m from √½ to √2. With s = (m - 1)/(m + 1), between -0.172 and 0.172, the logarithm of m is
2·atanh(s), of which the first term, or the first two, stand apart from a polynomial in s². An exponential is 2^k·e^r
with r from -ln 2/2 to ln 2/2; 1 and r stand apart from the polynomial. The polynomials are Chebyshev fits, below 2^-66
of the result. For powers the logarithm is held as a sum of two doubles, good to 2^-66, for the exponent multiplies its
error by up to 2^10 (Dekker 1971 for the arithmetic of such sums).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final, NamedTuple

from xlmc.engine.llvm.loop_arithmetic import TO_WHOLE, Arithmetic

__all__ = ["common_logarithm", "exponential", "logarithm", "power"]

_LN2: Final = (0.6931471805592082, 7.371002565167799e-13)
"""ln 2 as a sum; the first has 40 bits, so that its products with k are exact."""
_LOG2_E: Final = 1.4426950408889634
_LOG10_E: Final = (0.4342944819032518, 1.098319650216765e-17)
_TWO_THIRDS: Final = (2 / 3, 3.700743415417188e-17)

_EXPONENTIAL: Final = (
    *(0.5, 0.1666666666666667, 0.04166666666666667, 0.008333333333326136, 0.0013888888888883748),
    *(0.00019841269874820627, 2.4801587325547743e-05, 2.7557255400206422e-06, 2.75572736431103e-07),
    *(2.5105217004720745e-08, 2.0914686968086876e-09),
)
"""Coefficients of the powers of r, from the second power on."""
_LOGARITHM: Final = (
    *(0.666666666666667, 0.3999999999989938, 0.28571428626031065, 0.2222221112572281),
    *(0.18182889786191042, 0.15331699633543858, 0.14616721179861816),
)
"""Coefficients of the powers of s², from the first power on: 2·atanh(s) = 2s + s·(…)."""
_FINE_LOGARITHM: Final = (
    *(0.4, 0.2857142857142937, 0.2222222222165554, 0.1818181833547124),
    *(0.15384594954137945, 0.13334805149611875, 0.11706224135460942, 0.11723306234080849),
)
"""The same from the second power on."""

_LEAST: Final = -708.3964185322640
"""The exponential of a smaller number is too small for Excel, or for a double."""
_MOST: Final = 709.782712893384
"""The exponential of a larger number is too large."""

_ROOT_OF_HALF: Final = 0x3FE6A09E667F3BCD
_ONE: Final = 0x3FF0000000000000
_MANTISSA: Final = 52
_BIAS: Final = 1023


class _Sum(NamedTuple):
    """A number as the sum of two doubles, the second of which is at most some units in the last bit of the first."""

    high: Any
    low: Any


def exponential(do: Arithmetic, x: Any) -> Any:
    """e^x; infinite where it is too large. Of finite numbers."""
    return _exponential(do, x, do.number(0.0))


def _exponential(do: Arithmetic, x: Any, more: Any) -> Any:
    """e^(x + more), where `more` is small."""
    shifted = do.plus(do.number(TO_WHOLE), x, do.number(_LOG2_E))
    k = do.sub(shifted, do.number(TO_WHOLE))
    near = do.minus(x, k, do.number(_LN2[0]))  # exact
    small = do.minus(more, k, do.number(_LN2[1]))
    r, rest = _ordered_sum(do, near, small)
    first, lost = _ordered_sum(do, do.number(1.0), r)
    lost = do.add(lost, rest)
    mantissa = do.add(first, do.plus(lost, do.mul(r, r), _polynomial(do, r, _EXPONENTIAL)))
    value = do.from_bits(do.add_bits(do.bits(mantissa), do.shift_left(do.bits(shifted), _MANTISSA)))
    value = do.select(do.above(do.number(_LEAST), x), do.number(0.0), value)
    return do.select(do.above(x, do.number(_MOST)), do.number(math.inf), value)


def logarithm(do: Arithmetic, x: Any) -> Any:
    """Emit the natural logarithm of finite numbers above 0."""
    k, f = _split(do, x)
    s = do.div(f, do.add(do.number(2.0), f))
    z = do.mul(s, s)
    half = do.mul(do.mul(do.number(0.5), f), f)
    rest = do.mul(s, do.plus(half, z, _polynomial(do, z, _LOGARITHM)))
    rest = do.plus(rest, k, do.number(_LN2[1]))
    return do.sub(do.mul(k, do.number(_LN2[0])), do.sub(do.sub(half, rest), f))


def common_logarithm(do: Arithmetic, x: Any) -> Any:
    """Emit the logarithm to base 10 of finite numbers above 0."""
    fine = _fine_logarithm(do, x)
    high, low = _product(do, fine.high, do.number(_LOG10_E[0]))
    low = do.plus(do.plus(low, fine.low, do.number(_LOG10_E[0])), fine.high, do.number(_LOG10_E[1]))
    return do.add(high, low)


def power(do: Arithmetic, x: Any, y: Any) -> Any:
    """x^y; infinite where it is too large. Of finite numbers, x above 0."""
    fine = _fine_logarithm(do, x)
    high, low = _product(do, fine.high, y)
    return _exponential(do, high, do.plus(low, fine.low, y))


def _split(do: Arithmetic, x: Any) -> tuple[Any, Any]:
    """Split a number into the power of two, k, and m - 1, both exact."""
    bits = do.bits(x)
    biased = do.shift_right(do.add_bits(bits, do.whole(_ONE - _ROOT_OF_HALF)), _MANTISSA)
    k = do.add_bits(biased, do.whole(-_BIAS))
    m = do.from_bits(do.sub_bits(bits, do.shift_left(k, _MANTISSA)))
    return do.of_whole(k), do.sub(m, do.number(1.0))


def _fine_logarithm(do: Arithmetic, x: Any) -> _Sum:
    """Emit the natural logarithm as a sum."""
    k, f = _split(do, x)
    s = _atanh_argument(do, f)
    z = _product(do, s.high, s.high)
    z = _Sum(z.high, do.plus(z.low, do.add(s.high, s.high), s.low))
    factor = _ordered_sum(do, do.number(_TWO_THIRDS[0]), do.mul(z.high, _polynomial(do, z.high, _FINE_LOGARITHM)))
    factor = _Sum(factor.high, do.add(factor.low, do.number(_TWO_THIRDS[1])))
    cubic = _times(do, s, _times(do, z, factor))
    of_m = _ordered_sum(do, do.add(s.high, s.high), cubic.high)
    rest = do.add(of_m.low, do.add(do.add(s.low, s.low), cubic.low))
    whole = _ordered_sum(do, do.mul(k, do.number(_LN2[0])), of_m.high)
    return _Sum(whole.high, do.add(whole.low, do.plus(rest, k, do.number(_LN2[1]))))


def _atanh_argument(do: Arithmetic, f: Any) -> _Sum:
    """f/(2 + f) as a sum."""
    two = do.number(2.0)
    divisor = _ordered_sum(do, two, f)
    inverse = do.div(do.number(1.0), divisor.high)
    high = do.mul(f, inverse)
    rest = do.less_product(f, high, divisor.high)
    return _Sum(high, do.mul(do.minus(rest, high, divisor.low), inverse))


def _polynomial(do: Arithmetic, x: Any, coefficients: Sequence[float]) -> Any:
    """Emit a polynomial of x, the coefficients from the lowest power up, in few steps that wait for each other
    (Estrin).
    """
    terms = [do.number(coefficient) for coefficient in coefficients]
    while len(terms) > 1:
        pairs = [do.plus(low, x, high) for low, high in zip(terms[::2], terms[1::2], strict=False)]
        terms = pairs + terms[2 * len(pairs) :]
        x = do.mul(x, x)
    return terms[0]


def _ordered_sum(do: Arithmetic, large: Any, small: Any) -> _Sum:
    """Add exactly, where the first is 0 or the larger."""
    high = do.add(large, small)
    return _Sum(high, do.add(do.sub(large, high), small))


def _product(do: Arithmetic, x: Any, y: Any) -> _Sum:
    """Multiply exactly."""
    high = do.mul(x, y)
    return _Sum(high, do.rest_of_product(x, y, high))


def _times(do: Arithmetic, x: _Sum, y: _Sum) -> _Sum:
    """Multiply sums, nearly exactly."""
    high, low = _product(do, x.high, y.high)
    return _Sum(high, do.plus(do.plus(low, x.high, y.low), x.low, y.high))
