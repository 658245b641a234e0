"""Blocks on a sheet: paragraphs, tables of texts and numbers, and charts of Excel's own.

What charts are drawn from stands on a second sheet. Pictures, which a sheet of results cannot hold, are described
in words.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.outputs.document.cells import BLANK, Shown, shown_text
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
from xlmc.outputs.sheets.native_charts import native_chart, write_series
from xlmc.outputs.sheets.styles import SIZE

if TYPE_CHECKING:
    from xlsxwriter.workbook import Workbook

    from xlmc.outputs.sheets.page import Page

__all__ = ["Charting", "row_cells", "sheet_widths", "write_blocks"]

_WIDTHS: Final = (44.0, *[17.0] * 7)
_LONG, _LONG_NUMBER = 60, 26
"""Characters of a column of the sheet that stay in one line, of texts and of numbers."""
_LAST: Final = 5
"""The column to which paragraphs reach."""
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
        charting: where charts are made; without it they are described in words.
        last: the column to which paragraphs reach.
    """
    spaced = True
    before: Block | None = None
    for block in blocks:
        if not (spaced or isinstance(block, Heading) or (isinstance(block, Table) and (block.title or block.caption))):
            page.row += 1
        spaced = not isinstance(block, Table)
        if isinstance(before, Table) and isinstance(block, Table):
            page.may_begin()
        before = block
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
                    page.wide(f"{picture.description}.", "remark", last)
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
            at_right = block.at_right
            right = [index in at_right for index, count in enumerate(counts) for _ in range(count)]
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
    text = cell.description if isinstance(cell, Drawing | Chart) else cell
    if index not in right:
        return (Shown(text, look="name" if index == 0 else "text"),)
    try:
        return (Shown(float(text)),)
    except ValueError:
        return (Shown(text, look="number"),)


def _write_chart(page: Page, book: Workbook, chart: Chart, numbers: Page) -> None:
    """Write a chart, and go to the row behind it."""
    made = native_chart(book, chart, write_series(numbers, chart))
    high = 110 + 24 * len(chart.data.bars) if isinstance(chart.data, Bars) else SIZE[1]
    made.set_size({"width": SIZE[0], "height": high})
    page.sheet.insert_chart(page.row, 0, made, {"object_position": 1, "description": chart.description})
    page.row += high // _PIXELS + 1
