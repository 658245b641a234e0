"""Operators, roots, exponentials, logarithms, angles and hyperbolic functions, absolute values and remainders."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from xlmc.engine.passes.derivatives.jet import Jet, chain
from xlmc.engine.passes.derivatives.rules import Operand, Outcome, elementwise, level_jets, rule
from xlmc.excel.functions import Function
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.excel.functions.values import Floats, Value

__all__: list[str] = []

_LN10 = np.log(10.0)

elementwise("+", lambda y, a, b: (1.0, 1.0), lambda y, a, b: (0.0, 0.0, 0.0))
elementwise("-", lambda y, a, b: (1.0, -1.0), lambda y, a, b: (0.0, 0.0, 0.0))
elementwise("*", lambda y, a, b: (b, a), lambda y, a, b: (0.0, 1.0, 0.0))
elementwise("/", lambda y, a, b: (1 / b, -y / b), lambda y, a, b: (0.0, -1 / b**2, 2 * y / b**2))
elementwise("u-", lambda y, x: (-1.0,), lambda y, x: (0.0,))
elementwise("%", lambda y, x: (0.01,), lambda y, x: (0.0,))


@rule("u+", "shown", SNAP_TO_ZERO.name)
def same(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Functions that give a number unchanged, except for its last bits."""
    return Outcome(operands[0].jet)


def _log_of_base(x: Floats) -> Floats:
    return np.where(x > 0, np.log(np.where(x > 0, x, 1.0)), np.nan)


