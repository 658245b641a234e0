"""Filters of some forecasts only: a trial that one rejects is discarded for these, and stays for the others.

The conditions of these filters are computed with the forecasts. A discarded trial gets a code of its own in the column
of its forecast, so that whoever evaluates forecasts sees it as a trial without a number there.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import (
    DISCARDED_FIRST,
    UNDECIDED_RESULT,
    AcceptedBlock,
    BlockMemory,
    BlockRunner,
    Column,
    Evaluator,
    Linear,
    Program,
    RunsWholeBlocks,
    Target,
)
from xlmc.montecarlo.definitions.definitions import Filter, Forecast
from xlmc.montecarlo.model.needed import filter_condition

if TYPE_CHECKING:
    from xlmc.excel.functions.values import Bools

__all__ = ["FilteringEvaluator", "FilteringProgram", "conditions_of", "discards_by_name", "filters_by_forecast"]

Floats = NDArray[np.float64]


def filters_by_forecast(forecasts: Sequence[Forecast], filters: Sequence[Filter]) -> tuple[tuple[int, ...], ...]:
    """Return the indices of each forecast's own filters, in the order of both."""
    return tuple(
        tuple(index for index, each in enumerate(filters) if forecast.name in each.only_for) for forecast in forecasts
    )


def conditions_of(filters: Sequence[Filter]) -> list[Target]:
    """Return what they ask, 1 where it holds."""
    return [Target(filter_condition(each), each.cell) for each in filters]


class FilteringProgram:
    """A program whose last targets are the conditions of filters of some forecasts only.

    Args:
        program: computes the forecasts, and then the conditions.
        own: the indices of each forecast's conditions.
    """

    def __init__(self, program: Program, own: tuple[tuple[int, ...], ...]) -> None:
        self.largest_block = program.largest_block
        self._program, self._own = program, own

    def evaluator(self, block: int) -> Evaluator:
        """See `Program`."""
        return FilteringEvaluator(self._program.evaluator(block), self._own)


@dataclass(frozen=True, slots=True)
class FilteringEvaluator:
    """The evaluator of such a program.

    Attributes:
        evaluator: of its program.
        own: the indices of each forecast's conditions.
    """

    evaluator: Evaluator
    own: tuple[tuple[int, ...], ...]

    def filters(self, inputs: Mapping[str, Floats], n: int) -> list[Column]:
        """See `Evaluator`."""
        return self.evaluator.filters(inputs, n)

    def forecasts(self, survivors: NDArray[np.intp]) -> list[Column]:
        """See `Evaluator`."""
        columns = self.evaluator.forecasts(survivors)
        conditions = columns[len(self.own) :]
        return [
            _discarding(column, [conditions[index] for index in own]) if own else column
            for column, own in zip(columns, self.own, strict=False)
        ]

    def block_runner(
        self, names: Sequence[str], draw: Callable[[int], Mapping[str, Floats]], linear: Linear | None
    ) -> BlockRunner | None:
        """See `RunsWholeBlocks`."""
        evaluator = self.evaluator
        run = evaluator.block_runner(names, draw, linear) if isinstance(evaluator, RunsWholeBlocks) else None
        return None if run is None else _FilteringRunner(run, self.own)


@dataclass(frozen=True, slots=True)
class _FilteringRunner:
    """A `BlockRunner` of forecasts and, behind them, the conditions of filters of some forecasts only."""

    run: BlockRunner
    own: tuple[tuple[int, ...], ...]

    def __call__(
        self, start: int, trials: int, inputs: bool, block_memory: Callable[[], BlockMemory] | None
    ) -> AcceptedBlock | None:
        """See `BlockRunner`."""
        accepted_block = self.run(start, trials, inputs, block_memory)
        if accepted_block is None:
            return None
        forecasts, conditions = accepted_block.forecasts[: len(self.own)], accepted_block.forecasts[len(self.own) :]
        fails = [condition == 0 for condition in conditions]
        result = [
            _discard(column, [fails[index] for index in own]) for column, own in zip(forecasts, self.own, strict=True)
        ]
        return replace(
            accepted_block, forecasts=[column for column, _ in result], discards=[counts for _, counts in result]
        )


def _discarding(column: Column, conditions: Sequence[Column]) -> Column:
    """Return the column with a code where a condition is false, that of the first such condition, or is an error.

    Where the forecast is an error itself, the code that takes the place of the error's goes with NaN: what is discarded
    is still shown at the base case.
    """
    values = column.values if column.codes is None else column.as_floats()
    kind = np.min_scalar_type(DISCARDED_FIRST + len(conditions))
    codes = np.zeros(column.values.shape, kind) if column.codes is None else column.codes.astype(kind)
    for condition in conditions:
        if condition.codes is not None:
            codes[(codes == 0) & (condition.codes > 0)] = UNDECIDED_RESULT
    for number, condition in reversed([*enumerate(conditions)]):
        false = condition.values == 0
        if condition.codes is not None:
            false = false & (condition.codes == 0)
        codes[false] = DISCARDED_FIRST + number
    return Column(values, codes, column.texts)


def _discard(column: Floats, fails: Sequence[Bools]) -> tuple[Floats, Counter[int]]:
    """Return the column with NaN where a condition is false; number of a condition -> trials in which it is the first
    such.
    """
    counts: Counter[int] = Counter()
    if not fails:
        return column, counts
    discarded = np.zeros(column.shape, np.bool_)
    for number, false in enumerate(fails):
        counts[number] = int(np.count_nonzero(false & ~discarded))
        discarded |= false
    return np.where(discarded, np.nan, column), +counts


def discards_by_name(
    forecasts: Sequence[Forecast], filters: Sequence[Filter], discards: Sequence[Counter[int]]
) -> dict[str, Counter[str]]:
    """Forecast -> its own filters by name -> accepted trials that each discarded; without a forecast that has none.

    Args:
        forecasts: of the model.
        filters: of some forecasts only.
        discards: per forecast, number of its own filter -> trials.
    """
    own = filters_by_forecast(forecasts, filters)
    return {
        forecast.name: Counter({filters[index].name: counts[number] for number, index in enumerate(mine)})
        for forecast, mine, counts in zip(forecasts, own, discards, strict=True)
        if mine
    }
