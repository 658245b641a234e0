"""Compute the cells of a circle again and again until they converge: Excel's iterative calculation.

Every trial starts from the values that Excel saved. In each iteration the cells are computed one after another, in the
order of the tabs, and on a sheet row by row from left to right; each reads what the others hold by then. A trial ends
when no cell has changed by as much as the workbook's maximum change, or after its maximum number of iterations. Trials
do not depend on each other: a trial that has converged is left alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from xlmc.engine.graph.node_values import corner, evaluate_node
from xlmc.engine.graph.nodes import Apply, IfErrorNode, Range, Select, uses
from xlmc.engine.graph.recursive_calls import join_trials, spread_trials
from xlmc.excel.functions.values import ERROR, TEXT, Bools, Value, constant
from xlmc.excel.iteration import Iteration

__all__ = ["Formula", "Round", "iterate"]

Step = Apply | Select | IfErrorNode | Range


@dataclass(frozen=True, slots=True)
class Formula:
    """How a cell is computed: its steps in order, by slot, and the slot of its value."""

    steps: Mapping[int, Step]
    result: int


@dataclass(frozen=True, slots=True)
class Round:
    """One iteration. Slots count its cells, then what they take from outside, then constants and steps.

    Attributes:
        formulas: of the cells, in the order in which they are computed.
        constants: by slot.
        iteration: when to stop.
    """

    formulas: tuple[Formula, ...]
    constants: Mapping[int, Value]
    iteration: Iteration


def iterate(round_: Round, start: Value, *taken: Value) -> Value:
    """Iterate from a start.

    Args:
        round_: what to repeat.
        start: (1, k + 1, 1), what the k cells hold at first; the last row is not looked at.
        taken: what the cells read beside each other.

    Returns:
        (n, k + 1, 1): the cells, and in the last row whether the trial has converged.
    """
    n = max((value.shape[0] for value in taken), default=1)
    cells = [spread_trials(_row(start, row), n) for row in range(len(round_.formulas))]
    left, given, ended = np.arange(n), list(taken), list[tuple[np.ndarray, list[Value]]]()
    for _ in range(round_.iteration.count):
        before, cells = cells, _iterate(round_, cells, given)
        still = _are_still(before, cells, round_.iteration.change)
        if still.any():
            ended.append((left[still], [value.take(np.flatnonzero(still)) for value in (*cells, constant(True))]))
            going = np.flatnonzero(~still)
            left, cells, given = left[going], *([v.take(going) for v in values] for values in (cells, given))
        if not left.size:
            break
    if left.size:
        ended.append((left, [*cells, constant(False)]))
    rows = [join_trials(n, [(trials, values[row]) for trials, values in ended]) for row in range(len(cells) + 1)]
    return evaluate_node(Range(tuple((row,) for row in range(len(rows)))), dict(enumerate(rows)))


def _row(column: Value, row: int) -> Value:
    """One cell of a column, (1,)."""
    texts = None if column.texts is None else column.texts[:, row, 0]
    return Value(column.numbers[:, row, 0], np.broadcast_to(column.kinds, column.shape)[:, row, 0], texts)


def _iterate(round_: Round, cells: Sequence[Value], given: Sequence[Value]) -> list[Value]:
    """Compute each cell once."""
    n = cells[0].shape[0]
    values = {**round_.constants, **dict(enumerate([*cells, *given]))}
    for cell, formula in enumerate(round_.formulas):
        for slot, step in formula.steps.items():
            values[slot] = evaluate_node(step, {used: values[used] for used in uses(step)})
        values[cell] = spread_trials(corner(values[formula.result]), n)
    return [values[cell] for cell in range(len(round_.formulas))]


def _are_still(before: Sequence[Value], after: Sequence[Value], change: float) -> Bools:
    """Find the trials in which no cell has changed by so much: numbers by less, all else not at all."""
    still = np.ones(after[0].shape[0], bool)
    for old, new in zip(before, after, strict=True):
        moved = np.abs(new.numbers - old.numbers)
        same = (moved < change) | (moved == 0.0)
        if old.texts is not None or new.texts is not None:
            same &= (new.kinds != TEXT) | (old.to_texts()[0] == new.to_texts()[0])
        still &= same & (_kinds(old) == _kinds(new))
    return still


def _kinds(value: Value) -> np.ndarray:
    """Return the kinds, those that count as numbers being one."""
    return np.where((value.kinds >= ERROR) | (value.kinds == TEXT), value.kinds, np.uint8(0))
