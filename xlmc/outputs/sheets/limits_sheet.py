"""The sheet Filter limits: how the answers move as each limit of each filter moves.

The charts of all limits come first and are printed; below them each limit has its tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.in_words import given_text
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.sheets.sensitivity_charts import (
    CHART_ROWS,
    CHARTED,
    RIGHT,
    WIDTHS,
    Captioned,
    TableAt,
    limit_chart,
    place_rows,
)
from xlmc.outputs.sheets.styles import bounds

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.analysis.studies.sensitivity import (
        FilterLimit,
        ForecastSensitivity,
        LimitAnswer,
        LimitPoint,
        Sensitivities,
    )
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "limit_sentences", "moved_caption", "write_acceptance", "write_answers", "write_limits"]

_LAST: Final = len(WIDTHS) - 1
_PRINTED: Final = (
    "Only the changes of the means are printed. The shares of trials accepted, the slopes and the numbers of all "
    "charts are below, and are not printed unless you clear the print area."
)
_FIRST_ROWS: Final = 12
"""Rows of the sheet that each of the first charts covers: a page has room for eight."""
_MOVED: Final = (
    "Charts: how far each forecast's mean moves from that with the limit as it is; whiskers are standard errors of the "
    "change. Other filters and limits stay."
)
_LIMIT, _CHANGE, _OF_RANGE = 1, 4, 10
"""Columns of the long table."""


def write_limits(page: Page, book: Workbook, found: Sensitivities, name: str) -> None:
    """Write the sheet; its first charts draw the tables that stand below them, so room is left for them."""
    page.title("Filter limits: how the answers move as each limit moves", name)
    for sentence in (*limit_sentences(found), f"{_MOVED} {_PRINTED}"):
        page.wide(sentence, "remark", CHARTED)
    forecasts = {each.forecast: each for each in found.forecasts}
    page.row += 1
    top, drawn = page.row, sum(bool(limit.points) for limit in found.filter_limits)
    for _ in range(0, drawn, 2):
        page.may_begin()
        page.row += _FIRST_ROWS + 1
    printed = page.row
    charts: list[Captioned] = []
    for limit in found.filter_limits:
        charts += _write_limit(page, book, limit, forecasts)
    page.row = top
    place_rows(page, charts, _FIRST_ROWS, [_brief(limit) for limit in found.filter_limits if limit.points])
    page.set_up_printing(name, printed=printed, columns=(0, CHARTED))


def limit_sentences(found: Sensitivities) -> list[str]:
    """Sentences that say what moving a limit means."""
    said = [
        "One limit is moved; all others stay. A tighter limit keeps some of the accepted trials. A looser one also "
        "accepts trials that nothing else rejects; these come from the run's first trials, so their errors are larger. "
        "Changes and slopes compare runs that share trials, and their errors allow for that. A limit is evidence: "
        "this sheet shows how much its exact value matters, not which value is right."
    ]
    if found.varying_limits:
        said.append(f"Not moved, because the limit varies with the assumptions: {', '.join(found.varying_limits)}.")
    if found.omitted_limits:
        said.append(
            f"{count_text(found.omitted_limits)} further limits were left out: the last of very many, "
            "or all of them where "
            "accepted trials are rare, because trials near a limit are then not among those drawn before the search."
        )
    return said


def _write_limit(
    page: Page, book: Workbook, limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]
) -> list[Captioned]:
    """Write a limit's tables, and the chart of the shares above them; that of the changes is returned, for the top."""
    page.heading(f"{limit.filter}: {limit.relation} {given_text(limit.limit)} ({limit.cell})")
    if not limit.points:
        page.wide("The accepted trials do not say by how much it could be moved.", "paragraph", _LAST)
        return []
    top = page.row
    page.row += CHART_ROWS + 1
    acceptance = write_acceptance(page, limit)
    page.row += 1
    tables = write_answers(page, limit, forecasts)
    bottom, page.row = page.row, top
    place_rows(page, [_acceptance_chart(book, limit, acceptance)])
    page.row = bottom
    return [_moved_chart(book, limit, tables, forecasts)] if tables else []


def write_acceptance(page: Page, limit: FilterLimit) -> TableAt:
    """Write the shares accepted, and the slopes beside them; where the shares stand is returned."""
    header = page.row
    page.table(["Limit", "Value", "Trials", "Share", "±"], [_acceptance(point, limit) for point in limit.points])
    bottom, page.row = page.row, header
    starts, last = (RIGHT + 1, 12, 13), 13
    headers = ("Slope: change of the mean of …, per unit of the limit", "Slope", "±")
    page.line([Shown(header, look="header left") for header in headers], starts, last)
    for slope in limit.slopes:
        page.line([Shown(slope.forecast, look="name"), *cells.estimate(slope.mean)], starts, last)
    page.row = max(bottom, page.row)
    return TableAt(page.name, header, header + 1, header + len(limit.points))


