"""The sheet Curves: the numbers that the cumulative, overlay, trend and scatter charts draw, a table for each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.outputs.document.cells import Shown
from xlmc.outputs.sheets.styles import Reference

if TYPE_CHECKING:
    from xlmc.outputs.sheets.page import Page

__all__ = ["HEADER", "SHARE", "Curves", "TableAt"]

HEADER = 5
"""The row of the headings, counted from 0."""

_TITLES = HEADER - 3
SHARE = "0.00%"
_WIDTH = 11
_HEAD_HEIGHT = 48
"""The height of the headings in points: three lines, in whichever table."""


@dataclass(frozen=True, slots=True)
class TableAt:
    """The place of a table of numbers; above its headings are a chart's title and the name of its axis."""

    sheet: str
    left: int
    rows: int

    def title(self, number: int = 0) -> Reference:
        """Return a reference to the first title or the second."""
        return [self.sheet, _TITLES + number, self.left]

    @property
    def axis(self) -> Reference:
        return [self.sheet, HEADER - 1, self.left]

    def heading(self, column: int) -> Reference:
        return [self.sheet, HEADER, self.left + column]

    def cell(self, row: int) -> Reference:
        """Return a reference to a cell of the first column, its row counted from the one below the headings."""
        return [self.sheet, HEADER + 1 + row, self.left]

    def column(self, column: int) -> Reference:
        """Return a reference to the cells of a column below its heading."""
        return [self.sheet, HEADER + 1, self.left + column, HEADER + self.rows, self.left + column]


class Curves:
    """The sheet, its tables side by side."""

    def __init__(self, page: Page, name: str) -> None:
        self._page, self._left = page, 0
        below = f"{name}: the numbers that the cumulative, overlay, trend and scatter charts draw."
        page.title_of_data("Curves", below, name, HEADER, hidden=True)
        page.sheet.freeze_panes(HEADER + 1, 0)

    def write(
        self,
        titles: Sequence[str],
        axis: str,
        heads: Sequence[str],
        rows: Iterable[Sequence[Shown]],
        width: float = _WIDTH,
    ) -> TableAt:
        """Write the next table; what it returns says where.

        Args:
            titles: of the charts that draw it, at most two.
            axis: the name of their horizontal axis.
            heads: the headings of its columns.
            rows: of cells.
            width: of a column.
        """
        page, left = self._page, self._left
        page.sheet.set_column(left, left + len(heads) - 1, width)
        page.sheet.set_column(left + len(heads), left + len(heads), 3)
        for row, title in enumerate(titles, _TITLES):
            page.put(row, left, Shown(title, look="heading"))
        page.put(HEADER - 1, left, Shown(axis, look="subtitle"))
        page.row = HEADER
        page.table(heads, rows, left)
        page.sheet.set_row(HEADER, _HEAD_HEIGHT)
        self._left += len(heads) + 1
        return TableAt(page.sheet.get_name(), left, page.row - HEADER - 1)

    def finish(self) -> None:
        """Say so where there is nothing."""
        if not self._left:
            self._page.put(HEADER - 1, 0, Shown("No forecast has a number in an accepted trial.", look="alarm"))
