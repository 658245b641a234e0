"""The sheet Sensitivity: what each forecast depends on.

The two charts of each forecast that say most come first and are printed; below them stand its other charts and the
tables of influences and of moves that all are drawn from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final

from xlmc.analysis.studies.sensitivity.influences import MEASURED
from xlmc.analysis.studies.sensitivity.measures import Noise, noise
from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.sheets.sensitivity_charts import (
    CHART_ROWS,
    CHARTED,
    MOST_LINES,
    WIDTHS,
    Captioned,
    TableAt,
    bar_chart,
    place_rows,
    spider_chart,
    tornado_chart,
)
from xlmc.outputs.summary import first_forecasts

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.analysis.studies.sensitivity import Bar, ForecastSensitivity, Influence, Sensitivities
    from xlmc.excel.workbook.workbook import Workbook as SourceBook
    from xlmc.montecarlo.statistics import Estimate
    from xlmc.outputs.sheets.page import Page

__all__ = [
    "BARS",
    "ROWS",
    "WIDTHS",
    "influence_captions",
    "influence_charts",
    "move_captions",
    "move_charts",
    "sensitivity_sentences",
    "write_influences",
    "write_moves",
    "write_sensitivity",
]


_LAST: Final = len(WIDTHS) - 1

BARS: Final = 10
"""Bars on a chart: more would not have readable names."""

ROWS: Final = 40
"""Rows in a table."""

_EXPLAINED, _DEPENDENCE, _RANK, _CONTRIBUTION, _FIRST, _TOTAL = 2, 5, 8, 10, 12, 14
"""The columns of the values; their errors follow them."""

_HEADING: Final = 2
"""The rows of a heading."""

_DRAWN: Final = 8
"""Bars on a chart of the sheet, where more would have no room for their names."""

_FIRST_ROWS: Final = 10
"""Rows of the sheet that the first two charts of a forecast cover: a page has room for those of four forecasts."""

_NAMES_WIDE, _BARS_WIDE, _TORNADO_WIDE = 0.43, 0.53, 0.4
"""Parts of the width of such a chart: the names of its bars, and the bars, of which a tornado has a legend beside them.

