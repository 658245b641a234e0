"""Which assumptions reach which cells."""

from __future__ import annotations

from collections.abc import Iterable

from xlmc.address import Cell
from xlmc.run.model import Model

__all__ = ["assumptions_of", "upstream"]


def upstream(model: Model, cells: Iterable[Cell]) -> set[Cell]:
    """The cells that these depend on, and they themselves."""
    needs = model.scene.graph.needs
    found: set[Cell] = set()
    open_ = list(cells)
    while open_:
        cell = open_.pop()
        if cell not in found:
            found.add(cell)
            open_ += needs.get(cell, ())
    return found


def assumptions_of(model: Model, cells: Iterable[Cell]) -> list[int]:
    """The places of the live assumptions that reach any of these cells, ascending.

    An assumption that only moves another's parameters does not count.
    """
    reached = upstream(model, cells)
    return [place for place, assumption in enumerate(model.live) if assumption.cell in reached]
