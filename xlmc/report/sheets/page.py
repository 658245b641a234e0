"""A result sheet as it is written, from the top down. Texts never become formulas; what is no number becomes a text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import count, islice
from typing import TYPE_CHECKING

from xlmc.report.sheets.cells import NONE, Shown

if TYPE_CHECKING:
    from xlmc.report.sheets.exact_book import ExactSheet
    from xlmc.report.sheets.styles import Styles

__all__ = ["LONGEST_TEXT", "ROW", "Page", "cut"]

LONGEST_TEXT = 32_767
"""Characters in a cell, Excel's limit."""

ROW = 17.25
"""The height of a row, in points: 23 pixels."""

_HEADING_COLUMNS = 11
_LINE = 15.0
_HIGHEST = 409.0
_WIDTH = 8.43


class Page:
    """A worksheet and the row to write next.

    Attributes:
        row: counted from 0.

    Args:
        sheet: the worksheet.
        styles: of its cells.
        widths: of its columns, from the first on.
        header: stands on top of every printed page, on the right.
    """

    def __init__(self, sheet: ExactSheet, styles: Styles, widths: Sequence[float], header: str = "") -> None:
        self.sheet, self._styles, self._widths = sheet, styles, list(widths)
        self._header = header
        self.row = 0
        for column, width in enumerate(widths):
            sheet.set_column(column, column, width)
        sheet.set_default_row(ROW)
        sheet.hide_gridlines(2)

    def put(self, row: int, column: int, shown: Shown) -> None:
        """Write one cell."""
        style, value = self._styles(shown.look, shown.format), shown.value
        if value is None or value == "":
            self.sheet.write_blank(row, column, None, style)
        elif isinstance(value, str):
            self.sheet.write_string(row, column, cut(value), style)
        elif isinstance(value, bool):
            self.sheet.write_boolean(row, column, value, style)
        elif math.isfinite(value):
            self.sheet.write_number(row, column, value, style)
        else:
            self.sheet.write_string(row, column, _in_words(value), style)

    def numbers(self, row: int, column: int, values: Sequence[float], number_format: str, look: str = "number") -> None:
        """Write a column of numbers that look alike, from a row on down: what `put` does for each, in less time."""
        style = self._styles(look, number_format)
        if values:
            self.sheet.write_numbers(row, column, values, style)
        for at, value in enumerate(values, row):
            if not math.isfinite(value):
                self.sheet.write_string(at, column, _in_words(value), style)

    def formula(self, row: int, column: int, formula: str, shown: Shown) -> None:
        """Write one cell whose value, shown until somebody changes what it depends on, is known."""
        self.sheet.write_formula(row, column, formula, self._styles(shown.look, shown.format), shown.value)

    def line(
        self, cells: Sequence[Shown], starts: Iterable[int] | None = None, last: int | None = None, *, fit: bool = True
    ) -> None:
        """Write cells, and go to the next row.

        Args:
            cells: from left to right.
            starts: the column of each, which reaches to the next one's; by default they stand side by side.
            last: the column that the last cell reaches to; by default its own.
            fit: whether the row becomes as high as its texts need.
        """
        starts = list(islice(count() if starts is None else starts, len(cells)))
        ends = [*(start - 1 for start in starts[1:]), *(starts[-1:] if last is None else [last])]
        lines = 1
        for shown, first, end in zip(cells, starts, ends, strict=True):
            if end > first:
                self.sheet.merge_range(self.row, first, self.row, end, "", self._styles(shown.look, shown.format))
            self.put(self.row, first, shown)
            if isinstance(shown.value, str):
                lines = max(lines, self._lines(shown, first, end))
        if fit:  # every row, or LibreOffice chooses heights of its own
            self.sheet.set_row(self.row, ROW if lines == 1 else min(_LINE * lines + 3.0, _HIGHEST))
        self.row += 1

    def wide(self, value: str, look: str, last: int, first: int = 0) -> None:
        """Write a text across columns, and go to the next row."""
        self.line([Shown(value, look=look)], [first], last)

    def table(self, headers: Sequence[str], rows: Iterable[Sequence[Shown]], column: int = 0) -> None:
        """Write a table with its header."""
        looks = ["header left", *["header"] * (len(headers) - 1)]
        self.line([Shown(header, look=look) for header, look in zip(headers, looks, strict=True)], count(column))
        for cells in rows:
            self.line(cells, count(column))

    def title(self, value: str, below: str, column: int = 0) -> None:
        """Write the sheet's title and the line below it."""
        self.sheet.set_row(self.row, 26)
        self.put(self.row, column, Shown(value, look="title"))
        self.put(self.row + 1, column, Shown(below, look="subtitle"))
        self.row += 2

    def title_of_data(self, value: str, below: str, name: str, header: int, *, hidden: bool = False) -> None:
        """Write the title of a sheet that would fill many pages; of it, the title and the line below are printed.

        Args:
            value: the title.
            below: the line below; what is printed is added to it.
            name: of the workbook, for the foot of the page.
            header: the row of headings, which stands on top of every page once the numbers are printed, too.
            hidden: whether the sheet opens hidden, so that nothing of it is printed.
        """
        if hidden:
            self.title(value, f"{below} This sheet opens hidden; hidden sheets are not printed.")
            self.sheet.hide()
        else:
            self.title(value, f"{below} Only this heading is printed, unless you clear the print area.")
            self.sheet.print_area(0, 0, 1, _HEADING_COLUMNS)
        self.set_up_printing(name, repeat=header)

    def heading(self, value: str, column: int = 0) -> None:
        """Write the heading of a section, with space above it."""
        self.sheet.set_row(self.row + 1, 21)
        self.put(self.row + 1, column, Shown(value, look="heading"))
        self.row += 2

    def set_up_printing(
        self,
        name: str,
        *,
        repeat: int | None = None,
        repeat_from: int | None = None,
        scale: int = 100,
        breaks: Sequence[int] = (),
        columns: Sequence[int] = (),
        upright: bool = False,
    ) -> None:
        """Set up how the sheet prints: one page wide, unless columns are given to break at.

        Args:
            name: of the workbook, for the foot of the page.
            repeat: the row to stand on top of every page, counted from 0.
            repeat_from: the first of several such rows.
            scale: in percent; 100 without breaks fits the sheet to the page's width, where Excel heeds no break.
            breaks: the rows that begin a new page, counted from 0.
            columns: the columns that do.
            upright: whether its pages are higher than wide.
        """
        if not upright:
            self.sheet.set_landscape()
        if breaks or columns or scale != 100:
            self.sheet.set_print_scale(scale)
            self.sheet.set_h_pagebreaks(list(breaks))
            self.sheet.set_v_pagebreaks(list(columns))
            self.sheet.center_horizontally()
        else:
            self.sheet.fit_to_pages(1, 0)
        self.sheet.set_margins(left=0.5, right=0.5, top=0.6, bottom=0.7)
        self.sheet.set_footer(f"&L{_plain(name)}&C&A&RPage &P of &N")
        if self._header:
            self.sheet.set_header(f"&R{_plain(self._header)}")
        if repeat is not None:
            self.sheet.repeat_rows(repeat if repeat_from is None else repeat_from, repeat)

    def _lines(self, shown: Shown, first: int, last: int) -> int:
        """How many lines a text takes, of letters somewhat narrower than the digits that widths are counted in."""
        own = self._widths[first : last + 1]
        width = sum(own) + _WIDTH * (last - first + 1 - len(own))
        room = max(1.1 * width - (1.0 if shown.look == "header" else 3.0), 1.0)
        return sum(max(1, math.ceil(length / room)) for length in map(len, str(shown.value).split("\n")))


def cut(value: str) -> str:
    """The text, or as much of it as a cell holds, with a mark."""
    return value if len(value) <= LONGEST_TEXT else value[: LONGEST_TEXT - 6] + " [cut]"


def _plain(value: str) -> str:
    """A text as the head and the foot of a page take it: `&` begins a code there, and Excel takes 255 characters."""
    return value[:120].replace("&", "&&")


def _in_words(value: float) -> str:
    if math.isnan(value):
        return NONE
    return "∞" if value > 0 else "−∞"
