"""Arithmetic on numbers in the loop, and the functions that are made of it: sine, cosine and the inverse functions.

All are straight-line code. Sine and cosine are within 1 ulp, for angles below 2^27, all that Excel takes: the angle is
reduced to [-π/4, π/4] by a multiple of π/2 held to 159 bits (Cody and Waite); every step but the last is exact, so that
nothing is lost near the multiples of π/2. The polynomials are those of fdlibm's `k_sin.c` and `k_cos.c`, of degree 13
and 14.

The arctangent of a number is within 1 ulp, that of two within 2. A number is reduced to a short interval around 0 by
the arctangent of 1/2, 1, 3/2 or infinity, held as a sum of two doubles; the polynomial, of degree 23, is that of
fdlibm's `s_atan.c`.

Arcsine and arccosine are within 2 ulp. For |x| up to 1/2 let y = x, above it y = √((1 - |x|)/2): the arcsine of y is
y + y·R(y²), with R the ratio of polynomials of fdlibm's `e_asin.c`. One ulp is a unit of the last bit.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any, Final

from llvmlite import ir

__all__ = [
    "HALF_PI",
    "TO_WHOLE",
    "Arithmetic",
    "arccosine",
    "arcsine",
    "arctangent",
    "arctangent_of_two",
    "intrinsic",
    "sine_and_cosine",
]

_SPLIT: Final = 2.0**27 + 1

_TINY_DIVIDEND_BITS: Final = (1023 - 800) << 52
"""Those of 2^-800."""

_DOUBLE, _INTEGER = ir.DoubleType(), ir.IntType(64)


def intrinsic(builder: Any, real: ir.Type, name: str, *arguments: Any) -> Any:
    """Call one of LLVM's own functions of numbers."""
    of = ir.FunctionType(real, [real] * len(arguments))
    return builder.call(builder.module.declare_intrinsic(name, [real], of), arguments)


