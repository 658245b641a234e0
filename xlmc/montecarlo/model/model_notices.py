"""What a person should know of a model before it is run: what does not vary, what has no mean, what has no source."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence, Set
from typing import Final

from xlmc.errors import Notice
from xlmc.excel.address import Cell
from xlmc.excel.formula import Graph
from xlmc.excel.formula.graph import downstream
from xlmc.montecarlo.definitions.definitions import Assumption, Forecast
from xlmc.montecarlo.model.needed import Needed
from xlmc.montecarlo.model.plain_words import list_of

__all__ = ["example_notices", "heavy_notices", "still_cells", "still_notices"]

_EXAMPLE: Final = re.compile(r"example\b", re.IGNORECASE)
_MOST_NAMED: Final = 4


def example_notices(sources: Iterable[tuple[str, Cell, str]]) -> list[Notice]:
    """Return the sources and reasons that still begin with the word "Example", as those of a template do.

    Args:
        sources: what each is the source of, the row where it stands, and what it says.
    """
    result = [(named, row) for named, row, text in sources if _EXAMPLE.match(text.strip())]
    if not result:
        return []
    named = ", ".join(name for name, _ in result[:_MOST_NAMED])
    more = f" and {len(result) - _MOST_NAMED} more" if len(result) > _MOST_NAMED else ""
    begins = "source still says" if len(result) == 1 else f"{len(result)} sources still say"
    message = f'{begins} "Example": {named}{more}. Write there what each number of this case rests on'
    return [Notice(message, result[0][1])]


def heavy_notices(heavy: Iterable[Assumption]) -> Iterator[Notice]:
    """Return the assumptions whose mean is infinite or does not exist."""
    for assumption in heavy:
        message = (
            f"{assumption.name!r} ({assumption.distribution}) has no finite mean: means and standard deviations of "
            "what depends on it need not settle, however many trials there are; report medians and percentiles, or "
            "give it cutoffs at both ends"
        )
        yield Notice(message, assumption.row)


def still_cells(needed: Needed, moving: Set[Cell], forecasts: Sequence[Forecast]) -> frozenset[Cell]:
    """Return the cells of the forecasts that are the same in every trial.

    Args:
        needed: what they need.
        moving: the cells of the live assumptions whose range has more than one value.
        forecasts: all of them.
    """
    reached = needed.graph.varying if len(moving) == len(needed.live) else _reached(needed.graph, moving)
    return frozenset(each.cell for each in forecasts if each.cell not in reached)


def still_notices(needed: Needed, moving: Set[Cell], forecasts: Sequence[Forecast], same: Set[Cell]) -> list[Notice]:
    """Say which forecasts are the same in every trial: `same` is what `still_cells` gives for the other arguments."""
    still = [forecast for forecast in forecasts if forecast.cell in same]
    if forecasts and len(still) == len(forecasts):
        why = (
            "no assumption is drawn, as when all are Frozen"
            if not needed.live
            else "no assumption that is drawn reaches a forecast"
        )
        if needed.live and not moving:
            why = "the range of every assumption that is drawn has a single value"
        return [Notice(f"nothing varies: {why}, so every trial gives the base case again", still[0].cell)]
    if len(still) < 2:
        return [
            Notice(f"the forecast {each.name!r} does not vary: no assumption with a range reaches it", each.cell)
            for each in still
        ]
    names = [repr(each.name) for each in still[:_MOST_NAMED]]
    more = [f"{len(still) - _MOST_NAMED} more"] if len(still) > _MOST_NAMED else []
    message = f"the forecasts {list_of([*names, *more])} do not vary: no assumption with a range reaches them"
    return [Notice(message, still[0].cell)]


def _reached(graph: Graph, moving: Set[Cell]) -> set[Cell]:
    """Return the cells that depend on a moving one."""
    if graph.circles:
        return set(downstream(graph.needs, moving))
    cells = set(moving)
    for cell in graph.formulas:  # each after the cells it needs
        if not cells.isdisjoint(graph.needs[cell]):
            cells.add(cell)
    return cells
