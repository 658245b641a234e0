"""Sine and cosine of one angle as straight-line code, within 1 ulp, for angles below 2^27, all that Excel takes.

The angle is reduced to [-π/4, π/4] by a multiple of π/2 held to 159 bits (Cody and Waite); every step but the last is
exact, so that nothing is lost near the multiples of π/2. The polynomials are those of fdlibm's `k_sin.c` and `k_cos.c`,
of degree 13 and 14.
"""

from __future__ import annotations

from typing import Any, Final

from xlmc.evaluation.llvm.arithmetic import Arithmetic

__all__ = ["HALF_PI", "sine_and_cosine"]

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
