"""Every assumption against every forecast, on the accepted trials."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.columns import picked
from xlmc.studies.sensitivity.dependence import dependence, dependence_floor
from xlmc.studies.sensitivity.examined import COARSE_TRIALS, LEAST_TRIALS, examined_places, trials_for
from xlmc.studies.sensitivity.explained import explained, explained_floor, shares, standardised
from xlmc.studies.sensitivity.rank_correlations import contributions, rank_correlation
from xlmc.studies.sensitivity.ranked import Ranked
from xlmc.studies.sensitivity.results import Influence
from xlmc.studies.sensitivity.units import Units

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["MOST_ASSUMPTIONS", "Influences", "influences", "ranked_assumptions"]

MOST_ASSUMPTIONS: Final = 200
"""Examined closely; of more, those that explain most of some forecast in a first look."""

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]


@dataclass(frozen=True)
class Influences:
    """Of every assumption on one forecast, by the variance explained; `trials` are those it is a number in."""

    trials: int
    found: tuple[Influence, ...]


def ranked_assumptions(simulation: Simulation) -> list[str]:
    """The live assumptions to examine closely: all in their order, or of very many the most influential first."""
    live = [a.name for a in simulation.model.live]
    if len(live) <= MOST_ASSUMPTIONS:
        return live
    places, _ = examined_places(simulation, COARSE_TRIALS)
    forecasts = [_read(simulation.forecasts[f.name], places) for f in simulation.model.forecasts]
    if places.size < LEAST_TRIALS:
        return live[:MOST_ASSUMPTIONS]
    columns = [standardised(np.where(np.isnan(y), np.nanmean(y), y)) for y in forecasts if not np.isnan(y).all()]
    z = np.array([column for column in columns if column is not None])
    if not z.size:
        return live[:MOST_ASSUMPTIONS]
    scores = [float(shares(Ranked.of(_read(simulation.inputs[name], places)), z).max()) for name in live]
    first = np.argsort(-np.asarray(scores), kind="stable")[:MOST_ASSUMPTIONS]
    return [live[place] for place in first]


def influences(simulation: Simulation, assumptions: Sequence[str]) -> list[Influences]:
    """Of the assumptions of these names on every forecast, in the order of the workbook."""
    forecasts = simulation.model.forecasts
    places, replicate = examined_places(simulation, trials_for(len(assumptions) * len(forecasts)))
    draws = [_read(simulation.inputs[name], places) for name in assumptions]
    units = {a.name: a.units for a in simulation.model.live}
    named = [(name, units[name]) for name in assumptions]
    tables: dict[bytes, _Table] = {}
    found = []
    for forecast in forecasts:
        y = _read(simulation.forecasts[forecast.name], places)
        known = ~np.isnan(y)
        key = known.tobytes()
        if key not in tables:
            tables[key] = _Table.of(draws, replicate, known)
        found.append(tables[key].influences(named, y[known]))
    return found


def _read(column: Floats, places: NDArray[np.intp]) -> Floats:
    """The trials at these places, in memory."""
    return picked(column, places) if places.size else np.empty(0)


@dataclass(frozen=True)
class _Table:
    """The draws of the trials in which a forecast is a number, each column ranked once for all forecasts like it."""

    columns: list[Ranked]
    units: Units

    @classmethod
    def of(cls, draws: Sequence[Floats], replicate: Ids | None, known: NDArray[np.bool_]) -> _Table:
        units = Units.of(int(np.count_nonzero(known)), None if replicate is None else replicate[known])
        enough = units.n >= LEAST_TRIALS
        return cls([Ranked.of(column[known]) for column in draws] if enough else [], units)

    def influences(self, named: Sequence[tuple[str, str]], y: Floats) -> Influences:
        """Of the assumptions with these names and units on one forecast."""
        if not self.columns or not (ranked := Ranked.of(y)).varies:
            return Influences(int(y.size), ())
        correlations = [rank_correlation(x, ranked, self.units) for x in self.columns]
        parts = zip(named, self.columns, correlations, contributions(correlations), strict=True)
        found = [
            Influence(
                assumption=name,
                units=units,
                rank_correlation=correlation,
                contribution=contribution,
                explained=explained(x, y, self.units),
                explained_floor=explained_floor(x, len(named)),
                dependence=dependence(x, ranked, self.units),
                dependence_floor=dependence_floor(x, len(named)),
            )
            for (name, units), x, correlation, contribution in parts
        ]
        return Influences(int(y.size), tuple(sorted(found, key=_by_share)))


def _by_share(influence: Influence) -> tuple[float, float]:
    share = influence.explained.value
    return (1.0 if math.isnan(share) else -share), -abs(influence.rank_correlation.value)
