"""Operators, and the functions that are one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from xlmc.evaluation.passes.derivatives.jet import chained
from xlmc.evaluation.passes.derivatives.rules import Operand, Outcome, elementwise, leveled, rule
from xlmc.functions import Function
from xlmc.functions.fifteen_digits import SETTLED
from xlmc.functions.values import Floats, Value

__all__: list[str] = []

elementwise("+", lambda y, a, b: (1.0, 1.0), lambda y, a, b: (0.0, 0.0, 0.0))
elementwise("-", lambda y, a, b: (1.0, -1.0), lambda y, a, b: (0.0, 0.0, 0.0))
elementwise("*", lambda y, a, b: (b, a), lambda y, a, b: (0.0, 1.0, 0.0))
elementwise("/", lambda y, a, b: (1 / b, -y / b), lambda y, a, b: (0.0, -1 / b**2, 2 * y / b**2))
elementwise("u-", lambda y, x: (-1.0,), lambda y, x: (0.0,))
elementwise("%", lambda y, x: (0.01,), lambda y, x: (0.0,))
elementwise("RADIANS", lambda y, x: (np.pi / 180,), lambda y, x: (0.0,))
elementwise("DEGREES", lambda y, x: (180 / np.pi,), lambda y, x: (0.0,))


@rule("u+", "shown", SETTLED.name)
def same(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """What gives a number as it is, or but for its last bits."""
    return Outcome(operands[0].jet)


def _log_of_base(x: Floats) -> Floats:
    return np.where(x > 0, np.log(np.where(x > 0, x, 1.0)), np.nan)


@rule("^", why="a negative base has whole powers only, and a root is vertical at 0")
def power(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Power; the exponent of a base that is not above 0 may not vary."""
    base, exponent = leveled(operands)
    x, p, y = base.x, exponent.x, result.numbers
    by_x = np.where(p == 0, 0.0, p * np.power(x, p - 1))
    if not exponent.active:
        return Outcome(base.function(y, by_x, lambda: _second_power(x, p)))
    log = _log_of_base(x)

    def seconds() -> dict[tuple[int, int], Floats]:
        mixed = np.power(x, p - 1) * (1 + p * log)
        return {(0, 0): _second_power(x, p), (0, 1): mixed, (1, 1): y * log * log}

    return Outcome(chained(y, [base, exponent], [by_x, y * log], seconds))


def _second_power(x: Floats, p: Floats) -> Floats:
    return np.where((p == 0) | (p == 1), 0.0, p * (p - 1) * np.power(x, p - 2))
