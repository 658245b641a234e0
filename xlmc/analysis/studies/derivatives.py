"""The derivatives of a workbook's cells."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from xlmc.engine.graph.nodes import Range
from xlmc.engine.passes.derivatives.derivative import Derivative, Derivatives, Notes
from xlmc.engine.passes.derivatives.jet import Jet
from xlmc.engine.passes.derivatives.sweep import UnequalSizes, owners, sweep_forward
from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.excel.functions.values import BLANK, ERROR, TEXT, Floats, Value

if TYPE_CHECKING:
    from xlmc.engine.graph.lowering import Lowering
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["Movements", "derivatives"]

_PORTION: Final = 1 << 21
"""Derivatives held of one node at once."""


class Movements:
    """By how much cells move with the assumptions, gathered while derivatives are: 3 numbers a trial, not 2 k.

    Args:
        nodes: cell -> its node.

    Attributes:
        of_trials: node -> `(n,)`, the sum over assumptions of |derivative × value|; those without derivative count 0.
        of_assumptions: node -> `(k,)`, the same, summed over trials.
    """

    def __init__(self, nodes: Mapping[Cell, int]) -> None:
        self.nodes = dict(nodes)
        self.of_trials: dict[int, Floats] = {}
        self.of_assumptions: dict[int, Floats] = {}

    def add(self, node: int, gradient: Floats, points: Floats, start: int, n: int) -> None:
        """Take up the derivatives of a node in some trials.

        Args:
            node: of a cell.
            gradient: `(m, k)`.
            points: `(m, k)`, what the assumptions are.
            start: the number of the first of these trials, of n.
            n: all trials.
        """
        with np.errstate(all="ignore"):
            moved = np.abs(gradient * points)
            self.of_trials.setdefault(node, np.zeros(n))[start : start + len(moved)] = np.nansum(moved, axis=1)
            total = np.nansum(moved, axis=0)
            self.of_assumptions[node] = self.of_assumptions.get(node, 0.0) + total


def derivatives(
    model: CompiledModel,
    inputs: Mapping[str, ArrayLike],
    *,
    order: int = 1,
    cells: Iterable[Cell] = (),
    movements: Movements | None = None,
) -> Derivatives:
    """First, and second, derivatives of every forecast and of every filter's cell, at the points given.

    Filters are not asked: give accepted trials for derivatives there. Assumptions whose parameters depend on others
    count as independent of them: their draws are what varies.

    Args:
        model: the workbook.
        inputs: name of every live assumption -> `(n,)` or a number.
        order: 1, or 2 for second derivatives too; these take k times the time and memory.
        cells: more cells that are wanted, among those that the forecasts and filters need.
        movements: of cells whose derivatives are not wanted themselves.

    Raises:
        SimulationError: an assumption is missing, unknown or frozen, the values are of different lengths, the order is
            neither, or a cell is not needed by any forecast or filter.
    """
    if order not in (1, 2):
        raise SimulationError(f"derivatives of order {order} were asked for", hint="ask for order 1 or 2")
    draws, n = model.points(inputs)
    lowering = model.lowering
    more = list(dict.fromkeys(cells))
    nodes = {cell: _node_of(lowering, cell) for cell in more}
    targets = [*(f.cell for f in model.forecasts), *(f.cell for f in model.filters)]
    nodes |= {cell: lowering.cell(cell) for cell in targets}
    notes = Notes()
    points = np.column_stack([*draws.values()]) if draws else np.empty((n, 0))
    result = _Derivatives(n, len(draws), order, set(nodes.values()))
    portion = _portion(lowering, len(draws), order)
    for start in range(0, n, portion):
        part = {name: values[start : start + portion] for name, values in draws.items()}
        try:
            _sweep(lowering, result, part, order, notes, start, points, movements)
        except UnequalSizes:
            for trial in range(start, min(start + portion, n)):
                one = {name: values[trial : trial + 1] for name, values in draws.items()}
                _sweep(lowering, result, one, order, notes, trial, points, movements)
    by_cell = {cell: result.derivative(cell, node) for cell, node in nodes.items()}
    concerned = np.flatnonzero(np.any([np.isnan(d.gradient).any(axis=1) for d in by_cell.values()], axis=0))
    whose = owners(lowering)
    return Derivatives(
        names=tuple(a.name for a in model.live),
        points=points,
        forecasts={f.name: by_cell[f.cell] for f in model.forecasts},
        filters={f.name: by_cell[f.cell] for f in model.filters},
        cells={cell: by_cell[cell] for cell in more},
        kinks=notes.kinks(whose),
        undefined=notes.undefined(whose, concerned),
        numerical=notes.numerical(whose),
    )


def _node_of(lowering: Lowering, cell: Cell) -> int:
    if cell not in lowering.graph.formulas and cell not in lowering.inputs:
        raise SimulationError(f"no forecast or filter needs {cell}, or it holds no formula", hint="ask for one they do")
    return lowering.cell(cell)


def _portion(lowering: Lowering, k: int, order: int) -> int:
    """How many trials at once."""
    sizes = (len(node.rows) * len(node.rows[0]) for node in lowering.dag.nodes if isinstance(node, Range))
    each: int = max(sizes, default=1) * max(k, 1) ** order
    return max(1, _PORTION // each)


class _Derivatives:
    """Arrays for the derivatives of the nodes wanted, filled portion by portion."""

    def __init__(self, n: int, k: int, order: int, nodes: Iterable[int]) -> None:
        self.nodes = set(nodes)
        self._order = order
        self._values = {node: np.full(n, np.nan) for node in self.nodes}
        self._first = {node: np.zeros((2, n, k)) for node in self.nodes}
        self._second = {node: np.zeros((2, n, k, k)) for node in self.nodes} if order > 1 else {}

    def add(self, node: int, value: Value, jet: Jet, start: int, stop: int) -> None:
        """Return what a sweep found in the trials from `start` to `stop`."""
        here = slice(start, stop)
        self._values[node][here] = np.where((value.kinds >= TEXT) & (value.kinds != BLANK), np.nan, value.numbers)
        first, second = self._first[node], self._second.get(node)
        _spread_out(value, jet, first[:, here])
        columns = list(jet.active)
        if second is None or not columns:
            return
        for kind, part in enumerate((jet.second, jet.second_error)):
            if part is not None:
                full = np.broadcast_to(part, (len(columns), len(columns), stop - start))
                block = np.ix_(np.arange(start, stop), *[np.array(columns)] * 2)
                second[kind][block] = full.transpose(2, 0, 1)
        second[1][np.isnan(second[0])] = np.nan

    def derivative(self, cell: Cell, node: int) -> Derivative:
        first = self._first[node]
        second = self._second.get(node)
        return Derivative(
            cell, self._values[node], first[0], first[1], *((None, None) if second is None else (second[0], second[1]))
        )


def _spread_out(value: Value, jet: Jet, into: Floats) -> None:
    """Write first derivatives, and their errors, `(2, n, k)`: NaN where the value is lost, 0 where it does not vary."""
    into[:] = 0.0
    if columns := list(jet.active):
        for kind, part in enumerate((jet.first, jet.error)):
            if part is not None:
                into[kind][:, columns] = np.broadcast_to(part, (len(columns), into.shape[1])).T
    lost = np.asarray((value.kinds >= ERROR) | (value.kinds == TEXT))[:, None]
    into[1][np.isnan(into[0]) | lost] = np.nan
    into[0][np.broadcast_to(lost, into[0].shape)] = np.nan


def _sweep(
    lowering: Lowering,
    result: _Derivatives,
    draws: Mapping[str, Floats],
    order: int,
    notes: Notes,
    start: int,
    points: Floats,
    movements: Movements | None,
) -> None:
    stop = start + next((values.size for values in draws.values()), 1)
    moving = set() if movements is None else {*movements.nodes.values()}
    for node, value, jet in sweep_forward(lowering.dag, result.nodes | moving, draws, order, notes, start):
        if node in result.nodes:
            result.add(node, value, jet, start, stop)
        if movements is not None and node in moving:
            first = np.empty((2, stop - start, points.shape[1]))
            _spread_out(value, jet, first)
            movements.add(node, first[0], points[start:stop], start, len(points))
