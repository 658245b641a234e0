"""Conditions stand still, except at their limits; a choice has the derivatives of the branch it takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import ErrorCode
from xlmc.evaluation.passes.derivatives.jet import Jet, aligned
from xlmc.evaluation.passes.derivatives.rules import Operand, Outcome, leveled, rule
from xlmc.functions import Function
from xlmc.functions.values import ERROR, TEXT, Bools, Value

__all__ = ["condition", "rescued", "selected"]


@rule("<", "<=", ">", ">=", why="the two sides are equal there", jumps=True)
def ordered(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Which is larger: no derivative where both are equal and do not change alike."""
    ways = result.numbers
    if any((operand.value.kinds == TEXT).any() for operand in operands):
        return Outcome(Jet.still(result.numbers), ways)
    left, right = leveled(operands)
    equal: Bools = np.asarray(left.x == right.x)
    return Outcome(condition(result, [left, right], equal), ways)


@rule("=", "<>", why="one side has no derivative there", jumps=True)
def labels(function: Function, result: Value, operands: Sequence[Operand]) -> Outcome:
    """Whether two are equal: what is compared so is a label, which does not change little by little."""
    if any((operand.value.kinds == TEXT).any() for operand in operands):
        return Outcome(Jet.still(result.numbers), result.numbers)
    return Outcome(condition(result, leveled(operands), np.zeros(1, bool)), result.numbers)


def condition(result: Value, jets: Sequence[Jet], edge: Bools) -> Jet:
    """What stands still: derivatives of 0, and none where an operand has none or is on the edge with one that is not 0.

    Args:
        result: what it is.
        jets: of which it is the condition; their difference decides, if they are two.
        edge: where the condition is about to change.
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
    """Conditions put together."""
    total = Jet.still(np.zeros(1))
    for operand in operands:
        jet = operand.jet
        if jet.active:
            cells = jet.spread().each(lambda part, axes: part.reshape(*part.shape[: axes + 1], -1).sum(axis=-1))
            total = total + cells
    return Outcome(replace(total.times(0.0), x=result.numbers), result.numbers)


def selected(result: Value, operands: Sequence[Operand]) -> Outcome:
    """`IF`: the branch taken, and the limit of the condition."""
    test, yes, no = leveled(operands)
    truth, _ = operands[0].value.to_logicals()
    truth = truth.reshape(-1, 1, 1) if test.x.ndim > truth.ndim else truth
    jet = _either(truth, yes, no)
    edge = test.times(0.0)
    jet = jet if not edge.active else replace(jet + edge, x=result.numbers)
    return Outcome(replace(jet, x=result.numbers), truth)


def rescued(result: Value, operands: Sequence[Operand], only_na: bool) -> Outcome:
    """`IFERROR`: the value, or the other one where it is an error."""
    value, instead = leveled(operands)
    kinds = operands[0].value.kinds
    lost = kinds == ERROR + ErrorCode.NA if only_na else kinds >= ERROR
    lost = lost.reshape(-1, 1, 1) if value.x.ndim > lost.ndim else lost
    return Outcome(replace(_either(lost, instead, value), x=result.numbers), lost)


def _either(truth: Bools, yes: Jet, no: Jet) -> Jet:
    """One where it holds, else the other."""
    if not yes.active and not no.active:
        return Jet.still(np.where(truth, yes.x, no.x))
    live = yes if yes.active else no
    yes, no = ((jet if jet.active else _like(live, jet)) for jet in (yes, no))
    a, b = aligned([yes, no])
    parts = zip((a.first, a.second, a.error, a.second_error), (b.first, b.second, b.error, b.second_error), strict=True)
    chosen = [None if x is None and y is None else np.where(truth, _or_0(x), _or_0(y)) for x, y in parts]
    return Jet(np.where(truth, a.x, b.x), a.active, *chosen)  # type: ignore[arg-type]  # `first` is never None


def _like(live: Jet, still: Jet) -> Jet:
    """A still jet of the order of another."""
    return still if live.order > 1 else replace(still, second=None)


def _or_0(part: Any) -> Any:
    return 0.0 if part is None else part