Without them LibreOffice wraps long names, and then leaves out every other one.
"""

_PRINTED: Final = 12
"""Forecasts whose first charts are printed: three pages."""

_CHANGES: Final = 5
"""The column of the first of the five changes."""


_EXPLAINED_CHART: Final = (
    "Variance explained: how much of the forecast's variance would vanish, on average, if the assumption's true "
    "value were known. It is found from the accepted trials, so it holds with filters and correlations; shares "
    "need not add up to 100 %. Pale bars, and the word noise in the table: no more than chance alone would show."
)

_TORNADO_CHART: Final = (
    "Tornado: how far the forecast moves from its base case when one assumption goes to its 10th or 90th "
    "percentile and all others stay at their base values. It uses no trials, so probabilities, filters and "
    "correlations have no part in it."
)

_SPIDER: Final = "Spider: the same over five points of each assumption's own distribution before filtering."

_BENT: Final = "Where the table says that it does not only rise or fall, the bar hides what lies between."


def write_sensitivity(page: Page, book: Workbook, found: Sensitivities, source: SourceBook) -> None:
    """Write the sheet: two charts of each forecast, which are printed; below all of them its others and its tables.

    The charts draw the tables that stand below them, so room is left for them.
    """
    page.title(
        "Sensitivity: what the answers depend on", f"{source.name}: {count_text(found.accepted)} accepted trials"
    )
    bent = f" {_BENT}" if any(map(_is_bent, found.forecasts)) else ""
    printed_only = _printed_sentence(len(found.forecasts))
    for sentence in (*sensitivity_sentences(found, source), _EXPLAINED_CHART, f"{_TORNADO_CHART}{bent}", printed_only):
        page.wide(sentence, "remark", CHARTED)
    tops = []
    for forecast in found.forecasts:
        tops.append(page.row)
        _write_heading(page, forecast)
        page.row += _FIRST_ROWS + 1 if _is_drawn(forecast) else 0
    printed = [*tops, page.row][min(len(tops), _PRINTED)]
    for top, forecast in zip(tops, found.forecasts, strict=True):
        if not _is_drawn(forecast):
            continue
        charts = _write_details(page, book, forecast, found)
        bottom, page.row = page.row, top + _HEADING
        place_rows(page, charts, _FIRST_ROWS, _brief(forecast))
        page.row = bottom
    page.set_up_printing(source.name, printed=printed, columns=(0, CHARTED))


def _printed_sentence(forecasts: int) -> str:
    which = "each forecast" if forecasts <= _PRINTED else f"each of the first {_PRINTED} forecasts"
    return (
        f"Only the first two charts of {which} are printed. The other charts and the numbers of all are below, and "
        "are not printed unless you clear the print area."
    )


def _write_heading(page: Page, forecast: ForecastSensitivity) -> None:
    page.heading(f"{forecast.forecast} ({forecast.units})" if forecast.units else forecast.forecast)
    if not _is_drawn(forecast):
        page.wide("No assumption is drawn: there is nothing that it could depend on.", "paragraph", _LAST)


def _is_drawn(forecast: ForecastSensitivity) -> bool:
    return bool(forecast.influences or forecast.bars)


def sensitivity_sentences(found: Sensitivities, source: SourceBook) -> list[str]:
    """Return the sentences that say what the numbers are and rest on."""
    said = [
        "Influences are those among the accepted trials: filters change which assumptions matter. ± is the standard "
        "error that comes from a limited number of trials. No sensitivity says whether the model "
        f"{vocabulary_of(source).fits}."
    ]
    if found.sobol_reason:
        said.append(f"{found.sobol_reason}.")
    if found.examined < found.accepted:
        said.append(
            f"Influences rest on {count_text(found.examined)} of the {count_text(found.accepted)} "
            "accepted trials; the variance explained, "
            "where the forecast jumps or bends, on up to "
            f"{count_text(131_072)}."
        )
    if any(each.explained_at_least for forecast in found.forecasts for each in forecast.influences):
        said.append(
            "Variance explained “at least” so much: the forecast jumps or bends more finely than the trials show, or a "
            "few trials decide the number, and it may be larger than its error says. More trials help."
        )
    if omitted := max((each.omitted for each in found.forecasts), default=0):
        said.append(
            f"For each forecast those {MEASURED} assumptions are measured that matter most in a first look at all; the "
            f"other {count_text(omitted)} have less influence."
        )
    if found.omitted_forecasts:
        said.append(first_forecasts("Sensitivity is told of", len(found.forecasts), found.omitted_forecasts))
    if found.medians:
        said.append(f"Held at their medians, because their cells are blank: {', '.join(found.medians)}.")
    return said


def _write_details(
    page: Page, book: Workbook, forecast: ForecastSensitivity, found: Sensitivities
) -> Sequence[Captioned]:
    """Write the further charts and the tables of a forecast; the first two charts are returned, for the top."""
    page.heading(f"{forecast.forecast}: all numbers")
    top, sobol = page.row, found.sobol_trials > 0
    count = (4 if forecast.influences else 0) + (2 if forecast.bars else 0)
    page.row += (count // 2 - 1) * (CHART_ROWS + 1)
    influences: Sequence[Captioned] = ()
    moves: Sequence[Captioned] = ()
    if forecast.influences:
        at = write_influences(page, forecast, sobol)
        bars = influence_charts(book, at, forecast, sobol)
        influences = list(zip(bars, influence_captions(forecast, found.sobol_trials), strict=True))
        _write_rest(page, len(forecast.influences))
    else:
        page.wide(_nothing(forecast), "paragraph", _LAST)
    if forecast.bars:
        page.row += 1
        at = write_moves(page, forecast)
        moves = list(zip(move_charts(book, at, forecast), move_captions(forecast), strict=True))
    for drawn, width in ((influences[:1], _BARS_WIDE), (moves[:1], _TORNADO_WIDE)):
        for chart, _ in drawn:
            chart.set_plotarea({"layout": {"x": _NAMES_WIDE, "y": 0.13, "width": width, "height": 0.6}})
    charts = [*influences[:1], *moves[:1], *influences[1:], *moves[1:]]
    bottom, page.row = page.row, top
    place_rows(page, charts[2:])
    page.row = bottom
    return charts[:2]


def _brief(forecast: ForecastSensitivity) -> list[str] | None:
    """Return the captions of its first two charts, if the top of the sheet explains them; otherwise None."""
    if not forecast.bars:
        return None
    tornado = f"Tornado about the base case{_base_text(forecast)}."
    return ["Variance explained.", tornado] if forecast.influences else [tornado, _SPIDER]


def _base_text(found: ForecastSensitivity) -> str:
    return f" of {found.base_text}" if found.base_text else ""


def _change_format(found: ForecastSensitivity) -> str:
    """Return the format of changes of a forecast; of dates they are days."""
    widest = found.bars[0].span if found.bars else 0.0
    return cells.spread_format(widest, found.change_form)


def _is_bent(found: ForecastSensitivity) -> bool:
    """Whether it does not only rise or fall with an assumption that is drawn."""
    return any(bar.monotonic is False for bar in found.bars[:BARS])


def _nothing(forecast: ForecastSensitivity) -> str:
    return (
        f"It is a number in {count_text(forecast.trials)} accepted trials: too few to say what "
        "influences it, or it is the same "
        "in all of them, or the draws of the accepted trials were not kept."
    )


def _write_rest(page: Page, count: int) -> None:
    if count > ROWS:
        page.wide(f"and {count_text(count - ROWS)} more that explain less.", "remark", _LAST)


def write_influences(page: Page, found: ForecastSensitivity, sobol: bool) -> TableAt:
    """Write the table; where its rows to draw stand is returned."""
    headers = ["Assumption", "Units", "Variance explained", "±", "Noise up to", "Dependence", "±", "Noise up to"]
    headers += ["Rank correlation", "±", "Contribution to variance", "±"]
    shown = found.influences[:ROWS]
    header = page.row
    weak = noise(found)
    page.table(
        [*headers, *(["First order", "±", "Total effect", "±"] if sobol else [])],
        [_row(one, its, sobol) for one, its in zip(shown, weak, strict=False)],
    )
    return TableAt(page.name, header, header + 1, header + min(len(shown), _DRAWN))


def _row(found: Influence, weak: Noise, sobol: bool) -> list[Shown]:
    row = [
        Shown(found.assumption, look="name"),
        Shown(found.units),
        *_at_least(found, _with_floor(found.explained, found.explained_floor, weak.explained)),
        *_with_floor(found.dependence, found.dependence_floor, weak.dependence),
        *_as_noise(cells.estimate(found.rank_correlation), weak.correlation),
        *_as_noise(cells.share(found.contribution), weak.correlation),
    ]
    for index, is_noise in ((found.first_order, weak.first_order), (found.total, weak.total)) if sobol else ():
        row += [cells.BLANK, cells.BLANK] if index is None else _as_noise(cells.share(index), is_noise)
    return row


def _with_floor(found: Estimate, floor: float, is_noise: bool) -> list[Shown]:
    shown = _as_noise(cells.share(found), is_noise)
    return [*shown, Shown(floor, cells.share_format(found), "error")]


def _at_least(found: Influence, shown: list[Shown]) -> list[Shown]:
    """Return the cells of the variance explained, with `at least` before the number if it is a lower bound."""
    if not found.explained_at_least or shown[0].format == cells.NOISE:
        return shown
    return [replace(shown[0], format=cells.AT_LEAST + shown[0].format), *shown[1:]]


def _as_noise(shown: list[Shown], is_noise: bool) -> list[Shown]:
    """Return a value and its error; a value that is noise shows as that word, and its cell keeps the number."""
    return [replace(shown[0], format=cells.NOISE), *shown[1:]] if is_noise else shown


def influence_charts(book: Workbook, at: TableAt, found: ForecastSensitivity, sobol: bool) -> list[Any]:
    """Variance explained, dependence or total effects, rank correlation and contribution to variance."""
    of = noise(found)[:_DRAWN]
    weak, unseen = [each.explained for each in of], [each.dependence for each in of]
    flat, lone = [each.correlation for each in of], [each.total for each in of]
    second = (
        bar_chart(
            book, at, "Total effect (Sobol)", "Share of the variance, alone and with others", _TOTAL, _TOTAL + 1, lone
        )
        if sobol
        else bar_chart(
            book, at, "Dependence", "0 %: none; 100 %: nothing else matters", _DEPENDENCE, _DEPENDENCE + 1, unseen
        )
    )
    rank = "Rank correlation with the forecast (Spearman)"
    share = "Squared rank correlations, scaled to 100 %, with their sign"
    return [
        bar_chart(book, at, "Variance explained", "Share of the variance", _EXPLAINED, _EXPLAINED + 1, weak),
        second,
        bar_chart(book, at, "Rank correlation", rank, _RANK, _RANK + 1, flat, "0.0"),
        bar_chart(book, at, "Contribution to variance (approximate)", share, _CONTRIBUTION, _CONTRIBUTION + 1, flat),
    ]


def influence_captions(found: ForecastSensitivity, pairs: int) -> list[str]:
    """Return a caption for each chart of influences: what it is and what it is not."""
    dependence = (
        "Dependence (index of Cramér and von Mises): 0 only if no part of the forecast's distribution depends on the "
        "assumption, 100 % if nothing else matters. Unlike variance explained it also shows an assumption that "
        "only widens the forecast or acts only together with others; it is not a share of the variance."
    )
    total = (
        f"Total effect (Sobol), from {count_text(pairs)} pairs of trials of their own: the variance "
        "that would be left, on "
        "average, if all other assumptions were known. It counts what the assumption does together with others, so the "
        "effects add up to 100 % or more. (Sobol's total index; first order is the part that it explains alone.)"
    )
    rank = (
        f"Rank correlation on {count_text(found.trials)} accepted trials: whether the forecast rises or falls with the "
        "assumption. It does not show effects that rise and fall, and it is not a share of the variance."
    )
    contribution = (
        "Contribution to variance as Crystal Ball shows it: squared rank correlations scaled to 100 %. Approximate, "
        "and wrong where filters or correlations tie assumptions together or an effect rises and falls: trust variance "
        "explained then."
    )
    return [_EXPLAINED_CHART, total if pairs else dependence, rank, contribution]


def write_moves(page: Page, found: ForecastSensitivity) -> TableAt:
    """Write the table; where its rows to draw stand is returned."""
    headers = ["Assumption, moved alone", "Units", "Base value", "10th percentile", "90th percentile"]
    headers += [
        "at 10 %",
        "at 25 %",
        "at 50 %",
        "at 75 %",
        "at 90 %",
        "Only rises or falls",
        "Cases rejected by filters",
    ]
    header, shown = page.row, found.bars[:ROWS]
    page.table(headers, [_move_row(bar, found.base or 0.0, _change_format(found)) for bar in shown])
    return TableAt(page.name, header, header + 1, header + min(len(shown), _DRAWN))


def _move_row(bar: Bar, base: float, changed: str) -> list[Shown]:
    digits = cells.spread_format(bar.inputs[-1] - bar.inputs[0], bar.form)
    changes = [None if answer is None else answer - base for answer in bar.answers]
    rises = "–" if bar.monotonic is None else "yes" if bar.monotonic else "no"
    return [
        Shown(bar.assumption, look="name"),
        Shown(bar.units),
        *(Shown(value, digits, date1904=bar.form.date1904) for value in (bar.base, bar.inputs[0], bar.inputs[-1])),
        *(Shown(change, changed) for change in changes),
        Shown(rises, look="moved" if bar.monotonic is False else "number"),
        Shown(f"{sum(bar.rejected)} of {len(bar.rejected)}", look="number"),
    ]


def move_charts(book: Workbook, at: TableAt, found: ForecastSensitivity) -> list[Any]:
    """Return the charts: tornado and spider."""
    units = f" ({found.change_units})" if found.change_units else ""
    axis = f"Change of the forecast from its base case{units}"
    first, last = _CHANGES, _CHANGES + 4
    number = "General" if found.form == PLAIN else _change_format(found)
    return [
        tornado_chart(book, at, "Tornado", axis, first, last, number),
        spider_chart(book, at, "Spider", f"Change from the base case{units}", first, last, number),
    ]


def move_captions(found: ForecastSensitivity) -> list[str]:
    """Return a caption for tornado and spider: what each is and what it is not."""
    tornado = _TORNADO_CHART.replace("its base case", f"its base case{_base_text(found)}")
    if _is_bent(found):
        tornado += f" {_BENT}"
    lines = min(MOST_LINES, len(found.bars))
    spider = (
        f"Spider: the same over five points of each assumption's own distribution before filtering, for the {lines} "
        "that move it most; a bent line is an effect that a correlation describes badly. A steep line does not mean "
        "that a change is probable: it shows how the model reacts."
    )
    return [tornado, spider]
