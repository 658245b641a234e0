"""Assumptions against forecasts, on the accepted trials: all, or so many that every error is small enough.

Where there are many assumptions, `first_look` chooses those that are measured for a forecast.

Of independent trials the first ones are examined; of a Latin hypercube or Sobol run the first ones of each of its first
replicates, because later ones of a Sobol replicate fill the gaps that earlier ones left and are no sample alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.explained import Explained, explained
from xlmc.analysis.studies.sensitivity.first_look import LOOK_TRIALS, first_look
from xlmc.analysis.studies.sensitivity.given_data import (
    contributions,
    dependence,
    dependence_floor,
    explained_floor,
    rank_correlation,
)
from xlmc.analysis.studies.sensitivity.measures import Influence
from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.analysis.studies.sensitivity.ranked import Ranked
from xlmc.montecarlo.columns import picked
from xlmc.montecarlo.interruption import checkpoint

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Forecast
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["MEASURED", "Chosen", "Influences", "choose", "influences"]

MEASURED: Final = 20
"""Assumptions that are measured for a forecast; of more, those that a first look finds."""

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
_MOST_TRIALS: Final = 1 << 13
"""The most trials; they give a rank correlation to 0.011."""

_LEAST_TRIALS: Final = 20
"""Fewer say nothing of an influence."""

_FEWEST = 1 << 11
_VALUES = 1 << 20
"""Trials times pairs of an assumption and a forecast: some 0.05 s of work."""

_REPLICATES = 32

_FINE_TRIALS = 1 << 15, 1 << 17
_FINE_VALUES = 1 << 22
"""Trials, and trials times pairs, where a forecast jumps or bends inside the classes of the first look; the second
number where the first leaves an error above `_FINE_ERROR`, or a lower bound only."""

_FINE_ERROR = 0.006


@dataclass(frozen=True)
class Influences:
    """The influence of every assumption on one forecast, by the variance explained; `trials` are those it is a number
    in. `coarse` names the assumptions whose share asks for finer classes, and more trials.
    """

    trials: int
    influences: tuple[Influence, ...]
    coarse: tuple[str, ...] = ()


@dataclass(frozen=True)
class Chosen:
    """The assumptions that are measured for each forecast.

    Attributes:
        names: one a forecast, each in the order of the workbook.
        others: `(forecasts,)` the squared rank correlations of the assumptions that are left out, summed.
        scores: assumption -> the share of some forecast that it explains in the first look; empty where all are chosen.
    """

    names: tuple[tuple[str, ...], ...]
    others: Floats
    scores: Mapping[str, float]

    @property
    def most_influential(self) -> list[str]:
        """All that are measured for some forecast: in their order, or those with the highest scores first."""
        every = dict.fromkeys(name for names in self.names for name in names)
        return sorted(every, key=lambda name: -self.scores.get(name, 0.0))


def choose(simulation: RunResult, forecasts: Sequence[Forecast], asked: Collection[str] = ()) -> Chosen:
    """Choose the live assumptions to measure for each forecast: all, or of many those that a first look finds.

    Args:
        simulation: the run.
        forecasts: those that are wanted.
        asked: names of assumptions that are measured for every forecast.
    """
    live = [a.name for a in simulation.model.live]
    rows, _ = _examined_rows(simulation, LOOK_TRIALS)
    if len(live) <= MEASURED or rows.size < _LEAST_TRIALS or not forecasts:
        return Chosen(tuple(tuple(live) for _ in forecasts), np.zeros(len(forecasts)), {})
    look = first_look(
        [_read_draws(simulation, name, rows) for name in live],
        [_read(simulation.forecasts[each.name], rows) for each in forecasts],
    )
    always = {index for index, name in enumerate(live) if name in asked}
    squares = look.squares - (1.0 - look.squares) / (rows.size - 2.0)  # less what noise gives on average (Ezekiel 1930)
    chosen = [sorted(always.union(look.first(number, MEASURED).tolist())) for number in range(len(forecasts))]
    return Chosen(
        names=tuple(tuple(live[index] for index in indices) for indices in chosen),
        others=np.array([max(np.delete(squares[:, i], indices).sum(), 0.0) for i, indices in enumerate(chosen)]),
        scores=dict(zip(live, look.scores.max(axis=1).tolist(), strict=True)),
    )


def influences(
    simulation: RunResult,
    chosen: Chosen,
    forecasts: Sequence[Forecast],
    progress: Callable[[float], None] = lambda share: None,
) -> list[Influences]:
    """Measure the influences of the chosen assumptions on each of these forecasts; `progress` takes the share done."""
    rows, replicate = _examined_rows(simulation, _trials_for(sum(map(len, chosen.names))))
    units = {a.name: a.units for a in simulation.model.live}
    draws = {name: _read_draws(simulation, name, rows) for name in chosen.most_influential}
    tables: dict[bytes, _Table] = {}
    result = []
    for forecast, names, others in zip(forecasts, chosen.names, chosen.others.tolist(), strict=True):
        y = _read(simulation.forecasts[forecast.name], rows)
        known = ~np.isnan(y)
        table = tables.setdefault(known.tobytes(), _Table(draws, _units_of(replicate, known), known))
        result.append(table.influences({name: units[name] for name in names}, y[known], others, len(units)))
        progress(len(result) / len(forecasts))
    for trials in _FINE_TRIALS:
        pairs = sum(len(each.coarse) for each in result)
        most = min(trials, _FINE_VALUES // max(pairs, 1))
        if pairs and most > rows.size < simulation.accepted:
            result = _with_finer_shares(simulation, forecasts, result, most)
    return result


def _with_finer_shares(
    simulation: RunResult, forecasts: Sequence[Forecast], result: Sequence[Influences], most: int
) -> list[Influences]:
    """Return the same with the shares that ask for it from up to `most` trials."""
    rows, replicate = _examined_rows(simulation, most)
    tables: dict[bytes, tuple[Units, dict[str, Ranked]]] = {}
    finer = []
    for forecast, each in zip(forecasts, result, strict=True):
        if not each.coarse:
            finer.append(each)
            continue
        y = _read(simulation.forecasts[forecast.name], rows)
        known = ~np.isnan(y)
        units, columns = tables.setdefault(known.tobytes(), (_units_of(replicate, known), {}))
        for name in each.coarse:
            if name not in columns:
                columns[name] = Ranked.of(_read_draws(simulation, name, rows)[known])
        shares_now = {name: explained(columns[name], y[known], units) for name in each.coarse}
        changed = [
            replace(one, explained=now.share, explained_at_least=now.at_least)
            if (now := shares_now.get(one.assumption))
            else one
            for one in each.influences
        ]
        coarse = tuple(name for name in each.coarse if _asks_for_more(shares_now[name]))
        finer.append(replace(each, influences=tuple(sorted(changed, key=_by_share)), coarse=coarse))
    return finer


def _asks_for_more(result: Explained) -> bool:
    return result.at_least or (result.share.error or 0.0) > _FINE_ERROR


def _units_of(replicate: Ids | None, known: NDArray[np.bool_]) -> Units:
    return Units.of(int(np.count_nonzero(known)), None if replicate is None else replicate[known])


def _read(column: Floats, rows: NDArray[np.intp]) -> Floats:
    """Read these rows of a column into memory."""
    return picked(column, rows) if rows.size else np.empty(0)


def _read_draws(simulation: RunResult, assumption: str, rows: NDArray[np.intp]) -> Floats:
    """Read these rows of draws; where a draw is none, and nothing used it, it counts as an average one."""
    checkpoint()
    draws = _read(simulation.inputs[assumption], rows)
    missing = np.isnan(draws)
    return np.where(missing, draws[~missing].mean(), draws) if missing.any() and not missing.all() else draws


@dataclass(frozen=True)
class _Table:
    """The draws of the trials in which a forecast is a number, each column ranked once for all forecasts like it."""

    draws: Mapping[str, Floats]
    units: Units
    known: NDArray[np.bool_]
    _ranked: dict[str, Ranked] = field(default_factory=dict)

    def column(self, assumption: str) -> Ranked:
        """Return the draws of an assumption, ranked."""
        if assumption not in self._ranked:
            self._ranked[assumption] = Ranked.of(self.draws[assumption][self.known])
        return self._ranked[assumption]

    def influences(self, named: Mapping[str, str], y: Floats, others: float, count: int) -> Influences:
        """Measure the influences of assumptions on one forecast.

        Args:
            named: the assumptions' names and units.
            y: `(n,)` the forecast.
            others: the sum of the squared rank correlations of the assumptions that are not measured.
            count: of all assumptions, the largest of which noise may be.
        """
        if self.units.n < _LEAST_TRIALS or not (ranked := Ranked.of(y)).varies:
            return Influences(int(y.size), ())
        columns = [self.column(name) for name in named]
        correlations = [rank_correlation(x, ranked, self.units) for x in columns]
        shares_of = [explained(x, y, self.units) for x in columns]
        parts = zip(named.items(), columns, correlations, contributions(correlations, others), shares_of, strict=True)
        result = [
            Influence(
                assumption=name,
                units=units,
                rank_correlation=correlation,
                contribution=contribution,
                explained=share.share,
                explained_at_least=share.at_least,
                explained_floor=explained_floor(x, count),
                dependence=dependence(x, ranked, self.units),
                dependence_floor=dependence_floor(x, count),
            )
            for (name, units), x, correlation, contribution, share in parts
        ]
        coarse = tuple(name for name, share in zip(named, shares_of, strict=True) if not share.coarse_enough)
        return Influences(int(y.size), tuple(sorted(result, key=_by_share)), coarse)


def _by_share(influence: Influence) -> tuple[float, float]:
    share = influence.explained.value
    return (1.0 if math.isnan(share) else -share), -abs(influence.rank_correlation.value)


def _trials_for(pairs: int) -> int:
    """How many trials to examine, at most, for so many pairs of an assumption and a forecast."""
    return min(_MOST_TRIALS, max(_FEWEST, _VALUES // max(pairs, 1)))


def _examined_rows(simulation: RunResult, most: int) -> tuple[NDArray[np.intp], NDArray[np.int64] | None]:
    """Return the rows of at most `most` accepted trials with known draws, ascending, and their replicates, if any."""
    stored = simulation.kept_inputs if simulation.model.live else 0
    if not simulation.plan.size:
        return np.arange(min(stored, most)), None
    replicate = simulation.plan.replicate_of(np.asarray(simulation.trial_index[:stored]))
    assert replicate is not None
    starts = np.flatnonzero(np.diff(replicate, prepend=-1))
    ends = np.append(starts[1:], replicate.size)
    chosen = min(_REPLICATES, starts.size)
    each = max(most // max(chosen, 1), 1)
    parts = [np.arange(start, min(end, start + each)) for start, end in zip(starts[:chosen], ends, strict=False)]
    rows = np.concatenate(parts) if parts else np.empty(0, np.intp)
    return rows, replicate[rows]
