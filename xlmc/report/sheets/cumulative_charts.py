"""A forecast's cumulative and reverse cumulative charts, the central range shaded, as Crystal Ball draws them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from xlmc.report.cumulative import Cumulative, cumulative
from xlmc.report.figure import Figure
from xlmc.report.sheets import cells
from xlmc.report.sheets.cells import Shown
from xlmc.report.sheets.chart_style import across, finish, upwards
from xlmc.report.sheets.curves import SHARE, Curves, TableAt
from xlmc.report.sheets.styles import DARK, LIGHT
from xlmc.report.summary import percent

if TYPE_CHECKING:
    from xlsxwriter.chart_area import ChartArea
    from xlsxwriter.workbook import Workbook

    from xlmc.run.simulation import Simulation

__all__ = ["cumulative_charts"]

_KINDS = ((2, "cumulative", "Cumulative probability"), (4, "reverse cumulative", "Reverse cumulative probability"))
"""The column of each chart's shares inside the central range, which those outside follow; its name; its axis."""


def cumulative_charts(book: Workbook, curves: Curves, simulation: Simulation, figure: Figure) -> list[ChartArea]:
    """Write the curve's table, and draw the cumulative chart and the reverse cumulative one."""
    result, answer = simulation.results[figure.answer.name], figure.answer
    curve = cumulative(result.sample, figure.bins, answer.low.value, answer.high.value)
    share = percent(answer.share)
    heads = ["Label", "Value", *[f"Inside {share} range", "Outside"] * len(_KINDS)]
    titles = [f"{figure.name}: {kind}" for _, kind, _ in _KINDS]
    table = curves.write(titles, answer.units or "Value", heads, _rows(curve))
    return [_chart(book, table, curve, number) for number in range(len(_KINDS))]


def _rows(curve: Cumulative) -> Iterator[list[Shown]]:
    columns = (curve.at.tolist(), curve.at_most.tolist(), curve.above.tolist(), curve.central.tolist())
    for label, at, at_most, above, central in zip(curve.labels, *columns, strict=True):
        shares = (at_most, 0.0, above, 0.0) if central else (0.0, at_most, 0.0, above)
        yield [cells.text(label), Shown(at), *(Shown(share, SHARE) for share in shares)]


def _chart(book: Workbook, table: TableAt, curve: Cumulative, number: int) -> ChartArea:
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
