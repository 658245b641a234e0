"""The trials that decide a limit of a filter: the accepted ones, and those that nothing but this limit rejects.

The run keeps the accepted trials only. The filters' cells are computed again from their draws; the others are found by
running some of the run's first trials again, with the same draws, no more than a quarter of a long run.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.definitions.model import name_key
from xlmc.studies.sensitivity.limit_cells import Limit, LimitCells, Looked
from xlmc.studies.sensitivity.moved_limit import LimitTrials, grid, kept

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["LimitsFound", "TriedLimit", "limit_trials"]

MOST_ACCEPTED: Final = 1 << 14
"""Accepted trials that answers are taken from."""

LEAST_AGAIN, MOST_AGAIN = 1 << 13, 1 << 15
"""Trials run again, unless the run has fewer."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class TriedLimit:
    """A limit that is a number, its trials, and the limits to try, ascending, itself among them; or none."""

    limit: Limit
    trials: LimitTrials
    grid: tuple[float, ...]


@dataclass(frozen=True)
class LimitsFound:
    """The limits that are numbers, `omitted` more of them, and the filters with a limit that varies."""

    tried: tuple[TriedLimit, ...] = ()
    omitted: int = 0
    varying: tuple[str, ...] = ()


@dataclass(frozen=True)
class _More:
    """Trials `(e,)` that one limit alone rejects, their filter's cell `(e,)`, their forecasts `(f, e)`."""

    trials: NDArray[np.int64]
    values: Floats
    forecasts: Floats

    @classmethod
    def joined(cls, parts: list[_More], forecasts: int) -> _More:
        parts = [cls(np.empty(0, np.int64), np.empty(0), np.empty((forecasts, 0))), *parts]
        columns = [(part.trials, part.values, part.forecasts) for part in parts]
        return cls(*(np.concatenate(each, axis=-1) for each in zip(*columns, strict=True)))


def limit_trials(simulation: Simulation, most: int, forecasts: int) -> LimitsFound:
    """Gather the trials of the first `most` limits of a run, and its first `forecasts` forecasts in them.

    Nothing is found where the draws of fewer than two accepted trials were kept, and no limit is tried where accepted
    trials are rare: those near it are not among the run's plain trials.
    """
    cells = LimitCells(simulation.model)
    if simulation.rare is not None:
        return LimitsFound(omitted=len(cells.limits))
    m = min(simulation.kept_inputs, simulation.accepted, MOST_ACCEPTED)
    if not cells.limits or not simulation.model.live or m < 2:
        return LimitsFound()
    now = _accepted(simulation, cells, m)
    constant = [bool(np.all(bound == bound[0])) for bound in now.bounds]
    places = [place for place, fixed in enumerate(constant) if fixed]
    grids = {
        place: grid(cells.limits[place].relation, float(now.bounds[place][0]), now.filters[cells.limits[place].place])
        for place in places[:most]
    }
    reached = simulation.trials if m == simulation.accepted else int(simulation.trial_index[m])
    names = [f.name for f in simulation.model.forecasts[:forecasts]]
    again = min(reached, MOST_AGAIN, max(LEAST_AGAIN, simulation.trials // 4))
    more = _rejected(simulation, cells, grids, again, len(names))
    index = np.asarray(simulation.trial_index[:m])
    answers = np.array([simulation.forecasts[name][:m] for name in names]).reshape(len(names), m)
    tried = []
    for place, limits in grids.items():
        limit, extra = cells.limits[place], more[place]
        trials = np.concatenate([index, extra.trials])
        found = LimitTrials(
            relation=limit.relation,
            limit=float(now.bounds[place][0]),
            values=np.concatenate([now.filters[limit.place], extra.values]),
            accepted=np.arange(trials.size) < m,
            forecasts=np.concatenate([answers, extra.forecasts], axis=1),
            replicate=simulation.plan.replicate_of(trials),
            trials=reached,
            loosened=again if limits else 0,
        )
        tried.append(TriedLimit(limit, found, limits))
    varying = [limit.filter.name for limit, fixed in zip(cells.limits, constant, strict=True) if not fixed]
    return LimitsFound(tuple(tried), max(0, len(places) - most), tuple(dict.fromkeys(varying)))


def _accepted(simulation: Simulation, cells: LimitCells, m: int) -> Looked:
    """What decides the limits in the first m accepted trials."""
    block = min(m, cells.program.largest_block)
    evaluator, parts = cells.program.evaluator(block), []
    for start in range(0, m, block):
        n = min(block, m - start)
        draws = {
            name_key(a.name): np.ascontiguousarray(simulation.inputs[a.name][start : start + n])
            for a in simulation.model.live
        }
        parts.append(cells.look(evaluator, draws, n))
    filters = [np.concatenate(columns) for columns in zip(*(part.filters for part in parts), strict=True)]
    return Looked(filters, [np.concatenate(columns) for columns in zip(*(part.bounds for part in parts), strict=True)])


def _rejected(
    simulation: Simulation, cells: LimitCells, grids: Mapping[int, tuple[float, ...]], again: int, forecasts: int
) -> dict[int, _More]:
    """Of each limit those of the first `again` trials that it alone rejects and its loosest value to try lets in."""
    parts: dict[int, list[_More]] = {place: [] for place in grids}
    chosen = [p for p, limits in grids.items() if limits and simulation.tally.only[cells.limits[p].place]]
    program, plan = cells.program, simulation.plan
    block = min(again, program.largest_block)
    if chosen:
        sampler = simulation.model.sampler(simulation.settings.seed, block, "numpy", plan)
        evaluator = program.evaluator(block)
    for start in range(0, again if chosen else 0, block):
        n = min(block, again - start)
        draws = {key: values[:n] for key, values in sampler.draw(start).items()}
        looked = cells.look(evaluator, draws, n)
        alone = cells.rejected_by_one(looked, draws)
        let_in = {place: alone[place] & _loosely_kept(cells.limits[place], looked, grids[place]) for place in chosen}
        every = np.flatnonzero(np.logical_or.reduce(list(let_in.values())))
        if not every.size:
            continue
        answers = np.array([column.as_floats() for column in evaluator.forecasts(every)[:forecasts]])
        for place, mask in let_in.items():
            mine = mask[every]
            values = looked.filters[cells.limits[place].place][every[mine]]
            parts[place].append(_More(every[mine] + start, values, answers[:, mine]))
    return {place: _More.joined(found, forecasts) for place, found in parts.items()}


def _loosely_kept(limit: Limit, looked: Looked, limits: tuple[float, ...]) -> NDArray[np.bool_]:
    """`(n,)` the trials within the loosest limit to try."""
    loosest = limits[0] if limit.relation.startswith(">") else limits[-1]
    return kept(limit.relation, looked.filters[limit.place], loosest)
