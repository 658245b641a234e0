"""Sine and cosine of one angle as straight-line code, within 1 ulp, for angles below 2^27, all that Excel takes.

The angle is reduced to [-π/4, π/4] by a multiple of π/2 held to 159 bits (Cody and Waite); every step but the last is
exact, so that nothing is lost near the multiples of π/2. The polynomials are those of fdlibm's `k_sin.c` and `k_cos.c`,
of degree 13 and 14.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from llvmlite import ir

__all__ = ["HALF_PI", "Arithmetic", "sine_and_cosine"]

HALF_PI: Final = (1.5707963267948966, 6.123233995736766e-17, -1.4973849048591698e-33)
"""π/2 as a sum of three doubles."""

_SINE: Final = (
    *(-1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04),
    *(2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10),
)
_COSINE: Final = (
    *(4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05),
    *(-2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11),
)
_TO_WHOLE: Final = 1.5 * 2.0**52
"""Added and taken off again, it leaves the nearest whole number, whose last bits then end the sum's mantissa."""

_SPLIT: Final = 2.0**27 + 1

_DOUBLE, _INTEGER = ir.DoubleType(), ir.IntType(64)


class Arithmetic:
    """Reals and integers of their size on a builder, doubles by default.

    `fused` says whether the processor multiplies and adds at once.
    """

    def __init__(self, builder: Any, fused: bool, real: ir.Type = _DOUBLE, integer: ir.IntType = _INTEGER) -> None:
        self._builder, self._fused, self._real, self._integer = builder, fused, real, integer
        self.add, self.sub, self.mul, self.select = builder.fadd, builder.fsub, builder.fmul, builder.select
        of = ir.FunctionType(real, [real] * 3)
        self._fma = builder.module.declare_intrinsic("llvm.fma", [real], of)

    def number(self, value: float) -> Any:
        return ir.Constant(self._real, value)

    def plus(self, z: Any, x: Any, y: Any) -> Any:
        """Z + x·y, rounded once or twice."""
        return self._builder.call(self._fma, (x, y, z)) if self._fused else self.add(z, self.mul(x, y))

    def minus(self, z: Any, x: Any, y: Any) -> Any:
        """Z - x·y, rounded once or twice."""
        return self.plus(z, self._builder.fneg(x), y)

    def polynomial(self, x: Any, coefficients: Sequence[float]) -> Any:
        """The coefficients from the lowest power up."""
        result = self.number(coefficients[-1])
        for coefficient in reversed(coefficients[:-1]):
            result = self.plus(self.number(coefficient), result, x)
        return result

    def lost(self, k: Any, constant: float, product: Any) -> Any:
        """k·constant less the product as rounded, exactly; k is whole and below 2^27."""
        if self._fused:
            return self._builder.call(self._fma, (k, self.number(constant), self._builder.fneg(product)))
        high = _SPLIT * constant - (_SPLIT * constant - constant)
        rest = self.sub(self.mul(k, self.number(high)), product)
        return self.add(rest, self.mul(k, self.number(constant - high)))

    def less_multiple(self, angle: Any, k: Any, constant: float) -> Any:
        """What k·constant leaves of the angle, exactly: the two nearly cancel."""
        if self._fused:
            return self.minus(angle, k, self.number(constant))
        product = self.mul(k, self.number(constant))
        return self.sub(self.sub(angle, product), self.lost(k, constant, product))

    def bits(self, x: Any) -> Any:
        return self._builder.bitcast(x, self._integer)

    def odd(self, whole: Any) -> Any:
        return self._builder.trunc(whole, ir.IntType(1))

    def turned(self, x: Any, quadrant: Any, one_more: bool) -> Any:
        """`x` negated where the second bit of the quadrant, or of the one after it, is set."""
        if one_more:
            quadrant = self._builder.add(quadrant, ir.Constant(self._integer, 1))
        sign = self._builder.and_(quadrant, ir.Constant(self._integer, 2))
        flipped = self._builder.xor(
            self.bits(x), self._builder.shl(sign, ir.Constant(self._integer, self._integer.width - 2))
        )
        return self._builder.bitcast(flipped, self._real)


def sine_and_cosine(builder: Any, angle: Any, fused: bool) -> tuple[Any, Any]:
    """The instructions for both; what is not used of them the compiler takes out again."""
    do = Arithmetic(builder, fused)
    x, rest, quadrant = _reduced(do, angle)
    square = do.mul(x, x)
    first = do.minus(do.number(1.0), do.number(0.5), square)
    sine, cosine = _sine(do, x, rest, square, first), _cosine(do, x, rest, square, first)
    swapped = do.odd(quadrant)
    return (
        do.turned(do.select(swapped, cosine, sine), quadrant, one_more=False),
        do.turned(do.select(swapped, sine, cosine), quadrant, one_more=True),
    )


def _reduced(do: Arithmetic, angle: Any) -> tuple[Any, Any, Any]:
    """The angle less the nearest multiple k of π/2, as a sum of two doubles, and k modulo 4 in its last two bits."""
    first, second, third = HALF_PI
    shifted = do.plus(do.number(_TO_WHOLE), angle, do.number(1 / first))
    k = do.sub(shifted, do.number(_TO_WHOLE))
    near = do.less_multiple(angle, k, first)
    product = do.mul(k, do.number(second))
    x = do.sub(near, product)
    rounding = do.sub(do.sub(near, x), product)  # exact: `near` is a multiple of the product's last place, or k is 0
    rest = do.minus(do.sub(rounding, do.lost(k, second, product)), k, do.number(third))
    whole = do.add(x, rest)
    return whole, do.add(do.sub(x, whole), rest), do.bits(shifted)


def _sine(do: Arithmetic, x: Any, rest: Any, square: Any, first: Any) -> Any:
    """The sum x + (x³·p + rest·(1 - x²/2))."""
    cubic = do.mul(do.mul(square, x), do.polynomial(square, _SINE))
    return do.add(x, do.plus(cubic, rest, first))


def _cosine(do: Arithmetic, x: Any, rest: Any, square: Any, first: Any) -> Any:
    """1 - x²/2 + (x⁴·p - x·rest), with what the first difference loses."""
    lost = do.minus(do.sub(do.number(1.0), first), do.number(0.5), square)
    fourth = do.minus(do.mul(do.mul(square, square), do.polynomial(square, _COSINE)), x, rest)
    return do.add(first, do.add(lost, fourth))
