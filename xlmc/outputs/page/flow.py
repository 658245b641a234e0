"""What the result sheets say, as blocks: their writers write onto a `Flow` as they do onto a sheet.

Rows, columns, widths and heights mean nothing here: headings, tables and paragraphs follow each other.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.element import Html
from xlmc.outputs.document.html_writer import blocks_html
from xlmc.outputs.document.parts import Block, Heading, Paragraph, Table
from xlmc.outputs.sheets.page import Page

__all__ = ["Flow"]

_HEADER = "header"
_LOOKS = {"remark": "small"}


class Flow(Page):
    """A result sheet as blocks, from the top down."""

    def __init__(self) -> None:
        self.row = 0
        self._found: list[Block] = []
        self._open: list[Sequence[Shown]] = []

    @property
    def name(self) -> str:
        """Nothing: it is no worksheet."""
        return ""

    @property
    def blocks(self) -> list[Block]:
        """All that was written so far."""
        self._close()
        return self._found

    @property
    def html(self) -> Html:
        """The same as HTML."""
        return blocks_html(self.blocks)

    def put(self, row: int, column: int, shown: Shown) -> None:
        """Write a single cell, which becomes a paragraph."""
        self.wide(str(shown.value or ""), shown.look, column, column)

    def line(
        self, cells: Sequence[Shown], starts: Iterable[int] | None = None, last: int | None = None, *, fit: bool = True
    ) -> None:
        """Write a row of the table that is being written, or the first of another."""
        if self._open and (len(self._open[-1]) != len(cells) or _heads(cells)):
            self._close()
        self._open.append(list(cells))
        self.row += 1

    def wide(self, value: str, look: str, last: int, first: int = 0) -> None:
        """Write a paragraph."""
        self._add(Paragraph(value, _LOOKS.get(look, look)))

    def title(self, value: str, below: str, column: int = 0) -> None:
        """Write the heading of the whole, and the line below it."""
        self._add(Heading(value))
        self._add(Paragraph(below, "subtitle"))

    def heading(self, value: str, column: int = 0) -> None:
        """Write the heading of a section."""
        self._add(Heading(value, 2))

    def may_begin(self) -> None:
        """Do nothing, as for `set_up_printing`."""

    def set_up_printing(self, name: str, **options: Any) -> None:
        """Do nothing: each writer of blocks prints in its own way."""

    def _add(self, found: Block) -> None:
        self._close()
        self._found.append(found)
        self.row += 1

    def _close(self) -> None:
        if self._open:
            rows, self._open = self._open, []
            heads = tuple(str(shown.value or "") for shown in rows[0]) if _heads(rows[0]) else ()
            self._found.append(Table("", heads, tuple(map(tuple, rows[1:] if heads else rows))))


def _heads(cells: Sequence[Shown]) -> bool:
    return cells[0].look.startswith(_HEADER)