def _acceptance(point: LimitPoint, limit: FilterLimit) -> list[Shown]:
    return [
        Shown(_tighter_or_looser(point.limit, limit), look="name"),
        cells.exact(point.limit),
        cells.count(point.trials),
        *cells.share(point.acceptance),
    ]


def _tighter_or_looser(value: float, limit: FilterLimit) -> str:
    if value == limit.limit:
        return "as it is"
    looser = (value < limit.limit) == (limit.relation in ("at least", "above"))
    return "looser" if looser else "tighter"


def write_answers(page: Page, limit: FilterLimit, forecasts: Mapping[str, ForecastSensitivity]) -> list[TableAt]:
    """Write every forecast at every value of the limit; where each forecast's rows stand is returned."""
    header = page.row
    headers = [
        "Forecast",
        "Limit",
        "Mean",
        "±",
        "Change of mean",
        "±",
        "Range from",
        "±",
        "to",
        "±",
        "Change / range",
        "±",
    ]
    page.table(headers, [])
    tables = []
    for index, slope in enumerate(limit.slopes):
        first = page.row
        now = next(point.answers[index] for point in limit.points if point.limit == limit.limit)
        for point in limit.points:
            page.line(_answer(forecasts[slope.forecast], point.limit, point.answers[index], now))
        tables.append(TableAt(page.name, header, first, page.row - 1))
    return tables


def _answer(forecast: ForecastSensitivity, limit: float, answer: LimitAnswer, now: LimitAnswer) -> list[Shown]:
    width = now.high.value - now.low.value
    looks = ("second number", "second error") if answer is now else ("number", "error")
    shown = [
        each
        for found in (answer.mean, answer.change, answer.low, answer.high)
        for each in cells.estimate(found, *looks, like=now.mean, form=forecast.form, spread=found is answer.change)
    ]
    part = [
        Shown(None if each is None or width <= 0.0 else each / width, "0.0%", look)
        for each, look in zip((answer.change.value, answer.change.error), looks, strict=True)
    ]
    return [Shown(forecast.forecast, look="name"), Shown(limit, look=looks[0]), *shown, *part]


def _moved_chart(
    book: Workbook, limit: FilterLimit, tables: list[TableAt], forecasts: Mapping[str, ForecastSensitivity]
) -> Captioned:
    shown = [forecasts[slope.forecast] for slope in limit.slopes]
    alike = len({(each.change_units, each.form.affixes) for each in shown}) == 1
    unit = shown[0].change_units if alike and shown[0].form.factor == 1.0 else None
    axis = "Change of the mean" + (", of the central range" if unit is None else f" ({unit})" if unit else "")
    value, error, number = (_CHANGE, _CHANGE + 1, "General") if unit is not None else (_OF_RANGE, _OF_RANGE + 1, "0%")
    chart = limit_chart(book, tables, "Change of each mean", _across(limit), axis, (0, _LIMIT, value, error), number)
    return chart, moved_caption(limit)


def _acceptance_chart(book: Workbook, limit: FilterLimit, acceptance: TableAt) -> Captioned:
    title = "Share of trials accepted"
    ends = _share_axis(limit)
    chart = limit_chart(book, [acceptance], title, _across(limit), "Share", (0, 1, 3, 4), "0.0%", ends=ends)
    return chart, _share_caption(limit)


def _across(limit: FilterLimit) -> str:
    return f"Limit: {limit.filter} {limit.relation} …"


def _share_axis(limit: FilterLimit) -> dict[str, float]:
    """Return the axis of the shares: from 0 to above the whiskers, and never beyond 100 %."""
    tops = [each.acceptance.value + (each.acceptance.error or 0.0) for each in limit.points]
    return bounds(0.0, min(1.0, max(tops, default=0.0)))


def moved_caption(limit: FilterLimit) -> str:
    """Return the caption of the chart of the changes."""
    return (
        f"How far each forecast's mean moves from that with the limit as it is ({given_text(limit.limit)}); whiskers "
        f"are standard errors of the change. Other filters and limits stay.{_nothing_moves(limit)}"
    )


def _brief(limit: FilterLimit) -> str:
    """Return the caption of the same chart where the sheet says once what all of them show."""
    return f"{limit.filter}: as it is, {given_text(limit.limit)}.{_nothing_moves(limit)}"


def _nothing_moves(limit: FilterLimit) -> str:
    """Return the sentence on changes of 0 ± 0; empty if some change is not."""
    if len({point.trials for point in limit.points}) > 1:
        return ""
    return " No trial that everything else keeps lies between these limits, so nothing moves; with more trials it may."


def _share_caption(limit: FilterLimit) -> str:
    return (
        f"The share of all trials that are accepted with each limit, from {count_text(limit.trials)} "
        "trials; what a looser limit "
        f"adds comes from {count_text(limit.loosened_trials)}."
    )
