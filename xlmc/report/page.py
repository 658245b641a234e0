"""A result sheet being written, from the top down. It writes no formula, and no number that is none."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from xlmc.report.cells import NONE, Shown

if TYPE_CHECKING:
    from xlsxwriter.worksheet import Worksheet

    from xlmc.report.styles import Styles

__all__ = ["LONGEST_TEXT", "Page", "cut"]

LONGEST_TEXT = 32_767
"""Characters in a cell, Excel's limit."""

_LINE = 15.5
_WIDTH = 8.43


class Page:
    """A worksheet and the row to write next.

    Attributes:
        row: counted from 0.
    """

    def __init__(self, sheet: Worksheet, styles: Styles, widths: Sequence[float]) -> None:
        self.sheet, self.styles, self._widths = sheet, styles, list(widths)
        self.row = 0
        for column, width in enumerate(widths):
            sheet.set_column(column, column, width)
        sheet.hide_gridlines(2)

    def put(self, row: int, column: int, shown: Shown) -> None:
        """Write one cell."""
        style = self.styles(shown.look, shown.format)
        value = shown.value
        if value is None:
            self.sheet.write_blank(row, column, None, style)
        elif isinstance(value, str):
            self.sheet.write_string(row, column, cut(value), style)
        elif math.isfinite(value):
            self.sheet.write_number(row, column, value, style)
        else:
            self.sheet.write_string(row, column, _in_words(value), style)

    def line(self, cells: Iterable[Shown], column: int = 0) -> None:
        """Write cells side by side, and go to the next row."""
        for place, shown in enumerate(cells, column):
            self.put(self.row, place, shown)
        self.row += 1

    def table(self, headers: Sequence[str], rows: Iterable[Sequence[Shown]], column: int = 0) -> None:
        """Write a table: its header, and a row as high as its texts need."""
        looks = ["header left", *["header"] * (len(headers) - 1)]
        self.fitted([Shown(header, look=look) for header, look in zip(headers, looks, strict=True)], column)
        for cells in rows:
            self.fitted(cells, column)

    def fitted(self, cells: Sequence[Shown], column: int = 0) -> None:
        """Write cells side by side in a row as high as their texts need."""
        widths = [self._width(place, place) for place in range(column, column + len(cells))]
        texts = [(c.value, width) for c, width in zip(cells, widths, strict=True) if isinstance(c.value, str)]
        self._heighten(max((_lines(value, width) for value, width in texts), default=1))
        self.line(cells, column)

    def spread(self, texts: Sequence[str], starts: Sequence[int], last: int, look: str) -> None:
        """Write texts side by side, each across the columns from its start to the next one's."""
        ends = [*(start - 1 for start in starts[1:]), last]
        lines = 1
        for value, first, end in zip(texts, starts, ends, strict=True):
            self._across(value, look, first, end)
            lines = max(lines, _lines(value, self._width(first, end)))
        self._heighten(lines)
        self.row += 1

    def wide(self, value: str, look: str, last: int, first: int = 0) -> None:
        """Write a text across columns, in a row as high as it needs, and go to the next row."""
        self.spread([value], [first], last, look)

    def title(self, value: str, below: str) -> None:
        """Write the sheet's title and the line below it."""
        self.sheet.set_row(self.row, 26)
        self.line([Shown(value, look="title")])
        self.line([Shown(below, look="subtitle")])

    def heading(self, value: str) -> None:
        """Write the heading of a section, with space above it."""
        self.row += 1
        self.sheet.set_row(self.row, 20)
        self.line([Shown(value, look="heading")])

    def printed(self, name: str, *, landscape: bool = True, repeat: int | None = None) -> None:
        """Make it print one page wide, with `repeat` as the last row to stand on top of every page."""
        if landscape:
            self.sheet.set_landscape()
        self.sheet.fit_to_pages(1, 0)
        self.sheet.set_margins(left=0.5, right=0.5, top=0.6, bottom=0.7)
        self.sheet.set_footer(f"&L&9{name.replace('&', '&&')[:120]}&C&9&A&R&9Page &P of &N")
        if repeat is not None:
            self.sheet.repeat_rows(repeat)

    def _across(self, value: str, look: str, first: int, last: int) -> None:
        style = self.styles(look)
        if last > first:
            self.sheet.merge_range(self.row, first, self.row, last, "", style)
        self.sheet.write_string(self.row, first, cut(value), style)

    def _width(self, first: int, last: int) -> float:
        own = self._widths[first : last + 1]
        return sum(own) + _WIDTH * (last - first + 1 - len(own))

    def _heighten(self, lines: int) -> None:
        if lines > 1:
            self.sheet.set_row(self.row, min(_LINE * lines + 3, 409))


def cut(value: str) -> str:
    """The text, or as much of it as a cell holds, with a mark."""
    return value if len(value) <= LONGEST_TEXT else value[: LONGEST_TEXT - 6] + " [cut]"


def _in_words(value: float) -> str:
    if math.isnan(value):
        return NONE
    return "∞" if value > 0 else "−∞"


def _lines(value: str, width: float) -> int:
    """How many lines a text takes; words do not fill lines, hence the margin."""
    room = max(width * 0.95 - 1, 1)
    return sum(max(1, math.ceil(len(part) / room)) for part in value.split("\n"))
