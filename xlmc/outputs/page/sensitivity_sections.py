"""The sections Sensitivity and Filter limits of the page: influences, tornado, how the answers move with a limit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from xlmc.analysis.results.statements.in_words import given_text
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.outputs.document.charts import contribution_chart, influence_chart, limit_chart, tornado_chart
from xlmc.outputs.document.element import EMPTY, Html, element
from xlmc.outputs.document.html_writer import picture_html
from xlmc.outputs.document.parts import Chart
from xlmc.outputs.page.flow import Flow
from xlmc.outputs.sheets.limits_sheet import limit_sentences, moved_caption, write_acceptance, write_answers
from xlmc.outputs.sheets.sensitivity_sheet import (
    BARS,
    influence_captions,
    move_captions,
    sensitivity_sentences,
    write_influences,
    write_moves,
)

if TYPE_CHECKING:
    from xlmc.analysis.studies.sensitivity import FilterLimit, ForecastSensitivity, Sensitivities
    from xlmc.excel.workbook.workbook import Workbook

__all__ = ["dependence", "limits"]


def dependence(found: Sensitivities, source: Workbook) -> Html:
    """Return the section with what each forecast depends on; nothing if there is no forecast."""
    if not found.forecasts:
        return EMPTY
    return element(
        "section",
        element("h2", "Sensitivity: what the answers depend on"),
        *(element("p", said, class_="remark") for said in sensitivity_sentences(found, source)),
        *(_forecast(each, found) for each in found.forecasts),
        id="sensitivity",
    )


def _forecast(found: ForecastSensitivity, whole: Sensitivities) -> Html:
    if not found.influences and not found.bars:
        return element("article", element("h3", found.forecast), element("p", "No assumption moves it."))
    charts = element("div", *_charts(found, whole), class_="drawings")
    return element("article", element("h3", found.forecast), charts, *_tables(found, whole), class_="sensitivity")


def _charts(found: ForecastSensitivity, whole: Sensitivities) -> Iterator[Html]:
    if found.influences:
        explained, _, _, contribution = influence_captions(found, whole.sobol_trials)
        yield _figure(influence_chart(found, BARS, "Variance explained"), explained)
        yield _figure(contribution_chart(found, BARS, "Contribution to variance (approximate)"), contribution)
    if found.bars and found.base is not None:
        yield _figure(tornado_chart(found, BARS, "Tornado"), move_captions(found)[0])


def _figure(chart: Chart, caption: str) -> Html:
    return element("figure", picture_html(chart), element("figcaption", caption) if caption else EMPTY)


def _tables(found: ForecastSensitivity, whole: Sensitivities) -> Iterator[Html]:
    flow = Flow()
    if found.influences:
        write_influences(flow, found, whole.sobol_trials > 0)
    if found.bars:
        write_moves(flow, found)
    yield element("details", element("summary", "The numbers"), flow.html)


def limits(found: Sensitivities) -> Html:
    """Return the section with how the answers move with each limit; nothing if no filter has one."""
    if not (found.filter_limits or found.varying_limits or found.omitted_limits):
        return EMPTY
    forecasts = {each.forecast: each for each in found.forecasts}
    return element(
        "section",
        element("h2", "Filter limits: how the answers move as each limit moves"),
        *(element("p", said, class_="remark") for said in limit_sentences(found)),
        *(_limit(limit, forecasts) for limit in found.filter_limits),
        id="limits",
    )


def _limit(limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]) -> Html:
    heading = element("h3", f"{limit.filter}: {limit.relation} {given_text(limit.limit)} ({limit.cell})")
    if not limit.points:
        said = "The accepted trials do not say by how much it could be moved."
        return element("article", heading, element("p", said))
    flow, answers = Flow(), Flow()
    write_acceptance(flow, limit)
    write_answers(answers, limit, forecasts)
    numbers = element("details", element("summary", "The answers at each limit"), answers.html)
    drawings = element("div", *_answer_charts(limit, forecasts), element("div", flow.html), class_="drawings")
    return element("article", heading, drawings, numbers, class_="sensitivity")


def _answer_charts(limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]) -> Iterator[Html]:
    """Yield a chart for the forecasts of each unit and kind: changes in different units have no common axis."""
    alike: dict[tuple[str, Form], list[int]] = {}
    for index, slope in enumerate(limit.slopes):
        each = forecasts[slope.forecast]
        form = replace(each.form, report_to=None)
        alike.setdefault((each.change_units, form if any(form.affixes) else PLAIN), []).append(index)
    for number, ((unit, form), indexes) in enumerate(alike.items()):
        shown = forecasts[limit.slopes[indexes[0]].forecast].change_form if form != PLAIN else PLAIN
        yield _figure(limit_chart(limit, indexes, unit, shown), "" if number else moved_caption(limit))
