"""Cells that need each other in a circle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from xlmc.address import Cell
from xlmc.errors import FormulaError

__all__ = ["circular", "cycle"]


def circular(needs: Mapping[Cell, Sequence[Cell]]) -> dict[Cell, FormulaError]:
    """Every cell that needs itself, directly or through others, with one circle of those that it is in with.

    Args:
        needs: cell -> the cells it needs; those that are no keys need nothing.
    """
    cells = list(needs)
    groups = _groups(cells, needs)
    found: dict[Cell, FormulaError] = {}
    for cell in cells:
        if cell not in found and (loop := _loop(cell, needs, groups)):
            fault = cycle(loop)
            found |= dict.fromkeys(groups[cell], fault)
    return found


def cycle(cells: Sequence[Cell]) -> FormulaError:
    """What to tell of a circle."""
    loop = " → ".join(str(cell) for cell in [*cells, cells[0]])
    return FormulaError(
        f"the cells need each other in a circle: {loop}",
        where=cells[0],
        hint="break the circle; iterative calculation is not supported",
    )


def _groups(cells: Sequence[Cell], needs: Mapping[Cell, Sequence[Cell]]) -> dict[Cell, dict[Cell, None]]:
    """The strongly connected component of every cell, in the order of the cells."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    places = {cell: place for place, cell in enumerate(cells)}
    edges = [(places[cell], places[need]) for cell in cells for need in needs[cell] if need in places]
    rows, columns = np.array(edges, np.int64).T
    matrix = coo_array((np.ones(len(edges), np.int8), (rows, columns)), shape=(len(cells), len(cells)))
    _, labels = connected_components(matrix.tocsr(), connection="strong")
    members: dict[int, dict[Cell, None]] = {}
    for cell, label in zip(cells, labels.tolist(), strict=True):
        members.setdefault(label, {})[cell] = None
    return {cell: members[label] for cell, label in zip(cells, labels.tolist(), strict=True)}


def _loop(start: Cell, needs: Mapping[Cell, Sequence[Cell]], groups: Mapping[Cell, dict[Cell, None]]) -> list[Cell]:
    """Follow needs within the group until a cell comes up again; nothing where the cell is in no circle."""
    group, trail = groups[start], {start: None}
    while True:
        following = next((need for need in needs[next(reversed(trail))] if need in group), None)
        if following is None:
            return []
        if following in trail:
            return [*trail][[*trail].index(following) :]
        trail[following] = None
