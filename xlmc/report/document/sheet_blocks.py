"""What the result sheets say, as parts of a document: their writers write onto a `Blocks` as they do onto a sheet."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from xlmc.report.document.parts import Block, Heading, Paragraph, Table
from xlmc.report.page.flow import shown_text
from xlmc.report.sheets.cells import Shown
from xlmc.report.sheets.page import Page

__all__ = ["blocks_of"]

_LOOKS = {"warning": "warning", "alarm": "warning", "remark": "small"}
_LEFT = frozenset({"name", "text", "paragraph", "header left"})


def blocks_of(write: Callable[[Page], Any]) -> list[Block]:
    """What a writer of a result sheet writes."""
    blocks = _Blocks()
    write(blocks)
    return blocks.found


class _Blocks(Page):
    """A result sheet as parts of a document, from the top down."""

    def __init__(self) -> None:
        self.row = 0
        self.sheet = _Nothing()  # type: ignore[assignment]  # takes every call, and does nothing
        self._found: list[Block] = []
        self._open: list[Sequence[Shown]] = []

    @property
    def found(self) -> list[Block]:
        """All that was written so far."""
        self._close()
        return self._found

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
        if value:
            self._add(Paragraph(value, look=_LOOKS.get(look, "plain")))

    def title(self, value: str, below: str, column: int = 0) -> None:
        """Write nothing: the document has headings of its own."""

    def heading(self, value: str, column: int = 0) -> None:
        """Write the heading of a part."""
        self._add(Heading(value, 2))

    def set_up_printing(self, name: str, **options: Any) -> None:
        """Do nothing: the document has a style of its own."""

    def _add(self, found: Block) -> None:
        self._close()
        self._found.append(found)
        self.row += 1

    def _close(self) -> None:
        rows, self._open = self._open, []
        if rows:
            heads = rows[0] if _heads(rows[0]) else ()
            self._found.append(_table(heads, rows[1:] if heads else rows))


def _heads(cells: Sequence[Shown]) -> bool:
    return cells[0].look.startswith("header")


def _table(heads: Sequence[Shown], rows: Sequence[Sequence[Shown]]) -> Table:
    names = [shown_text(shown) for shown in heads] or [""] * len(rows[0])
    texts = [[shown_text(shown) for shown in row] for row in rows]
    pairs = [at for at, name in enumerate(names) if name == "±" and at]
    for at in reversed(pairs):  # a number and its error are one cell
        names.pop(at)
        for row in texts:
            error = row.pop(at)
            row[at - 1] = f"{row[at - 1]} ± {error}" if error not in ("", "–", "-", "—") else row[at - 1]
    kept = [at for at in range(len(names)) if at == 0 or names[at] or any(row[at] for row in texts)]
    numbers = frozenset(
        new
        for new, at in enumerate(kept)
        if new and any(row[at] for row in texts) and all(_is_number(row[at]) for row in texts)
    )
    return Table(tuple(names[at] for at in kept), tuple(tuple(row[at] for at in kept) for row in texts), numbers)


def _is_number(text: str) -> bool:
    return not text or text[0] in "0123456789-−+–—." or text in ("noise", "∞")


class _Nothing:
    """Stands for the worksheet; what only a worksheet has (widths, heights, panes) is ignored."""

    def __getattr__(self, name: str) -> Any:
        return lambda *args, **options: None
