"""The sheet Bins: the numbers of the histograms, a table for each; and the histogram as Excel draws it from them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.montecarlo.number_text import percent
from xlmc.outputs.document import cells
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.colours import DARK, LIGHT
from xlmc.outputs.histogram import Figure, Histogram
from xlmc.outputs.sheets.styles import Reference, across, finish, no_reference, upwards

if TYPE_CHECKING:
    from xlsxwriter.chart_column import ChartColumn
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.sheets.page import Page

__all__ = ["HEADER", "TABLE", "BinsAt", "histogram_chart", "write_bins"]


HEADER = 4
"""The row of the headings, counted from 0."""

TABLE = 6
"""Columns of a table; a narrow one follows."""

_COUNTS = (3, 4)


@dataclass(frozen=True, slots=True)
class BinsAt:
    """The place of a table of bins; rows and columns are counted from 0.

    Attributes:
        header: the row of column headings; the bins follow it, and above it stand the chart's title and its axis's.
        last: the row of the last bin.
        left: the column of the labels and of both titles; the counts stand `_COUNTS` to its right.
    """

    sheet: str
    header: int
    last: int
    left: int

    def cell(self, row: int, column: int = 0) -> Reference:
        """Return a reference to one cell, its column counted from `left`."""
        return [self.sheet, row, self.left + column]

    def column(self, column: int) -> Reference:
        """Return a reference to the bins of one column."""
        return [self.sheet, self.header + 1, self.left + column, self.last, self.left + column]


def write_bins(page: Page, figures: Sequence[Figure], name: str) -> list[BinsAt]:
    """Write the sheet with the tables of bins side by side; what is returned says where each stands."""
    page.title_of_data(
        "Bins of the histograms", f"{name}: the numbers that the charts draw.", name, HEADER, hidden=True
    )
    tables = [_write_table(page, figure) for figure in figures]
    page.sheet.freeze_panes(HEADER + 1, 0)
    return tables


def _write_table(page: Page, figure: Figure) -> BinsAt:
    left = (figure.number - 1) * (TABLE + 1)
    page.sheet.set_column(left, left + TABLE - 1, 11)
    page.sheet.set_column(left + TABLE, left + TABLE, 3)
    page.put(HEADER - 2, left, Shown(figure.name, look="heading"))
    page.put(HEADER - 1, left, Shown(figure.axis, look="subtitle"))
    page.row = HEADER
    share = percent(figure.answer.share)
    inside, outside = f"Inside {share} range", "Outside"
    if figure.answer.is_share:
        inside, outside = "Accepted trials", " "
    page.table(["Label", "From", "to below", inside, outside, "Trials"], _rows(figure.bins), left)
    last = page.row - 1
    for label, count in _rest(figure.bins):
        line = [Shown(label, look="label"), *[cells.BLANK] * (TABLE - 2), cells.count(count)]
        page.line(line, range(left, left + TABLE))
    return BinsAt(page.sheet.get_name(), HEADER, last, left)


def _rows(bins: Histogram) -> Iterator[list[Shown]]:
    columns = zip(bins.labels, bins.edges, bins.upper_edges, bins.inside, bins.outside, strict=True)
    for label, low, high, inside, outside in columns:
        edges = [Shown(float(edge), bins.edge_format) for edge in (low, high)]
        if bins.names is not None:
            edges = [cells.BLANK, cells.BLANK]
        yield [
            Shown(_unbroken(label)),
            *edges,
            *(cells.count(int(count)) for count in (inside, outside, inside + outside)),
        ]


def _rest(bins: Histogram) -> Iterator[tuple[str, int]]:
    if bins.names is None:
        yield "Below", bins.below
        yield "Above", bins.above
    elif bins.above:
        yield "Rarer texts", bins.above
    yield "All", int(bins.inside.sum() + bins.outside.sum()) + bins.below + bins.above


def _unbroken(label: str) -> str:
    """Write a label's sign as U+2212: behind a hyphen LibreOffice breaks it, and shows -80 as 80 below a dash."""
    return f"−{label[1:]}" if label[:1] == "-" else label


def histogram_chart(book: Workbook, at: BinsAt, bins: Histogram, units: str | None = None) -> ChartColumn:
    """Chart a histogram. Its texts are references to cells, so that none can be taken for a formula.

    Args:
        book: the workbook.
        at: where its bins stand.
        bins: what is drawn.
        units: below a small chart, which has room for no more, and for no legend; by default it says what bars are.
    """
    chart = book.add_chart({"type": "column", "subtype": "stacked"})
    only_inside = not bins.outside.any()
    for column, colour in zip(_COUNTS[:1] if only_inside else _COUNTS, (DARK, LIGHT), strict=False):
        chart.add_series(
            {
                "name": at.cell(at.header, column),
                "categories": at.column(0),
                "values": at.column(column),
                "fill": {"color": colour},
                "border": {"none": True},
                "gap": 4 if bins.names is None else 40,
            }
        )
    marks = {"interval_unit": bins.step, "interval_tick": bins.step}
    small = units is not None
    below = across(at.cell(at.header - 1), **marks)
    if small:
        below |= {"name": no_reference(units or "")}
    chart.set_x_axis(below)
    chart.set_y_axis(upwards("Accepted trials", min=0))
    finish(chart, at.cell(at.header - 2), legend=not (only_inside or small))
    return chart
