"""The arctangent of a number, within 1 ulp, and of two, within 2, as straight-line code.

A number is reduced to a short interval around 0 by the arctangent of 1/2, 1, 3/2 or infinity, held as a sum of two
doubles; the polynomial, of degree 23, is that of fdlibm's `s_atan.c`.
"""

from __future__ import annotations

from typing import Any, Final

from xlmc.evaluation.llvm.arithmetic import Arithmetic
from xlmc.evaluation.llvm.sine import HALF_PI

__all__ = ["arctangent", "arctangent_of_two"]

_HALF_PI: Final = HALF_PI[:2]
_PI: Final = (2 * HALF_PI[0], 2 * HALF_PI[1])

_STEPS: Final = (
    (7 / 16, 4.63647609000806093515e-01, 2.26987774529616870924e-17),
    (11 / 16, 7.85398163397448278999e-01, 3.06161699786838301793e-17),
    (19 / 16, 9.82793723247329054082e-01, 1.39033110312309984516e-17),
    (39 / 16, *_HALF_PI),
)
"""From there on it is reduced by the arctangent of 1/2, 1, 3/2, infinity: that, as a sum."""

_ARCTANGENT: Final = (
    *(3.33333333333329318027e-01, -1.99999999998764832476e-01, 1.42857142725034663711e-01),
    *(-1.11111104054623557880e-01, 9.09088713343650656196e-02, -7.69187620504482999495e-02),
    *(6.66107313738753120669e-02, -5.83357013379057348645e-02, 4.97687799461593236017e-02),
    *(-3.65315727442169155270e-02, 1.62858201153657823623e-02),
)


def arctangent(do: Arithmetic, x: Any) -> Any:
    """Of any number."""
    return do.with_sign_of(x, _of_size(do, do.size(x)))


def arctangent_of_two(do: Arithmetic, x: Any, y: Any) -> Any:
    """The angle from the first axis to the point (x, y), above -π and up to π; NaN of (0, 0)."""
    across, along = do.size(y), do.size(x)
    steep = do.above(across, along)
    low, high = do.select(steep, along, across), do.select(steep, across, along)
    angle = _of_size(do, do.div(low, high))
    angle = do.select(steep, _less(do, _HALF_PI, angle), angle)
    angle = do.select(do.above(do.number(0.0), x), _less(do, _PI, angle), angle)
    return do.select(do.above(do.number(0.0), y), do.negative(angle), angle)


def _of_size(do: Arithmetic, x: Any) -> Any:
    """Of a number from 0 up."""
    above, below = x, do.number(1.0)
    whole, rest = do.number(0.0), do.number(0.0)
    for (limit, first, second), (over, under) in zip(_STEPS, _reductions(do, x), strict=True):
        there = do.above(x, do.number(limit))
        above, below = do.select(there, over, above), do.select(there, under, below)
        whole = do.select(there, do.number(first), whole)
        rest = do.select(there, do.number(second), rest)
    t = do.div(above, below)
    square = do.mul(t, t)
    lost = do.sub(do.mul(do.mul(t, square), do.polynomial(square, _ARCTANGENT)), rest)
    return do.add(whole, do.sub(t, lost))


def _reductions(do: Arithmetic, x: Any) -> tuple[tuple[Any, Any], ...]:
    """Of each step what is divided by what: (x - c) by (1 + c·x)."""
    one, half, two = do.number(1.0), do.number(1.5), do.number(2.0)
    return (
        (do.sub(do.add(x, x), one), do.add(two, x)),
        (do.sub(x, one), do.add(x, one)),
        (do.sub(x, half), do.plus(one, half, x)),
        (do.number(-1.0), x),
    )


def _less(do: Arithmetic, whole: tuple[float, float], angle: Any) -> Any:
    """What an angle leaves of a sum."""
    return do.sub(do.number(whole[0]), do.sub(angle, do.number(whole[1])))
