"""A run as the window draws it: charts, the numbers beside them, and how far they are from the state drawn behind."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from itertools import combinations
from typing import TYPE_CHECKING, Any, Final
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.record import make_record
from xlmc.analysis.results.statements.run_in_words import sampling_sentence
from xlmc.analysis.results.statements.sentences import statements
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.montecarlo.definitions.forms import PLAIN, Form, span_text
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.number_text import MOST_DIGITS, count_text, fixed_text, number_text, two_digit_exponent
from xlmc.montecarlo.statistics import (
    Estimate,
    Sample,
    maximum,
    minimum,
    percentiles,
    rank_correlation,
)
from xlmc.montecarlo.statistics.estimate import finite
from xlmc.outputs.document.content.answers import opening_sentences
from xlmc.outputs.document.content.scenarios import scenario_blocks
from xlmc.outputs.document.element import EMPTY, Html, element, join
from xlmc.outputs.document.html_writer import blocks_html
from xlmc.outputs.histogram import Figure, bars_of, multiples
from xlmc.outputs.live.protocol import Message
from xlmc.outputs.page.payload import axis_of, forecast_payload, form_json
from xlmc.outputs.page.sensitivity_sections import dependence, limits
from xlmc.outputs.page.sheet_sections import (
    assumptions,
    certainty,
    checks,
    filters,
    notices,
    record,
    statistics,
)
from xlmc.outputs.summary import SummaryRow, base_case, error_sentence, share_text, shares_of

if TYPE_CHECKING:
    from xlmc.analysis.studies.scenario_answers import ScenarioAnswers
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "Bases",
    "bases_of",
    "frame_of",
    "matrix_of",
    "matters_html",
    "pair_of",
    "rest_of",
    "scenarios_html",
    "tables_html",
]

_VALUES_MOVING: Final = 400
_VALUES_AT_REST: Final = 4_000
"""Values of a forecast that a chart counts between its grabbers from: `xlmc.outputs.page.payload` says how exactly."""

_PARTS: Final = 20
"""Parts of a bar, whose trials are counted apart, so that a window can draw more bars, or others."""

_PERCENTS: Final = (5.0, 25.0, 50.0, 75.0, 95.0)
_KNOWN: Final[WeakKeyDictionary[ForecastResult, list[tuple[str, Estimate]]]] = WeakKeyDictionary()
"""The estimates of each forecast: those of the state for comparison are asked for with every frame."""

_MEASURING: Final = 0.8
"""The share of the work that measuring takes, and not writing, where it is shown what matters."""

_POINTS: Final = 2_000
"""Accepted trials that a scatter shows."""

_MATRIX: Final = 6
"""Forecasts in a matrix of scatters: all pairs of more would be too small to be read."""
_MATRIX_POINTS: Final = 300
_RANKED: Final = 1 << 16
"""Trials that a matrix looks at: each rank correlation sorts them."""

Bases = Mapping[str, float | None]
"""Forecast -> its base case; None where that is no number."""


def frame_of(
    simulation: RunResult,
    behind: RunResult | None,
    names: Collection[str],
    base: Bases | None,
    *,
    moving: bool,
    fits: bool,
) -> Message:
    """Return the charts of some forecasts.

    Args:
        simulation: the run.
        behind: the run of the state that is drawn behind it; None where there is none.
        names: of the forecasts.
        base: of each forecast; None where there is no base case.
        moving: while a handle moves: fewer values to count from.
        fits: with fitted distributions, which take their time.
    """
    most = _VALUES_MOVING if moving else _VALUES_AT_REST
    charts: dict[str, Any] = dict.fromkeys(name for name in names if name in simulation.results)
    for name in charts:
        figure = _figure(simulation.results[name], None if base is None else base[name])
        if figure is not None and figure.answer.is_share:
            charts[name] = _shares(figure, None if behind is None else behind.results.get(name))
        elif figure is not None:
            payload = forecast_payload(simulation, figure, most, fits=fits)
            payload["bins"]["parts"] = figure.bins.in_parts(simulation.results[name].sample, _PARTS).tolist()
            charts[name] = payload | _beside(figure, simulation.results[name], behind)
    return {
        "trials": simulation.evaluated,
        "accepted": simulation.accepted,
        "share": share_text(simulation.acceptance),
        "few": simulation.has_few,
        "forecasts": charts,
    }


def bases_of(simulation: RunResult) -> Bases | None:
    """Return the base case of a run."""
    result = base_case(simulation)
    return None if result is None else result.forecasts


def _figure(result: ForecastResult, base: float | None) -> Figure | None:
    """Return a forecast to draw, with no other statistics than the window shows.

    None if it has no number, or if its weighted trials carry too little for a range.
    """
    definition, (low, high) = result.definition, result.central()
    if not result.sample.n:
        return None
    threshold = definition.threshold
    row = SummaryRow(
        name=definition.name,
        units=definition.units,
        trials=result.sample.n,
        mean=result.mean,
        standard_deviation=result.standard_deviation,
        share=definition.central,
        low=low,
        high=high,
        base=base,
        threshold=threshold,
        above=None if threshold is None else result.probability_above(threshold),
        yes=result.yes,
        kind=result.kind,
        form=result.form,
        categories=result.categories,
        numbers=result.numbers_of_texts,
    )
    bins = bars_of(row, result.sample)
    return None if bins is None else Figure(1, row, bins)


def _shares(figure: Figure, behind: ForecastResult | None) -> Message:
    """Return the share of each text, or of yes and no: name, share in words, in percent, and of the state behind."""
    now = shares_of(figure.answer)
    before: Mapping[str, Estimate] = {}
    if behind is not None and behind.sample.n:
        before = shares_of(behind)
    shown = [*dict.fromkeys([*now, *before])][:_MOST_TEXTS]
    nothing = Estimate(0.0)
    return {
        "name": figure.answer.name,
        "units": figure.answer.units,
        "shares": [
            [
                text or "(empty)",
                share_text(now[text]) if text in now else "0 %",
                100.0 * now.get(text, nothing).value,
                None if not before else 100.0 * before.get(text, nothing).value,
            ]
            for text in shown
        ],
    }


def _beside(figure: Figure, now: ForecastResult, behind: RunResult | None) -> dict[str, Any]:
    """Return the numbers beside a chart, and the state behind it."""
    before = None if behind is None else behind.results.get(figure.answer.name)
    if before is None or not before.sample.n or before.kind is not now.kind:
        beside = [[label, *_texts(label, each, None, now.form)] for label, each in _numbers(now)]
        return {"beside": beside, "said": None, "behind": None}
    pairs = zip(_numbers(now), _numbers(before), strict=True)
    return {
        "beside": [[label, *_texts(label, new, old, now.form)] for (label, new), (_, old) in pairs],
        "said": _moved(figure, now, before),
        "behind": _bars_behind(figure, before.sample),
    }


def _numbers(result: ForecastResult) -> list[tuple[str, Estimate]]:
    """Return the numbers that a reader of the chart asks for first."""
    if result not in _KNOWN:
        sample = result.sample
        results = percentiles(sample, _PERCENTS)
        _KNOWN[result] = [
            ("Mean", result.mean),
            (_SPREAD, result.standard_deviation),
            ("Minimum", minimum(sample)),
            *((f"{number_text(percent)} %", results[percent]) for percent in _PERCENTS),
            ("Maximum", maximum(sample)),
        ]
    return _KNOWN[result]


def _texts(label: str, now: Estimate, before: Estimate | None, form: Form) -> tuple[str, str, str]:
    """Write the number, the one before to the same decimal, and by how much it has changed."""
    written = form.spread if label == _SPREAD else form.estimate
    if before is None:
        return written(now), "", ""
    apart = now.value - before.value
    if not math.isfinite(apart):
        return written(now), written(before), ""
    if form.kind is Kind.DATE:
        return written(now), written(before), _sign(apart) + span_text(abs(apart))
    decimals, size = form.decimals_of_both(now, before), max(abs(now.value), abs(before.value))
    if decimals is not None and size and decimals + two_digit_exponent(form.factor * size) >= MOST_DIGITS:
        decimals = None  # an error below the last bit
    if decimals is None and apart:  # two numbers without an error, of which six digits are shown
        apart = round(apart, 5 - math.floor(math.log10(size)))
    shown, old = (form.estimate(each, decimals) for each in (now, before))
    return shown, old, _sign(apart) + form.number(abs(apart), decimals)


def _sign(number: float) -> str:
    return "+" if number > 0 else "−" if number < 0 else ""


def _moved(figure: Figure, now: ForecastResult, before: ForecastResult) -> str:
    """Say how the mean moved: `Nissan impact speed: mean 4.72 → 5.31 mph`."""
    units = f" {figure.answer.units}" if figure.answer.units else ""
    means, form = (before.mean, now.mean), now.form
    decimals = form.decimals_of_both(*means)
    old, new = (form.value(each) if decimals is None else form.number(each.value, decimals) for each in means)
    return f"{figure.answer.name}: mean {old} → {new}{units}"


_SPREAD: Final = "Standard deviation"

_MOST_TEXTS: Final = 30
"""Texts of one forecast that the window shows."""


def _bars_behind(figure: Figure, sample: Sample) -> dict[str, Any]:
    """Return the bars of the state behind, as wide as those before it, so that the two compare."""
    x, width = sample.even, figure.bins.width
    first, last = x[round(0.001 * (x.size - 1))], x[round(0.999 * (x.size - 1))]
    start, stop = math.floor(first / width), math.floor(last / width) + 1
    while stop - start > 400:  # it is much wider than the one before it
        width, start, stop = 2.0 * width, start // 2, stop // 2 + 1
    edges = multiples(width, start, stop - start + 1)
    counts = np.diff(np.searchsorted(x, edges, side="left"))
    return {
        "edges": edges.tolist(),
        "counts": counts.tolist(),
        "trials": int(x.size),
        "parts": figure.bins.width / width,
        "curve": [[float(x[round(share * (x.size - 1))]), 100.0 * share] for share in np.linspace(0.0, 1.0, 101)],
        "mean": finite(float(np.mean(x))),
    }


def rest_of(simulation: RunResult) -> Message:
    """Return what is said of a finished run: the answer in sentences, warnings, checks, what the filters rejected."""
    counts = zip(simulation.model.filters, simulation.tally.rejected, simulation.tally.only, strict=True)
    return {
        "sentences": [each.text for each in statements(simulation)],
        "meaning": error_sentence(simulation.model.workbook),
        "warnings": [str(each) for each in opening_sentences(simulation)],
        "notices": [str(each) for each in simulation.notices_of_run],
        "sampling": sampling_sentence(simulation),
        "evaluated": simulation.trials,
        "rejected": {each.name: [int(rejected), int(only)] for each, rejected, only in counts},
        "checks": [
            {"name": each.name, "cell": str(each.cell), "holds": each.holds, "failing": each.warnings}
            for each in simulation.checks
        ],
    }


def matters_html(simulation: RunResult, names: Collection[str], report_share: Callable[[float], None]) -> str:
    """Write which assumptions some answers depend on, and what another limit of a filter would change.

    Args:
        simulation: the run.
        names: of the forecasts.
        report_share: takes the share that is done.
    """
    if simulation.weighting is not None:
        note = "Each trial has a weight of its own, by the evidence; what matters is not known of such trials."
        return join([element("p", note, class_="remark")]).source
    chosen = [name for name in simulation.results if name in names]
    if not chosen:
        return _of_chosen(simulation, chosen).source
    result = sensitivities(simulation, chosen, progress=lambda share: report_share(_MEASURING * share))
    parts = [_of_chosen(simulation, chosen), dependence(result, simulation.model.workbook)]
    report_share(0.5 + _MEASURING / 2.0)
    return join([*parts, limits(result)]).source


def _of_chosen(simulation: RunResult, names: Sequence[str]) -> Html:
    """Say of how many answers a tab is, if it is not of all."""
    count, every = len(names), len(simulation.results)
    if count == every:
        return EMPTY
    note = f"Of {count} of {every} answers: those that are chosen above." if count else "Choose an answer above."
    return element("p", note, class_="remark")


def tables_html(simulation: RunResult, names: Collection[str], report_share: Callable[[float], None]) -> str:
    """Write the tables that the page of results has; of single forecasts, those of some. See `matters_html`."""
    chosen = [name for name in simulation.results if name in names]
    makers: tuple[Callable[[], Html], ...] = (
        lambda: statistics(simulation, chosen),
        lambda: certainty(simulation, chosen),
        *(partial(make, simulation) for make in (assumptions, filters, checks, notices)),
        lambda: record(make_record(simulation, None)),
    )
    parts = [_of_chosen(simulation, chosen)]
    for number, make in enumerate(makers):
        report_share(number / len(makers))
        parts.append(make())
    return join(parts).source


def scenarios_html(answers: Sequence[ScenarioAnswers], impossible: Mapping[str, str]) -> str:
    """Write the answers of scenarios beside those of the workbook itself, in tables.

    Args:
        answers: the workbook itself, then scenarios.
        impossible: why there are no answers of a scenario, by its name.
    """
    blocks = blocks_html(scenario_blocks(answers, impossible))
    return element("section", element("h2", "Scenarios"), blocks).source


def pair_of(simulation: RunResult, first: str, second: str) -> dict[str, Any] | None:
    """Return two quantities in the same accepted trials, for a scatter and an overlay; None if either is unknown.

    Args:
        simulation: the run.
        first: name of a forecast, or of an assumption that is drawn.
        second: likewise.
    """
    columns: Mapping[str, Any] = {**simulation.inputs, **simulation.forecasts}
    if first not in columns or second not in columns or not simulation.labels.keys().isdisjoint((first, second)):
        return None
    n = min(columns[first].size, columns[second].size, 50 * _POINTS)
    x, y = np.asarray(columns[first][:n]), np.asarray(columns[second][:n])
    if simulation.weighting is not None:
        chosen = simulation.weighting.even_rows(n)
        x, y = x[chosen], y[chosen]
    both = np.isfinite(x) & np.isfinite(y)
    x, y = x[both], y[both]
    return {
        "first": first,
        "second": second,
        "x": x[:_POINTS].tolist(),
        "y": y[:_POINTS].tolist(),
        "trials": int(x.size),
        "looked": n,
        "accepted": simulation.accepted,
        "correlation": finite(rank_correlation(x, y).value) if x.size > 2 else None,
        "quadrants": _quadrants(simulation, (first, second), x, y, n),
        "units": [_units(simulation, first), _units(simulation, second)],
        "forms": [form_json(_form(simulation, name)) for name in (first, second)],
        "together": _together(simulation, (first, second)),
    }


def matrix_of(simulation: RunResult, names: Collection[str]) -> dict[str, Any] | None:
    """Return some forecasts two at a time, for a matrix of scatters; None for fewer than two that vary.

    Of each two it has the rank correlation and the share of the trials in which both lie above their thresholds or
    medians, as the sheet Pairs.

    Args:
        simulation: the run; without weights.
        names: of forecasts, of which the first `_MATRIX` that have no texts are taken.
    """
    if simulation.weighting is not None:
        return None
    chosen = [name for name in simulation.results if name in names and name not in simulation.labels]
    columns: dict[str, NDArray[np.float64]] = {}
    bounds: list[tuple[float, str]] = []
    while chosen and len(columns) < _MATRIX:
        values = np.asarray(simulation.forecasts[name := chosen.pop(0)][:_RANKED])
        known = values[np.isfinite(values)]
        if known.size > 2 and np.ptp(known) > 0.0:
            columns[name] = values
            bounds.append(_limit(simulation, name, known))
    if len(columns) < 2:
        return None
    shown, cells = [*columns], []
    for (first, first_limit), (second, second_limit) in combinations(zip(shown, bounds, strict=True), 2):
        checkpoint()
        both = np.isfinite(columns[first]) & np.isfinite(columns[second])
        x, y = columns[first][both], columns[second][both]
        above = np.count_nonzero((x > first_limit[0]) & (y > second_limit[0])) / max(x.size, 1)
        related = finite(rank_correlation(x, y).value) if x.size > 2 else None
        cells.append({"first": first, "second": second, "correlation": related, "above": 100.0 * above})
    return {
        "names": shown,
        "left": len(chosen),
        "limits": [bound for bound, _ in bounds],
        "said": [message for _, message in bounds],
        "points": [[finite(float(value)) for value in columns[name][:_MATRIX_POINTS]] for name in shown],
        "cells": cells,
        "looked": min(_RANKED, simulation.accepted),
        "accepted": simulation.accepted,
    }


def _limit(simulation: RunResult, name: str, values: NDArray[np.float64]) -> tuple[float, str]:
    """Return the threshold of a forecast, or else the median of the trials, and what it is in words."""
    result = simulation.results.get(name)
    if result is not None and result.kind is Kind.YES_NO:
        return 0.5, f"{name} (a yes is above)"
    threshold = None if result is None else result.definition.threshold
    units, form = _units(simulation, name), _form(simulation, name)
    if threshold is not None:
        return threshold, f"{name} {form.number(threshold)}{units and ' '}{units} (threshold)"
    median, error = float(np.median(values)), float(np.std(values)) / math.sqrt(values.size)
    text = form.beside(median, Estimate(median, error or None))
    return median, f"{name} {text}{units and ' '}{units} (median)"


def _quadrants(
    simulation: RunResult, names: tuple[str, str], x: NDArray[np.float64], y: NDArray[np.float64], looked: int
) -> str:
    """Say in which shares of the trials both quantities, `(n,)` each, lie above a limit each, only one, or neither;
    nothing if one of them does not vary. `looked` is how many accepted trials they were looked for in.
    """
    if not x.size or not np.ptp(x) or not np.ptp(y):
        return ""
    (right_of, first_said), (over, second_said) = _limit(simulation, names[0], x), _limit(simulation, names[1], y)
    right, upper = x > right_of, y > over
    counts = (right & upper, right & ~upper, upper & ~right, ~(right | upper))
    both, first, second, neither = (f"{fixed_text(100.0 * np.count_nonzero(each) / x.size, 1)} %" for each in counts)
    of = "the trials" if looked >= simulation.accepted else f"the first {count_text(looked)} accepted trials"
    return (
        f"Above {first_said} and above {second_said}: {both} of {of}; only the first {first}, "
        f"only the second {second}, neither {neither}."
    )


def _together(simulation: RunResult, names: tuple[str, str]) -> list[dict[str, Any]]:
    """Return both as charts to be laid over each other; none if they are not two forecasts in one unit."""
    if names[0] == names[1] or not simulation.results.keys() >= {*names}:
        return []
    made = (_figure(result, None) for name, result in simulation.results.items() if name in names)
    figures = [each for each in made if each is not None]
    if len(figures) < 2 or len({axis_of(figure) for figure in figures}) > 1:
        return []
    if any(figure.answer.is_share for figure in figures):
        return []
    return [forecast_payload(simulation, figure, _VALUES_MOVING, fits=False) for figure in figures]


def _form(simulation: RunResult, name: str) -> Form:
    """Return how the numbers of a forecast are written; of an assumption nothing is known."""
    result = simulation.results.get(name)
    return PLAIN if result is None or result.kind is Kind.YES_NO else result.form


def _units(simulation: RunResult, name: str) -> str:
    model = simulation.model
    result = {each.name: each.units for each in model.assumptions} | {each.name: each.units for each in model.forecasts}
    return result.get(name, "")
