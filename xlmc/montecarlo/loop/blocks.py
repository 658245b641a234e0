"""One block of trials: drawn, evaluated, filtered, counted. Whole blocks are evaluated, then cut at the trial count.

Native code for whole blocks takes only as many chunks as hold the trials that count: what it gives of a trial does not
depend on the other trials.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import (
    BLANK_RESULT,
    DISCARDED_FIRST,
    TEXT_RESULT,
    UNDECIDED_RESULT,
    AcceptedBlock,
    BlockMemory,
    BlockRunner,
    Column,
    Evaluator,
    Linear,
    RunsWholeBlocks,
)
from xlmc.errors import ErrorCode
from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.loop.categories import labelled

__all__ = ["Block", "FilterTally", "ModelRunner", "Portable", "Runner", "Task", "add_counts", "fault_text", "portions"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Key = TypeVar("Key")


@dataclass(slots=True)
class FilterTally:
    """How many trials each filter rejected.

    Attributes:
        rejected: `(f,)` trials that the filter rejects, whatever the others do.
        only: `(f,)` trials that this filter alone rejects: all others keep them.
        together: `(f, f)` trials that both of two filters reject.
        errors: per filter, error -> trials in which the filter's cell is that error; they are among `rejected`.
        by_error: trials that no filter finds FALSE but some filter cannot decide.
    """

    rejected: NDArray[np.int64]
    only: NDArray[np.int64]
    together: NDArray[np.int64]
    errors: list[Counter[str]]
    by_error: int

    def add(self, other: FilterTally) -> None:
        """Count another block's trials too."""
        self.rejected += other.rejected
        self.only += other.only
        self.together += other.together
        self.by_error += other.by_error
        add_counts(self.errors, other.errors)

    @classmethod
    def empty(cls, filters: int) -> FilterTally:
        """Make a tally in which nothing is counted yet."""
        zeros = np.zeros(filters, np.int64)
        square = np.zeros((filters, filters), np.int64)
        return cls(zeros, zeros.copy(), square, [Counter() for _ in range(filters)], 0)


def add_counts(counts: Iterable[Counter[Key]], more: Iterable[Counter[Key]]) -> None:
    """Add the counts of a block; of most there are none, which takes `Counter.update` as long as some."""
    for mine, theirs in zip(counts, more, strict=True):
        if theirs:
            mine.update(theirs)


@dataclass(frozen=True, slots=True)
class Block:
    """What is kept of a block: the accepted trials, the counts, and, of the first blocks, all draws.

    Attributes:
        accepted: `(m,)` trial indices.
        draws: assumption -> `(m,)`; empty when not asked for.
        forecasts: one a forecast, `(m,)`, NaN where it has no number.
        faults: per forecast, fault -> accepted trials in which it has no number.
        discards: per forecast, number of one of its own filters -> accepted trials that this discards.
        invalid: assumption -> trials that were lost, and in which its parameters were no distribution.
        lost: trials with an error of any kind: in a draw that is used, in an undecided filter, in a forecast that
            counts.
        prior: assumption -> `(n,)` draws of all trials; None when not asked for. Where all trials are accepted and
            their draws asked for, it is `draws` itself.
        labels: number of a forecast whose answers are texts -> the texts that its numbers stand for.
    """

    trials: int
    accepted: NDArray[np.int64]
    draws: dict[str, Floats]
    forecasts: list[Floats]
    faults: list[Counter[str]]
    tally: FilterTally
    invalid: Counter[str]
    lost: int
    prior: dict[str, Floats] | None
    discards: Sequence[Counter[int]] = ()
    labels: Mapping[int, tuple[str, ...]] = field(default_factory=dict)

    def owned(self) -> Block:
        """Return the same block with its columns in memory of their own."""
        draws, prior = _copied(self.draws), self.prior
        if prior is not None:
            prior = draws if prior is self.draws else _copied(prior)
        return replace(
            self,
            accepted=self.accepted.copy(),
            draws=draws,
            forecasts=[column.copy() for column in self.forecasts],
            prior=prior,
        )


def _copied(columns: Mapping[str, Floats]) -> dict[str, Floats]:
    return {name: column.copy() for name, column in columns.items()}


class Task(NamedTuple):
    """A block to run: its first trial, how many of its trials count, and whether to keep all and accepted draws."""

    start: int
    trials: int
    prior: bool
    inputs: bool = True


class Runner(Protocol):
    """Whatever runs blocks, one after another."""

    def run(self, task: Task) -> Block:
        """Run the trials from the task's first on, a whole block of them, cut to those that count."""


class Portable(Protocol):
    """What can be pickled and makes a runner in another process."""

    def runner(self) -> Runner:
        """Make the runner."""


class Drawing(Protocol):
    """What draws the trials of blocks: a `Sampler`, or what takes its place."""

    @property
    def names(self) -> Sequence[str]:
        """See `Sampler`."""

    @property
    def linear(self) -> Linear | None:
        """See `Sampler`."""

    def draw(self, start: int) -> dict[str, Floats]:
        """See `Sampler`."""


