"""The record's tables of definitions, each row with what the run made of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from xlmc.results.record.correlations_met import correlations_met
from xlmc.results.record.model import RecordTable, Section, Value
from xlmc.results.record.wording import cutoffs_text, limits_text, notes_text, parameters_text, status

if TYPE_CHECKING:
    from xlmc.definitions.model import Filter
    from xlmc.run.simulation import ForecastResult, Simulation

__all__ = ["assumption_section", "check_section", "correlation_section", "filter_section", "forecast_section", "plain"]

_FORECAST = (
    ("name", "Forecast"),
    ("cell", "Cell"),
    ("units", "Units"),
    ("range_share", "Range"),
    ("threshold", "Threshold"),
    ("trials", "Trials"),
    ("mean", "Mean"),
    ("standard_deviation", "Standard deviation"),
    ("low", "Range from"),
    ("high", "to"),
    ("notes", "Notes"),
)
_FILTER = (
    ("name", "Filter"),
    ("cell", "Cell"),
    ("limits", "Must be"),
    ("because", "Because"),
    ("rejected", "Rejected"),
    ("only", "Rejected by it alone"),
    ("errors", "Errors in it"),
    ("notes", "Notes"),
)
_CHECK = (
    ("name", "Check"),
    ("cell", "Cell"),
    ("base", "Base case"),
    ("tried", "Trials"),
    ("failed", "Failing"),
    ("because", "Because"),
    ("notes", "Notes"),
)
_ASSUMPTION = (
    ("name", "Assumption"),
    ("cell", "Cell"),
    ("status", "Status"),
    ("distribution", "Distribution"),
    ("parameters", "Parameters"),
    ("cutoffs", "Cut off"),
    ("base", "Base case"),
    ("units", "Units"),
    ("source", "Source"),
    ("notes", "Notes"),
)
_CORRELATION = (
    ("first", "First"),
    ("second", "Second"),
    ("rank_correlation", "Rank correlation"),
    ("used", "Drawn with"),
    ("accepted", "Accepted"),
    ("accepted_error", "±"),
    ("cell", "Row"),
)


def plain(value: float | None) -> float | None:
    """The number, or None where there is none: a record holds no NaN."""
    return value if value is not None and math.isfinite(value) else None


def forecast_section(simulation: Simulation) -> Section:
    """Every forecast with its main results at full precision, for a repeat to be compared with."""
    rows = tuple(_forecast_row(result) for result in simulation.results.values())
    return Section("forecasts", "Forecasts", table=RecordTable(_FORECAST, rows))


def _forecast_row(result: ForecastResult) -> tuple[Value, ...]:
    definition, statistics = result.definition, result.statistics
    estimates = (statistics.mean, statistics.standard_deviation, *statistics.central)
    return (
        definition.name,
        str(definition.cell),
        definition.units,
        definition.central,
        definition.threshold,
        statistics.trials,
        *(plain(estimate.value) for estimate in estimates),
        notes_text(definition.notes),
    )


def filter_section(simulation: Simulation) -> Section:
    """Every filter with its limits, its reason, and the trials it rejected."""
    rows = tuple(_filter_row(simulation, *found) for found in enumerate(simulation.model.filters))
    return Section("filters", "Filters", table=RecordTable(_FILTER, rows))


def _filter_row(simulation: Simulation, place: int, filter_: Filter) -> tuple[Value, ...]:
    tally = simulation.tally
    return (
        filter_.name,
        str(filter_.cell),
        limits_text(filter_),
        filter_.because,
        int(tally.rejected[place]),
        int(tally.only[place]),
        sum(tally.errors[place].values()),
        notes_text(filter_.notes),
    )


def check_section(simulation: Simulation) -> Section:
    """Every check with what its cell holds at the base case, and the accepted trials that fail it."""
    rows = tuple(
        (
            check.name,
            str(check.cell),
            check.base.found,
            check.trials,
            check.failed,
            check.because,
            notes_text(check.base.definition.notes),
        )
        for check in simulation.checks
    )
    return Section("checks", "Checks", table=RecordTable(_CHECK, rows))


def assumption_section(simulation: Simulation) -> Section:
    """Every assumption, drawn or not."""
    rows = tuple(
        (
            assumption.name,
            str(assumption.cell),
            status(simulation.model, assumption.name, assumption.frozen),
            assumption.distribution,
            parameters_text(assumption),
            cutoffs_text(assumption.lower_cutoff, assumption.upper_cutoff),
            assumption.base,
            assumption.units,
            assumption.source,
            notes_text(assumption.notes),
        )
        for assumption in simulation.model.assumptions
    )
    return Section("assumptions", "Assumptions", table=RecordTable(_ASSUMPTION, rows))


def correlation_section(simulation: Simulation) -> Section:
    """The rank correlations asked for, those drawn with, and those of the accepted trials."""
    rows = tuple(
        (
            met.first,
            met.second,
            met.asked,
            met.used,
            None if met.accepted is None else plain(met.accepted.value),
            None if met.accepted is None else plain(met.accepted.error),
            None if met.row is None else str(met.row),
        )
        for met in correlations_met(simulation)
    )
    return Section("correlations", "Correlations", table=RecordTable(_CORRELATION, rows))
