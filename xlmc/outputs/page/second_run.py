"""A second run beside the first: both answers with their differences, and what the two runs were given."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.analysis.results.statements.in_words import distribution_text, limits_text
from xlmc.analysis.results.statements.run_in_words import status
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.number_text import count_text, counted_text, exact_text, percent
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs.document.element import EMPTY, Html, element, join
from xlmc.outputs.document.html_writer import estimate_html, share_html
from xlmc.outputs.summary import SummaryRow, summarise

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["partner_of", "second_run"]

_DIFFERENCE = (
    "Difference: second minus first. Its ± is that of independent runs. Runs of one seed share the draws of "
    "assumptions with the same name, so their difference is usually known better: xlmc compare runs two workbooks "
    "over the same trials, and says how well."
)
_SAME = "Both runs were given the same assumptions and filters."
_FILES = "Fixed values and formulas are not compared: files with the same fingerprint have the same."
_ABSENT = "—"

_Given = dict[tuple[str, str], tuple[str, str]]
"""What a run was given: kind and key -> its name, and what is said of it."""


def second_run(first: RunResult, second: RunResult) -> Html:
    """Return the section that says what the second run is, and how its answers differ."""
    model, rows = second.model, summarise(first)
    message = (
        f": {counted_text(second.evaluated, 'trial')}, {count_text(second.accepted)} accepted; seed "
        f"{second.settings.seed}. In each chart the "
        "dashed purple line is the second run, as if it had as many accepted trials as the first; its certainty stands "
        "below that of the first."
    )
    pairs = [(row, partner) for row in rows if (partner := partner_of(row, second)) is not None]
    return element(
        "section",
        element("h2", "Beside a second run"),
        element("p", "The second run is of ", element("bdi", model.workbook.name), message),
        _answers(pairs) if pairs else EMPTY,
        element("p", _DIFFERENCE, class_="remark") if pairs else EMPTY,
        *(element("p", sentence, class_="remark") for sentence in _alone(rows, second)),
        element("h3", "What the two runs were given"),
        _given(first, second),
        id="second",
    )


def partner_of(row: SummaryRow, second: RunResult) -> SummaryRow | None:
    """Return the second run's forecast of the same name and units, if some accepted trial has a number; else None."""
    for each in summarise(second):
        if name_key(each.name) == name_key(row.name) and each.units == row.units and each.trials:
            return each
    return None


def _answers(pairs: list[tuple[SummaryRow, SummaryRow]]) -> Html:
    heads = ("Forecast", "", "First", "Second", "Difference")
    head = element(
        "tr", *(element("th", text, scope="col", class_="number" if text in heads[2:] else None) for text in heads)
    )
    bodies = (element("tbody", *_lines(first, second)) for first, second in pairs)
    return element("div", element("table", element("thead", head), *bodies), class_="wide-table paired-runs")


def _lines(first: SummaryRow, second: SummaryRow) -> Iterator[Html]:
    lines = list(_numbers(first, second))
    for index, (what, mine, theirs, as_share) in enumerate(lines):
        written = share_html if as_share else estimate_html
        cells = (element("td", written(each), class_="number") for each in (mine, theirs, _difference(mine, theirs)))
        named = f"{first.name}, {first.units}" if first.units else first.name
        name = EMPTY if index else element("th", named, scope="rowgroup", rowspan=str(len(lines)))
        yield element("tr", name, element("td", what), *cells)


def _numbers(first: SummaryRow, second: SummaryRow) -> Iterator[tuple[str, Estimate, Estimate, bool]]:
    """Yield each statistic's name, its values in the first and the second run, and whether it is a share."""
    if first.yes is not None and second.yes is not None:
        yield "Yes", first.yes, second.yes, True
        return
    yield "Mean", first.mean, second.mean, False
    yield "Standard deviation", first.standard_deviation, second.standard_deviation, False
    if first.share == second.share:
        yield f"Central {percent(first.share)} from", first.low, second.low, False
        yield "to", first.high, second.high, False
    threshold = first.threshold if first.threshold == second.threshold else None
    if threshold is not None and first.above is not None and second.above is not None:
        yield f"Above {exact_text(threshold)}", first.above, second.above, True


def _difference(first: Estimate, second: Estimate) -> Estimate:
    error = None if first.error is None or second.error is None else math.hypot(first.error, second.error)
    return Estimate(second.value - first.value, error)


def _alone(rows: list[SummaryRow], second: RunResult) -> Iterator[str]:
    shown = {name_key(row.name) for row in rows if partner_of(row, second) is not None}
    others = ("first", rows), ("second", summarise(second))
    for which, result in others:
        names = [row.name for row in result if name_key(row.name) not in shown]
        if names:
            yield f"Of the {which} run alone, by name and units: {'; '.join(names)}."


def _given_to(run: RunResult) -> _Given:
    model = run.model
    result = {("Run", what): (what, message) for what, message in _settings(run)}
    for a in model.assumptions:
        form = model.input_forms.get(a.name, PLAIN)
        words = f"held at {form.number(a.base)}" if a.frozen and a.base is not None else distribution_text(a)
        unused = "" if status(model, a.name, a.frozen) in ("drawn", "frozen") else ", not needed"
        result["Assumption", name_key(a.name)] = a.name, words + unused
    return result | {("Filter", name_key(f.name)): (f.name, limits_text(f)) for f in model.filters}


def _settings(run: RunResult) -> Iterator[tuple[str, str]]:
    yield "Workbook", run.model.workbook.name
    yield "Fingerprint", run.model.workbook.sha256[:16]
    yield "Seed", str(run.settings.seed)
    yield "Trials", count_text(run.evaluated)
    yield "Accepted", count_text(run.accepted)
    yield "Sampling", run.settings.sampling
    yield "Engine", run.settings.engine


def _given(first: RunResult, second: RunResult) -> Html:
    mine, theirs = _given_to(first), _given_to(second)
    rows = [
        (
            kind,
            (mine.get((kind, key)) or theirs[kind, key])[0],
            *(_in_words(each, kind, key) for each in (mine, theirs)),
        )
        for kind, key in dict.fromkeys((*mine, *theirs))
    ]
    differing = [row for row in rows if row[2] != row[3]]
    same = all(kind == "Run" for kind, *_ in differing)
    remark = element("p", f"{_SAME} {_FILES}" if same else _FILES, class_="remark")
    if not differing:
        return remark
    head = element("tr", *(element("th", text, scope="col") for text in ("", "What differs", "First", "Second")))
    body = (
        element("tr", element("td", kind), element("th", name, scope="row"), element("td", one), element("td", other))
        for kind, name, one, other in differing
    )
    table = element("table", element("thead", head), element("tbody", *body))
    return join([remark, element("div", table, class_="wide-table")])


def _in_words(given: _Given, kind: str, key: str) -> str:
    return given[kind, key][1] if (kind, key) in given else _ABSENT
