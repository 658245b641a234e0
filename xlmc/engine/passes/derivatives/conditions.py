"""Rules of conditions and roundings, whose derivative is 0 except where they jump, and of choices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.passes.derivatives.jet import Jet, align
from xlmc.engine.passes.derivatives.rules import Operand, Outcome, level_jets, rule
from xlmc.errors import ErrorCode
from xlmc.excel.functions import Function
from xlmc.excel.functions.values import ERROR, TEXT, Bools, Value

__all__ = ["constant_jet", "if_", "if_error"]

_STEP: Final = "the value jumps there"

_NEAR: Final = 1e-14
"""A share of a number: Excel, which shows 15 digits, may treat two numbers that differ by less as equal."""


@rule("<", "<=", ">", ">=", why="the two sides are equal there", jumps=True)
def ordered(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Comparisons by size: no derivative where both sides are equal and do not change alike."""
    branches = result.numbers
    if any((operand.value.kinds == TEXT).any() for operand in operands):
        return Outcome(Jet.still(result.numbers), branches)
    left, right = level_jets(operands)
    equal: Bools = np.asarray(left.x == right.x)
    return Outcome(_condition(result, [left, right], equal), branches)


@rule("=", "<>", why="one side has no derivative there", jumps=True)
def labels(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Comparisons for equality: they are taken to compare labels, which do not change little by little."""
    if any((operand.value.kinds == TEXT).any() for operand in operands):
        return Outcome(Jet.still(result.numbers), result.numbers)
    return Outcome(_condition(result, level_jets(operands), np.zeros(1, bool)), result.numbers)


def _condition(result: Value, jets: Sequence[Jet], edge: Bools) -> Jet:
    """Return the derivatives of a condition: 0, but none where an operand has none, or where it is about to change.

    Args:
        result: the condition's value.
        jets: what it depends on; if these are two, their difference decides.
        edge: where the condition changes as soon as the difference does.
    """
    if not edge.any() and all(np.isfinite(jet.first).all() for jet in jets):
        return Jet.still(result.numbers)
    difference = jets[0] - jets[1] if len(jets) == 2 else jets[0]
    change = difference.first

    def still(part: NDArray[Any], axes: int) -> NDArray[Any]:
        if axes == 0:
            return part
        lost = ~np.isfinite(change) | (edge & (change != 0))
        if axes == 2:
            lost = lost[:, None] | lost[None, :]
        return np.where(lost, np.nan, 0.0 * np.where(np.isfinite(part), part, 0.0))

    return difference.each(still, result.numbers)


@rule("AND", "OR", "XOR", "NOT", why="a condition is at its limit there", jumps=True)
def joined(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Conditions joined by AND, OR, XOR or NOT."""
    total = Jet.still(np.zeros(1))
    for operand in operands:
        jet = operand.jet
        if jet.active:
            cells = jet.spread().each(lambda part, axes: part.reshape(*part.shape[: axes + 1], -1).sum(axis=-1))
            total = total + cells
    return Outcome(replace(total.times(0.0), x=result.numbers), result.numbers)


def if_(result: Value, operands: Sequence[Operand]) -> Outcome:
    """`IF`: the derivatives of the branch taken; none at the limit of the condition."""
    test, yes, no = level_jets(operands)
    truth, _ = operands[0].value.to_logicals()
    truth = truth.reshape(-1, 1, 1) if test.x.ndim > truth.ndim else truth
    jet = _either(truth, yes, no)
    edge = test.times(0.0)
    jet = jet if not edge.active else replace(jet + edge, x=result.numbers)
    return Outcome(replace(jet, x=result.numbers), truth)


def if_error(result: Value, operands: Sequence[Operand], only_na: bool) -> Outcome:
    """`IFERROR`: the value, or the other one where it is an error."""
    value, instead = level_jets(operands)
    kinds = operands[0].value.kinds
    lost = kinds == ERROR + ErrorCode.NA if only_na else kinds >= ERROR
    lost = lost.reshape(-1, 1, 1) if value.x.ndim > lost.ndim else lost
    return Outcome(replace(_either(lost, instead, value), x=result.numbers), lost)


def _either(truth: Bools, yes: Jet, no: Jet) -> Jet:
    """`yes` where the condition holds, else `no`."""
    if not yes.active and not no.active:
        return Jet.still(np.where(truth, yes.x, no.x))
    live = yes if yes.active else no
    yes, no = ((jet if jet.active else _like(live, jet)) for jet in (yes, no))
    a, b = align([yes, no])
    parts = zip((a.first, a.second, a.error, a.second_error), (b.first, b.second, b.error, b.second_error), strict=True)
    chosen = [None if x is None and y is None else np.where(truth, _or_0(x), _or_0(y)) for x, y in parts]
    return Jet(np.where(truth, a.x, b.x), a.active, *chosen)  # type: ignore[arg-type]  # `first` is never None


def _like(live: Jet, still: Jet) -> Jet:
    """Make a still jet of the order of another."""
    return still if live.order > 1 else replace(still, second=None)


def _or_0(part: Any) -> Any:
    return 0.0 if part is None else part


def _find_nudged(function: Function, result: Value, operands: Sequence[Operand], index: int = 0) -> Bools:
    """Find the trials in which the result changes with the 15th digit of an operand, in the result's shape."""
    changed = np.zeros(1, bool)
    for nudge in (1 - _NEAR, 1 + _NEAR):
        values = [operand.value for operand in operands]
        values[index] = replace(values[index], numbers=values[index].numbers * nudge)
        changed = changed | (function(values).numbers != result.numbers)
    return changed


@rule(
    *("ROUND", "ROUNDUP", "ROUNDDOWN", "TRUNC", "INT", "EVEN", "ODD", "SIGN", "QUOTIENT", "FACT", "FACTDOUBLE"),
    why=_STEP,
    jumps=True,
)
def steps(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Functions that go in steps: their derivative is 0 between two steps."""
    jets = level_jets(operands)
    where = _find_nudged(function, result, operands)
    if function.name == "SIGN":
        where = where | (jets[0].x == 0)
    return Outcome(constant_jet(result, jets, where), result.numbers)


@rule(
    *("CEILING", "FLOOR", "CEILING.MATH", "FLOOR.MATH", "MROUND"),
    *("CEILING.PRECISE", "FLOOR.PRECISE"),
    why=_STEP,
    jumps=True,
)
def multiples(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Multiples: the derivative is that of the multiple times the number of times, which stays the same."""
    jets = level_jets(operands)
    where = _find_nudged(function, result, operands)
    multiple = jets[1] if len(jets) > 1 else Jet.still(np.ones((1,) * result.numbers.ndim))
    times = np.where(multiple.x == 0, 0.0, result.numbers / np.where(multiple.x == 0, 1.0, multiple.x))
    still = constant_jet(result, jets[:1] + jets[2:], where)
    return Outcome(still + multiple.times(times), times)


def constant_jet(result: Value, jets: Sequence[Jet], where: Bools) -> Jet:
    """Make a jet that is constant between steps; it has no derivatives at a step, and where an operand has none."""
    if not where.any() and all(np.isfinite(jet.first).all() for jet in jets):
        return Jet.still(result.numbers)
    total = jets[0].times(0.0, result.numbers)
    for jet in jets[1:]:
        total = total + jet.times(0.0)
    steep = where & np.isfinite(total.first).all(axis=0)
    return replace(total.lost(steep), x=result.numbers)
