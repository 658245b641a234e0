"""The charts that are drawn from the sheet Curves: cumulative charts of one forecast, and charts of several.

A cumulative curve shows the share of trials at most at each of many values, counted exactly and not summed from bins.
The values divide the bins of the histogram, so that both charts have the same axis. Trials that the histogram does not
draw count below and above.

Crystal Ball's overlay and trend charts show forecasts of the same units, as frequency curves or as ranges. A frequency
curve joins the middles of a histogram's bars, each share divided by the width of its bar: so curves from bars of
different width compare, and each has an area of 1 but for what the histogram leaves out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.columns import release
from xlmc.montecarlo.number_text import percent
from xlmc.montecarlo.statistics import percentiles
from xlmc.montecarlo.statistics.sample import Sample
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.colours import DARK, INK, LIGHT
from xlmc.outputs.histogram import Figure, Histogram, multiples
from xlmc.outputs.sheets.curves_sheet import SHARE, Curves, TableAt
from xlmc.outputs.sheets.styles import COLOURS, across, axis_format, finish, straight, upwards

if TYPE_CHECKING:
    from xlsxwriter.chart_area import ChartArea
    from xlsxwriter.chart_scatter import ChartScatter
    from xlsxwriter.chart_stock import ChartStock
    from xlsxwriter.workbook import Workbook

    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["MOST", "cumulative_charts", "group_by_units", "overlay_chart", "trend_chart"]


MOST: Final = len(COLOURS)
"""Forecasts in one chart; more could not be told apart."""

_KINDS = ((2, "cumulative", "Cumulative probability"), (4, "reverse cumulative", "Reverse cumulative probability"))
"""The column of each chart's shares inside the central range, which those outside follow; its name; its axis."""

_POINTS = 120
"""Points at least: the steps between them are then too short to see."""

_TAILS: Final = (5.0, 95.0)

_BOX: Final = {"fill": {"color": DARK}, "border": {"none": True}}

Floats = NDArray[np.float64]


def cumulative_charts(book: Workbook, curves: Curves, simulation: RunResult, figure: Figure) -> list[ChartArea]:
    """Write the curve's table, and draw the cumulative chart and the reverse cumulative one."""
    result, answer = simulation.results[figure.answer.name], figure.answer
    curve = _cumulative(result.sample, figure.bins, answer.low.value, answer.high.value)
    share = percent(answer.share)
    heads = ["Label", "Value", *[f"Inside {share} range", "Outside"] * len(_KINDS)]
    titles = [f"{figure.name}: {kind}" for _, kind, _ in _KINDS]
    table = curves.write(
        titles, answer.units or "Value", heads, _rows(curve, cells.exact(curve.at[0], answer.form).format)
    )
    return [_chart(book, table, curve, number) for number in range(len(_KINDS))]


def _rows(curve: _Cumulative, digits: str) -> Iterator[list[Shown]]:
    columns = (curve.at.tolist(), curve.at_most.tolist(), curve.above.tolist(), curve.central.tolist())
    for label, at, at_most, above, central in zip(curve.labels, *columns, strict=True):
        shares = (at_most, 0.0, above, 0.0) if central else (0.0, at_most, 0.0, above)
        yield [Shown(label), Shown(at, digits), *(Shown(share, SHARE) for share in shares)]


def _chart(book: Workbook, table: TableAt, curve: _Cumulative, number: int) -> ChartArea:
    """Two areas, of which one is 0 where the other is not: their sum is the curve whichever way they overlap."""
    inside, _, axis = _KINDS[number]
    chart = book.add_chart({"type": "area", "subtype": "stacked"})
    for column, colour in ((inside, DARK), (inside + 1, LIGHT)):
        chart.add_series(
            {
                "name": table.heading(column),
                "categories": table.column(0),
                "values": table.column(column),
                "fill": {"color": colour},
                "border": {"none": True},
            }
        )
    marks = {"interval_unit": curve.step, "interval_tick": curve.step}
    chart.set_x_axis(across(table.axis, position_axis="on_tick", major_tick_mark="none", **marks))
    chart.set_y_axis(upwards(axis, "0%", min=0, max=1, major_unit=0.1))
    finish(chart, table.title(number))
    return chart


@dataclass(frozen=True, slots=True)
class _Cumulative:
    """A curve of `g` points.

    Attributes:
        at: `(g,)` values.
        at_most, above: `(g,)` shares of the trials; together 1.
        central: `(g,)` whether the point lies in the central range.
        labels: a text for some points, nothing for the others.
        step: points from one label to the next; the first has one.
    """

    at: Floats
    at_most: Floats
    above: Floats
    central: NDArray[np.bool_]
    labels: list[str]
    step: int


def _cumulative(sample: Sample, bins: Histogram, low: float, high: float) -> _Cumulative:
    """Return the cumulative curve over the range of the bins; the central range is [low, high]."""
    pieces = math.ceil(_POINTS / bins.edges.size)
    first = round(float(bins.edges[0] / bins.width) * pieces)
    at = multiples(bins.width / pieces, first, bins.edges.size * pieces + 1)
    at[::pieces] = [*bins.edges, bins.upper_edges[-1]]
    x = sample.even
    reached = np.searchsorted(x, at, side="right")
    release(x)
    labels = [""] * at.size
    middle = 0 if bins.names is None else pieces // 2
    labels[middle::pieces] = [*bins.labels, bins.last_label][: len(labels[middle::pieces])]
    return _Cumulative(
        at=at,
        at_most=reached / x.size,
        above=(x.size - reached) / x.size,
        central=(at >= low) & (at <= high),
        labels=labels,
        step=bins.step * pieces,
    )


def group_by_units(figures: Sequence[Figure]) -> list[list[Figure]]:
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
    """Chart the frequency curves of figures with the same units."""
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
    """Yield the middles of the bars and their density, closed with an empty bar at either end."""
    bins, trials = figure.bins, figure.bins.counted
    middles = [*(float(edge) + bins.width / 2.0 for edge in bins.edges)]
    density = [float(count) / trials / bins.width for count in bins.inside + bins.outside]
    at = [middles[0] - bins.width, *middles, middles[-1] + bins.width]
    for middle, height in zip(at, [0.0, *density, 0.0], strict=True):
        yield [Shown(middle), Shown(height, "0.0000")]


def trend_chart(book: Workbook, curves: Curves, simulation: RunResult, group: Sequence[Figure]) -> ChartStock:
    """Chart the central range of each figure as a box, with a line from its 5th to its 95th percentile."""
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


def _ranges(simulation: RunResult, group: Sequence[Figure]) -> Iterator[list[Shown]]:
    """Yield the ranges in the order of a stock chart: open, high, low, close."""
    for figure in group:
        low, high = (each.value for each in percentiles(simulation.results[figure.answer.name].sample, _TAILS).values())
        digits = cells.paired_format(figure.answer.mean)
        ends = (figure.answer.low.value, high, low, figure.answer.high.value)
        yield [Shown(figure.name), *(Shown(end, digits) for end in ends)]
