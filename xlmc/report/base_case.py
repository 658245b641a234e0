"""The base case: every assumption at its cell's own value, in the same model that the trials went through."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from xlmc.definitions.model import name_key

if TYPE_CHECKING:
    from xlmc.evaluation.engine import Column
    from xlmc.run.simulation import Simulation

__all__ = ["BaseCase", "base_case"]


@dataclass(frozen=True, slots=True)
class BaseCase:
    """What the workbook shows before any simulation.

    Attributes:
        forecasts: forecast -> its value; None where it is no number.
        rejected_by: the filters that reject it.
    """

    forecasts: Mapping[str, float | None]
    rejected_by: tuple[str, ...]


def base_case(simulation: Simulation) -> BaseCase | None:
    """The base case of a run's model; None where an assumption has none.

    It is computed, not read: a file may hold no cached values, or stale ones.
    """
    model = simulation.model
    base = {name_key(a.name): a.base for a in model.live}
    known = {key: np.full(1, value) for key, value in base.items() if value is not None}
    if len(known) < len(base):
        return None
    settings = simulation.settings  # always in float64
    evaluator = model.program(settings.engine).evaluator(1)
    filters = [_fails(column) for column in evaluator.filters(known, 1)]
    columns = evaluator.forecasts(np.zeros(1, np.intp))
    return BaseCase(
        forecasts={f.name: _number(column) for f, column in zip(model.forecasts, columns, strict=True)},
        rejected_by=tuple(f.name for f, fails in zip(model.filters, filters, strict=True) if fails),
    )


def _fails(column: Column) -> bool:
    return bool(column.values[0] == 0 or (column.codes is not None and column.codes[0] > 0))


def _number(column: Column) -> float | None:
    value = float(column.as_floats()[0])
    return value if np.isfinite(value) else None