@rule("^", why="a negative base has whole powers only, and a root is vertical at 0")
def power(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Power; the exponent of a base that is not above 0 may not vary."""
    base, exponent = level_jets(operands)
    x, p, y = base.x, exponent.x, result.numbers
    by_x = np.where(p == 0, 0.0, p * np.power(x, p - 1))
    if not exponent.active:
        return Outcome(base.function(y, by_x, lambda: _second_power(x, p)))
    log = _log_of_base(x)

    def seconds() -> dict[tuple[int, int], Floats]:
        mixed = np.power(x, p - 1) * (1 + p * log)
        return {(0, 0): _second_power(x, p), (0, 1): mixed, (1, 1): y * log * log}

    return Outcome(chain(y, [base, exponent], [by_x, y * log], seconds))


def _second_power(x: Floats, p: Floats) -> Floats:
    return np.where((p == 0) | (p == 1), 0.0, p * (p - 1) * np.power(x, p - 2))


elementwise("SQRT", lambda y, x: (0.5 / y,), lambda y, x: (-0.25 / (x * y),), why="a root is vertical at 0")
elementwise("SQRTPI", lambda y, x: (np.pi / (2 * y),), lambda y, x: (-np.pi / (4 * x * y),), why="vertical at 0")
elementwise("EXP", lambda y, x: (y,), lambda y, x: (y,))
elementwise("LN", lambda y, x: (1 / x,), lambda y, x: (-1 / x**2,))
elementwise("LOG10", lambda y, x: (1 / (x * _LN10),), lambda y, x: (-1 / (x * x * _LN10),))

elementwise("SIN", lambda y, x: (np.cos(x),), lambda y, x: (-y,))
elementwise("COS", lambda y, x: (-np.sin(x),), lambda y, x: (-y,))
elementwise("TAN", lambda y, x: (1 + y * y,), lambda y, x: (2 * y * (1 + y * y),))
elementwise("SEC", lambda y, x: (y * np.tan(x),), lambda y, x: (y * (1 + 2 * np.tan(x) ** 2),))
elementwise("CSC", lambda y, x: (-y / np.tan(x),), lambda y, x: (y * (2 * y * y - 1),))
elementwise("COT", lambda y, x: (-(1 + y * y),), lambda y, x: (2 * y * (1 + y * y),))


def _rest(x: Floats) -> Floats:
    """1 - x², in a form that loses no digits near ±1."""
    return np.asarray((1 - x) * (1 + x))


elementwise("ASIN", lambda y, x: (_rest(x) ** -0.5,), lambda y, x: (x * _rest(x) ** -1.5,), why="vertical at ±1")
elementwise("ACOS", lambda y, x: (-(_rest(x) ** -0.5),), lambda y, x: (-x * _rest(x) ** -1.5,), why="vertical at ±1")
elementwise("ATAN", lambda y, x: (1 / (1 + x * x),), lambda y, x: (-2 * x / (1 + x * x) ** 2,))
elementwise(
    "ACOT",
    lambda y, x: (-1 / (1 + x * x),),
    lambda y, x: (2 * x / (1 + x * x) ** 2,),
)


def _turn(y: Floats, x: Floats, v: Floats) -> Floats:
    """Return the side of the negative x axis, at which the angle jumps by a whole turn; 0 to the right of the
    y axis.
    """
    return np.where(x < 0, np.where(v < 0, -1, 1), 0)


def _radius(x: Floats, y: Floats) -> Floats:
    return np.asarray(x * x + y * y)


elementwise(
    "ATAN2",
    lambda t, x, y: (-y / _radius(x, y), np.where((y == 0) & (x < 0), np.nan, x / _radius(x, y))),
    lambda t, x, y: (
        2 * x * y / _radius(x, y) ** 2,
        (y - x) * (y + x) / _radius(x, y) ** 2,
        -2 * x * y / _radius(x, y) ** 2,
    ),
    why="the angle jumps from -180° to 180° there",
    branches=_turn,
    jumps=True,
)

elementwise("SINH", lambda y, x: (np.cosh(x),), lambda y, x: (y,))
elementwise("COSH", lambda y, x: (np.sinh(x),), lambda y, x: (y,))
elementwise("TANH", lambda y, x: (np.cosh(x) ** -2.0,), lambda y, x: (-2 * y * np.cosh(x) ** -2.0,))
elementwise("SECH", lambda y, x: (-y * np.tanh(x),), lambda y, x: (y * (np.tanh(x) ** 2 - np.cosh(x) ** -2.0),))
elementwise("CSCH", lambda y, x: (-y / np.tanh(x),), lambda y, x: (y * (1 + 2 * y * y),))
elementwise("COTH", lambda y, x: (-(np.sinh(x) ** -2.0),), lambda y, x: (2 * y * np.sinh(x) ** -2.0,))
elementwise("ASINH", lambda y, x: ((1 + x * x) ** -0.5,), lambda y, x: (-x * (1 + x * x) ** -1.5,))
elementwise("ACOSH", lambda y, x: ((-_rest(x)) ** -0.5,), lambda y, x: (-x * (-_rest(x)) ** -1.5,), why="vertical at 1")
elementwise("ATANH", lambda y, x: (1 / _rest(x),), lambda y, x: (2 * x / _rest(x) ** 2,))
elementwise("ACOTH", lambda y, x: (1 / _rest(x),), lambda y, x: (2 * x / _rest(x) ** 2,))
elementwise("FISHER", lambda y, x: (1 / _rest(x),), lambda y, x: (2 * x / _rest(x) ** 2,))
elementwise("FISHERINV", lambda y, x: (np.cosh(x) ** -2.0,), lambda y, x: (-2 * y * np.cosh(x) ** -2.0,))

elementwise(
    "ABS",
    lambda y, x: (np.where(x == 0, np.nan, np.sign(x)),),
    lambda y, x: (np.where(x == 0, np.nan, 0.0),),
    why="it turns at 0",
    branches=lambda y, x: np.sign(x),
)


@rule("LOG")
def log(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Logarithm to a base, 10 unless it is given."""
    jets = level_jets(operands)
    x = jets[0].ln()
    base = jets[1].ln() if len(jets) > 1 else Jet.still(np.full((1,) * x.x.ndim, _LN10))
    return Outcome(x / base)


@rule("MOD", why="the remainder jumps there", jumps=True)
def mod(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """`x - d⌊x/d⌋`, where the whole part stays the same; it jumps where the remainder is 0."""
    x, divisor = level_jets(operands)
    whole = np.floor(x.x / divisor.x)
    jet = (x - divisor.times(whole)).lost(result.numbers == 0)
    return Outcome(jet, whole)
