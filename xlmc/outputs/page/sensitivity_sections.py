"""The sections Sensitivity and Filter limits of the page: charts side by side, and the numbers below them folded."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from xlmc.outputs.document.content.limits import (
    NOT_MOVED,
    acceptance_table,
    answers_table,
    limit_figures,
    limit_heading,
    limit_sentences,
    slopes_table,
)
from xlmc.outputs.document.content.sensitivity import (
    influence_table,
    move_table,
    sensitivity_figures,
    sensitivity_sentences,
)
from xlmc.outputs.document.element import EMPTY, Html, element
from xlmc.outputs.document.html_writer import blocks_html
from xlmc.outputs.document.parts import Block

if TYPE_CHECKING:
    from xlmc.analysis.studies.sensitivity import FilterLimit, ForecastSensitivity, Sensitivities
    from xlmc.excel.workbook.workbook import Workbook

__all__ = ["dependence", "limits"]


def dependence(sensitivities: Sensitivities, source: Workbook) -> Html:
    """Return the section with what each forecast depends on; nothing if there is no forecast."""
    if not sensitivities.forecasts:
        return EMPTY
    return element(
        "section",
        element("h2", "Sensitivity: what the answers depend on"),
        *(element("p", message, class_="remark") for message in sensitivity_sentences(sensitivities, source)),
        *(_forecast(each, sensitivities) for each in sensitivities.forecasts),
        id="sensitivity",
    )


def _forecast(sensitivity: ForecastSensitivity, whole: Sensitivities) -> Html:
    heading = element("h3", sensitivity.forecast)
    if not sensitivity.influences and not sensitivity.bars:
        return element("article", heading, element("p", "No assumption moves it."))
    tables = [influence_table(sensitivity, whole.sobol_trials > 0)] if sensitivity.influences else []
    tables += [move_table(sensitivity)] if sensitivity.bars else []
    return _article(heading, sensitivity_figures(sensitivity, whole.sobol_trials), "The numbers", tables)


def limits(sensitivities: Sensitivities) -> Html:
    """Return the section with how the answers move with each limit; nothing if no filter has one."""
    if not (sensitivities.filter_limits or sensitivities.varying_limits or sensitivities.omitted_limits):
        return EMPTY
    forecasts = {each.forecast: each for each in sensitivities.forecasts}
    return element(
        "section",
        element("h2", "Filter limits: how the answers move as each limit moves"),
        *(element("p", message, class_="remark") for message in limit_sentences(sensitivities)),
        *(_limit(limit, forecasts) for limit in sensitivities.filter_limits),
        id="limits",
    )


def _limit(limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]) -> Html:
    heading = element("h3", limit_heading(limit))
    if not limit.points:
        return element("article", heading, element("p", NOT_MOVED))
    beside = element("div", blocks_html([acceptance_table(limit), slopes_table(limit)]))
    answers = [answers_table(limit, forecasts)]
    return _article(heading, limit_figures(limit, forecasts), "The answers at each limit", answers, beside)


def _article(
    heading: Html, drawn: Iterable[Block], summary: str, tables: Iterable[Block], beside: Html = EMPTY
) -> Html:
    """Return charts and what stands beside them, and tables that open when they are asked for."""
    drawings = element("div", blocks_html(drawn), beside, class_="drawings")
    numbers = element("details", element("summary", summary), blocks_html(tables))
    return element("article", heading, drawings, numbers, class_="sensitivity")
