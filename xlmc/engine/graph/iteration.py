"""Lowers the cells of a circle in a workbook whose iterative calculation is on: their formulas once for all iterations.

While they are lowered, each of them is a parameter. The nodes that depend on these become a `Round`; all others are
computed once, before the first iteration.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from xlmc.engine.graph.arrays import element
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.iterated_cells import Formula, Round, Step, iterate
from xlmc.engine.graph.nodes import Apply, Constant, in_slots, uses
from xlmc.engine.graph.recursion import placeholder
from xlmc.errors import Notice
from xlmc.excel.address import Cell
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.registry import Anything, Cells
from xlmc.excel.functions.values import from_objects
from xlmc.excel.iteration import Iteration

__all__ = ["IteratedCells", "in_order", "iterate_cells"]


@dataclass(frozen=True, slots=True)
class IteratedCells:
    """The cells of a circle, in the order in which they are computed.

    Attributes:
        nodes: of each.
        start: the node of what they hold at first, in a column.
        converged: the node that says whether a trial has converged.
    """

    cells: tuple[Cell, ...]
    nodes: tuple[int, ...]
    start: int
    converged: int

    @property
    def name(self) -> str:
        """What a message at the first cell calls them."""
        one = len(self.cells) == 1
        return "this cell" if one else f"the circle of {len(self.cells)} cells, of which this is the first,"

    def notice(self, iteration: Iteration) -> Notice:
        """Say that they are iterated, and how."""
        return Notice(
            f"{self.name} is computed iteratively, in each trial from the values that Excel saved: at most "
            f"{iteration.count:,} times, until no change is as large as {iteration.change:g}",
            self.cells[0],
        )


def in_order(tabs: Iterable[str], cells: Iterable[Cell]) -> list[Cell]:
    """Sort cells as they are computed: by tab, row and column."""
    places = {name: number for number, name in enumerate(tabs)}
    return sorted(cells, key=lambda cell: (places.get(cell.sheet, len(places)), cell.row, cell.column))


def iterate_cells(
    dag: Dag,
    cells: Sequence[Cell],
    saved: Sequence[object],
    iteration: Iteration,
    lower: Callable[[Mapping[Cell, int]], Sequence[int]],
) -> IteratedCells:
    """Make the nodes of cells that need each other.

    Args:
        dag: takes the nodes.
        cells: in the order in which they are computed.
        saved: what they hold at first; an empty cell is 0.
        iteration: the workbook's.
        lower: lowers the formulas, given the nodes that stand for the cells meanwhile.
    """
    parameters = {cell: placeholder(dag) for cell in cells}
    results = lower(parameters)
    round_, taken = _round(dag, list(parameters.values()), results, iteration)
    column = np.empty((1, len(cells) + 1, 1), object)
    column[0, :, 0] = [*(0.0 if value is None else value for value in saved), False]
    function = Function("iterative calculation", (Anything, Cells(repeat=True)), partial(iterate, round_), Kind.ANY)
    start = dag.constant(from_objects(column))
    node = dag.add(Apply(function, (start, *taken)))
    *nodes, converged = (element(dag, node, row, 0) for row in range(len(cells) + 1))
    return IteratedCells(tuple(cells), tuple(nodes), start, converged)


def _round(
    dag: Dag, parameters: Sequence[int], results: Sequence[int], iteration: Iteration
) -> tuple[Round, tuple[int, ...]]:
    """One iteration, and the nodes that it takes from outside."""
    needed = dag.upstream(results)
    steps = [node for node in _dependent(dag, needed, parameters) if node not in parameters]
    read = dict.fromkeys(used for node in (*steps, *results) for used in (node, *uses(dag.nodes[node])))
    outer = [node for node in read if node not in steps and node not in parameters]
    taken = tuple(node for node in outer if not isinstance(dag.nodes[node], Constant))
    known = [node for node in outer if isinstance(dag.nodes[node], Constant)]
    slots = {node: slot for slot, node in enumerate((*parameters, *taken, *known, *steps))}
    constants = {slots[node]: answer.value for node in known if isinstance(answer := dag.nodes[node], Constant)}
    made: dict[int, Step] = {node: in_slots(dag.nodes[node], slots) for node in steps}
    formulas = []
    for result in results:
        own = set(dag.upstream([result]))
        formulas.append(Formula({slots[node]: step for node, step in made.items() if node in own}, slots[result]))
    return Round(tuple(formulas), constants, iteration), taken


def _dependent(dag: Dag, needed: Iterable[int], parameters: Iterable[int]) -> list[int]:
    """Return the nodes among those needed that depend on parameters, in order."""
    result = set(parameters)
    for node in needed:
        if not result.isdisjoint(uses(dag.nodes[node])):
            result.add(node)
    return [node for node in needed if node in result]