class ModelRunner:
    """Runs blocks, one after another, in one thread. It can be pickled where the engine's evaluators can.

    Args:
        block: trials that it evaluates at once.
        forecasts: how many the evaluator gives.
        fallible: the assumptions whose draws may be errors.
        categories: the numbers of the forecasts whose answers are texts.
    """

    def __init__(
        self,
        sampler: Drawing,
        evaluator: Evaluator,
        block: int,
        forecasts: int,
        fallible: frozenset[str],
        categories: tuple[int, ...] = (),
    ) -> None:
        self._made_of = sampler, evaluator, block, forecasts, fallible, categories
        self._categories = categories
        self._sampler, self._evaluator, self.block = sampler, evaluator, block
        self._width, self._fallible = forecasts, fallible
        self._run_whole: BlockRunner | None = None
        if isinstance(evaluator, RunsWholeBlocks) and not fallible and not categories:
            self._run_whole = evaluator.block_runner(sampler.names, sampler.draw, sampler.linear)

    def __reduce__(self) -> tuple[Any, ...]:
        return ModelRunner, self._made_of

    def runner(self) -> ModelRunner:
        """See `Portable`."""
        return self

    def run(self, task: Task) -> Block:
        """See `Runner`."""
        return self.borrow(task).owned()

    def borrow(self, task: Task, block_memory: Callable[[], BlockMemory] | None = None) -> Block:
        """Run a block in memory that the next block overwrites, else as `run`: copy what you keep.

        Where all trials are kept, the columns may be written to what `block_memory` gives.
        """
        start, trials = task.start, task.trials
        whole = None if self._run_whole is None else self._run_whole(start, trials, task.inputs, block_memory)
        if whole is not None:
            return _block_of(whole, self._prior(whole.drawn, whole.draws, whole.accepted.size, task), task.trials)
        draws = self._sampler.draw(start)
        columns = self._evaluator.filters(draws, self.block)
        invalid = {name: np.isnan(draws[name]) for name in sorted(self._fallible)}
        fails, undecided = [_fails(column) for column in columns], _undecided(columns, trials)
        tally = _tally(columns, [rejected[:trials] for rejected in fails], undecided)
        survivors = np.flatnonzero(~_any(fails, self.block))
        forecasts = self._forecasts(survivors)
        labels: dict[int, tuple[str, ...]] = {}
        for number in self._categories:
            forecasts[number], labels[number] = labelled(forecasts[number])
        used = _spoiled([*invalid.values()], columns, survivors, forecasts, self.block)
        if used.any():
            sound = ~used[survivors]
            survivors, forecasts = survivors[sound], [column.at(sound) for column in forecasts]
        survivors = survivors[: np.searchsorted(survivors, trials)]
        lost = undecided | used[:trials]
        counted = {name: np.count_nonzero(bad[:trials] & used[:trials]) for name, bad in invalid.items()}
        m = survivors.size
        accepted_draws = {}
        if task.inputs:
            accepted_draws = {name: v[:m] if m == trials else v[survivors] for name, v in draws.items()}
        lost[survivors] |= _any_error(forecasts, m)
        return Block(
            trials,
            survivors + start,
            accepted_draws,
            [column.as_floats(copy=False)[:m] for column in forecasts],
            [_faults(column, m) for column in forecasts],
            tally,
            Counter({name: int(count) for name, count in counted.items() if count}),
            int(np.count_nonzero(lost)),
            self._prior(draws, accepted_draws, m, task),
            [_discards(column, m) for column in forecasts],
            labels,
        )

    def _prior(
        self, drawn: Mapping[str, Floats] | None, accepted_draws: dict[str, Floats], accepted: int, task: Task
    ) -> dict[str, Floats] | None:
        """Return the draws of all trials of a block, if they are asked for.

        Args:
            drawn: the block's draws; where it is None they are drawn once more.
            accepted_draws: those of the accepted trials, which are returned if all are accepted; empty where they were
                not asked for.
            accepted: how many trials are accepted.
            task: what was asked for.
        """
        if not task.prior:
            return None
        if task.inputs and accepted == task.trials:
            return accepted_draws
        drawn = self._sampler.draw(task.start) if drawn is None else drawn
        return {name: values[: task.trials] for name, values in drawn.items()}

    def _forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        """Return an empty block, for the bodies of functions need not know what to make of no trials at all."""
        if survivors.size:
            return self._evaluator.forecasts(survivors)
        return [Column(np.empty(0)) for _ in range(self._width)]


def _block_of(block: AcceptedBlock, prior: dict[str, Floats] | None, trials: int) -> Block:
    """Make a block of so many trials without errors; `prior` are the draws of all, if they are asked for."""
    faults: list[Counter[str]] = [Counter() for _ in block.forecasts]
    errors: list[Counter[str]] = [Counter() for _ in block.only]
    tally = FilterTally(np.diagonal(block.together).copy(), block.only, block.together, errors, 0)
    return Block(
        trials,
        block.accepted,
        block.draws,
        block.forecasts,
        faults,
        tally,
        Counter(),
        0,
        prior,
        block.discards,
    )


