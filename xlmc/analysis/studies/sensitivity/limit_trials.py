"""The trials that decide a limit of a filter: the accepted ones, and those that nothing but this limit rejects.

The run keeps only the accepted trials. The filters' cells are computed again from their draws; the others are found by
running some of the run's first trials again, with the same draws, no more than a quarter of a long run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.moved_limit import LimitTrials, grid, holds_to
from xlmc.engine.engine import Target
from xlmc.excel.address import Cell
from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.loop.blocks import portions
from xlmc.montecarlo.model.draw_binding import parameter_target
from xlmc.montecarlo.model.needed import filter_condition, filter_limits

if TYPE_CHECKING:
    from xlmc.engine.engine import Evaluator, Program
    from xlmc.montecarlo.definitions.definitions import Filter
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Limit", "TriedLimit", "TriedLimits", "limit_trials"]

Bools = NDArray[np.bool_]

_MOST_ACCEPTED: Final = 1 << 14
"""Accepted trials that answers are taken from."""

LEAST_AGAIN, _MOST_AGAIN = 1 << 13, 1 << 15
"""Trials run again, unless the run has fewer."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Limit:
    """One limit of a filter, a number or a cell; filters are counted from 0."""

    filter: Filter
    filter_index: int
    relation: str
    bound: float | Cell


@dataclass(frozen=True)
class _CellValues:
    """What a block of trials has in the cells: `(n,)` of each filter and of each limit; NaN for an error."""

    filters: list[Floats]
    bounds: list[Floats]


class _LimitCells:
    """The limits of a model, in the order of the workbook, and a program that computes what decides them.

    Attributes:
        limits: of all filters.
    """

    def __init__(self, model: CompiledModel) -> None:
        self._model = model
        self.limits = [
            Limit(filter_, i, relation, bound)
            for i, filter_ in enumerate(model.filters)
            for relation, bound in filter_limits(filter_)
        ]

    @cached_property
    def program(self) -> Program:
        """Gives filters' cells and limits instead of filters, and the forecasts."""
        targets = [_asked_of(filter_) for filter_ in self._model.filters]
        targets += [parameter_target(limit.bound) for limit in self.limits if isinstance(limit.bound, Cell)]
        return self._model.program_of(targets)

    def look(self, evaluator: Evaluator, draws: Mapping[str, Floats], n: int) -> _CellValues:
        """Into the cells, in `n` trials, with an evaluator of the program."""
        columns = [column.as_floats() for column in evaluator.filters(draws, n)]
        filters = len(self._model.filters)
        computed = iter(columns[filters:])
        bounds = [next(computed) if isinstance(each.bound, Cell) else np.full(n, each.bound) for each in self.limits]
        return _CellValues(columns[:filters], bounds)

    def rejected_by_one(self, looked: _CellValues) -> list[Bools]:
        """For each limit, the trials `(n,)` that it rejects and nothing else does."""
        within = [
            holds_to(limit.relation, looked.filters[limit.filter_index], bound)
            for limit, bound in zip(self.limits, looked.bounds, strict=True)
        ]
        limited = {limit.filter_index for limit in self.limits}
        logical = [cell for i, cell in enumerate(looked.filters) if i not in limited]
        broken = np.sum([~each for each in within], axis=0)
        for cell in logical:
            broken += (cell == 0.0) | np.isnan(cell)
        return [(broken == 1) & ~each for each in within]


def _asked_of(filter_: Filter) -> Target:
    """Return the filter's cell; or, for evidence whose error is not a limit, whether it keeps the trial."""
    if filter_.evidence is not None and filter_.evidence.bell is not None:
        return Target(filter_condition(filter_), filter_.cell)
    return parameter_target(filter_.cell)


@dataclass(frozen=True)
class TriedLimit:
    """A limit that is a number, its trials, and the limits to try, ascending, itself among them; or none."""

    limit: Limit
    trials: LimitTrials
    grid: tuple[float, ...]


@dataclass(frozen=True)
class TriedLimits:
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
    def join(cls, parts: list[_More], forecasts: int) -> _More:
        parts = [cls(np.empty(0, np.int64), np.empty(0), np.empty((forecasts, 0))), *parts]
        columns = [(part.trials, part.values, part.forecasts) for part in parts]
        return cls(*(np.concatenate(each, axis=-1) for each in zip(*columns, strict=True)))


