"""Which forecasts each assumption reaches: what reaches no common forecast can be changed in one and the same run.

As the columns of a sparse Jacobian that have no row in common are found from one difference (Curtis, Powell and Reid
1974), so a run with several assumptions held says what each of them costs, if no forecast depends on two of them.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from xlmc.excel.address import Cell
from xlmc.excel.formula.graph import reached
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import targets_of

__all__ = ["apart", "reach_of"]

Item = TypeVar("Item")


def reach_of(model: CompiledModel) -> Mapping[str, frozenset[str]]:
    """Return the names of the forecasts that each drawn assumption may move: all, if it may move a filter.

    An assumption also moves those whose parameters depend on it, and those it is correlated with, because a group is
    drawn anew without it.
    """
    needs, led_to = model.needed.graph.needs, model.lowering.led_to
    cell_of = {each.name: each.cell for each in model.live}
    further: dict[Cell, set[Cell]] = defaultdict(set)
    for each in model.live:
        further[each.cell].update(each.cells)
    for group in model.groups:
        cells = {cell_of[name] for name in group.names if name in cell_of}
        for cell in cells:
            further[cell] |= cells

    def upstream(cells: Iterable[Cell]) -> set[Cell]:
        return {*reached(cells, lambda at: (*needs.get(at, ()), *led_to.get(at, ()), *further.get(at, ())))}

    decisive = upstream(targets_of((), (*model.filters, *model.forecast_filters)))
    above = {each.name: upstream([each.cell]) for each in model.forecasts}
    return {
        name: frozenset(above if cell in decisive else (each for each in above if cell in above[each]))
        for name, cell in cell_of.items()
    }


def apart(items: Sequence[Item], reaches: Sequence[frozenset[str]]) -> list[list[Item]]:
    """Put items into as few lists as their order allows: no two of a list reach a common forecast.

    Of two that do, the first stands in an earlier list.

    >>> apart("abcd", [frozenset("x"), frozenset("y"), frozenset("xz"), frozenset("z")])
    [['a', 'b'], ['c'], ['d']]
    """
    lists: list[list[Item]] = []
    next_of: dict[str, int] = {}
    for item, forecasts in zip(items, reaches, strict=True):
        at = max((next_of.get(each, 0) for each in forecasts), default=0)
        if at == len(lists):
            lists.append([])
        lists[at].append(item)
        next_of |= dict.fromkeys(forecasts, at + 1)
    return lists