class Arithmetic:
    """Reals and integers of their size on a builder, doubles by default.

    `fused` says whether the processor multiplies and adds at once.
    """

    def __init__(self, builder: Any, fused: bool, real: ir.Type = _DOUBLE, integer: ir.IntType = _INTEGER) -> None:
        self._builder, self._fused, self._real, self._integer = builder, fused, real, integer
        self.add, self.sub, self.mul, self.div = builder.fadd, builder.fsub, builder.fmul, builder.fdiv
        self.select, self.negative = builder.select, builder.fneg

    def number(self, value: float) -> Any:
        return ir.Constant(self._real, value)

    def above(self, x: Any, y: Any) -> Any:
        """Whether x > y; not where one is NaN."""
        return self._builder.fcmp_ordered(">", x, y)

    def quotient(self, x: Any, divisor: float) -> tuple[Any, Any]:
        """Emit x/divisor, rounded as a division rounds it, and whether x is too small for that; None if it never is.

        The rounded product with the rounded reciprocal, corrected once, is less than a unit of the last bit off; so the
        second correction rounds it correctly (Markstein's lemma: Russinoff, "FMA-Based Division", 13.1). All that takes
        less time than the instruction for a division. It is exact where no step is below 2^-1022: so `divisor` is from
        2^-64 to 2^64 in size.
        """
        if not self._fused:
            return self.div(x, self.number(divisor)), None
        reciprocal = self.number(1.0 / divisor)
        product = value = self.mul(x, reciprocal)
        for _ in range(2):
            value = self.plus(value, self.minus(x, value, self.number(divisor)), reciprocal)
        one, twice = self.whole(1), self.shift_left(self.bits(x), 1)  # without its sign
        tiny = self._builder.icmp_unsigned("<", self.sub_bits(twice, one), self.whole(_TINY_DIVIDEND_BITS << 1))
        return self.with_sign_of(product, self.size(value)), tiny  # a zero has lost its sign

    def size(self, x: Any) -> Any:
        return self._intrinsic("llvm.fabs", x)

    def root(self, x: Any) -> Any:
        return self._intrinsic("llvm.sqrt", x)

    def with_sign_of(self, x: Any, size: Any) -> Any:
        """Emit a size with the sign of `x`."""
        return self._intrinsic("llvm.copysign", size, x)

    def plus(self, z: Any, x: Any, y: Any) -> Any:
        """Emit the sum z + x·y, rounded once or twice."""
        return self._intrinsic("llvm.fma", x, y, z) if self._fused else self.add(z, self.mul(x, y))

    def minus(self, z: Any, x: Any, y: Any) -> Any:
        """Emit the difference z - x·y, rounded once or twice."""
        return self.plus(z, self.negative(x), y)

    def polynomial(self, x: Any, coefficients: Sequence[float]) -> Any:
        """Emit a polynomial of x; the coefficients from the lowest power up."""
        result = self.number(coefficients[-1])
        for coefficient in reversed(coefficients[:-1]):
            result = self.plus(self.number(coefficient), result, x)
        return result

    def lost(self, k: Any, constant: float, product: Any) -> Any:
        """k·constant less the product as rounded, exactly; k is whole and below 2^27."""
        if self._fused:
            return self._intrinsic("llvm.fma", k, self.number(constant), self.negative(product))
        high = _SPLIT * constant - (_SPLIT * constant - constant)
        rest = self.sub(self.mul(k, self.number(high)), product)
        return self.add(rest, self.mul(k, self.number(constant - high)))

    def less_multiple(self, angle: Any, k: Any, constant: float) -> Any:
        """Emit the angle less k·constant, exactly: the two nearly cancel."""
        if self._fused:
            return self.minus(angle, k, self.number(constant))
        product = self.mul(k, self.number(constant))
        return self.sub(self.sub(angle, product), self.lost(k, constant, product))

    def rest_of_product(self, x: Any, y: Any, product: Any) -> Any:
        """x·y less the product as rounded, exactly (Veltkamp's and Dekker's splitting where nothing is fused)."""
        if self._fused:
            return self._intrinsic("llvm.fma", x, y, self.negative(product))
        (high, low), (more, less) = self._halves(x), self._halves(y)
        rest = self.add(self.sub(self.mul(high, more), product), self.mul(high, less))
        return self.add(self.add(rest, self.mul(low, more)), self.mul(low, less))

    def less_product(self, z: Any, x: Any, y: Any) -> Any:
        """Emit the difference z - x·y, exactly: the two nearly cancel."""
        if self._fused:
            return self.minus(z, x, y)
        product = self.mul(x, y)
        return self.sub(self.sub(z, product), self.rest_of_product(x, y, product))

    def _halves(self, x: Any) -> tuple[Any, Any]:
        """Split a number into the sum of two with half of the bits each."""
        scaled = self.mul(self.number(_SPLIT), x)
        high = self.sub(scaled, self.sub(scaled, x))
        return high, self.sub(x, high)

    def bits(self, x: Any) -> Any:
        return self._builder.bitcast(x, self._integer)

    def from_bits(self, bits: Any) -> Any:
        """Return the number that has these bits."""
        return self._builder.bitcast(bits, self._real)

    def whole(self, value: int) -> Any:
        """Make a constant of the size of a number's bits."""
        return ir.Constant(self._integer, value)

    def add_bits(self, x: Any, y: Any) -> Any:
        return self._builder.add(x, y)

    def sub_bits(self, x: Any, y: Any) -> Any:
        return self._builder.sub(x, y)

    def shift_left(self, bits: Any, places: int) -> Any:
        return self._builder.shl(bits, self.whole(places))

    def shift_right(self, bits: Any, places: int) -> Any:
        """Zeros come in on the left."""
        return self._builder.lshr(bits, self.whole(places))

    def of_whole(self, bits: Any) -> Any:
        """Convert a whole number, below 2^51 in size, to a double."""
        offset = self.add_bits(bits, self.whole(int.from_bytes(struct.pack(">d", TO_WHOLE))))
        return self.sub(self.from_bits(offset), self.number(TO_WHOLE))

    def odd(self, whole: Any) -> Any:
        return self._builder.trunc(whole, ir.IntType(1))

    def turn(self, x: Any, quadrant: Any, one_more: bool) -> Any:
        """`x` negated where the second bit of the quadrant, or of the one after it, is set."""
        if one_more:
            quadrant = self._builder.add(quadrant, ir.Constant(self._integer, 1))
        sign = self._builder.and_(quadrant, ir.Constant(self._integer, 2))
        flipped = self._builder.xor(
            self.bits(x), self._builder.shl(sign, ir.Constant(self._integer, self._integer.width - 2))
        )
        return self._builder.bitcast(flipped, self._real)

    def _intrinsic(self, name: str, *arguments: Any) -> Any:
        return intrinsic(self._builder, self._real, name, *arguments)


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
TO_WHOLE: Final = 1.5 * 2.0**52
"""A number plus this, less this, is the nearest whole number; its last bits are those of the sum's mantissa."""


