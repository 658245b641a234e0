"""The sections Sensitivity and Filter limits of the page: influences, tornado, how the answers move with a limit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.analysis.results.statements.in_words import number_text
from xlmc.analysis.studies.sensitivity.measures import noise
from xlmc.outputs.page.element import EMPTY, Html, element
from xlmc.outputs.page.flow import Flow
from xlmc.outputs.page.svg import Bar, Line, bars, lines
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
    from xlmc.montecarlo.statistics import Estimate

__all__ = ["dependence", "limits"]


def dependence(found: Sensitivities) -> Html:
    """The section with what each forecast depends on; nothing where there is no forecast."""
    if not found.forecasts:
        return EMPTY
    return element(
        "section",
        element("h2", "Sensitivity: what the answers depend on"),
        *(element("p", said, class_="remark") for said in sensitivity_sentences(found)),
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
        drawn, weak = found.influences[:BARS], noise(found)[:BARS]
        explained, _, _, contribution = influence_captions(found, whole.sobol_trials)
        shares = [_share(each.assumption, each.explained, one.explained) for each, one in zip(drawn, weak, strict=True)]
        yield _figure(bars(shares, "Variance explained", "Share of the variance, %"), explained)
        scaled = [
            _share(each.assumption, each.contribution, one.correlation) for each, one in zip(drawn, weak, strict=True)
        ]
        title = "Contribution to variance (approximate)"
        yield _figure(bars(scaled, title, "Squared rank correlation, % of all, signed"), contribution)
    if found.bars and found.base is not None:
        units = f", {found.units}" if found.units else ""
        tornado = [_tornado_bar(each.assumption, each.low, each.high, found.base) for each in found.bars[:BARS]]
        axis = f"Change{units} (light: at 10 %, dark: at 90 %)"
        yield _figure(bars(tornado, "Tornado", axis), move_captions(found)[0])


def _share(name: str, found: Estimate, pale: bool) -> Bar:
    value = 100.0 * found.value if math.isfinite(found.value) else 0.0
    error = None if found.error is None else 100.0 * found.error
    whisker = None if error is None else (value - error, value + error)
    return Bar(name, ((0.0, value, "light" if pale else "dark"),), whisker)


def _tornado_bar(name: str, low: float | None, high: float | None, base: float) -> Bar:
    ends = ((low, "light"), (high, "dark"))
    return Bar(name, tuple((0.0, end - base, look) for end, look in ends if end is not None))


def _figure(drawing: Html, caption: str) -> Html:
    return element("figure", drawing, element("figcaption", caption))


def _tables(found: ForecastSensitivity, whole: Sensitivities) -> Iterator[Html]:
    flow = Flow()
    if found.influences:
        write_influences(flow, found, whole.sobol_trials > 0)
    if found.bars:
        write_moves(flow, found)
    yield element("details", element("summary", "The numbers"), flow.html)


def limits(found: Sensitivities) -> Html:
    """The section with how the answers move with each limit; nothing where no filter has one."""
    if not (found.filter_limits or found.varying_limits or found.omitted_limits):
        return EMPTY
    units = {each.forecast: each.units for each in found.forecasts}
    return element(
        "section",
        element("h2", "Filter limits: how the answers move as each limit moves"),
        *(element("p", said, class_="remark") for said in limit_sentences(found)),
        *(_limit(limit, units) for limit in found.filter_limits),
        id="limits",
    )


def _limit(limit: FilterLimit, units: dict[str, str]) -> Html:
    heading = element("h3", f"{limit.filter}: {limit.relation} {number_text(limit.limit)} ({limit.cell})")
    if not limit.points:
        said = "The accepted trials do not say by how much it could be moved."
        return element("article", heading, element("p", said))
    flow, answers = Flow(), Flow()
    write_acceptance(flow, limit)
    write_answers(answers, limit)
    numbers = element("details", element("summary", "The answers at each limit"), answers.html)
    drawings = element("div", *_answer_charts(limit, units), element("div", flow.html), class_="drawings")
    return element("article", heading, drawings, numbers, class_="sensitivity")


def _answer_charts(limit: FilterLimit, units: dict[str, str]) -> Iterator[Html]:
    """A chart for the forecasts of each unit: changes in different units have no common axis."""
    by_unit: dict[str, list[int]] = {}
    for index, slope in enumerate(limit.slopes):
        by_unit.setdefault(units[slope.forecast], []).append(index)
    for unit, indexes in by_unit.items():
        drawn = [
            Line(
                limit.slopes[index].forecast,
                tuple((p.limit, p.answers[index].change.value, p.answers[index].change.error) for p in limit.points),
            )
            for index in indexes
        ]
        upwards = f"Change of the mean{f', {unit}' if unit else ''}"
        across = f"Limit: {limit.filter} {limit.relation}"
        names = "; ".join(f"{number} {line.name}" for number, line in enumerate(drawn, 1))
        chart = lines(drawn, "Change of each mean", across, upwards, limit.limit)
        yield _figure(chart, f"{names}. {moved_caption(limit)}")
