"""A forecast's cumulative and reverse cumulative charts, the central range shaded, as Crystal Ball draws them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.report import cells
from xlmc.report.cells import Shown
from xlmc.report.chart_style import across, finish, upwards
from xlmc.report.cumulative import Cumulative, cumulative
from xlmc.report.curves import SHARE, Curves, TableAt
from xlmc.report.figure import Figure
from xlmc.report.styles import DARK, LIGHT
from xlmc.report.summary import percent

if TYPE_CHECKING:
    from xlsxwriter.chart_area import ChartArea
    from xlsxwriter.workbook import Workbook

    from xlmc.simulation import Simulation

__all__ = ["cumulative_charts"]

_KINDS = (("cumulative", "Cumulative probability"), ("reverse cumulative", "Reverse cumulative probability"))
"""The name of each chart, and of its axis."""


def cumulative_charts(
    book: Workbook, curves: Curves, simulation: Simulation, figure: Figure
) -> list[ChartArea]:
    """Write the curve's tables, and draw the cumulative chart and the reverse cumulative one."""
    result, answer = simulation.results[figure.answer.name], figure.answer
    curve = cumulative(result.sample, figure.bins, answer.low.value, answer.high.value)
    share = percent(answer.share)
    drawn = []
    for (kind, axis), shares in zip(_KINDS, (curve.at_most, curve.above), strict=True):
        heads = ["Label", "Value", f"Inside {share} range", "Outside"]
        table = curves.write(f"{figure.name}: {kind}", answer.units or "Value", heads, _rows(curve, shares))
        drawn.append(_chart(book, table, curve, axis))
    return drawn


def _rows(curve: Cumulative, shares: NDArray[np.float64]) -> list[list[Shown]]:
    columns = zip(curve.labels, curve.at.tolist(), shares.tolist(), curve.central.tolist(), strict=True)
    return [
        [
            cells.text(label),
            Shown(at, "General"),
            Shown(share if central else 0.0, SHARE),
            Shown(0.0 if central else share, SHARE),
        ]
        for label, at, share, central in columns
    ]


def _chart(book: Workbook, table: TableAt, curve: Cumulative, axis: str) -> ChartArea:
    """Two areas, of which one is 0 where the other is not: their sum is the curve whichever way they overlap."""
    chart = book.add_chart({"type": "area", "subtype": "stacked"})
    for column, colour in ((2, DARK), (3, LIGHT)):
        chart.add_series(
            {
                "name": table.heading(column),
                "categories": table.column(0),
                "values": table.column(column),
                "fill": {"color": colour},
                "border": {"none": True},
            }
        )
    marks = {"interval_unit": curve.step, "interval_tick": curve.step, "position_axis": "on_tick", "major_tick_mark": "none"}
    chart.set_x_axis(across(table.axis, **marks))
    chart.set_y_axis(upwards(axis, "0%", min=0, max=1, major_unit=0.1))
    finish(chart, table.title)
    return chart
