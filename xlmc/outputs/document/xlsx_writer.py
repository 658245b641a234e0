"""Blocks on a sheet: paragraphs, tables of texts and numbers, and charts of Excel's own.

What charts are drawn from stands on a second sheet. Pictures, which a sheet of results cannot hold, are told in words.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.outputs.document.drawings import COLOURS
from xlmc.outputs.document.parts import (
    Bars,
    Block,
    Bullets,
    Chart,
    Code,
    Content,
    Drawing,
    Figure,
    Heading,
    Lines,
    Paragraph,
    Table,
    cell_text,
)
from xlmc.outputs.sheets.cells import Shown, spread_format
from xlmc.outputs.sheets.styles import DARK, INK, LIGHT, SIZE, across, bounds, no_reference, straight, upwards

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart as ExcelChart
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.sheets.page import Page

__all__ = ["sheet_widths", "write_blocks"]

_WIDTHS: Final = (44.0, *[17.0] * 7)
_LONG, _LONG_NUMBER = 60, 26
"""Characters of a column of the sheet that stay in one line, of texts and of numbers."""
_LAST: Final = 5
_CLOUD: Final = {
    "line": {"none": True},
    "marker": {"type": "circle", "size": 3, "fill": {"color": INK, "transparency": 60}, "border": {"none": True}},
}
"""How the points of a cloud look."""
"""The column to which paragraphs reach."""
_CHART_ROWS: Final = 17
_PIXELS: Final = 23
"""Of a row."""
_LOOKS: Final = {"text": "paragraph", "small": "remark"}


def write_blocks(page: Page, blocks: Iterable[Block], book: Workbook, numbers: Callable[[], Page]) -> None:
    """Write blocks from the page's row on down.

    Args:
        page: the sheet.
        blocks: to write.
        book: that the sheet is in.
        numbers: gives the sheet that takes what charts are drawn from; it is asked only where there is one.
    """
    for block in blocks:
        match block:
            case Heading(text, _):
                page.heading(text)
            case Paragraph(text, look):
                page.wide(text, _LOOKS.get(look, look), _LAST)
            case Bullets(texts, look):
                for text in texts:
                    page.wide(f"• {text}", _LOOKS.get(look, look), _LAST)
            case Code(text):
                page.wide(text, "paragraph", _LAST)
            case Figure(picture, caption):
                if isinstance(picture, Chart) and isinstance(picture.data, Lines | Bars):
                    _write_chart(page, book, picture, numbers())
                else:
                    page.wide(f"{picture.said}.", "remark", _LAST)
                if caption:
                    page.wide(caption, "remark", _LAST)
            case Table():
                _write_table(page, block)


def sheet_widths(blocks: Iterable[Block]) -> list[float]:
    """Return the widths of the sheet's columns, in characters: wider where a table has long texts."""
    widths = list(_WIDTHS)
    for block in blocks:
        if isinstance(block, Table) and not _is_wrapped(block):
            right = block.at_right
            widths += [_WIDTHS[-1]] * (block.columns - len(widths))
            for column, cells in enumerate(zip(*block.rows, strict=True)):
                longest = max(len(cell_text(cell)) for cell in cells)
                widths[column] = max(widths[column], min(longest, _LONG_NUMBER if column in right else _LONG))
    return widths


def _is_wrapped(table: Table) -> bool:
    """Whether it is of a name and a long text, which reaches over the columns of the other tables."""
    return table.columns == 2 and any(len(cell_text(row[1])) > _LONG for row in table.rows)


def _write_table(page: Page, table: Table) -> None:
    if table.title:
        page.heading(table.title)
    if table.caption:
        page.wide(table.caption, "remark", _LAST)
    right = table.at_right
    rows = [[_cell(cell, index, index in right) for index, cell in enumerate(row)] for row in table.rows]
    if _is_wrapped(table):
        for row in ([Shown(head, look="header left") for head in table.heads], *rows):
            page.line(row, (0, 1), _LAST)
    elif table.heads:
        page.table(table.heads, rows)
    else:
        for row in rows:
            page.line(row)
    page.row += 1


def _cell(cell: Content, index: int, is_number: bool) -> Shown:
    """Return a cell of the sheet: a text that is a number becomes one; a number with its error stays text."""
    if isinstance(cell, Shown):
        return cell
    text = cell.said if isinstance(cell, Drawing | Chart) else cell
    if not is_number:
        return Shown(text, look="name" if index == 0 else "text")
    try:
        return Shown(float(text))
    except ValueError:
        return Shown(text, look="number")


