"""How much of a model is looked at, and in how many trials, so that it fits into memory; known before the run."""

from __future__ import annotations

from math import prod
from typing import Final

from xlmc.engine.engine import Target
from xlmc.engine.graph.nodes import Constant
from xlmc.engine.passes.random_rounding import closure, open_constants
from xlmc.excel.address import Cell
from xlmc.excel.functions.budget import TooLargeError
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import filter_condition

__all__ = ["Extent"]

_PRIOR: Final = 2048
_ACCEPTED: Final = 1024
_FEWEST_OF_EITHER: Final = 64
"""Trials as drawn, and accepted ones; and how few there may be of each in a large book."""

_BYTES: Final = 1 << 29
"""Bytes for the values of all nodes: they limit the number of trials."""

_MOST_BYTES: Final = 1 << 31
"""Bytes that the fewest trials may take."""

_A_VALUE: Final = 24
"""Bytes of a node's number in a trial: its kind too, and as much of another evaluation beside it."""

_OF_A_CELL: Final = 64
"""Bytes for a needed cell and trial: by how much it moves, and errors in several senses."""

_MOST_OPENED: Final = 1 << 18
"""Cells that computed constants read and that are computed again: with 50 digits each takes 2 microseconds."""


class Extent:
    """What is looked at.

    Args:
        model: the workbook.

    Attributes:
        cells: the formula cells that forecasts and filters need.
        node: of these, and of forecasts and filters.
        conditions: the nodes of the filters.
        graph: the model's nodes; constants computed from large arrays count as typed.
        nodes: all that is computed, each after those that it needs.
        prior, accepted: how many trials are looked at, of those as drawn and of accepted ones.

    Raises:
        TooLargeError: it does not fit into memory.
    """

    def __init__(self, model: CompiledModel) -> None:
        self.model, lowering = model, model.lowering
        self.cells = [cell for cell in lowering.graph.formulas if cell not in lowering.inputs]
        targets = [*(f.cell for f in model.forecasts), *(f.cell for f in model.filters)]
        self.node: dict[Cell, int] = {cell: lowering.cell(cell) for cell in (*self.cells, *targets)}
        self.conditions = [lowering.target(Target(filter_condition(f, certain=True), f.cell)) for f in model.filters]
        wanted = [*self.node.values(), *self.conditions]
        self.graph = open_constants(lowering.dag, wanted, _MOST_OPENED)
        self.nodes = closure(self.graph, wanted)
        self.prior, self.accepted = self._trials()

    def _trials(self) -> tuple[int, int]:
        dag = self.model.lowering.dag
        sizes = {node: prod(dag.sizes[node] or (1,)) for node in self.nodes}
        # a computed number counts as one that varies: its roundings differ from trial to trial
        still = {node for node in self.nodes if isinstance(dag.nodes[node], Constant) and sizes[node] > 1}
        fixed = _A_VALUE * sum(sizes[node] for node in still)
        a_trial = _A_VALUE * sum(size for node, size in sizes.items() if node not in still)
        a_trial += _OF_A_CELL * len(self.cells)
        share = max(_BYTES - fixed, 0) / (a_trial * (_PRIOR + _ACCEPTED) or 1)
        fewest = 1 + 2 * len(self.model.live) + 2 * _FEWEST_OF_EITHER
        if (needed := fixed + a_trial * fewest) > _MOST_BYTES:
            largest = max(self.nodes, key=sizes.__getitem__)
            raise dag.naming_cell_of(
                TooLargeError(
                    f"stability keeps the values of all cells in {fewest:,} trials and more, which takes "
                    f"{needed / 1e9:.1f} GB: xlmc takes up to {_MOST_BYTES / 1e9:.1f} GB",
                    hint="make the arrays of the workbook smaller, this one first, or look at a part of the workbook",
                ),
                largest,
            )
        if share >= 1:
            return _PRIOR, _ACCEPTED
        return max(_FEWEST_OF_EITHER, int(share * _PRIOR)), max(_FEWEST_OF_EITHER, int(share * _ACCEPTED))