def limit_trials(simulation: RunResult, most: int, forecasts: Sequence[int]) -> TriedLimits:
    """Gather the trials of the first `most` limits of a run, and the forecasts with these numbers in them.

    Nothing is found where the draws of fewer than two accepted trials were kept, and no limit is tried where accepted
    trials are rare: those near it are not among the run's plain trials.
    """
    cells = _LimitCells(simulation.model)
    if simulation.rare is not None:
        return TriedLimits(omitted=len(cells.limits))
    m = min(simulation.kept_inputs, simulation.accepted, _MOST_ACCEPTED)
    if not cells.limits or not simulation.model.live or m < 2:
        return TriedLimits()
    now = _look_at_accepted(simulation, cells, m)
    constant = [bool(np.all(bound == bound[0])) for bound in now.bounds]
    fixed_limits = [i for i, fixed in enumerate(constant) if fixed]
    grids = {i: grid(float(now.bounds[i][0]), now.filters[cells.limits[i].filter_index]) for i in fixed_limits[:most]}
    reached = simulation.trials if m == simulation.accepted else int(simulation.trial_index[m])
    names = [simulation.model.forecasts[number].name for number in forecasts]
    again = min(reached, _MOST_AGAIN, max(LEAST_AGAIN, simulation.trials // 4))
    more = _find_rejected(simulation, cells, grids, again, forecasts)
    index = np.asarray(simulation.trial_index[:m])
    answers = np.array([simulation.forecasts[name][:m] for name in names]).reshape(len(names), m)
    tried = []
    for i, limits in grids.items():
        limit, extra = cells.limits[i], more[i]
        trials = np.concatenate([index, extra.trials])
        result = LimitTrials(
            relation=limit.relation,
            limit=float(now.bounds[i][0]),
            values=np.concatenate([now.filters[limit.filter_index], extra.values]),
            accepted=np.arange(trials.size) < m,
            forecasts=np.concatenate([answers, extra.forecasts], axis=1),
            replicate=simulation.plan.replicate_of(trials),
            trials=reached,
            loosened=again if limits else 0,
        )
        tried.append(TriedLimit(limit, result, limits))
    varying = [limit.filter.name for limit, fixed in zip(cells.limits, constant, strict=True) if not fixed]
    return TriedLimits(tuple(tried), max(0, len(fixed_limits) - most), tuple(dict.fromkeys(varying)))


def _look_at_accepted(simulation: RunResult, cells: _LimitCells, m: int) -> _CellValues:
    """Return what decides the limits in the first m accepted trials."""
    block = min(m, cells.program.largest_block)
    evaluator, parts = cells.program.evaluator(block), []
    for part, draws in portions(simulation.inputs, m, block):
        n = part.stop - part.start
        parts.append(cells.look(evaluator, draws | simulation.model.certain(n), n))
    filters = [np.concatenate(columns) for columns in zip(*(part.filters for part in parts), strict=True)]
    return _CellValues(
        filters, [np.concatenate(columns) for columns in zip(*(part.bounds for part in parts), strict=True)]
    )


def _find_rejected(
    simulation: RunResult,
    cells: _LimitCells,
    grids: Mapping[int, tuple[float, ...]],
    again: int,
    forecasts: Sequence[int],
) -> dict[int, _More]:
    """For each limit, those of the first `again` trials that it alone rejects and that its loosest value lets in."""
    parts: dict[int, list[_More]] = {i: [] for i in grids}
    chosen = [p for p, limits in grids.items() if limits and simulation.tally.only[cells.limits[p].filter_index]]
    program, plan = cells.program, simulation.plan
    block = min(again, program.largest_block)
    if chosen:
        sampler = simulation.model.sampler(simulation.settings.seed, block, "numpy", plan)
        evaluator = program.evaluator(block)
    for start in range(0, again if chosen else 0, block):
        checkpoint()
        n = min(block, again - start)
        draws = {key: values[:n] for key, values in sampler.draw(start).items()}
        looked = cells.look(evaluator, draws, n)
        alone = cells.rejected_by_one(looked)
        let_in = {i: alone[i] & _within_loosest(cells.limits[i], looked, grids[i]) for i in chosen}
        every = np.flatnonzero(np.logical_or.reduce(list(let_in.values())))
        if not every.size:
            continue
        columns = evaluator.forecasts(every)
        answers = np.array([columns[number].as_floats() for number in forecasts]).reshape(-1, every.size)
        for i, mask in let_in.items():
            mine = mask[every]
            values = looked.filters[cells.limits[i].filter_index][every[mine]]
            parts[i].append(_More(every[mine] + start, values, answers[:, mine]))
    return {i: _More.join(results, len(forecasts)) for i, results in parts.items()}


def _within_loosest(limit: Limit, looked: _CellValues, limits: tuple[float, ...]) -> NDArray[np.bool_]:
    """`(n,)` the trials within the loosest limit to try."""
    loosest = limits[0] if limit.relation.startswith(">") else limits[-1]
    return holds_to(limit.relation, looked.filters[limit.filter_index], loosest)
