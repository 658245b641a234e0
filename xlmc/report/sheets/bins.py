"""The sheet Bins: the numbers that the charts draw, a table for each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from xlmc.report.figure import Figure
from xlmc.report.histogram import Histogram
from xlmc.report.sheets import cells
from xlmc.report.sheets.cells import Shown
from xlmc.report.sheets.histogram_chart import BinsAt
from xlmc.report.summary import percent

if TYPE_CHECKING:
    from xlmc.report.sheets.page import Page

__all__ = ["HEADER", "TABLE", "BinsAt", "write_bins"]

HEADER = 4
"""The row of the headings, counted from 0."""

TABLE = 6
"""Columns of a table; a narrow one follows."""

_ON_A_PAGE, _SCALE = 2, 64
"""Tables side by side, and the percentage at which so many fit."""


def write_bins(page: Page, figures: Sequence[Figure], name: str) -> list[BinsAt]:
    """Write the sheet with the tables of bins side by side; the place of each is returned."""
    page.title("Bins of the histograms", f"{name}: the numbers that the charts draw")
    places = [_write_table(page, figure) for figure in figures]
    page.sheet.freeze_panes(HEADER + 1, 0)
    breaks = [place.left for place in places[_ON_A_PAGE::_ON_A_PAGE]]
    page.printed(name, repeat=HEADER, repeat_from=HEADER - 2, scale=_SCALE, columns=breaks)
    return places


def _write_table(page: Page, figure: Figure) -> BinsAt:
    left = (figure.number - 1) * (TABLE + 1)
    page.sheet.set_column(left, left + TABLE - 1, 11)
    page.sheet.set_column(left + TABLE, left + TABLE, 3)
    page.put(HEADER - 2, left, Shown(figure.name, look="heading"))
    page.put(HEADER - 1, left, Shown(figure.axis, look="subtitle"))
    page.row = HEADER
    share = percent(figure.answer.share)
    page.table(["Label", "From", "to below", f"Inside {share} range", "Outside", "Trials"], _rows(figure.bins), left)
    last = page.row - 1
    for label, count in _rest(figure.bins):
        page.line([cells.text(label, "label"), *[cells.BLANK] * (TABLE - 2), cells.count(count)], left)
    return BinsAt(page.sheet.get_name(), HEADER, last, left)


def _rows(bins: Histogram) -> Iterator[list[Shown]]:
    columns = zip(bins.labels, bins.edges, bins.upper_edges, bins.inside, bins.outside, strict=True)
    for label, low, high, inside, outside in columns:
        edges = [Shown(float(edge), bins.edge_format) for edge in (low, high)]
        yield [cells.text(label), *edges, *(cells.count(int(count)) for count in (inside, outside, inside + outside))]


def _rest(bins: Histogram) -> Iterator[tuple[str, int]]:
    yield "Below", bins.below
    yield "Above", bins.above
    yield "All", int(bins.inside.sum() + bins.outside.sum()) + bins.below + bins.above
