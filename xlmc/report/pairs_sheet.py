"""The sheet Pairs: forecasts two at a time, their joint probabilities, their correlation, and scatter charts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.report import cells, number_format
from xlmc.report.cells import BLANK, Shown
from xlmc.report.chart_style import across, bounds, finish, upwards
from xlmc.report.charts import Drawing, place_drawings
from xlmc.report.curves import Curves, TableAt
from xlmc.report.styles import DARK
from xlmc.statements import PAIRS, Pair, pairs_of

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from xlsxwriter.chart_scatter import ChartScatter
    from xlsxwriter.workbook import Workbook

    from xlmc.report.page import Page
    from xlmc.simulation import Simulation

__all__ = ["POINTS", "WIDTHS", "write_pairs"]

POINTS: Final = 1_000
"""In a scatter chart: more hide each other and make the file slow to open."""

WIDTHS = (*[8.43] * 14, 11.5, *[8.43] * 3)
_LAST = 17
_STARTS = (0, 3, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17)
_SCALE = 60


@dataclass(frozen=True, slots=True)
class _Points:
    """A forecast's points: where they stand, and the limits of an axis for them."""

    at: TableAt
    limits: dict[str, float]


def write_pairs(page: Page, book: Workbook, simulation: Simulation, curves: Curves) -> None:
    """Write the sheet; `curves` takes the points of the charts."""
    name = simulation.model.workbook.name
    page.title("Forecasts two at a time", f"{name}: {simulation.accepted:,} accepted trials")
    pairs = pairs_of(simulation)
    if not pairs:
        page.row += 1
        page.wide("There are no two forecasts with numbers in the same accepted trials.", "paragraph", _LAST)
        page.printed(name, scale=_SCALE)
        return
    page.heading("Joint probability and rank correlation")
    _write_table(page, pairs)
    for sentence in _sentences(simulation, pairs):
        page.wide(sentence, "remark", _LAST)
    page.row += 1
    breaks = [page.row] if len(pairs) > 2 else []
    breaks += place_drawings(page, _drawings(book, curves, simulation, pairs))
    page.printed(name, scale=_SCALE, breaks=breaks)


def _write_table(page: Page, pairs: Sequence[Pair]) -> None:
    heads = ["First (A) and its limit a", "Second (B) and its limit b", "A > a and B > b", "±", "95 % from", "to"]
    heads += ["A > a or B > b", "±", "A > B", "±", "Rank correlation", "±", "95 % from", "to"]
    looks = ["header left", "header left", *["header"] * 12]
    page.spread([Shown(head, look=look) for head, look in zip(heads, looks, strict=True)], _STARTS, _LAST)
    for pair in pairs:
        page.spread(_line(pair), _STARTS, _LAST)


def _line(pair: Pair) -> list[Shown]:
    greater = [cells.text(cells.NONE), BLANK] if pair.first_greater is None else cells.share(pair.first_greater)
    return [
        *(cells.text(_limited(pair, place), "name") for place in (0, 1)),
        *cells.share(pair.both_above),
        *cells.interval(pair.both_above, percent=True),
        *cells.share(pair.either_above),
        *greater,
        *cells.estimate(pair.correlation),
        *cells.interval(pair.correlation),
    ]


def _limited(pair: Pair, place: int) -> str:
    forecast, limit = (pair.first, pair.second)[place], pair.limits[place]
    units = f" {forecast.units}" if forecast.units else ""
    what = "threshold" if pair.thresholds[place] else "median"
    return f"{forecast.name}, {what} {limit:.6g}{units}"


def _sentences(simulation: Simulation, pairs: Sequence[Pair]) -> list[str]:
    trials, ranked = {pair.trials for pair in pairs}, {pair.ranked for pair in pairs}
    said = "A limit is the forecast's threshold, or its median where it has none, taken as the number that stands here."
    said += " Probabilities are shares of the accepted trials in which both forecasts are numbers"
    said += f" ({min(trials):,})." if len(trials) == 1 else f" ({min(trials):,} to {max(trials):,})."
    if max(ranked) < max(trials):
        said += f" Rank correlations come from the first {max(ranked):,} of them."
    said += " A > B is given where both have the same units."
    found = [said]
    count = len(simulation.model.forecasts)
    if count * (count - 1) // 2 > len(pairs) == PAIRS:
        found.append(f"Only the first {PAIRS} of {count * (count - 1) // 2:,} pairs are here.")
    return found


def _drawings(book: Workbook, curves: Curves, simulation: Simulation, pairs: Sequence[Pair]) -> list[Drawing]:
    """A scatter chart a pair, from the first trials in which all forecasts of these pairs are numbers."""
    forecasts = {each.name: each for pair in pairs for each in (pair.first, pair.second)}
    columns = _points([simulation.forecasts[name] for name in forecasts])
    if not columns[0].size:
        return []
    tables: dict[str, _Points] = {}
    for (name, forecast), values in zip(forecasts.items(), columns, strict=True):
        digits = number_format.exact(float(np.ptp(values)))
        axis = f"{name} ({forecast.units})" if forecast.units else name
        at = curves.write("Points of the scatter charts", axis, [name], [[Shown(v, digits)] for v in values.tolist()])
        tables[name] = _Points(at, bounds(float(values.min()), float(values.max())))
    titles = [f"{pair.first.name} and {pair.second.name}" for pair in pairs]
    names = curves.write("Titles of the scatter charts", "", ["Title"], [[cells.text(title)] for title in titles])
    points = f"the first {columns[0].size:,} accepted trials in which all of these forecasts are numbers"
    return [
        Drawing(
            _scatter(book, tables[pair.first.name], tables[pair.second.name], names, place),
            f"Scatter chart {place + 1}. {titles[place]}: {points}.",
        )
        for place, pair in enumerate(pairs)
    ]


def _points(columns: Sequence[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """The first points of which all are numbers; a text among them would turn a chart's axis into 1, 2, 3."""
    early = [column[: 20 * POINTS] for column in columns]
    known = np.flatnonzero(~np.any([np.isnan(column) for column in early], axis=0))[:POINTS]
    return [column[known] for column in early]


def _scatter(book: Workbook, first: _Points, second: _Points, titles: TableAt, place: int) -> ChartScatter:
    chart = book.add_chart({"type": "scatter"})
    chart.add_series(
        {
            "categories": first.at.column(0),
            "values": second.at.column(0),
            "marker": {
                "type": "circle",
                "size": 3,
                "fill": {"color": DARK, "transparency": 50},
                "border": {"none": True},
            },
        }
    )
    chart.set_x_axis(across(first.at.axis, num_format="General", **first.limits))
    chart.set_y_axis(upwards(second.at.axis, "General", **second.limits))
    sheet, row, column, *_ = titles.column(0)
    assert isinstance(row, int)
    finish(chart, [sheet, row + place, column], legend=False)
    return chart
