"""The ways to be accepted that a model has: by the discrete assumptions and the branches above its filters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.address import Area, Cell
from xlmc.definitions.model import name_key
from xlmc.formula import ir
from xlmc.run.rare.shortfall import Shortfall
from xlmc.run.rare.switches import MOST_WAYS, Switch, formula_switches, value_switch, ways
from xlmc.run.scene import filter_limits, upstream

if TYPE_CHECKING:
    from xlmc.definitions.model import Assumption
    from xlmc.run.model import Model

__all__ = ["ways_of"]

_MOST_CELLS: Final = 1_000
"""Of an area that are looked at."""

_RANKS: Final = np.concatenate([[1e-12, 1e-9, 1e-6], np.linspace(1e-4, 1.0 - 1e-4, 4_001), [1 - 1e-6, 1 - 1e-9]])
"""Where values of a discrete assumption are looked for."""


def ways_of(model: Model, filters: Sequence[Shortfall]) -> list[tuple[Shortfall, ...]]:
    """What each way asks, beside the filters; one that asks nothing where there is nothing to tell apart.

    Args:
        model: with filters.
        filters: what they ask.
    """
    graph = model.scene.graph
    limits = (bound for f in model.filters for _, bound in filter_limits(f))
    asked_of = [*(f.cell for f in model.filters), *(bound for bound in limits if isinstance(bound, Cell))]
    needed = upstream(graph, asked_of, {})
    strata = {a.cell: switch for a in model.live if a.cell in needed and (switch := _strata(model, a)) is not None}
    drawn = {a.cell for a in model.live}
    switches = list(strata.values())
    for decided_by, switch in formula_switches(filters, graph.formulas):
        reached = drawn if decided_by is None else upstream(graph, cells_of(decided_by), {}) & drawn
        if not reached or not reached <= strata.keys():  # else its strata decide it
            switches.append(switch)
    return ways(switches)


def _strata(model: Model, assumption: Assumption) -> Switch | None:
    """The values of an assumption that has few; None of any other."""
    draw = model.draws[assumption.name]
    if not draw.fixed:
        return None
    values = _RANKS.copy()
    draw.fill(values, {})
    found = np.unique(values)
    if not 1 < found.size <= MOST_WAYS // 2 or name_key(assumption.name) in model.fallible:
        return None
    return value_switch(assumption.cell, found.tolist())


def cells_of(tree: ir.Expression) -> Iterator[Cell]:
    """The cells that a tree names, those of its areas among them."""
    match tree:
        case Cell():
            yield tree
        case Area():
            yield from islice(tree.cells(), _MOST_CELLS)
        case ir.Call(_, parts):
            yield from _cells_of_all(parts)
        case ir.Binary(_, left, right):
            yield from _cells_of_all((left, right))
        case ir.Unary(_, operand):
            yield from cells_of(operand)


def _cells_of_all(parts: Iterable[ir.Expression]) -> Iterator[Cell]:
    for part in parts:
        yield from cells_of(part)
