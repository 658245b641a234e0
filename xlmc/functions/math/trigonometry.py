"""Angles and hyperbolic functions. Angles are in radians."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.functions.facts import Domain, Facts
from xlmc.functions.guards import Within
from xlmc.functions.math.sine import COSINE, SINE
from xlmc.functions.registry import Number, excel
from xlmc.functions.values import DIV0, NUM, Bools, Floats

__all__: list[str] = []

_LIMIT: Final = 2.0**27
"""Excel refuses the sine and its kin of larger angles, with `#NUM!`."""

excel("ASIN", Number, ufunc=np.arcsin, facts=Facts(domain=Domain(-1.0, 1.0)))(np.arcsin)
excel("ACOS", Number, ufunc=np.arccos, facts=Facts(domain=Domain(-1.0, 1.0)))(np.arccos)
excel("ATAN", Number, ufunc=np.arctan)(np.arctan)
excel("SINH", Number, ufunc=np.sinh)(np.sinh)
excel("COSH", Number, ufunc=np.cosh)(np.cosh)
excel("TANH", Number, ufunc=np.tanh, facts=Facts(between=(-1.0, 1.0)))(np.tanh)
excel("ASINH", Number, ufunc=np.arcsinh)(np.arcsinh)
excel("ACOSH", Number, ufunc=np.arccosh, facts=Facts(domain=Domain(1.0)))(np.arccosh)
excel("ATANH", Number, ufunc=np.arctanh, facts=Facts(domain=Domain(-1.0, 1.0)))(np.arctanh)
# x·(π/180) is to the bit what Excel gives, and NumPy's own functions are several times slower
excel("RADIANS", Number, ufunc=np.radians, facts=Facts(factor=np.pi / 180))(np.radians)
excel("DEGREES", Number, ufunc=np.degrees, facts=Facts(factor=180 / np.pi))(np.degrees)


def _small(x: Floats) -> Bools:
    return np.abs(x) < _LIMIT


_ALL_SMALL: Final = Within(_LIMIT)


@excel("SIN", Number, ufunc=SINE, guard=_ALL_SMALL, facts=Facts(measures=True, between=(-1.0, 1.0)))
def sin(x: Floats) -> Floats:
    """Sine."""
    return np.where(_small(x), SINE(x), NUM)


@excel("COS", Number, ufunc=COSINE, guard=_ALL_SMALL, facts=Facts(measures=True, between=(-1.0, 1.0)))
def cos(x: Floats) -> Floats:
    """Cosine."""
    return np.where(_small(x), COSINE(x), NUM)


@excel("TAN", Number, ufunc=np.tan, guard=_ALL_SMALL, facts=Facts(measures=True))
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
