"""Sine and cosine of one angle in float32, within 2^-23 of the angle's own, for angles up to 8192.

The angle is reduced by a multiple of π/2 held in three parts, the first two so short that their multiples are exact
(Cody and Waite). The polynomials are those of Cephes' `sinf.c` and `cosf.c`.
"""

from __future__ import annotations

from typing import Any, Final

from llvmlite import ir

from xlmc.evaluation.llvm.arithmetic import Arithmetic

__all__ = ["HALF_PI_PARTS", "LARGEST_ANGLE", "single_sine_and_cosine"]

LARGEST_ANGLE: Final = 8192.0
"""Of larger angles float32 holds less than three digits after the point."""

HALF_PI_PARTS: Final = (1.5703125, 0.0004837512969970703, 7.549790126404332e-08)
"""π/2 as a sum of floats; the first two have 11 digits in base 2."""

_SINE: Final = (-1.6666654611e-1, 8.3321608736e-3, -1.9515295891e-4)
_COSINE: Final = (4.166664568298827e-2, -1.388731625493765e-3, 2.443315711809948e-5)
_TO_WHOLE: Final = 1.5 * 2.0**23
"""See `sine`."""


def single_sine_and_cosine(builder: Any, angle: Any, fused: bool) -> tuple[Any, Any]:
    """The instructions for both."""
    do = Arithmetic(builder, fused, ir.FloatType(), ir.IntType(32))
    shifted = do.plus(do.number(_TO_WHOLE), angle, do.number(2 / 3.141592653589793))
    k, quadrant = do.sub(shifted, do.number(_TO_WHOLE)), do.bits(shifted)
    x = angle
    for part in HALF_PI_PARTS:
        x = do.minus(x, k, do.number(part))
    square = do.mul(x, x)
    sine = do.plus(x, do.mul(x, square), do.polynomial(square, _SINE))
    first = do.minus(do.number(1.0), do.number(0.5), square)
    cosine = do.plus(first, do.mul(square, square), do.polynomial(square, _COSINE))
    swapped = do.odd(quadrant)
    return (
        do.turned(do.select(swapped, cosine, sine), quadrant, one_more=False),
        do.turned(do.select(swapped, sine, cosine), quadrant, one_more=True),
    )
