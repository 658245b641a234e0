"""Lower again and wider, as long as OFFSET and its like lead to cells that the graph did not hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from xlmc.address import Cell
from xlmc.evaluation.graph.lower import Lowering

__all__ = ["widened"]


L = TypeVar("L", bound=Lowering)


def widened(lower: Callable[[Mapping[Cell, set[Cell]]], L]) -> L:
    """What `lower` makes once nothing is missing.

    Args:
        lower: takes formula cell -> cells it turned out to need, and lowers a graph that holds these too.
    """
    more: dict[Cell, set[Cell]] = {}
    while True:
        lowering = lower(more)
        if not lowering.more:
            return lowering
        for cell, needed in lowering.more.items():
            more.setdefault(cell, set()).update(needed)
