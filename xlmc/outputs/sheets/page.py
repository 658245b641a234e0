"""A result sheet as it is written, from the top down. Texts never become formulas; what is no number becomes a text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import count, islice
from typing import TYPE_CHECKING

from xlmc.outputs.document.cells import LOGICAL, NONE, Shown, shown_text
from xlmc.outputs.sheets.paper import MARGINS, lay_out
from xlmc.outputs.sheets.text_lines import line_count

if TYPE_CHECKING:
    from xlmc.outputs.sheets.exact_book import ExactSheet
    from xlmc.outputs.sheets.styles import Styles

__all__ = ["LONGEST_TEXT", "ROW", "Page", "cut"]

LONGEST_TEXT = 32_767
"""Characters in a cell, Excel's limit."""

ROW = 17.25
"""The height of a row, in points: 23 pixels."""

_LAST_CELL = (1_048_575, 16_383)
"""The row and column of the sheet's last cell, which is blank: the print area of a sheet that is not printed."""
_EDGE = 0.2
"""Inches between the edge of the paper and the head or the foot."""
_GAP = 6.0
_HEADING = 16.5
_POINTS = 0.75
"""In a pixel."""
_LINE = 15.0
_HIGHEST = 409.0
_WIDTH = 8.43
_PADDING = 0.7
"""The digits that fit between the columns of two cells that are one."""
_CERTAIN = 0.96
"""The part of a cell that letters are taken to fill: programs break a line somewhat sooner on paper."""
_INDENT = 1.5
_AT_THE_EDGE = frozenset({"header", "paragraph", "remark", "caption"})
"""Looks without an indent, which takes so many digits."""
_BOLD = frozenset({"header", "header left", "name", "warning", "alarm"})
_CODE = 1.05
"""How wide letters of equal width are, in digits."""
_LARGE = 1e8
"""From here on a number may be wider than a column."""


