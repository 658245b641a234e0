"""Forecasts that share their units in one chart, as frequency curves or as ranges side by side.

Crystal Ball's overlay and trend charts. A curve is that of the histogram, its bars' middles joined, each share divided
by the width of its bar: so curves from bars of different width compare, and each has an area of 1 but for what the
histogram leaves out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

from xlmc.report.figure import Figure
from xlmc.report.sheets import cells
from xlmc.report.sheets.cells import Shown
from xlmc.report.sheets.chart_style import COLOURS, across, axis_format, finish, straight, upwards
from xlmc.report.sheets.curves import Curves, TableAt
from xlmc.report.sheets.styles import DARK, INK
from xlmc.report.summary import percent
from xlmc.statistics import percentiles

if TYPE_CHECKING:
    from xlsxwriter.chart_scatter import ChartScatter
    from xlsxwriter.chart_stock import ChartStock
    from xlsxwriter.workbook import Workbook

    from xlmc.run.simulation import Simulation

__all__ = ["MOST", "alike", "overlay_chart", "trend_chart"]

MOST: Final = len(COLOURS)
"""Forecasts in one chart; more could not be told apart."""

_TAILS: Final = (5.0, 95.0)
_BOX: Final = {"fill": {"color": DARK}, "border": {"none": True}}


def alike(figures: Sequence[Figure]) -> list[list[Figure]]:
    """Figures by their units, in their order, at most `MOST` together; those that share theirs with no other left out.

    Forecasts without units are taken for numbers of different kinds.
    """
    groups: dict[str, list[Figure]] = {}
    for figure in figures:
        groups.setdefault(figure.answer.units.strip(), []).append(figure)
    groups.pop("", None)
    cut = [group[start : start + MOST] for group in groups.values() for start in range(0, len(group), MOST)]
    return [group for group in cut if len(group) > 1]


def overlay_chart(book: Workbook, curves: Curves, group: Sequence[Figure]) -> ChartScatter:
    """The frequency curves of figures with the same units."""
    units = group[0].answer.units
    chart = straight(book.add_chart({"type": "scatter", "subtype": "straight"}))
    tables: list[TableAt] = []
    for figure, colour in zip(group, COLOURS, strict=False):
        titles = [] if tables else [f"Overlay of forecasts in {units}"]
        table = curves.write(titles, units, ["Middle of bar", figure.name], _polygon(figure))
        tables.append(table)
        chart.add_series(
            {
                "name": table.heading(1),
                "categories": table.column(0),
                "values": table.column(1),
                "line": {"color": colour, "width": 2.0},
                "marker": {"type": "none"},
            }
        )
    first = min(float(figure.bins.edges[0]) for figure in group)
    limits = {"min": 0} if 0.0 <= first < max(figure.bins.width for figure in group) else {}  # no room for none below 0
    chart.set_x_axis(across(tables[0].axis, num_format=axis_format("General"), **limits))
    chart.set_y_axis(upwards("Probability per unit of the axis", "General", min=0))
    finish(chart, tables[0].title())
    return chart


def _polygon(figure: Figure) -> Iterator[list[Shown]]:
    """The middles of the bars and their density, closed with a bar of none at either end."""
    bins, trials = figure.bins, figure.answer.trials
    middles = [*(float(edge) + bins.width / 2.0 for edge in bins.edges)]
    density = [float(count) / trials / bins.width for count in bins.inside + bins.outside]
    at = [middles[0] - bins.width, *middles, middles[-1] + bins.width]
    for middle, height in zip(at, [0.0, *density, 0.0], strict=True):
        yield [Shown(middle), Shown(height, "0.0000")]


def trend_chart(book: Workbook, curves: Curves, simulation: Simulation, group: Sequence[Figure]) -> ChartStock:
    """The central range of each figure as a box, with a line from its 5th to its 95th percentile."""
    units, shares = group[0].answer.units, {figure.answer.share for figure in group}
    central = f"{percent(shares.pop())} range" if len(shares) == 1 else "Central range"
    heads = ["Forecast", f"{central} from", "95th percentile", "5th percentile", f"{central} to"]
    table = curves.write([f"Trend of forecasts in {units}"], units, heads, _ranges(simulation, group))
    chart = book.add_chart({"type": "stock"})
    for column in range(1, len(heads)):
        chart.add_series({"name": table.heading(column), "categories": table.column(0), "values": table.column(column)})
    chart.set_up_down_bars({"up": _BOX, "down": _BOX})
    chart.set_high_low_lines({"line": {"color": INK, "width": 1.5}})
    chart.set_x_axis(across(text_axis=True))
    chart.set_y_axis(upwards(table.axis, "General"))
    finish(chart, table.title(), legend=False)
    return chart


def _ranges(simulation: Simulation, group: Sequence[Figure]) -> Iterator[list[Shown]]:
    """In the order of a stock chart: open, high, low, close."""
    for figure in group:
        low, high = (each.value for each in percentiles(simulation.results[figure.answer.name].sample, _TAILS).values())
        digits = cells.digits_of(figure.answer.mean)
        ends = (figure.answer.low.value, high, low, figure.answer.high.value)
        yield [cells.text(figure.name), *(Shown(end, digits) for end in ends)]