def _write_chart(page: Page, book: Workbook, chart: Chart, numbers: Page) -> None:
    """Write a chart, and go to the row behind it."""
    if isinstance(chart.data, Lines):
        made, rows = _line_chart(book, chart, chart.data, numbers), _CHART_ROWS
        made.set_size({"width": SIZE[0], "height": SIZE[1]})
    else:
        assert isinstance(chart.data, Bars)
        made, high = _bar_chart(book, chart, chart.data, numbers), 110 + 24 * len(chart.data.bars)
        made.set_size({"width": SIZE[0], "height": high})
        rows = high // _PIXELS + 1
    if chart.title:
        made.set_title({"name": no_reference(chart.title), "name_font": {"size": 12, "bold": True, "color": INK}})
    else:
        made.set_title({"none": True})
    page.sheet.insert_chart(page.row, 0, made, {"object_position": 1, "description": chart.said})
    page.row += rows


def _line_chart(book: Workbook, chart: Chart, shown: Lines, numbers: Page) -> ExcelChart:
    made = straight(book.add_chart({"type": "scatter", "subtype": "straight"}))
    for index, line in enumerate(shown.all, len(shown.lines) - len(shown.all)):
        points = [(point[0], point[1]) for point in line.points]
        places = [point[0] for point in points]
        spread = spread_format(max(places) - min(places), shown.form_across)
        share = "0.00%" if shown.share else _numbers_format(shown)
        first, last, column = _columns(numbers, (line.name, shown.upwards), points, (spread, share))
        made.add_series(
            {
                "name": [numbers.name, first - 1, column],
                "categories": [numbers.name, first, column, last, column],
                "values": [numbers.name, first, column + 1, last, column + 1],
                "line": {"color": COLOURS[index % len(COLOURS)], "width": 1.5 if index else 2.25},
                "marker": {"type": "circle" if shown.dots else "none", "size": 4},
                **(_CLOUD if line is shown.cloud else {}),
            }
        )
    low, high = shown.ends
    made.set_x_axis({**across(), "name": no_reference(chart.across), **bounds(low, high)})
    vertical = upwards(no_reference(shown.upwards), "0%" if shown.share else "General")
    if not shown.share and shown.form_upwards != PLAIN:
        vertical["num_format"] = _numbers_format(shown)
    made.set_y_axis({**vertical, **({"min": 0, "max": 1} if shown.share else {})})
    made.set_legend({"position": "right"})
    return made


def _numbers_format(shown: Lines) -> str:
    """Return the format of the numbers of the vertical axis, in digits that tell its ends apart."""
    if shown.form_upwards == PLAIN:
        return "General"
    heights = [point[1] for line in shown.all for point in line.points if math.isfinite(point[1])]
    return spread_format(max(heights) - min(heights), shown.form_upwards) if heights else "General"


def _bar_chart(book: Workbook, chart: Chart, shown: Bars, numbers: Page) -> ExcelChart:
    """Draw bars from 0, those of one row over each other: each look is a series."""
    made = straight(book.add_chart({"type": "bar"}))
    looks = [*dict.fromkeys(look for bar in shown.bars for _, _, look in bar.pieces)]
    ends: list[list[str | float]] = []
    for bar in shown.bars:
        found: dict[str, float] = {look: end for _, end, look in bar.pieces}
        ends.append([bar.name, *(found.get(look, 0.0) for look in looks)])
    pieces = len(looks)
    heads = (chart.across, *(f"To {index + 1}" for index in range(pieces)))
    first, last, column = _columns(numbers, heads, ends, ("", *["General"] * pieces))
    for index in range(pieces):
        made.add_series(
            {
                "categories": [numbers.name, first, column, last, column],
                "values": [numbers.name, first, column + 1 + index, last, column + 1 + index],
                "fill": {"color": DARK if looks[index] == "dark" else LIGHT},
                "gap": 40,
                "overlap": 100,
            }
        )
    made.set_x_axis({**across(), "name": no_reference(chart.across)})
    made.set_y_axis({"reverse": True, "label_position": "low", "num_font": {"rotation": 0}})  # all are shown
    made.set_legend({"none": True})
    return made


def _columns(
    page: Page, heads: Sequence[str], rows: Sequence[Sequence[str | float]], formats: Sequence[str]
) -> tuple[int, int, int]:
    """Write columns beside those that are there: their first row, their last, and the first of them."""
    last = page.sheet.dim_colmax
    column = 0 if last is None or page.row == 0 else last + 2
    page.row = 1
    page.sheet.set_column(column, column + len(heads) - 1, 16)
    for offset, head in enumerate(heads):
        page.put(0, column + offset, Shown(head, look="header left"))
    for row, cells in enumerate(rows, 1):
        for offset, (cell, form) in enumerate(zip(cells, formats, strict=True)):
            page.put(row, column + offset, Shown(cell) if isinstance(cell, str) else Shown(cell, form))
    return 1, len(rows), column