def sine_and_cosine(builder: Any, angle: Any, fused: bool) -> tuple[Any, Any]:
    """Emit the instructions for both; the compiler drops those that are not used."""
    do = Arithmetic(builder, fused)
    x, rest, quadrant = _reduce_angle(do, angle)
    square = do.mul(x, x)
    first = do.minus(do.number(1.0), do.number(0.5), square)
    sine, cosine = _sine(do, x, rest, square, first), _cosine(do, x, rest, square, first)
    swapped = do.odd(quadrant)
    return (
        do.turn(do.select(swapped, cosine, sine), quadrant, one_more=False),
        do.turn(do.select(swapped, sine, cosine), quadrant, one_more=True),
    )


def _reduce_angle(do: Arithmetic, angle: Any) -> tuple[Any, Any, Any]:
    """Emit the angle less the nearest multiple k of π/2, as a sum of two doubles, and k modulo 4 in its last
    two bits.
    """
    first, second, third = HALF_PI
    shifted = do.plus(do.number(TO_WHOLE), angle, do.number(1 / first))
    k = do.sub(shifted, do.number(TO_WHOLE))
    near = do.less_multiple(angle, k, first)
    product = do.mul(k, do.number(second))
    x = do.sub(near, product)
    rounding = do.sub(do.sub(near, x), product)  # exact: `near` is a multiple of the product's last bit, or k is 0
    rest = do.minus(do.sub(rounding, do.lost(k, second, product)), k, do.number(third))
    whole = do.add(x, rest)
    return whole, do.add(do.sub(x, whole), rest), do.bits(shifted)


def _sine(do: Arithmetic, x: Any, rest: Any, square: Any, first: Any) -> Any:
    """Emit the sum x + (x³·p + rest·(1 - x²/2))."""
    cubic = do.mul(do.mul(square, x), do.polynomial(square, _SINE))
    return do.add(x, do.plus(cubic, rest, first))


def _cosine(do: Arithmetic, x: Any, rest: Any, square: Any, first: Any) -> Any:
    """Emit the sum 1 - x²/2 + (x⁴·p - x·rest), and what rounding the first difference loses."""
    lost = do.minus(do.sub(do.number(1.0), first), do.number(0.5), square)
    fourth = do.minus(do.mul(do.mul(square, square), do.polynomial(square, _COSINE)), x, rest)
    return do.add(first, do.add(lost, fourth))


_HALF_PI: Final = HALF_PI[:2]
_PI: Final = (2 * HALF_PI[0], 2 * HALF_PI[1])

_ARCTANGENT_STEPS: Final = (
    (7 / 16, 4.63647609000806093515e-01, 2.26987774529616870924e-17),
    (11 / 16, 7.85398163397448278999e-01, 3.06161699786838301793e-17),
    (19 / 16, 9.82793723247329054082e-01, 1.39033110312309984516e-17),
    (39 / 16, *_HALF_PI),
)
"""From this number on the argument is reduced by the arctangent of 1/2, 1, 3/2 or infinity, which is the sum of the
other two.
"""

_ARCTANGENT: Final = (
    *(3.33333333333329318027e-01, -1.99999999998764832476e-01, 1.42857142725034663711e-01),
    *(-1.11111104054623557880e-01, 9.09088713343650656196e-02, -7.69187620504482999495e-02),
    *(6.66107313738753120669e-02, -5.83357013379057348645e-02, 4.97687799461593236017e-02),
    *(-3.65315727442169155270e-02, 1.62858201153657823623e-02),
)


def arctangent(do: Arithmetic, x: Any) -> Any:
    """Emit the arctangent of any number."""
    return do.with_sign_of(x, _arctangent_of_size(do, do.size(x)))


