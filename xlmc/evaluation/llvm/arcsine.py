"""Arcsine and arccosine as straight-line code, within 2 ulp.

Up to 1/2 a number is taken as it is, above it the root of half of what it lacks of 1: with y for either, its arcsine is
y + y·R(y²), and R the ratio of polynomials of fdlibm's `e_asin.c`.
"""

from __future__ import annotations

from typing import Any, Final

from xlmc.evaluation.llvm.arithmetic import Arithmetic
from xlmc.evaluation.llvm.sine import HALF_PI

__all__ = ["arccosine", "arcsine"]

_ABOVE: Final = (
    *(1.66666666666666657415e-01, -3.25565818622400915405e-01, 2.01212532134862925881e-01),
    *(-4.00555345006794114027e-02, 7.91534994289814532176e-04, 3.47933107596021167570e-05),
)
_BELOW: Final = (
    *(1.0, -2.40339491173441421878e00, 2.02094576023350569471e00),
    *(-6.88283971605453293030e-01, 7.70381505559019352791e-02),
)


def arcsine(do: Arithmetic, x: Any) -> Any:
    """Of a number from -1 to 1; NaN of others."""
    near, root, ratio = _reduced(do, x)
    half, rest = (do.number(part) for part in HALF_PI[:2])
    double = do.add(root, root)
    whole = do.sub(half, double)
    lost = do.sub(do.sub(half, whole), double)  # exactly what that difference rounds off
    far = do.add(whole, do.sub(lost, do.sub(do.mul(double, ratio), rest)))
    return do.select(near, do.plus(x, x, ratio), do.with_sign_of(x, far))


def arccosine(do: Arithmetic, x: Any) -> Any:
    """Likewise."""
    near, root, ratio = _reduced(do, x)
    half, rest = (do.number(part) for part in HALF_PI[:2])
    middle = do.sub(half, do.sub(x, do.minus(rest, x, ratio)))
    small = do.plus(root, root, ratio)
    large = do.sub(half, do.add(root, do.sub(do.mul(root, ratio), rest)))
    beyond = do.select(do.above(x, do.number(0.0)), small, large)
    return do.select(near, middle, do.add(beyond, beyond))


def _reduced(do: Arithmetic, x: Any) -> tuple[Any, Any, Any]:
    """Whether it is up to 1/2, what stands for it above, and R."""
    size, half = do.size(x), do.number(0.5)
    near = do.above(half, size)
    square = do.select(near, do.mul(x, x), do.mul(half, do.sub(do.number(1.0), size)))
    ratio = do.div(do.mul(square, do.polynomial(square, _ABOVE)), do.polynomial(square, _BELOW))
    return near, do.root(square), ratio
