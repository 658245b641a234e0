"""Runs a model: its blocks over threads, processes or a cluster, put together in block order."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Callable, Collection, Generator, Hashable, Iterator, Mapping
from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import BlockMemory
from xlmc.montecarlo.columns import ColumnStore
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.diagnostics.checking import LEAST_CHECKED
from xlmc.montecarlo.diagnostics.weighing import choose_method, weighing
from xlmc.montecarlo.loop.blocks import Block, FilterTally, ModelRunner, Task, add_counts
from xlmc.montecarlo.loop.categories import Labels
from xlmc.montecarlo.loop.disk_needed import disk_needed
from xlmc.montecarlo.loop.scheduling.run_spec import model_runner
from xlmc.montecarlo.loop.scheduling.worker_pool import WorkerPool
from xlmc.montecarlo.loop.sobol_order import plan_sampling
from xlmc.montecarlo.loop.stopping import (
    Interruption,
    Progress,
    ProgressTracker,
    Stopped,
    Watch,
    chosen_rule,
    may_end_early,
    refuse_other_sampling,
)
from xlmc.montecarlo.model.forecast_filters import discards_by_name
from xlmc.montecarlo.rare.rare_switch import RareSwitch, rare_switch
from xlmc.montecarlo.simulation.simulation import RunResult

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.rare.search import Search
    from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

__all__ = ["BLOCK", "PRIOR_TRIALS", "OnProgress", "run_model", "simulate"]

BLOCK: Final = 32_768
"""Trials evaluated at once, where the engine does not want fewer: enough that the calls cost little beside the
arithmetic, few enough for the cache."""

_TOGETHER: Final = 2_048
"""Short runs are computed in multiples of so many trials: a chunk of native code, and many more than a processor takes
in one instruction, so that the last bit of a trial does not depend on how many follow it."""

PRIOR_TRIALS: Final = 65_536
"""Trials whose draws are all kept, accepted or not, to show the prior."""

OnProgress = Callable[[Progress], None]


def simulate(
    model: CompiledModel,
    *,
    progress: OnProgress | None = None,
    tell: Callable[[str], None] | None = None,
    own_runner: ModelRunner | None = None,
    pieces: int = BLOCK,
    **asked: Any,
) -> RunResult:
    """Run a model with options given by name, the fields of `RunOptions`; without `evidence` it rejects trials.

    See `run_model`, and `Model.simulate`.
    """
    options = RunOptions(**{"evidence": "rejection", **asked})
    return run_model(model, options, progress=progress, tell=tell, own_runner=own_runner, pieces=pieces)


def run_model(
    model: CompiledModel,
    options: RunOptions,
    *,
    progress: OnProgress | None = None,
    tell: Callable[[str], None] | None = None,
    own_runner: ModelRunner | None = None,
    pieces: int = BLOCK,
    follow: Collection[str] | None = None,
    plan: SamplingPlan | None = None,
) -> RunResult:
    """Run a model; see `Model.simulate`.

    A runner that is given, of this model, seed and sampling method, runs the blocks. A run of a given number of trials
    is computed in pieces of at most `pieces` trials, a power of two, for who wants `progress` more often: its numbers
    are the same. `progress` is given the means of the forecasts to `follow`; by default of all.
    A `plan` that is given, for as many trials as the options ask for, says how they are drawn.
    """
    settings, keep_inputs = options.settings(model.definitions.settings), options.keep_inputs
    refuse_other_sampling(settings.sampling, settings.stopping)
    settings = replace(settings, evidence=choose_method(model, settings))
    if settings.evidence == "weights":
        model, keep_inputs = weighing(model), None  # weights are computed from the draws
    largest = model.program(settings.engine).largest_block if own_runner is None else own_runner.block
    plan = plan or plan_sampling(model, settings)
    rule, looks = chosen_rule(settings.stopping, model.forecasts, model.categories), rare_switch(model, settings)
    watch = Watch(rule, plan.trials, settings.stopping.seconds, time.monotonic)
    teller = None if progress is None else ProgressTracker([f.name for f in model.forecasts], _followed(model, follow))
    pool = WorkerPool(options.jobs, options.scheduler, options.workers)
    block = min(BLOCK, largest)
    piece = block if settings.stopping.asked else min(block, pieces)
    computed = min(piece, -(-plan.trials // _TOGETHER) * _TOGETHER)  # a short run computes no whole block
    most_inputs = plan.trials if keep_inputs is None else keep_inputs
    if model.checks:
        most_inputs = max(most_inputs, LEAST_CHECKED)
    gathered = _Gathered(model, block, piece, most_inputs, plan.trials, options.in_memory)

    def runner() -> ModelRunner:
        if own_runner is not None:
            return own_runner
        return model_runner(model, model.program(settings.engine), settings.engine, settings.seed, computed, plan)

    def blocks_of(tasks: Iterator[Task]) -> Generator[Block, None, None]:
        if own_runner is not None:
            return (own_runner.borrow(task, gathered.block_memory) for task in tasks)
        return pool.blocks(
            model, model.program(settings.engine), settings, plan, computed, tasks, gathered.block_memory
        )

    needed = disk_needed(model, settings.stopping, plan.trials, piece, most_inputs, runner, options.in_memory)
    if needed is not None:
        needed.check()
        if tell is not None:
            tell(needed.sentence())

    def task(start: int, trials: int) -> Task:
        return Task(start, trials, options.keep_prior and start < PRIOR_TRIALS, gathered.wants_inputs)

    tasks = (task(start, min(piece, plan.trials - start)) for start in range(0, plan.trials, piece))
    stopped: Stopped | None = None
    with Interruption(wanted=options.keep_interrupted and may_end_early(settings.sampling)) as interruption:
        result: Search | Stopped | None = None
        with closing(blocks_of(tasks)) as blocks:
            while stopped is None and result is None:
                if looks.should_search(gathered.trials, gathered.accepted):
                    result = _searched(
                        model, settings, gathered.trials, gathered.accepted_trials, watch, interruption, progress
                    )
                    if _plain_go_on(result, looks, gathered):
                        result = None
                    continue
                finished = next(blocks)
                counting = finished.trials if looks.certain else watch.counting(finished)
                if counting < finished.trials:
                    finished = runner().run(task(gathered.trials, counting))
                gathered.add(finished)
                interruption.keeping = True
                stopped = watch.after(finished, gathered.forecast, interrupted=interruption.asked)
                if looks.certain and stopped is not None and stopped.by == "accepted":
                    stopped = None
                if progress is not None and teller is not None:
                    progress(teller.after(finished, watch.share))
        if result is None:
            assert stopped is not None
            return gathered.simulation(settings, plan, stopped)
    if isinstance(result, Stopped):
        return gathered.simulation(settings, plan, result)
    return _with_search(gathered.simulation(settings, plan, watch.goal_reached), result, most_inputs, options.in_memory)


def _followed(model: CompiledModel, follow: Collection[str] | None) -> Collection[str]:
    """Return the forecasts whose means are wanted: of texts there are none."""
    numbers = [each.name for number, each in enumerate(model.forecasts) if number not in model.categories]
    return [name for name in numbers if follow is None or name in follow]


def _plain_go_on(result: Search | Stopped, looks: RareSwitch, gathered: _Gathered) -> bool:
    """Whether a search has failed where plain trials would do, only at a higher cost; no other is then made."""
    failed = isinstance(result, Stopped) and result.by == "search"
    if not failed or looks.certain or not looks.will_do(gathered.trials, gathered.accepted):
        return False
    looks.give_up()
    return True


class _EndedError(Exception):
    """Ctrl-C or the time limit stopped a search."""

    def __init__(self, stopped: Stopped) -> None:
        super().__init__(stopped.because)
        self.stopped = stopped


def _searched(
    model: CompiledModel,
    settings: Settings,
    plain: int,
    accepted: NDArray[np.int64],
    watch: Watch,
    interruption: Interruption,
    progress: OnProgress | None,
) -> Search | Stopped:
    """Search for accepted trials; returns them, or what ended the search before it had any."""

    def say(evaluations: int) -> None:
        if progress is not None:
            progress(Progress(plain + evaluations, 0, watch.share, {}, searching=True))
        ended = watch.meanwhile(interrupted=interruption.asked)
        if ended is not None:
            raise _EndedError(ended)

    from xlmc.montecarlo.rare.search import search

    try:
        result = search(model, settings, plain, accepted, say)
    except _EndedError as ended:
        return ended.stopped
    return result if result.account is not None else Stopped("search", result.failure, watch.goal_reached.goal)


def _with_search(plain: RunResult, search: Search, most_inputs: int, in_memory: int | None) -> RunResult:
    """Return the run with the trials that were found, instead of those few that plain trials had left."""
    from xlmc.montecarlo.rare.search import accepted_blocks

    assert search.account is not None
    model, block = plain.model, plain.model.program("numpy").largest_block
    gathered = _Gathered(model, block, block, most_inputs, len(search.uniforms), in_memory)
    for each in accepted_blocks(model, search.uniforms, block, lambda: gathered.wants_inputs):
        gathered.add(each)
    drawn = gathered.simulation(plain.settings, plain.plan, plain.stopped)
    return replace(
        plain,
        accepted_index=drawn.accepted_index,
        inputs=drawn.inputs,
        forecasts=drawn.forecasts,
        faults=drawn.faults,
        discards=drawn.discards,
        labels=drawn.labels,
        rare=replace(search.account, kept=gathered.accepted, faulty=gathered.lost),
    )


_MORE_THAN_SEEN: Final = 4.0
"""Standard errors by which more trials may be accepted than the first block lets expect."""

_MOST_AS_RANGE: Final = 1 << 23
"""Accepted trials whose numbers are made when they are asked for; of more they are kept, on the disk where that is
where columns go."""


class _Gathered:
    """The blocks so far: the counts of all trials, and the columns of the accepted ones."""

    def __init__(
        self, model: CompiledModel, block: int, piece: int, keep_inputs: int, trials: int, in_memory: int | None
    ) -> None:
        self._model, self._block, self._piece, self._keep_inputs = model, block, piece, keep_inputs
        real, whole = np.dtype(np.float64), np.dtype(np.int64)
        self._inputs = {name: ("input", name) for name in model.draws}
        self._prior = {name: ("prior", name) for name in model.draws}
        self._forecasts = {f.name: ("forecast", number) for number, f in enumerate(model.forecasts)}
        columns = (*self._inputs.values(), *self._prior.values(), *self._forecasts.values())
        expected = self._expected(trials) | dict.fromkeys(self._prior.values(), min(PRIOR_TRIALS, trials))
        types: dict[Hashable, np.dtype[Any]] = {("trial", 0): whole, **dict.fromkeys(columns, real)}
        self._keeper = ColumnStore(types, expected, in_memory=in_memory)
        self._most = trials
        self._prior_trials, self._prior_is_inputs = 0, True
        self._all_accepted = True
        self._tally = FilterTally.empty(len(model.filters))
        self._invalid: Counter[str] = Counter()
        self._faults: list[Counter[str]] = [Counter() for _ in model.forecasts]
        self._discards: list[Counter[int]] = [Counter() for _ in model.forecasts]
        self._labels = {number: Labels() for number in model.categories}
        self.trials = self.accepted = self.lost = 0

    @property
    def wants_inputs(self) -> bool:
        """Whether there are accepted trials still to come whose draws are kept."""
        return self.accepted < self._keep_inputs

    def add(self, block: Block) -> None:
        self._keep(block)
        self._tally.add(block.tally)
        add_counts((self._invalid, *self._faults), (block.invalid, *block.faults))
        if block.discards:
            add_counts(self._discards, block.discards)
        self.trials += block.trials
        self.accepted += block.accepted.size
        self.lost += block.lost

    def _expected(self, accepted: int) -> dict[Hashable, int]:
        """Return how many numbers the columns of accepted trials have, if so many are accepted."""
        result: dict[Hashable, int] = {("trial", 0): accepted, **dict.fromkeys(self._forecasts.values(), accepted)}
        return result | dict.fromkeys(self._inputs.values(), min(self._keep_inputs + self._piece, accepted))

    def _keep(self, block: Block) -> None:
        if not self.trials and block.accepted.size < block.trials:  # as many more as chance may add, and some
            share = (block.accepted.size + _MORE_THAN_SEEN * math.sqrt(block.accepted.size + 1.0)) / block.trials
            self._keeper.expect(self._expected(math.ceil(min(share, 1.0) * self._most)))
        self._keep_accepted(block)
        left = max(0, self._keep_inputs - self.accepted)
        for name, values in block.draws.items():
            self._keeper.add(("input", name), values[:left])
        if block.prior is not None:
            self._keep_prior(block, block.prior, left)
        for number, values in enumerate(block.forecasts):
            if number in self._labels:
                values = self._labels[number].renumbered(values, block.labels[number])
            self._keeper.add(("forecast", number), values)
        self._keeper.write_if_full()

    def _keep_accepted(self, block: Block) -> None:
        """Keep the numbers of the accepted trials, but none as long as all are accepted: a range says as much."""
        more = block.accepted.size
        if self._all_accepted and (more < block.trials or self.accepted + more > _MOST_AS_RANGE):
            self._keeper.add(("trial", 0), np.arange(self.accepted))
            self._all_accepted = False
        if not self._all_accepted:
            self._keeper.add(("trial", 0), block.accepted)

    def _keep_prior(self, block: Block, prior: Mapping[str, NDArray[np.float64]], left: int) -> None:
        """Keep the draws of all trials; as long as every trial is accepted they are the draws that are kept anyway."""
        if self._prior_is_inputs and (prior is not block.draws or left < block.trials):
            self._prior_is_inputs = False
            if self._prior_trials:
                for name, values in self._prior_columns(self._inputs).items():
                    self._keeper.add(self._prior[name], values)
        if not self._prior_is_inputs:
            for name, values in prior.items():
                self._keeper.add(("prior", name), values)
        self._prior_trials += block.trials

    def _prior_columns(self, keys: Mapping[str, Hashable]) -> Mapping[str, NDArray[np.float64]]:
        return self._keeper.columns(keys, self._prior_trials)

    def block_memory(self) -> BlockMemory:
        """Return the memory that the next block's columns go to."""
        reserve, inputs = self._keeper.reserve, self._inputs.values() if self.wants_inputs else ()
        return BlockMemory(
            None if self._all_accepted else reserve(("trial", 0), self._piece),
            {name: reserve((kind, name), self._piece) for kind, name in inputs},
            [reserve(key, self._piece) for key in self._forecasts.values()],
        )

    @property
    def accepted_trials(self) -> NDArray[np.int64]:
        """`(m,)` the numbers of the accepted trials so far."""
        if self._all_accepted:
            return np.arange(self.accepted)
        return self._keeper.columns({"trial": ("trial", 0)})["trial"]

    def forecast(self, number: int) -> NDArray[np.float64]:
        """Return a forecast's accepted trials so far, `(m,)`, NaN where it has no number."""
        return self._keeper.columns({"": ("forecast", number)})[""]

    def simulation(self, settings: Settings, plan: SamplingPlan, stopped: Stopped) -> RunResult:
        prior = self._inputs if self._prior_is_inputs else self._prior
        return RunResult(
            model=self._model,
            settings=settings,
            plan=plan,
            block=self._block,
            trials=self.trials,
            accepted_index=range(self.accepted) if self._all_accepted else self.accepted_trials,
            inputs=self._keeper.columns({a.name: self._inputs[a.name] for a in self._model.live}),
            prior=self._prior_columns({a.name: prior[a.name] for a in self._model.live}),
            forecasts=self._keeper.columns(self._forecasts),
            faults={f.name: counts for f, counts in zip(self._model.forecasts, self._faults, strict=True)},
            tally=self._tally,
            invalid=self._invalid,
            error_trials=self.lost,
            discards=discards_by_name(self._model.forecasts, self._model.forecast_filters, self._discards),
            stopped=stopped,
            labels={self._model.forecasts[number].name: each.texts for number, each in self._labels.items()},
        )
