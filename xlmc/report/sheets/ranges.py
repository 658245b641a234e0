"""Where a chart's numbers stand on a sheet."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["TableAt"]


@dataclass(frozen=True, slots=True)
class TableAt:
    """A table on a sheet; rows and columns are counted from 0.

    Attributes:
        header: the row of column headings.
        first, last: the rows to draw.
    """

    sheet: str
    header: int
    first: int
    last: int

    def heading(self, column: int) -> list[str | int]:
        """A reference to a column's heading."""
        return [self.sheet, self.header, column]

    def column(self, column: int) -> list[str | int]:
        """A reference to the numbers of a column."""
        return [self.sheet, self.first, column, self.last, column]

    def row(self, place: int, first: int, last: int) -> list[str | int]:
        """A reference to some columns of a row, which is counted from the first."""
        return [self.sheet, self.first + place, first, self.first + place, last]

    def cell(self, place: int, column: int) -> list[str | int]:
        """A reference to one cell, its row counted from the first."""
        return [self.sheet, self.first + place, column]

    def formula(self, column: int) -> str:
        """As `column`, in text: what error bars take."""
        from xlsxwriter.utility import xl_range_formula

        return f"={xl_range_formula(self.sheet, self.first, column, self.last, column)}"
