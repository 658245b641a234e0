"""The limits of a model's filters, and the cells that decide them, trial by trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.address import Cell
from xlmc.run.drawing import parameter_target
from xlmc.run.scene import filter_limits
from xlmc.studies.sensitivity.moved_limit import kept

if TYPE_CHECKING:
    from xlmc.definitions.model import Filter
    from xlmc.evaluation.engine import Evaluator, Program
    from xlmc.run.model import Model

__all__ = ["Limit", "LimitCells", "Looked"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Limit:
    """One limit of a filter, a number or a cell; `place` is the filter's, counted from 0."""

    filter: Filter
    place: int
    relation: str
    bound: float | Cell


@dataclass(frozen=True)
class Looked:
    """What a block of trials has in the cells: `(n,)` of each filter and of each limit; NaN for an error."""

    filters: list[Floats]
    bounds: list[Floats]


class LimitCells:
    """The limits of a model, in the order of the workbook, and a program that computes what decides them.

    Attributes:
        limits: of all filters.
    """

    def __init__(self, model: Model) -> None:
        self._model = model
        self.limits = [
            Limit(filter_, place, relation, bound)
            for place, filter_ in enumerate(model.filters)
            for relation, bound in filter_limits(filter_)
        ]

    @cached_property
    def program(self) -> Program:
        """Gives filters' cells and limits in place of filters, and the forecasts."""
        cells = [filter_.cell for filter_ in self._model.filters]
        cells += [limit.bound for limit in self.limits if isinstance(limit.bound, Cell)]
        return self._model.program_of([parameter_target(cell) for cell in cells])

    def look(self, evaluator: Evaluator, draws: Mapping[str, Floats], n: int) -> Looked:
        """Into the cells, in `n` trials, with an evaluator of the program."""
        columns = [column.as_floats() for column in evaluator.filters(draws, n)]
        filters = len(self._model.filters)
        computed = iter(columns[filters:])
        bounds = [next(computed) if isinstance(each.bound, Cell) else np.full(n, each.bound) for each in self.limits]
        return Looked(columns[:filters], bounds)

    def rejected_by_one(self, looked: Looked, draws: Mapping[str, Floats]) -> list[Bools]:
        """For each limit, the trials `(n,)` that it rejects and nothing else does."""
        held = [
            kept(limit.relation, looked.filters[limit.place], bound)
            for limit, bound in zip(self.limits, looked.bounds, strict=True)
        ]
        limited = {limit.place for limit in self.limits}
        logical = [cell for place, cell in enumerate(looked.filters) if place not in limited]
        broken = np.sum([~each for each in held], axis=0)
        for cell in logical:
            broken += (cell == 0.0) | np.isnan(cell)
        for name in sorted(self._model.fallible):
            broken += np.isnan(draws[name])
        return [(broken == 1) & ~each for each in held]
