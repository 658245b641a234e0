"""The record's tables of definitions, each row with its results in the run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from xlmc.analysis.results.record.record_parts import RecordTable, Section, Value
from xlmc.analysis.results.statements.in_words import (
    cutoffs_text,
    evidence_text,
    given_text,
    limits_text,
    notes_text,
    parameters_text,
)
from xlmc.analysis.results.statements.run_in_words import discards_of, status
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.stating import Role
from xlmc.montecarlo.model.cell_forms import content_in, forms_of
from xlmc.montecarlo.model.correlating import CHANGED, drawn_correlation
from xlmc.montecarlo.statistics import Estimate, rank_correlation
from xlmc.montecarlo.statistics.estimate import finite

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Filter, Forecast
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "CorrelationMet",
    "assumption_section",
    "check_section",
    "correlation_section",
    "correlations_met",
    "decision_section",
    "evidence_section",
    "filter_section",
    "forecast_filter_section",
    "forecast_section",
    "solve_section",
]


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
_CERTAINTY = (("certainty_from", "Certainty from"), ("certainty_to", "to"), ("certainty", "Certainty"))
"""Columns of forecasts where a range was asked for."""

_STATED = (("report_to", "Report to"), ("kind", "Kind"), ("role", "Role"))
"""Columns of forecasts where rows say how they are to be stated."""

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
_FORECAST_FILTER = (
    ("name", "Filter"),
    ("only_for", "Only for"),
    ("cell", "Cell"),
    ("limits", "Must be"),
    ("because", "Because"),
    ("discarded", "Discarded"),
    ("notes", "Notes"),
)
_DECISION = (
    ("name", "Decision"),
    ("cell", "Cell"),
    ("value", "Value"),
    ("units", "Units"),
    ("may be", "May be"),
)
_SOLVE = (
    ("name", "Solution"),
    ("cell", "Cell"),
    ("to", "To"),
    ("by", "By"),
    ("low", "Low"),
    ("high", "High"),
    ("root", "Root"),
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
_EVIDENCE = (
    ("name", "Evidence"),
    ("cell", "Cell"),
    ("reading", "Reading and error"),
    ("source", "Source"),
    ("kept", "Share kept alone"),
    ("chance", "Chance of such a reading"),
    ("verdict", "Verdict"),
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


def forecast_section(simulation: RunResult) -> Section:
    """Every forecast with its main results at full precision, for a repeat to be compared with."""
    results = simulation.results.values()
    columns: tuple[tuple[str, str], ...] = _FORECAST
    rows = [_forecast_row(result) for result in results]
    if any(result.definition.asked for result in results):
        columns = (*columns, *_CERTAINTY)
        rows = [row + _certainty_cells(result) for row, result in zip(rows, results, strict=True)]
    if any(result.definition.says_how for result in results):
        columns = (*columns, *_STATED)
        rows = [row + _stated_cells(result.definition) for row, result in zip(rows, results, strict=True)]
    return Section("forecasts", "Forecasts", table=RecordTable(columns, tuple(rows)))


def _certainty_cells(result: ForecastResult) -> tuple[Value, ...]:
    low, high = result.definition.asked or (None, None)
    return finite(low), finite(high), None if result.certainty is None else finite(result.certainty.value)


def _stated_cells(forecast: Forecast) -> tuple[Value, ...]:
    """How a forecast is stated; that it is an answer, as most are, is not repeated."""
    role = "" if forecast.role is Role.ANSWER else forecast.role.value
    return forecast.report_to, "" if forecast.kind is None else forecast.kind.value, role


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
        *(finite(estimate.value) for estimate in estimates),
        notes_text(definition.notes),
    )


def filter_section(simulation: RunResult) -> Section:
    """Every filter with its limits, its reason, and the trials it rejected; then those that are not used."""
    rows = [_filter_row(simulation, *result) for result in enumerate(simulation.model.filters)]
    idle = simulation.model.definitions.unused
    rows += [(*_filter_cells(each), None, None, None, notes_text(each.notes)) for each in idle]
    return Section("filters", "Filters", table=RecordTable(_FILTER, tuple(rows)))


def _filter_row(simulation: RunResult, index: int, filter_: Filter) -> tuple[Value, ...]:
    tally = simulation.tally
    return (
        *_filter_cells(filter_),
        int(tally.rejected[index]),
        int(tally.only[index]),
        sum(tally.errors[index].values()),
        notes_text(filter_.notes),
    )


def _filter_cells(filter_: Filter) -> tuple[Value, ...]:
    return filter_.name, str(filter_.cell), limits_text(filter_), filter_.because


def forecast_filter_section(simulation: RunResult) -> Section:
    """Every filter of some forecasts only, a row for each of them, with the accepted trials that it discards."""
    rows = tuple(
        (
            each.filter.name,
            each.forecast,
            str(each.filter.cell),
            limits_text(each.filter),
            each.filter.because,
            each.trials,
            notes_text(each.filter.notes),
        )
        for each in discards_of(simulation)
    )
    return Section("forecast_filters", "Filters for some forecasts only", table=RecordTable(_FORECAST_FILTER, rows))


def evidence_section(simulation: RunResult) -> Section:
    """Every row of `xlmc_evidence`, and what was found of those that are used."""
    result = {} if simulation.agreement is None else {each.name: each for each in simulation.agreement.items}
    rows = []
    for each in simulation.model.evidence:
        judged = result.get(each.name)
        judgement: tuple[Value, ...] = (None, None, "not used")
        if judged is not None:
            judgement = finite(judged.alone.value), finite(judged.chance), judged.verdict.value
        described = (each.name, str(each.cell), evidence_text(each), each.source)
        rows.append((*described, *judgement, notes_text(each.notes)))
    return Section("evidence", "Evidence", table=RecordTable(_EVIDENCE, tuple(rows)))


def check_section(simulation: RunResult) -> Section:
    """Every check with what its cell holds at the base case, and the accepted trials that fail it."""
    rows = tuple(
        (
            check.name,
            str(check.cell),
            check.base.content,
            check.trials,
            check.failed,
            check.because,
            notes_text(check.base.definition.notes),
        )
        for check in simulation.checks
    )
    return Section("checks", "Checks", table=RecordTable(_CHECK, rows))


def decision_section(simulation: RunResult) -> Section:
    """Every decision, with what its cell holds in this run."""
    workbook, decisions = simulation.model.workbook, simulation.model.definitions.decisions
    forms = forms_of(workbook, [each.cell for each in decisions])
    rows = tuple(
        (each.name, str(each.cell), content_in(form, workbook.content(each.cell).value), each.units, each.values_text)
        for each, form in zip(decisions, forms, strict=True)
    )
    return Section("decisions", "Decisions", table=RecordTable(_DECISION, rows))


def solve_section(simulation: RunResult) -> Section:
    """Every cell that is solved for."""
    rows = tuple(
        (
            each.name,
            str(each.cell),
            given_text(each.to, each.form),
            str(each.by),
            given_text(each.low, each.form_by),
            given_text(each.high, each.form_by),
            each.root or "only",
        )
        for each in simulation.model.definitions.solves
    )
    return Section("solves", "Cells that are solved for", table=RecordTable(_SOLVE, rows))


def assumption_section(simulation: RunResult) -> Section:
    """Every assumption, drawn or not."""
    rows: list[tuple[Value, ...]] = []
    for assumption in simulation.model.assumptions:
        described = status(simulation.model, assumption.name, assumption.frozen), assumption.distribution
        given = parameters_text(assumption), cutoffs_text(assumption), assumption.base
        notes = assumption.units, assumption.source, notes_text(assumption.notes)
        rows.append((assumption.name, str(assumption.cell), *described, *given, *notes))
    return Section("assumptions", "Assumptions", table=RecordTable(_ASSUMPTION, tuple(rows)))


def correlation_section(simulation: RunResult) -> Section:
    """Return the rank correlations asked for, those drawn with, and those of the accepted trials."""
    rows = tuple(
        (
            met.first,
            met.second,
            met.asked,
            met.used,
            None if met.accepted is None else finite(met.accepted.value),
            None if met.accepted is None else finite(met.accepted.error),
            None if met.row is None else str(met.row),
        )
        for met in correlations_met(simulation)
    )
    return Section("correlations", "Correlations", table=RecordTable(_CORRELATION, rows))


@dataclass(frozen=True, slots=True)
class CorrelationMet:
    """A pair of assumptions.

    Attributes:
        asked: the rank correlation in its row, or that of its copula; 0 where it has neither.
        row: its first cell, or that of the copula; None if a repair changed a pair that no row names.
        used: the rank correlation that it was drawn with; None if one of the two was not drawn.
        accepted: that of the accepted trials whose draws are kept; None if one of the two was not drawn, or where
            trials are weighted.
    """

    first: str
    second: str
    asked: float
    row: Cell | None
    used: float | None = None
    accepted: Estimate | None = None


def correlations_met(simulation: RunResult) -> list[CorrelationMet]:
    """Return the pairs in the order of the rows, then those that a repair changed without a row."""
    model = simulation.model
    pairs = [(c.first, c.second, c.number, c.row) for c in model.definitions.correlations]
    return [_met(simulation, *pair) for pair in (*pairs, *_unnamed(simulation))]


def _unnamed(simulation: RunResult) -> Iterator[tuple[str, str, float, Cell | None]]:
    model = simulation.model
    named = {frozenset((c.first, c.second)) for c in model.definitions.correlations}
    for group in model.groups:
        for first, second in combinations(group.names, 2):
            value = drawn_correlation(model.groups, first, second)
            if frozenset((first, second)) not in named and value is not None and abs(value) >= CHANGED:
                yield first, second, 0.0 if group.where is None else value, group.where


def _met(simulation: RunResult, first: str, second: str, asked: float, row: Cell | None) -> CorrelationMet:
    drawn = drawn_correlation(simulation.model.groups, first, second)
    if drawn is None:
        return CorrelationMet(first, second, asked, row)
    if simulation.weighting is not None:
        return CorrelationMet(first, second, asked, row, drawn)
    x, y = simulation.inputs[first], simulation.inputs[second]
    replicate, both = simulation.replicate, ~(np.isnan(x) | np.isnan(y))
    accepted = rank_correlation(x[both], y[both], None if replicate is None else replicate[: x.size][both])
    return CorrelationMet(first, second, asked, row, drawn, accepted)
