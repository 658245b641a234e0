"""Trials of many candidates, each of them values of the decisions of a workbook, over the same random numbers.

To compute a candidate as a workbook with its values typed in is to read the definitions and to compile the formulas
once more for each of them. Instead the decisions are made inputs of one model, beside its assumptions: it is compiled
once, its assumptions are drawn once for all candidates of a block, and a candidate is what its cells hold throughout.

A decision may also be a number that the definitions themselves read, such as a parameter in a row of a table, and then
no formula knows of it. So some candidates are computed in both ways first; where these do not agree, or where the
decisions cannot be inputs, each candidate is the workbook with its values typed in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Linear
from xlmc.engine.engines import ENGINES
from xlmc.errors import XlmcError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Assumption, Decision
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.loop.blocks import ModelRunner, Task
from xlmc.montecarlo.model.labels import calculate_labels
from xlmc.montecarlo.model.loading import model_with_values
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["CandidateTrials", "Column", "Computed", "Values"]

Floats = NDArray[np.float64]

Values = tuple[float, ...]
"""The value of each decision, in their order."""

Column = tuple[int, str | None]
"""What is wanted of the trials: a forecast by its number, and, of one whose answers are texts, the text that counts."""

_BLOCK: Final = 1 << 14
_CHECKED: Final = 256
"""Trials of the candidates that are computed in both ways."""

_ALIKE: Final = 1e-9

_MOST_BYTES: Final = 1 << 26
"""Bytes of draws that are kept for the next candidates, for each size of blocks and each thread."""


@dataclass(slots=True)
class Computed:
    """Trials of one candidate.

    Attributes:
        columns: `(columns, n)`; NaN where a trial is not accepted, or has no number; throughout, where the candidate is
            not possible.
        lost: trials lost to errors: in a draw, in a filter that cannot decide, in a column that is wanted.
    """

    columns: Floats
    lost: int = 0


class CandidateTrials:
    """Computes forecasts of candidates; for one thread, which shares the work among others.

    Args:
        model: of the workbook as it is.
        decisions: that the candidates give values to.
        engine: that computes.
        seed: of all draws.
        wanted: the columns, in order.
        jobs: threads.

    Attributes:
        by_typing: whether each candidate is the workbook with its values typed in, compiled anew.
        computed: trials so far.
    """

    def __init__(
        self,
        model: CompiledModel,
        decisions: Sequence[Decision],
        engine: str,
        seed: int,
        wanted: Sequence[Column],
        jobs: int = 1,
    ) -> None:
        self._model, self._decisions, self._seed = model, decisions, seed
        self._engine, self._wanted, self._jobs = engine, tuple(wanted), jobs
        self._typed: dict[Values, CompiledModel | None] = {}
        self._by_texts: dict[Values, CandidateTrials | None] = {}
        self._is_text = tuple(bool(each.contents) for each in decisions)
        self._runners: dict[tuple[int, int], tuple[_FixedDraws, ModelRunner]] = {}
        self.computed = 0
        self._by_inputs = self._with_inputs()
        self.by_typing = self._by_inputs is None

    def forecasts(self, candidates: Sequence[Values], start: int, stop: int) -> list[Computed]:
        """Return the trials of each candidate from `start` to `stop`."""
        if any(self._is_text):
            return self._of_texts(candidates, start, stop)
        results = [Computed(np.full((len(self._wanted), stop - start), np.nan)) for _ in candidates]
        workers = max(1, min(self._jobs, len(candidates)))
        shares = [range(number, len(candidates), workers) for number in range(workers)]

        def fill(number: int) -> None:
            self._fill(candidates, [*shares[number]], results, start, stop, number)

        if workers == 1:
            fill(0)
        else:
            with ThreadPoolExecutor(workers) as pool:
                list(pool.map(fill, range(workers)))
        self.computed += len(candidates) * (stop - start)
        return results

    def _fill(
        self,
        candidates: Sequence[Values],
        mine: Sequence[int],
        results: Sequence[Computed],
        start: int,
        stop: int,
        worker: int,
    ) -> None:
        """Compute some of the candidates, block by block: the draws of a block hold for all of them."""
        size = self._block_size(start, stop)
        for first in range(start, stop, size):
            count = min(size, stop - first)
            at = slice(first - start, first - start + count)
            for number in mine:
                runner = self._runner(candidates[number], size, worker)
                if runner is not None:
                    rows, lost = self._columns(runner, Task(first, count, prior=False, inputs=False))
                    results[number].columns[:, at] = rows
                    results[number].lost += lost

    def _block_size(self, start: int, stop: int) -> int:
        """Return a power of two of trials: what is asked for begins at a multiple of it, as long as it is one."""
        size = _BLOCK
        while size > 64 and (start % size or stop - start < size):
            size //= 2
        return size

    def _columns(self, runner: ModelRunner, task: Task) -> tuple[Floats, int]:
        """Return the columns of a block, and how many of its trials are lost to errors."""
        block = runner.borrow(task)
        rows = np.full((len(self._wanted), task.trials), np.nan)
        for row, (number, text) in zip(rows, self._wanted, strict=True):
            values = np.asarray(block.forecasts[number])
            if text is not None:
                texts = block.labels.get(number, ())
                at = texts.index(text) if text in texts else -1
                values = np.where(np.isnan(values), np.nan, (values == at).astype(np.float64))
            row[block.accepted - task.start] = values
        without = sum(block.faults[number].total() for number in {number for number, _ in self._wanted})
        return rows, min(block.lost, block.tally.by_error + block.invalid.total() + without)

    def _runner(self, candidate: Values, size: int, worker: int) -> ModelRunner | None:
        """Return what runs a candidate; None where it is not possible."""
        if self.by_typing:
            model = self._model_of(candidate)
            return None if model is None else _runner_of(model, self._engine, self._seed, size)
        assert self._by_inputs is not None
        if (worker, size) not in self._runners:
            draws = _FixedDraws(self._by_inputs, self._decisions, self._seed, size, self._engine)
            evaluator = self._by_inputs.program(self._engine).evaluator(size)
            made = ModelRunner(
                draws,
                evaluator,
                size,
                len(self._by_inputs.forecasts),
                self._by_inputs.fallible,
                self._by_inputs.categories,
            )
            self._runners[worker, size] = draws, made
        draws, runner = self._runners[worker, size]
        draws.hold(candidate)
        return runner

    def _model_of(self, candidate: Values) -> CompiledModel | None:
        if candidate not in self._typed:
            typed = {each.cell: each.content(value) for each, value in zip(self._decisions, candidate, strict=True)}
            try:
                model = model_with_values(self._model, typed)
                same = [f.name for f in model.forecasts] == [f.name for f in self._model.forecasts]
                self._typed[candidate] = model if same else None
            except XlmcError:
                self._typed[candidate] = None
        return self._typed[candidate]

    def _of_texts(self, candidates: Sequence[Values], start: int, stop: int) -> list[Computed]:
        """Compute candidates that have the same texts as those of one workbook, into which these are typed."""
        results = [Computed(np.full((len(self._wanted), stop - start), np.nan)) for _ in candidates]
        texts = [self._part(each, of_texts=True) for each in candidates]
        for key in dict.fromkeys(texts):
            trials = self._trials_of(key)
            if trials is None:
                continue
            numbers = [number for number, each in enumerate(texts) if each == key]
            parts = [self._part(candidates[number], of_texts=False) for number in numbers]
            for number, each in zip(numbers, trials.forecasts(parts, start, stop), strict=True):
                results[number] = each
        self.computed += len(candidates) * (stop - start)
        return results

    def _part(self, candidate: Values, *, of_texts: bool) -> Values:
        return tuple(value for value, is_text in zip(candidate, self._is_text, strict=True) if is_text == of_texts)

    def _trials_of(self, texts: Values) -> CandidateTrials | None:
        """Return what computes the candidates with these texts; None where the workbook is not possible with them."""
        if texts not in self._by_texts:
            typing = [each for each in self._decisions if each.contents]
            typed = {each.cell: each.content(value) for each, value in zip(typing, texts, strict=True)}
            others = [each for each in self._decisions if not each.contents]
            try:
                model = model_with_values(self._model, typed)
                same = [f.name for f in model.forecasts] == [f.name for f in self._model.forecasts]
                made = CandidateTrials(model, others, self._engine, self._seed, self._wanted, self._jobs)
                self._by_texts[texts] = made if same else None
            except XlmcError:
                self._by_texts[texts] = None
        return self._by_texts[texts]

    def _with_inputs(self) -> CompiledModel | None:
        """Return the model with the decisions as inputs; None where that is not the workbook with them typed in."""
        if self._model.definitions.feeding is not None or any(self._is_text):
            return None
        try:
            model = _model_with_inputs(self._model, self._decisions)
        except XlmcError:
            return None
        self._by_inputs, self.by_typing = model, False
        for candidate in self._looked_at():
            self.by_typing = False
            (drawn,) = self.forecasts([candidate], 0, _CHECKED)
            self.by_typing = True
            (typed,) = self.forecasts([candidate], 0, _CHECKED)
            if not np.allclose(drawn.columns, typed.columns, rtol=_ALIKE, atol=0.0, equal_nan=True):
                return None
        self.computed = 0
        return model

    def _looked_at(self) -> list[Values]:
        """Return three candidates in which each decision has its least, a middle and its largest value."""
        levels = [(each.values[0], each.values[len(each.values) // 2], each.values[-1]) for each in self._decisions]
        return [tuple(three[(turn + at) % 3] for at, three in enumerate(levels)) for turn in range(3)]


def _runner_of(model: CompiledModel, engine: str, seed: int, size: int) -> ModelRunner:
    evaluator = model.program(engine).evaluator(size)
    sampler = model.sampler(seed, size, engine)
    return ModelRunner(sampler, evaluator, size, len(model.forecasts), model.fallible, model.categories)


def _key(decision: Decision) -> str:
    """Name a decision among inputs, as no assumption is named."""
    return f"\0{decision.name}"


def _model_with_inputs(model: CompiledModel, decisions: Sequence[Decision]) -> CompiledModel:
    """Make the model in which the decisions are inputs.

    The definitions are read once more: those of a model have numbers for what formulas compute.

    Raises:
        XlmcError: a decision cannot be one.
    """
    workbook = calculate_labels(model.workbook)
    definitions = read_definitions(workbook, ENGINES, python=model.definitions.python)
    names = {each.name for each in model.forecasts}
    inputs = tuple(
        Assumption(
            _key(each),
            each.cell,
            "Uniform",
            {"low": min(each.values), "high": max(each.values)},
            each.row,
            base=float(content) if isinstance(content := workbook.content(each.cell).value, int | float) else None,
        )
        for each in decisions
    )
    forecasts = tuple(each for each in definitions.forecasts if each.name in names)
    return CompiledModel(
        workbook,
        replace(definitions, assumptions=(*inputs, *definitions.assumptions), forecasts=forecasts, checks=()),
        model.path,
    )


@dataclass(slots=True)
class _Slot:
    """The value of a decision in the candidate that is run."""

    value: float = 0.0


class _FixedDraw(Draw):
    """A decision, which is the same in all trials of a candidate."""

    slot: _Slot

    def fill(self, u: Floats, dynamic: Mapping[Cell, Floats]) -> None:
        """See `Draw`."""
        u[:] = self.slot.value

    def offset_and_factor(self) -> None:
        """See `Draw`."""

    @classmethod
    def instead_of(cls, draw: Draw, slot: _Slot) -> _FixedDraw:
        """Return what takes the place of a draw."""
        fixed_draw = cls(draw.name, draw.family, draw.parameters, draw.cutoffs)
        object.__setattr__(fixed_draw, "slot", slot)  # a draw is frozen
        return fixed_draw


class _FixedDraws:
    """Draws of the assumptions, and the values of one candidate beside them; takes the place of a `Sampler`."""

    linear: Linear | None = None

    def __init__(self, model: CompiledModel, decisions: Sequence[Decision], seed: int, block: int, engine: str) -> None:
        self._values = {_key(each): _Slot() for each in decisions}
        draws = dict(model.draws)
        for name, slot in self._values.items():
            if name in draws:
                draws[name] = _FixedDraw.instead_of(draws[name], slot)
        self._sampler = model.sampler(seed, block, engine, draws=draws)
        self._again = len(model.needed.stages) < 2
        self._stored: dict[int, dict[str, Floats]] = {}
        self._most = max(1, _MOST_BYTES // (8 * block * max(len(draws), 1)))

    @property
    def names(self) -> tuple[str, ...]:
        """See `Sampler`."""
        return self._sampler.names

    def hold(self, candidate: Values) -> None:
        """Take the values of a candidate."""
        for slot, value in zip(self._values.values(), candidate, strict=True):
            slot.value = value

    def draw(self, start: int) -> dict[str, Floats]:
        """See `Sampler`. Draws that depend on no decision stay from candidate to candidate."""
        if not self._again:
            return self._sampler.draw(start)
        drawn = self._stored.get(start)
        if drawn is None:
            drawn = {name: values.copy() for name, values in self._sampler.draw(start).items()}
            if len(self._stored) < self._most:
                self._stored[start] = drawn
        for name, slot in self._values.items():
            if name in drawn:
                drawn[name][:] = slot.value
        return drawn
