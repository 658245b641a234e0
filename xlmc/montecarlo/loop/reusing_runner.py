"""What the runs of one workbook have in common while its ranges and limits are moved, kept from run to run.

A `ReusingRunner` holds for all models that `CompiledModel.changed` makes of one model by other numbers, because

* limits of filters are data to it, not code: its program computes the quantities that filters look at, and the limits
  are compared with them afterwards;
* its program was compiled for any ranges;
* each assumption has a random stream of its own, so that the draws of those that were not moved are what they were;
* where nothing but a limit was moved, the quantities are what they were, too.

It draws by Monte Carlo. What it gives is what a runner that is made anew would give.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Column, Evaluator, Linear, Target
from xlmc.engine.engines import ENGINES
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.loop.blocks import ModelRunner
from xlmc.montecarlo.model.draw_binding import base_point, parameter_target
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import filter_condition, filter_limits
from xlmc.montecarlo.sampling.draws import Draw, DrawStage, Sampler
from xlmc.montecarlo.statistics.estimate import finite

__all__ = ["ReusingRunner"]

Floats = NDArray[np.float64]

_MOST_BYTES: Final = 1 << 27
"""The most bytes of draws that are kept, unless asked otherwise."""

_COMPARES: Final[Mapping[str, Callable[..., NDArray[np.bool_]]]] = {
    ">=": operator.ge,
    "<=": operator.le,
    ">": operator.gt,
    "<": operator.lt,
}

Known = tuple[int, tuple[int, ...]]
"""First trial, and the number of the version of each column of draws: what tells draws that are kept from others."""


class ReusingRunner:
    """See the module. For one thread.

    Args:
        model: the first one.
        engine: that computes.
        seed: of all runs.
        trials: of the longest run.
        most_bytes: of draws that are kept; if all draws of a run would take more, none is kept.
    """

    def __init__(
        self, model: CompiledModel, engine: str, seed: int, trials: int, most_bytes: int | None = None
    ) -> None:
        self._most_bytes = _MOST_BYTES if most_bytes is None else most_bytes
        self.engine, self._seed, self._trials = engine, seed, trials
        self._lowering = model.lowering
        self._questions = [_targets(each) for each in model.filters]
        targets = [target for each in self._questions for target in each] + list(model.answer_targets)
        self._program = ENGINES[engine].load()(model.lowering, targets, [], model.fallible)
        self.largest_block: int = self._program.largest_block
        self._runners: dict[int, tuple[_Draws, _MovedEvaluator]] = {}
        self._bases: dict[tuple[float, ...], dict[str, float | None]] = {}

    def holds_for(self, model: CompiledModel) -> bool:
        """Whether it can run a model: one that shares its nodes, and asks of its filters what the first one does."""
        return model.lowering is self._lowering and [_targets(each) for each in model.filters] == self._questions

    def runner(self, model: CompiledModel, block: int) -> ModelRunner:
        """Return what runs blocks of so many trials of a model that it holds for, until it is asked for another one."""
        if block not in self._runners:
            draws = _Draws(self._seed, block, self._trials, self._most_bytes)
            self._runners[block] = draws, _MovedEvaluator(self._program.evaluator(block), draws)
        draws, evaluator = self._runners[block]
        draws.take(model)
        evaluator.take(model.filters, self._questions)
        return ModelRunner(
            draws, model.filtered(evaluator), block, len(model.forecasts), model.fallible, model.categories
        )

    def forget(self) -> None:
        """Give the draws and quantities that are kept back."""
        self._runners.clear()

    def base(self, model: CompiledModel) -> dict[str, float | None] | None:
        """Return the forecasts of a model that it holds for where each assumption has its base value, by name.

        None for a forecast that is no number; None for all where an assumption has no base value.
        """
        inputs = base_point(model.bases)
        if inputs is None:
            return None
        key = tuple(value.item() for value in inputs.values())
        if key not in self._bases:
            evaluator = self._program.evaluator(1)
            columns = evaluator.filters(inputs | model.certain(1), 1)[-len(model.answer_targets) :]
            result = [float(column.as_floats()[0]) for column in columns]
            self._bases = {key: dict(zip((f.name for f in model.forecasts), map(finite, result), strict=False))}
        return self._bases[key]


def _targets(filter_: Filter) -> tuple[Target, ...]:
    """Return what must be computed for a filter: its quantity and the cells of its limits; without limits, the
    condition.
    """
    limits = filter_limits(filter_)
    if filter_.evidence is not None and filter_.evidence.by_chance:
        return parameter_target(filter_.cell), parameter_target(filter_.evidence.chance)
    if not limits:
        return (Target(filter_condition(filter_), filter_.cell),)
    cells = [filter_.cell, *(bound for _, bound in limits if isinstance(bound, Cell))]
    return tuple(map(parameter_target, cells))


@dataclass(slots=True)
class _Column:
    """The draws of an assumption in a block, `(block,)`, and how they were drawn."""

    draw: Draw
    values: Floats
    version: int


class _Draws:
    """Draws of the model that it was given last; takes the place of a `Sampler`."""

    linear: Linear | None = None

    def __init__(self, seed: int, block: int, trials: int, most_bytes: int) -> None:
        self._seed, self._block, self._trials, self._most_bytes = seed, block, trials, most_bytes
        self._columns: dict[tuple[str, int], _Column] = {}
        self._versions = 0
        self._draws: tuple[Draw, ...] = ()
        self._whole: Sampler | None = None
        self._some: tuple[tuple[Draw, ...], Sampler] | None = None
        self.known: Known | None = None
        """The blocks of the last draws; None if they were not kept."""

    def take(self, model: CompiledModel) -> None:
        """Draw this model from now on."""
        self._draws = tuple(model.draws[name] for names in model.needed.stages for name in names)
        large = 8 * len(self._draws) * self._trials > self._most_bytes
        if large or model.groups or len(model.needed.stages) > 1:
            self._whole = model.sampler(self._seed, self._block)
        else:
            self._whole = None

    @property
    def names(self) -> tuple[str, ...]:
        """See `Sampler`."""
        return tuple(draw.name for draw in self._draws)

    def draw(self, start: int) -> dict[str, Floats]:
        """See `Sampler`."""
        if self._whole is not None:
            self.known = None
            return self._whole.draw(start)
        stored_columns = self._columns
        other = tuple(
            d for d in self._draws if (d.name, start) not in stored_columns or stored_columns[d.name, start].draw != d
        )
        if other:
            if self._some is None or self._some[0] != other:
                self._some = other, Sampler(self._seed, [DrawStage(other)], (), (), self._block)
            for draw, values in zip(other, self._some[1].draw(start).values(), strict=True):
                self._versions += 1
                own = values.copy()
                own.flags.writeable = False
                stored_columns[draw.name, start] = _Column(draw, own, self._versions)
        columns = [stored_columns[draw.name, start] for draw in self._draws]
        self.known = start, tuple(each.version for each in columns)
        return {each.draw.name: each.values for each in columns}


class _MovedEvaluator:
    """Compares the quantities of filters with limits that are given later; an `Evaluator`.

    Args:
        evaluator: of all quantities and forecasts, as if they were filters.
        draws: what draws its inputs.
    """

    def __init__(self, evaluator: Evaluator, draws: _Draws) -> None:
        self._evaluator, self._draws = evaluator, draws
        self._filters: Sequence[Filter] = ()
        self._sizes: list[int] = []
        self._answers: list[Column] = []
        self._last: dict[int, Known] = {}
        self._columns: dict[int, tuple[Known, list[Column]]] = {}

    def take(self, filters: Sequence[Filter], questions: Sequence[Sequence[Target]]) -> None:
        """Return the filters with their limits."""
        self._filters, self._sizes = filters, [len(each) for each in questions]

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """See `Evaluator`."""
        columns = self._all(inputs, n)
        result, at = [], 0
        for filter_, size in zip(self._filters, self._sizes, strict=True):
            result.append(_condition(filter_, columns[at : at + size]))
            at += size
        self._answers = columns[at:]
        return result

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        """See `Evaluator`."""
        if all(column.values.size == survivors.size for column in self._answers):  # every trial survives
            return list(self._answers)
        return [column.at(survivors) for column in self._answers]

    def _all(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """Quantities and forecasts in all trials; kept where the same draws come twice, as they then come again."""
        known = self._draws.known
        if known is None:
            return self._evaluator.filters(inputs, n)
        stored_columns = self._columns.get(known[0])
        if stored_columns is not None and stored_columns[0] == known:
            return stored_columns[1]
        columns = self._evaluator.filters(inputs, n)
        if self._last.get(known[0]) == known:
            columns = [_owned(column) for column in columns]
            self._columns[known[0]] = known, columns
        else:
            self._columns.pop(known[0], None)
        self._last[known[0]] = known
        return columns


def _condition(filter_: Filter, columns: Sequence[Column]) -> Column:
    """Whether a filter keeps each trial, `(n,)`, with the error of a quantity or a limit where there is one."""
    limits = filter_limits(filter_)
    if filter_.evidence is not None and filter_.evidence.by_chance:
        return _by_chance(filter_.evidence, *columns)
    if not limits:
        return columns[0]
    quantity, bounds = columns[0], iter(columns[1:])
    holds = np.ones(quantity.values.size, bool)
    codes = quantity.codes
    for relation, bound in limits:
        if isinstance(bound, Cell):
            column = next(bounds)
            holds &= _COMPARES[relation](quantity.values, column.values)
            codes = column.codes if codes is None else _first(codes, column.codes)
        else:
            holds &= _COMPARES[relation](quantity.values, bound)
    return Column(holds, codes)


def _by_chance(evidence: Evidence, quantity: Column, chance: Column) -> Column:
    """Whether evidence whose error is no limit keeps each trial, `(n,)`; see `accepted_by_chance`."""
    law = evidence.bell
    assert law is not None, "evidence that keeps trials by chance has no limits"
    m = np.asarray(quantity.values, np.float64)
    holds = chance.values <= np.exp(law.log_weight(m))
    if law.logarithmic:
        holds &= m > 0.0
    return Column(holds, quantity.codes)


def _first(codes: NDArray[np.uint8], more: NDArray[np.uint8] | None) -> NDArray[np.uint8]:
    return codes if more is None else np.where(codes > 0, codes, more)


def _owned(column: Column) -> Column:
    codes, texts = (None if each is None else each.copy() for each in (column.codes, column.texts))
    return Column(column.values.copy(), codes, texts)
