"""Statements, certainties, pairs and sensitivities as JSON: their dataclasses, field by field."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

from xlmc.report.data.estimate_json import estimate_json, number_json
from xlmc.results.statements import certainties, pairs_of, statements
from xlmc.statistics import Estimate
from xlmc.studies.sensitivity import sensitivities

if TYPE_CHECKING:
    from xlmc.results.statements import Pair
    from xlmc.run.simulation import ForecastResult, Simulation

__all__ = ["certainties_json", "pairs_json", "sensitivity_json", "statements_json"]

Json = dict[str, Any]


def statements_json(simulation: Simulation) -> list[Json]:
    """The sentences to be quoted."""
    return [as_json(each) for each in statements(simulation)]


def certainties_json(result: ForecastResult) -> list[Json]:
    """The shares of the accepted trials in ranges; an end is null where the range has none."""
    return [as_json(each) for each in certainties(result)]


def pairs_json(simulation: Simulation) -> list[Json]:
    """Forecasts two at a time."""
    return [_pair(each) for each in pairs_of(simulation)]


def sensitivity_json(simulation: Simulation) -> Json:
    """What the answers depend on."""
    found: Json = as_json(sensitivities(simulation))
    return found


def _pair(pair: Pair) -> Json:
    others = (field.name for field in fields(pair) if field.name not in ("first", "second"))
    return {"first": pair.first.name, "second": pair.second.name} | {
        name: as_json(getattr(pair, name)) for name in others
    }


def as_json(value: Any) -> Any:
    """Dataclasses as objects, tuples as lists, estimates with their reasons, and null for what is no number."""
    if isinstance(value, Estimate):
        return estimate_json(value)
    if isinstance(value, float):
        return number_json(value)
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, tuple | list):
        return [as_json(each) for each in value]
    return {field.name: as_json(getattr(value, field.name)) for field in fields(value)}
