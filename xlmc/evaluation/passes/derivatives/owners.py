"""Whose formula a node is part of: nodes are shared, so that the first cell that needs one stands for all."""

from __future__ import annotations

from xlmc.address import Cell
from xlmc.evaluation.graph.dag import uses
from xlmc.evaluation.graph.lower import Lowering

__all__ = ["owners"]


def owners(lowering: Lowering) -> dict[int, Cell]:
    """Node -> the cell whose formula it is in, for every node that varies."""
    found: dict[int, Cell] = {lowering.cell(cell): cell for cell in lowering.inputs}
    nodes = lowering.dag.nodes
    for cell in lowering.graph.formulas:
        open_ = [lowering.cell(cell)]
        while open_:
            place = open_.pop()
            if place not in found:
                found[place] = cell
                open_ += uses(nodes[place])
    return found
