"""Blocks on a sheet: paragraphs, tables of texts and numbers, and charts of Excel's own.

What charts are drawn from stands on a second sheet. Pictures, which a sheet of results cannot hold, are told in words.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.forms import PLAIN
from xlmc.outputs.document.cells import BLANK, Shown, shown_text, spread_format
from xlmc.outputs.document.colours import DARK, INK, LIGHT
from xlmc.outputs.document.drawings import COLOURS
from xlmc.outputs.document.measured import HEADS, Measured
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
from xlmc.outputs.sheets.styles import SIZE, across, bounds, no_reference, straight, upwards

if TYPE_CHECKING:
    from xlsxwriter.chart import Chart as ExcelChart
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.sheets.page import Page

__all__ = ["Charting", "row_cells", "sheet_widths", "write_blocks"]

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
_LOOKS: Final = {"text": "paragraph", "small": "remark", "meaning": "remark"}


@dataclass(frozen=True, slots=True)
class Charting:
    """Where charts of Excel's own are made.

    Attributes:
        book: that the sheet is in.
        numbers: gives the sheet that takes what charts are drawn from; it is asked only where there is one.
    """

    book: Workbook
    numbers: Callable[[], Page]


def write_blocks(page: Page, blocks: Iterable[Block], charting: Charting | None = None, last: int = _LAST) -> None:
    """Write blocks from the page's row on down.

    Args:
        page: the sheet.
        blocks: to write.
        charting: where charts are made; without it they are told in words.
        last: the column to which paragraphs reach.
    """
    spaced = True
    for block in blocks:
        if not (spaced or isinstance(block, Heading) or (isinstance(block, Table) and (block.title or block.caption))):
            page.row += 1
        spaced = not isinstance(block, Table)
        match block:
            case Heading(text, _):
                page.heading(text)
            case Paragraph(text, look, _):
                page.wide(text, _LOOKS.get(look, look), last)
            case Bullets(texts, look, _):
                for text in texts:
                    page.wide(f"• {text}", _LOOKS.get(look, look), last)
            case Code(text):
                page.wide(text, "paragraph", last)
            case Figure(picture, caption):
                if charting and isinstance(picture, Chart) and isinstance(picture.data, Lines | Bars):
                    _write_chart(page, charting.book, picture, charting.numbers())
                else:
                    page.wide(f"{picture.said}.", "remark", last)
                if caption:
                    page.wide(caption, "remark", last)
            case Table():
                _write_table(page, block, last)


def sheet_widths(blocks: Iterable[Block]) -> list[float]:
    """Return the widths of the sheet's columns, in characters: wider where a table has long texts."""
    widths = list(_WIDTHS)
    for block in blocks:
        if isinstance(block, Table) and not _is_wrapped(block):
            lines, counts = _lines_of(block)
            widths += [_WIDTHS[-1]] * (sum(counts) - len(widths))
            right = [index in block.at_right for index, count in enumerate(counts) for _ in range(count)]
            for column, shown in enumerate(zip(*lines, strict=True)):
                longest = max(len(shown_text(cell)) for cell in shown)
                widths[column] = max(widths[column], min(longest, _LONG_NUMBER if right[column] else _LONG))
    return widths


def _is_wrapped(table: Table) -> bool:
    """Whether it is of a name and a long text, which reaches over the columns of the other tables."""
    return table.columns == 2 and any(len(cell_text(row[1])) > _LONG for row in table.rows)


def _write_table(page: Page, table: Table, last: int) -> None:
    if table.title or table.caption:
        page.heading(table.title or table.caption.removesuffix("."))
    if table.title and table.caption:
        page.wide(table.caption, "remark", last)
    right = table.at_right
    lines, counts = _lines_of(table)
    if _is_wrapped(table):
        for row in ([Shown(head, look="header left") for head in table.heads], *lines):
            page.line(row, (0, 1), _LAST)
        return
    starts, end = _starts(table, counts)
    if table.heads:
        heads = table.heads
        if table.over:
            above = [Shown(head, look="header") for head in heads[1:]]
            page.line([Shown(table.over, look="header left"), *above], _places(starts, counts), end)
            heads = (heads[0], *["Value"] * (table.columns - 1))
        looks = ["header" if index in right else "header left" for index in range(table.columns)]
        line = [
            Shown(text, look=look)
            for head, look, count in zip(heads, looks, counts, strict=True)
            for text in (head, *HEADS[: count - 1])
        ]
        page.line(line, starts, end)
    for line in lines:
        page.line(line, starts, end)


def _lines_of(table: Table) -> tuple[list[list[Shown]], list[int]]:
    """Return each row as cells of the sheet, and how many of them each column of the table takes."""
    right = table.at_right
    lines = [[_cells(cell, index, right) for index, cell in enumerate(row)] for row in table.rows]
    counts = [max((len(line[index]) for line in lines), default=1) for index in range(table.columns)]
    filled = (
        [[*cells, *[BLANK] * (count - len(cells))] for cells, count in zip(line, counts, strict=True)] for line in lines
    )
    return [[shown for cells in line for shown in cells] for line in filled], counts


def _places(starts: Sequence[int], counts: Sequence[int]) -> list[int]:
    """Return where the first cell of each column of a table stands."""
    return [starts[sum(counts[:index])] for index in range(len(counts))]


def _starts(table: Table, counts: Sequence[int]) -> tuple[list[int], int]:
    """Return the column of the sheet in which each cell of a row begins, and the column to which the last one reaches.

    Args:
        table: the table.
        counts: how many cells each of its columns takes.
    """
    starts: list[int] = []
    column = 0
    for count, span in zip(counts, table.spans or [1] * table.columns, strict=True):
        starts += range(column, column + count)
        column += max(count, span)
    return starts, column - 1


def row_cells(row: Sequence[Content]) -> list[Shown]:
    """Return a row of numbers and texts as the cells of the sheet that it takes."""
    return [shown for index, cell in enumerate(row) for shown in _cells(cell, index, ())]


def _cells(cell: Content, index: int, right: Collection[int]) -> Sequence[Shown]:
    """Return the cells of the sheet that a cell of a table takes: a text that is a number becomes one."""
    if isinstance(cell, Measured):
        return cell.shown
    if isinstance(cell, Shown):
        return (cell,)
    text = cell.said if isinstance(cell, Drawing | Chart) else cell
    if index not in right:
        return (Shown(text, look="name" if index == 0 else "text"),)
    try:
        return (Shown(float(text)),)
    except ValueError:
        return (Shown(text, look="number"),)


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
