"""Angles and hyperbolic functions. Angles are in radians."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.functions.guards import Within
from xlmc.functions.math.sine import COSINE, SINE
from xlmc.functions.registry import Number, excel
from xlmc.functions.values import DIV0, NUM, Bools, Floats

__all__: list[str] = []

_LIMIT: Final = 2.0**27
"""Excel refuses the sine and its kin of larger angles, with `#NUM!`."""

excel("ASIN", Number, ufunc=np.arcsin)(np.arcsin)
excel("ACOS", Number, ufunc=np.arccos)(np.arccos)
excel("ATAN", Number, ufunc=np.arctan)(np.arctan)
excel("SINH", Number, ufunc=np.sinh)(np.sinh)
excel("COSH", Number, ufunc=np.cosh)(np.cosh)
excel("TANH", Number, ufunc=np.tanh)(np.tanh)
excel("ASINH", Number, ufunc=np.arcsinh)(np.arcsinh)
excel("ACOSH", Number, ufunc=np.arccosh)(np.arccosh)
excel("ATANH", Number, ufunc=np.arctanh)(np.arctanh)
excel("RADIANS", Number, ufunc=np.radians)(np.radians)  # x·(π/180), to the bit what Excel gives
excel("DEGREES", Number, ufunc=np.degrees)(np.degrees)


def _small(x: Floats) -> Bools:
    return np.abs(x) < _LIMIT


_ALL_SMALL: Final = Within(_LIMIT)


@excel("SIN", Number, ufunc=SINE, guard=_ALL_SMALL)
def sin(x: Floats) -> Floats:
    """Sine."""
    return np.where(_small(x), SINE(x), NUM)


@excel("COS", Number, ufunc=COSINE, guard=_ALL_SMALL)
def cos(x: Floats) -> Floats:
    """Cosine."""
    return np.where(_small(x), COSINE(x), NUM)


@excel("TAN", Number, ufunc=np.tan, guard=_ALL_SMALL)
def tan(x: Floats) -> Floats:
    """Tangent."""
    return np.where(_small(x), np.tan(x), NUM)


@excel("SEC", Number)
def sec(x: Floats) -> Floats:
    """1 / cosine."""
    return np.where(_small(x), 1 / np.cos(x), NUM)


@excel("CSC", Number)
def csc(x: Floats) -> Floats:
    """1 / sine; `#DIV/0!` at 0."""
    return np.where(x == 0, DIV0, np.where(_small(x), 1 / np.sin(x), NUM))


@excel("COT", Number)
def cot(x: Floats) -> Floats:
    """1 / tangent; `#DIV/0!` at 0."""
    return np.where(x == 0, DIV0, np.where(_small(x), 1 / np.tan(x), NUM))


@excel("ATAN2", Number, Number)
def atan2(x: Floats, y: Floats) -> Floats:
    """Angle of the point (x, y), above -π and up to π: x comes first; `#DIV/0!` at (0, 0).

    Excel has one zero only, so that the point (-1, -0.0) lies at π: adding 0 takes the sign off.
    """
    return np.where((x == 0) & (y == 0), DIV0, np.arctan2(y + 0.0, x + 0.0))


@excel("PI")
def pi() -> Floats:
    """π."""
    return np.full(1, np.pi)