def _any(masks: Sequence[Bools], n: int) -> Bools:
    return np.asarray(np.logical_or.reduce([np.zeros(n, bool), *masks]))


def _tally(columns: Sequence[Column], fails: Sequence[Bools], undecided: Bools) -> FilterTally:
    """Return what the filters reject of a block's first trials: `fails`, a mask (n,) each, and `undecided` (n,)."""
    trials = undecided.size
    tally = FilterTally.empty(len(columns))
    if fails:
        bits = _bits(fails, trials)
        for i, mine in enumerate(bits):
            tally.together[i, : i + 1] = tally.together[: i + 1, i] = _count(mine & bits[: i + 1])
        tally.rejected[:] = np.diagonal(tally.together)
        tally.only[:] = _count(bits & _exactly_one(bits))
    for i, column in enumerate(columns):
        tally.errors[i] = _faults(column, trials)
    tally.by_error = int(np.count_nonzero(undecided))
    return tally


def _bits(masks: Sequence[Bools], n: int) -> NDArray[np.uint64]:
    """Masks `(n,)` as rows of words, a bit a trial: sets of trials are compared 64 trials at a time."""
    rows = np.zeros((len(masks), -(-n // 64) * 8), np.uint8)
    for row, mask in zip(rows, masks, strict=True):
        row[: -(-n // 8)] = np.packbits(mask)
    return rows.view(np.uint64)


def _count(bits: NDArray[np.uint64]) -> NDArray[np.int64]:
    """Count the set bits of every row."""
    return np.asarray(np.bitwise_count(bits).sum(axis=1, dtype=np.int64))


def _exactly_one(bits: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return a row of the bits that are set in one row only."""
    once, more = np.zeros_like(bits[0]), np.zeros_like(bits[0])
    for row in bits:
        more |= once & row
        once |= row
    return np.asarray(once & ~more)


def _fails(column: Column) -> Bools:
    fails: Bools = column.values == 0
    return fails if column.codes is None else fails | (column.codes > 0)


def _undecided(columns: Sequence[Column], trials: int) -> Bools:
    """Return the trials that no filter finds FALSE but some filter cannot decide."""
    errors = [column.codes[:trials] > 0 for column in columns if column.codes is not None]
    if not errors:
        return np.zeros(trials, bool)
    mask, false = _any(errors, trials), [_false(column)[:trials] for column in columns]
    return mask & ~_any(false, trials)


def _false(column: Column) -> Bools:
    false: Bools = column.values == 0
    return false if column.codes is None else false & (column.codes == 0)


def _spoiled(
    invalid: Sequence[Bools],
    filters: Sequence[Column],
    survivors: NDArray[np.intp],
    forecasts: Sequence[Column],
    n: int,
) -> Bools:
    """Return the trials of a block, `(n,)`, in which a draw is none, and a filter or a survivor's forecast has no
    number.
    """
    mask = _any(invalid, n)
    if mask.any():
        errors = _any_error(filters, n)
        errors[survivors] |= _any_error(forecasts, survivors.size)
        mask &= errors
    return mask


def _any_error(columns: Sequence[Column], n: int) -> Bools:
    """Return the first n trials in which one of the columns has no number, and is not discarded by a forecast's own
    filter.
    """
    codes = (column.codes[:n] for column in columns if column.codes is not None)
    return _any([(each > 0) & (each < DISCARDED_FIRST) for each in codes], n)


def _faults(column: Column, trials: int) -> Counter[str]:
    return Counter({fault_text(code): n for code, n in _codes(column, trials) if 0 < code < DISCARDED_FIRST})


def _discards(column: Column, trials: int) -> Counter[int]:
    return Counter({code - DISCARDED_FIRST: n for code, n in _codes(column, trials) if code >= DISCARDED_FIRST})


def _codes(column: Column, trials: int) -> Iterator[tuple[int, int]]:
    """Count the trials of each code among a column's first trials."""
    if column.codes is not None:
        counts = np.bincount(column.codes[:trials])
        codes = np.flatnonzero(counts)
        yield from zip(codes.tolist(), counts[codes].tolist(), strict=True)


def fault_text(code: int) -> str:
    """Say what a column's code stands for: an Excel error, `text` or `blank`."""
    if code == TEXT_RESULT:
        return "text"
    if code == UNDECIDED_RESULT:
        return "error in a filter of its own"
    return "blank" if code == BLANK_RESULT else ErrorCode(code).text


def portions(draws: Mapping[str, Floats], n: int, size: int) -> Iterator[tuple[slice, dict[str, Floats]]]:
    """Yield the first n trials of draws that are known, up to `size` at a time: which they are, and name -> their
    draws.
    """
    for start in range(0, n, size):
        checkpoint()
        trials = slice(start, min(start + size, n))
        yield trials, {name: np.ascontiguousarray(values[trials]) for name, values in draws.items()}
