"""The sheet Curves: the numbers that the cumulative, overlay, trend and scatter charts draw, a table for each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.report import cells
from xlmc.report.cells import Shown
from xlmc.report.chart_style import Reference

if TYPE_CHECKING:
    from xlmc.report.page import Page

__all__ = ["HEADER", "SHARE", "Curves", "TableAt"]

HEADER = 4
"""The row of the headings, counted from 0."""

SHARE = "0.00%"
_WIDTH = 11


@dataclass(frozen=True, slots=True)
class TableAt:
    """Where a table of numbers stands; above its headings are a chart's title and the name of its axis."""

    sheet: str
    left: int
    rows: int

    @property
    def title(self) -> Reference:
        return [self.sheet, HEADER - 2, self.left]

    @property
    def axis(self) -> Reference:
        return [self.sheet, HEADER - 1, self.left]

    def heading(self, column: int) -> Reference:
        return [self.sheet, HEADER, self.left + column]

    def column(self, column: int) -> Reference:
        """The cells of a column below its heading."""
        return [self.sheet, HEADER + 1, self.left + column, HEADER + self.rows, self.left + column]

    def formula(self, column: int) -> str:
        """The same as a formula, for what takes no other reference."""
        from xlsxwriter.utility import xl_range_formula

        return "=" + str(xl_range_formula(*self.column(column)))


class Curves:
    """The sheet, its tables side by side."""

    def __init__(self, page: Page, name: str) -> None:
        self._page, self._name, self._left = page, name, 0
        page.title("Curves", f"{name}: the numbers that the cumulative, overlay, trend and scatter charts draw")
        page.sheet.freeze_panes(HEADER + 1, 0)

    def write(self, title: str, axis: str, heads: Sequence[str], rows: Iterable[Sequence[Shown]]) -> TableAt:
        """Write the next table; what it returns says where."""
        page, left = self._page, self._left
        page.sheet.set_column(left, left + len(heads) - 1, _WIDTH)
        page.sheet.set_column(left + len(heads), left + len(heads), 3)
        page.put(HEADER - 2, left, Shown(title, look="heading"))
        page.put(HEADER - 1, left, Shown(axis, look="subtitle"))
        page.row = HEADER
        page.table(heads, rows, left)
        page.sheet.set_row(HEADER, _HEAD_HEIGHT)
        self._left += len(heads) + 1
        return TableAt(page.sheet.get_name(), left, page.row - HEADER - 1)

    def finish(self) -> None:
        """Say so where there is nothing, and set it up for printing."""
        if not self._left:
            self._page.put(HEADER - 1, 0, cells.text("No forecast has a number in an accepted trial.", "alarm"))
        self._page.printed(self._name, repeat=HEADER)


_HEAD_HEIGHT = 48
"""In points: headings of three lines, in whichever table they stand."""
