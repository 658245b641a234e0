"""What the sections of a run are made from."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from xlmc.montecarlo.definitions.stating import NOT_ROUNDED

if TYPE_CHECKING:
    from xlmc.analysis.results.record import Record
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Material", "also_named", "same_answers"]


@dataclass(frozen=True, slots=True)
class Material:
    """What sections are made from.

    Attributes:
        simulation: the finished run.
        record: its record.
        forecasts: the names of those that the report is about, in the order of the workbook.
        same: forecast -> the others of these that are the same in every trial; a report tells of them once.
    """

    simulation: RunResult
    record: Record
    forecasts: tuple[str, ...]
    same: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def once(self) -> tuple[str, ...]:
        """The forecasts without those that are the same as an earlier one."""
        others = {name for names in self.same.values() for name in names}
        return tuple(name for name in self.forecasts if name not in others)

    def called(self, name: str) -> str:
        """Return the name of a forecast, with those of the others that are the same."""
        return also_named(name, self.same)


def also_named(name: str, same: Mapping[str, tuple[str, ...]]) -> str:
    """Write a name with those of the others that are the same.

    >>> also_named("Speed", {"Speed": ("Speed, from momentum", "Speed when it fell")})
    'Speed (the same in every trial: Speed, from momentum; Speed when it fell)'
    """
    others = same.get(name, ())
    return f"{name} (the same in every trial: {'; '.join(others)})" if others else name


def same_answers(simulation: RunResult, names: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Find forecasts that are the same number in every accepted trial and are asked the same: a formula that chooses
    one of several readings gives them.

    A number that never varies, a yes and a text may be the same by coincidence, and each is reported.

    Args:
        simulation: the finished run.
        names: of the forecasts to compare.

    Returns:
        Forecast -> the later ones that are the same.
    """
    results: dict[str, tuple[str, ...]] = {}
    for name in names:
        result = simulation.results[name]
        if result.kind in NOT_ROUNDED or not result.statistics.standard_deviation.value > 0.0:
            continue
        first = next((each for each in results if _is_same(simulation.results[each], result)), None)
        if first is None:
            results[name] = ()
        else:
            results[first] = (*results[first], name)
    return {name: others for name, others in results.items() if others}


def _is_same(one: ForecastResult, other: ForecastResult) -> bool:
    its = other.definition
    asked = replace(one.definition, name=its.name, cell=its.cell, row=its.row, notes=its.notes)
    return (
        asked == its
        and one.form == other.form
        and one.statistics.mean == other.statistics.mean
        and np.array_equal(one.column, other.column, equal_nan=True)
    )