def arctangent_of_two(do: Arithmetic, x: Any, y: Any) -> Any:
    """Emit the angle from the first axis to the point (x, y), above -π and up to π; NaN of (0, 0)."""
    across, along = do.size(y), do.size(x)
    steep = do.above(across, along)
    low, high = do.select(steep, along, across), do.select(steep, across, along)
    angle = _arctangent_of_size(do, do.div(low, high))
    angle = do.select(steep, _less_angle(do, _HALF_PI, angle), angle)
    angle = do.select(do.above(do.number(0.0), x), _less_angle(do, _PI, angle), angle)
    return do.select(do.above(do.number(0.0), y), do.negative(angle), angle)


def _arctangent_of_size(do: Arithmetic, x: Any) -> Any:
    """Emit the arctangent of a number, 0 or more."""
    above, below = x, do.number(1.0)
    whole, rest = do.number(0.0), do.number(0.0)
    for (limit, first, second), (over, under) in zip(_ARCTANGENT_STEPS, _arctangent_steps(do, x), strict=True):
        there = do.above(x, do.number(limit))
        above, below = do.select(there, over, above), do.select(there, under, below)
        whole = do.select(there, do.number(first), whole)
        rest = do.select(there, do.number(second), rest)
    t = do.div(above, below)
    square = do.mul(t, t)
    lost = do.sub(do.mul(do.mul(t, square), do.polynomial(square, _ARCTANGENT)), rest)
    return do.add(whole, do.sub(t, lost))


def _arctangent_steps(do: Arithmetic, x: Any) -> tuple[tuple[Any, Any], ...]:
    """Dividend and divisor of each step: (x - c) and (1 + c·x)."""
    one, half, two = do.number(1.0), do.number(1.5), do.number(2.0)
    return (
        (do.sub(do.add(x, x), one), do.add(two, x)),
        (do.sub(x, one), do.add(x, one)),
        (do.sub(x, half), do.plus(one, half, x)),
        (do.number(-1.0), x),
    )


def _less_angle(do: Arithmetic, whole: tuple[float, float], angle: Any) -> Any:
    """Emit the number `whole`, a sum of two doubles, less an angle."""
    return do.sub(do.number(whole[0]), do.sub(angle, do.number(whole[1])))


_ARCSINE_ABOVE: Final = (
    *(1.66666666666666657415e-01, -3.25565818622400915405e-01, 2.01212532134862925881e-01),
    *(-4.00555345006794114027e-02, 7.91534994289814532176e-04, 3.47933107596021167570e-05),
)
_ARCSINE_BELOW: Final = (
    *(1.0, -2.40339491173441421878e00, 2.02094576023350569471e00),
    *(-6.88283971605453293030e-01, 7.70381505559019352791e-02),
)


def arcsine(do: Arithmetic, x: Any) -> Any:
    """Emit the arcsine of a number from -1 to 1; NaN of others."""
    near, root, ratio = _reduce_ratio(do, x)
    half, rest = (do.number(part) for part in HALF_PI[:2])
    double = do.add(root, root)
    whole = do.sub(half, double)
    lost = do.sub(do.sub(half, whole), double)  # exactly what that difference rounds off
    far = do.add(whole, do.sub(lost, do.sub(do.mul(double, ratio), rest)))
    return do.select(near, do.plus(x, x, ratio), do.with_sign_of(x, far))


def arccosine(do: Arithmetic, x: Any) -> Any:
    """Emit the arccosine of a number from -1 to 1; NaN of others."""
    near, root, ratio = _reduce_ratio(do, x)
    half, rest = (do.number(part) for part in HALF_PI[:2])
    middle = do.sub(half, do.sub(x, do.minus(rest, x, ratio)))
    small = do.plus(root, root, ratio)
    large = do.sub(half, do.add(root, do.sub(do.mul(root, ratio), rest)))
    beyond = do.select(do.above(x, do.number(0.0)), small, large)
    return do.select(near, middle, do.add(beyond, beyond))


def _reduce_ratio(do: Arithmetic, x: Any) -> tuple[Any, Any, Any]:
    """Whether |x| is below 1/2; y where it is not; and R. See the module's docstring."""
    size, half = do.size(x), do.number(0.5)
    near = do.above(half, size)
    square = do.select(near, do.mul(x, x), do.mul(half, do.sub(do.number(1.0), size)))
    ratio = do.div(do.mul(square, do.polynomial(square, _ARCSINE_ABOVE)), do.polynomial(square, _ARCSINE_BELOW))
    return near, do.root(square), ratio
