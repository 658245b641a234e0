"""The rank correlations of a run: asked for, drawn with, and found among the accepted trials."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

from xlmc.address import Cell
from xlmc.definitions.model import name_key
from xlmc.run.correlating import CHANGED, used
from xlmc.statistics import Estimate, rank_correlation

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["CorrelationMet", "correlations_met"]


@dataclass(frozen=True, slots=True)
class CorrelationMet:
    """A pair of assumptions.

    Attributes:
        asked: what its row says; 0 where it has none.
        row: its first cell; None where a repair of other pairs changed one that no row names.
        used: what it was drawn with, None where one of the two was not drawn.
        accepted: what the accepted trials have, of as many as have their draws kept; None where none was drawn.
    """

    first: str
    second: str
    asked: float
    row: Cell | None
    used: float | None = None
    accepted: Estimate | None = None


def correlations_met(simulation: Simulation) -> list[CorrelationMet]:
    """The pairs in the order of the rows, then those that a repair changed without a row."""
    model = simulation.model
    pairs = [(c.first, c.second, c.value, c.row) for c in model.definitions.correlations]
    return [_met(simulation, *pair) for pair in (*pairs, *_unnamed(simulation))]


def _unnamed(simulation: Simulation) -> Iterator[tuple[str, str, float, None]]:
    model = simulation.model
    named = {frozenset((name_key(c.first), name_key(c.second))) for c in model.definitions.correlations}
    spelt = {name_key(a.name): a.name for a in model.live}
    for group in model.groups:
        for first, second in combinations(group.names, 2):
            found = used(model.groups, first, second)
            if frozenset((first, second)) not in named and found is not None and abs(found) >= CHANGED:
                yield spelt[first], spelt[second], 0.0, None


def _met(simulation: Simulation, first: str, second: str, asked: float, row: Cell | None) -> CorrelationMet:
    drawn = used(simulation.model.groups, first, second)
    if drawn is None:
        return CorrelationMet(first, second, asked, row)
    columns = {name_key(name): values for name, values in simulation.inputs.items()}
    x, y = columns[name_key(first)], columns[name_key(second)]
    replicate = simulation.replicate
    accepted = rank_correlation(x, y, None if replicate is None else replicate[: x.size])
    return CorrelationMet(first, second, asked, row, drawn, accepted)