class Page:
    """A worksheet and the row to write next.

    Attributes:
        row: counted from 0.
        height: of a row of one line, in points.

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
        self.height = ROW
        self._begins: list[int] = []
        for column, width in enumerate(widths):
            sheet.set_column(column, column, width)
        sheet.set_default_row(ROW)
        sheet.hide_gridlines(2)

    @property
    def name(self) -> str:
        """Of the worksheet."""
        return str(self.sheet.get_name())

    def put(self, row: int, column: int, shown: Shown) -> None:
        """Write one cell."""
        value = shown.value
        style = self._styles(shown.look, LOGICAL if isinstance(value, bool) else shown.format)
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
            else:
                self._widen(first, shown)
            self.put(self.row, first, shown)
            if isinstance(shown.value, str):
                lines = max(lines, self._lines(shown, first, end))
        if fit:  # every row, or LibreOffice chooses heights of its own
            further = min(_LINE, self.height) * (lines - 1)
            self.sheet.set_row(self.row, min(self.height + further, _HIGHEST))
        self.row += 1

    def _widen(self, column: int, shown: Shown) -> None:
        """Make a column as wide as a large number in it, which would be `###` or in tiny digits else."""
        if isinstance(shown.value, str | None) or not math.isfinite(shown.value) or abs(shown.value) < _LARGE:
            return
        needed = len(shown_text(shown)) + 1.0
        own = self._widths[column] if column < len(self._widths) else _WIDTH
        if needed > own:
            self._widths += [_WIDTH] * (column + 1 - len(self._widths))
            self._widths[column] = needed
            self.sheet.set_column(column, column, needed)

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
        """Write the title of a sheet that would fill many pages, and is not printed.

        Args:
            value: the title.
            below: the line below; that it is not printed is added to it.
            name: of the workbook, for the foot of the page.
            header: the row of headings, which stands on top of every page once the numbers are printed.
            hidden: whether the sheet opens hidden.
        """
        if hidden:
            self.title(value, f"{below} This sheet opens hidden; hidden sheets are not printed.")
            self.sheet.hide()
        else:
            self.title(value, f"{below} This sheet is not printed, unless you clear its print area, a blank cell.")
            self.sheet.print_area(*_LAST_CELL, *_LAST_CELL)
        self.sheet.set_landscape()
        self.sheet.fit_to_pages(1, 0)
        self.sheet.repeat_rows(header, header)
        self._head_and_foot(name)

    def may_begin(self) -> None:
        """Say that the next row may begin a page."""
        self._begins.append(self.row)

    def heading(self, value: str, column: int = 0) -> None:
        """Write the heading of a section, with space above it."""
        self.sheet.set_row(self.row, _GAP)
        self.sheet.set_row(self.row + 1, _HEADING)
        self._begins.append(self.row + 1)
        self.put(self.row + 1, column, Shown(value, look="heading"))
        self.row += 2

    def set_up_printing(
        self,
        name: str,
        *,
        repeat: int | None = None,
        repeat_to: int | None = None,
        printed: int | None = None,
        columns: tuple[int, int] | None = None,
    ) -> None:
        """Set up how the sheet prints: one page wide, and whole sections on a page; see `paper`.

        Args:
            name: of the workbook, for the foot of the page.
            repeat: the row to stand on top of every page, counted from 0.
            repeat_to: the row behind the last that it is the heading of; what follows stays on the page of that one, so
                that no page repeats a heading that it has no rows of.
            printed: the row behind the last that is printed, where the rest is not unless the print area is cleared;
                by default all is printed.
            columns: the first and the last column that are printed; by default all are.
        """
        rows = (self.sheet.dim_rowmax or 0) + 1
        if repeat_to is not None:
            self._begins = [row for row in self._begins if row < repeat_to]
        first, last = columns or (0, self.sheet.dim_colmax or 0)
        width = _POINTS * sum(self.sheet._size_col(column) for column in range(first, last + 1))
        heights = [_POINTS * self.sheet._size_row(row) for row in range(rows)]
        repeated = 0.0 if repeat is None else heights[repeat]
        end = rows if printed is None else printed
        layout = lay_out(width, heights[:end], self._begins, repeated, whole=printed is None)
        if not layout.upright:
            self.sheet.set_landscape()
        self.sheet.fit_to_pages(1, 1 if layout.whole else 0)
        breaks = list(layout.breaks)
        if printed is not None:
            begins = [row - end for row in self._begins]
            breaks += [end, *(end + row for row in lay_out(width, heights[end:], begins, repeated, whole=False).breaks)]
        self.sheet.set_h_pagebreaks(breaks)
        if printed is not None or columns is not None:
            self.sheet.print_area(0, first, end - 1, last)
        self._head_and_foot(name)
        if repeat is not None:
            self.sheet.repeat_rows(repeat, repeat)

    def _head_and_foot(self, name: str) -> None:
        self.sheet.set_margins(**MARGINS)
        self.sheet.set_footer(f"&L{_plain(name)}&C&A&RPage &P of &N", {"margin": _EDGE})
        if self._header:
            self.sheet.set_header(f"&R{_plain(self._header)}", {"margin": _EDGE})

    def _lines(self, shown: Shown, first: int, last: int) -> int:
        """Return how many lines a text takes in cells that reach from column to column."""
        own = self._widths[first : last + 1]
        width = sum(own) + _WIDTH * (last - first + 1 - len(own)) + _PADDING * (last - first)
        room = _CERTAIN * width - (0.0 if shown.look in _AT_THE_EDGE else _INDENT)
        bold, even = shown.look in _BOLD, _CODE if shown.look == "code" else 0.0
        return line_count(str(shown.value), room, bold=bold, even=even)


def cut(value: str) -> str:
    """Return the text, or as much of it as a cell holds, with a mark."""
    return value if len(value) <= LONGEST_TEXT else value[: LONGEST_TEXT - 6] + " [cut]"


def _plain(value: str) -> str:
    """Escape a text for the head and foot of a page: `&` begins a code there, and Excel takes 255 characters."""
    return value[:120].replace("&", "&&")


def _in_words(value: float) -> str:
    if math.isnan(value):
        return NONE
    return "∞" if value > 0 else "−∞"
