"""Runs a model: blocks over threads, put together in block order."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from queue import SimpleQueue
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.blocks import Block, FilterTally, Worker
from xlmc.definitions.model import name_key
from xlmc.errors import SimulationError
from xlmc.simulation import Simulation

if TYPE_CHECKING:
    from xlmc.definitions import Settings
    from xlmc.model import Model

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
    jobs: int = 1,
    progress: Progress | None = None,
) -> Simulation:
    """Run a model; see `Model.simulate`."""
    settings = _settings(model, trials, seed, engine)
    if jobs < 1:
        raise SimulationError(f"{jobs} threads were asked for", hint="give 1 or more")
    program = model.program(settings.engine)
    block = min(BLOCK, program.largest_block)
    starts = range(0, settings.trials, block)
    workers = min(jobs, len(starts))
    idle: SimpleQueue[Worker] = SimpleQueue()
    for _ in range(workers):
        sampler, evaluator = model.sampler(settings.seed, block, settings.engine), program.evaluator(block)
        idle.put(Worker(sampler, evaluator, block, len(model.forecasts), model.fallible))

    def run(start: int) -> Block:
        worker = idle.get()
        try:
            return worker.run(start, min(block, settings.trials - start), start < PRIOR_TRIALS)
        finally:
            idle.put(worker)

    gathered = _Gathered(model, block)
    for finished in _in_order(run, starts, workers):
        gathered.add(finished)
        if progress is not None:
            progress(gathered.trials, gathered.accepted)
    return gathered.simulation(settings)


def _settings(model: Model, trials: int | None, seed: int | None, engine: str | None) -> Settings:
    given = {"trials": trials, "seed": seed, "engine": engine}
    settings = replace(model.definitions.settings, **{k: v for k, v in given.items() if v is not None})  # type: ignore[arg-type]
    if not 1 <= settings.trials <= MOST_TRIALS:
        raise SimulationError(f"{settings.trials} trials were asked for", hint=f"give 1 to {MOST_TRIALS:,}")
    if settings.seed < 0:
        raise SimulationError(f"the seed {settings.seed} is negative", hint="give a whole number from 0 up")
    return settings


def _in_order(run: Callable[[int], Block], starts: range, workers: int) -> Iterator[Block]:
    if workers == 1:
        yield from map(run, starts)
        return
    with ThreadPoolExecutor(workers) as pool:
        waiting: deque[Future[Block]] = deque()
        for start in starts:
            waiting.append(pool.submit(run, start))
            if len(waiting) > 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


class _Gathered:
    """The blocks so far."""

    def __init__(self, model: Model, block: int) -> None:
        self._model, self._block = model, block
        self._blocks: list[Block] = []
        self._tally = FilterTally.empty(len(model.filters))
        self._invalid: Counter[str] = Counter()
        self._faults: list[Counter[str]] = [Counter() for _ in model.forecasts]
        self.trials = self.accepted = self.lost = 0

    def add(self, block: Block) -> None:
        self._blocks.append(block)
        self._tally.add(block.tally)
        self._invalid.update(block.invalid)
        for mine, theirs in zip(self._faults, block.faults, strict=True):
            mine.update(theirs)
        self.trials += block.trials
        self.accepted += block.accepted.size
        self.lost += block.lost

    def simulation(self, settings: Settings) -> Simulation:
        names = [a.name for a in self._model.live]
        keys = list(self._blocks[0].draws)
        kept = {key: np.concatenate([block.draws[key] for block in self._blocks]) for key in keys}
        early = [block.prior for block in self._blocks if block.prior is not None]
        prior = {key: np.concatenate([part[key] for part in early]) for key in keys}
        forecasts = [np.concatenate(parts) for parts in zip(*(b.forecasts for b in self._blocks), strict=True)]
        return Simulation(
            model=self._model,
            settings=settings,
            block=self._block,
            trials=self.trials,
            trial_index=np.concatenate([block.accepted for block in self._blocks]),
            inputs={name: kept[name_key(name)] for name in names},
            prior={name: prior[name_key(name)] for name in names},
            forecasts={f.name: values for f, values in zip(self._model.forecasts, forecasts, strict=True)},
            faults={f.name: counts for f, counts in zip(self._model.forecasts, self._faults, strict=True)},
            tally=self._tally,
            invalid=self._invalid,
            error_trials=self.lost,
        )
