"""The errors a run met in cells: where, which, in how many trials."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.address import Cell
from xlmc.definitions.model import name_key

if TYPE_CHECKING:
    from xlmc.simulation import Simulation

__all__ = ["ErrorMet", "errors_met"]


@dataclass(frozen=True, slots=True)
class ErrorMet:
    """One kind of error in one cell.

    Attributes:
        kind: `filter`, `forecast` or `assumption`.
        error: the Excel error, `text`, `blank`, or what is wrong with the parameters.
        trials: all trials for filters and assumptions, accepted ones for forecasts.
    """

    kind: str
    name: str
    cell: Cell
    error: str
    trials: int


def errors_met(simulation: Simulation) -> list[ErrorMet]:
    """Every kind of error met, in the order of the definitions."""
    return list(_errors(simulation))


def _errors(simulation: Simulation) -> Iterator[ErrorMet]:
    model = simulation.model
    for filter_, errors in zip(model.filters, simulation.tally.errors, strict=True):
        yield from _of("filter", filter_.name, filter_.cell, errors)
    for forecast in model.forecasts:
        yield from _of("forecast", forecast.name, forecast.cell, simulation.faults[forecast.name])
    for assumption in model.assumptions:
        invalid = Counter({"parameters are no distribution": simulation.invalid[name_key(assumption.name)]})
        yield from _of("assumption", assumption.name, assumption.cell, invalid)


def _of(kind: str, name: str, cell: Cell, errors: Counter[str]) -> Iterator[ErrorMet]:
    for error, count in sorted(errors.items()):
        if count:
            yield ErrorMet(kind, name, cell, error, count)
