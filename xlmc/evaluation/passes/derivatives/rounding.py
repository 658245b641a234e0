"""Rounding stands still between its steps; at a step there is no derivative."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from xlmc.evaluation.passes.derivatives.jet import Jet
from xlmc.evaluation.passes.derivatives.rules import Operand, Outcome, leveled, rule
from xlmc.functions import Function
from xlmc.functions.values import Bools, Value

__all__ = ["nudged"]

_STEP: Final = "the value jumps there"

_NEAR: Final = 1e-14
"""As a share of a number: within it, Excel may take two numbers for one (it shows 15 digits)."""


def nudged(function: Function, result: Value, operands: Sequence[Operand], place: int = 0) -> Bools:
    """Where the result changes with the 15th digit of an operand, in the result's shape."""
    changed = np.zeros(1, bool)
    for nudge in (1 - _NEAR, 1 + _NEAR):
        values = [operand.value for operand in operands]
        values[place] = replace(values[place], numbers=values[place].numbers * nudge)
        changed = changed | (function(values).numbers != result.numbers)
    return changed


@rule(
    *("ROUND", "ROUNDUP", "ROUNDDOWN", "TRUNC", "INT", "EVEN", "ODD", "SIGN", "QUOTIENT", "FACT", "FACTDOUBLE"),
    why=_STEP,
    jumps=True,
)
def steps(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Steps: 0 in between."""
    jets = leveled(operands)
    where = nudged(function, result, operands)
    if function.name == "SIGN":
        where = where | (jets[0].x == 0)
    return Outcome(standing(result, jets, where), result.numbers)


@rule(
    *("CEILING", "FLOOR", "CEILING.MATH", "FLOOR.MATH", "MROUND"),
    *("CEILING.PRECISE", "FLOOR.PRECISE"),
    why=_STEP,
    jumps=True,
)
def multiples(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """A multiple, the number of times standing still."""
    jets = leveled(operands)
    where = nudged(function, result, operands)
    multiple = jets[1] if len(jets) > 1 else Jet.still(np.ones((1,) * result.numbers.ndim))
    times = np.where(multiple.x == 0, 0.0, result.numbers / np.where(multiple.x == 0, 1.0, multiple.x))
    still = standing(result, jets[:1] + jets[2:], where)
    return Outcome(still + multiple.times(times), times)


def standing(result: Value, jets: Sequence[Jet], where: Bools) -> Jet:
    """A value that its operands do not change in between; without derivatives where they have none, and at a step."""
    if not where.any() and all(np.isfinite(jet.first).all() for jet in jets):
        return Jet.still(result.numbers)
    total = jets[0].times(0.0, result.numbers)
    for jet in jets[1:]:
        total = total + jet.times(0.0)
    steep = where & np.isfinite(total.first).all(axis=0)
    return replace(total.lost(steep), x=result.numbers)
