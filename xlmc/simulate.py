"""Runs a model: its blocks over threads, processes or a cluster, put together in block order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.blocks import Block, FilterTally, Task
from xlmc.definitions.model import name_key
from xlmc.errors import SimulationError
from xlmc.pilot import planned
from xlmc.sampling import METHODS
from xlmc.scheduling import Crew
from xlmc.scratch import Keeper
from xlmc.simulation import KEPT_INPUTS, Simulation

if TYPE_CHECKING:
    from xlmc.definitions import Settings
    from xlmc.model import Model
    from xlmc.sampling import Plan

__all__ = ["BLOCK", "PRIOR_TRIALS", "Progress", "simulate"]

BLOCK: Final = 32_768
"""Trials evaluated at once: enough that the calls cost little beside the arithmetic, few enough for the cache."""

PRIOR_TRIALS: Final = 65_536
"""Trials whose draws are all kept, accepted or not, to show the prior."""

MOST_TRIALS: Final = 10**12

Progress = Callable[[int, int], None]


def simulate(
    model: Model,
    *,
    trials: int | None = None,
    seed: int | None = None,
    engine: str | None = None,
    sampling: str | None = None,
    jobs: int = 1,
    scheduler: str | None = None,
    workers: int | None = None,
    keep_inputs: int | None = KEPT_INPUTS,
    progress: Progress | None = None,
) -> Simulation:
    """Run a model; see `Model.simulate`."""
    settings = _settings(model, trials, seed, engine, sampling)
    plan = planned(model, settings)
    crew = Crew(jobs, scheduler, workers)
    if keep_inputs is not None and keep_inputs < 0:
        raise SimulationError(
            f"the draws of {keep_inputs} trials were asked for", hint="give 0 or more, or None for all"
        )
    program = model.program(settings.engine)
    block = min(BLOCK, program.largest_block)
    gathered = _Gathered(model, block, plan.trials if keep_inputs is None else keep_inputs)
    starts = range(0, plan.trials, block)

    def tasks() -> Iterator[Task]:
        for start in starts:
            yield Task(start, min(block, plan.trials - start), start < PRIOR_TRIALS, gathered.wants_inputs)

    with closing(crew.blocks(model, program, settings, plan, block, tasks())) as blocks:
        for finished in blocks:
            gathered.add(finished)
            if progress is not None:
                progress(gathered.trials, gathered.accepted)
    return gathered.simulation(settings, plan)


def _settings(model: Model, trials: int | None, seed: int | None, engine: str | None, sampling: str | None) -> Settings:
    given = {"trials": trials, "seed": seed, "engine": engine, "sampling": sampling}
    settings = replace(model.definitions.settings, **{k: v for k, v in given.items() if v is not None})  # type: ignore[arg-type]
    if not 1 <= settings.trials <= MOST_TRIALS:
        raise SimulationError(f"{settings.trials} trials were asked for", hint=f"give 1 to {MOST_TRIALS:,}")
    if settings.seed < 0:
        raise SimulationError(f"the seed {settings.seed} is negative", hint="give a whole number from 0 up")
    if settings.sampling not in METHODS:
        message = f"there is no sampling method {settings.sampling!r}"
        raise SimulationError(message, hint=f"choose one of {', '.join(METHODS)}")
    return settings


class _Gathered:
    """The blocks so far: the counts of all trials, and the columns of the accepted ones."""

    def __init__(self, model: Model, block: int, keep_inputs: int) -> None:
        self._model, self._block, self._keep_inputs = model, block, keep_inputs
        keys = [name_key(a.name) for a in model.live]
        real, whole = np.dtype(np.float64), np.dtype(np.int64)
        self._inputs = {a.name: ("input", key) for a, key in zip(model.live, keys, strict=True)}
        self._prior = {a.name: ("prior", key) for a, key in zip(model.live, keys, strict=True)}
        self._forecasts = {f.name: ("forecast", place) for place, f in enumerate(model.forecasts)}
        columns = (*self._inputs.values(), *self._prior.values(), *self._forecasts.values())
        self._keeper = Keeper({("trial", 0): whole, **dict.fromkeys(columns, real)})
        self._tally = FilterTally.empty(len(model.filters))
        self._invalid: Counter[str] = Counter()
        self._faults: list[Counter[str]] = [Counter() for _ in model.forecasts]
        self.trials = self.accepted = self.lost = 0

    @property
    def wants_inputs(self) -> bool:
        """Whether there are accepted trials still to come whose draws are kept."""
        return self.accepted < self._keep_inputs

    def add(self, block: Block) -> None:
        self._keep(block)
        self._tally.add(block.tally)
        self._invalid.update(block.invalid)
        for mine, theirs in zip(self._faults, block.faults, strict=True):
            mine.update(theirs)
        self.trials += block.trials
        self.accepted += block.accepted.size
        self.lost += block.lost

    def _keep(self, block: Block) -> None:
        self._keeper.add(("trial", 0), block.accepted)
        room = max(0, self._keep_inputs - self.accepted)
        for key, values in block.draws.items():
            self._keeper.add(("input", key), values[:room])
        for key, values in (block.prior or {}).items():
            self._keeper.add(("prior", key), values)
        for place, values in enumerate(block.forecasts):
            self._keeper.add(("forecast", place), values)
        self._keeper.settle()

    def simulation(self, settings: Settings, plan: Plan) -> Simulation:
        return Simulation(
            model=self._model,
            settings=settings,
            plan=plan,
            block=self._block,
            trials=self.trials,
            trial_index=self._keeper.columns({"trial": ("trial", 0)})["trial"],
            inputs=self._keeper.columns(self._inputs),
            prior=self._keeper.columns(self._prior),
            forecasts=self._keeper.columns(self._forecasts),
            faults={f.name: counts for f, counts in zip(self._model.forecasts, self._faults, strict=True)},
            tally=self._tally,
            invalid=self._invalid,
            error_trials=self.lost,
        )
