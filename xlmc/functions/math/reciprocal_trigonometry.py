"""The cotangent's inverse, and the reciprocals of the hyperbolic functions. Angles are in radians."""

from __future__ import annotations

import numpy as np

from xlmc.functions.registry import Number, excel
from xlmc.functions.values import DIV0, NUM, Floats

__all__: list[str] = []


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
