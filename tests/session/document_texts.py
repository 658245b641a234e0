"""What a reader of a report sees of it, however its lines are broken."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator

from xlmc.outputs.document.parts import (
    Bullets,
    Chart,
    Document,
    Drawing,
    Figure,
    Heading,
    Paragraph,
    Table,
    cell_text,
)

__all__ = ["squeezed", "texts_of"]


def squeezed(text: str) -> str:
    """A text without its blanks and line breaks."""
    return re.sub(r"\s+", "", text)


def texts_of(document: Document) -> Iterator[str]:
    """Every text that a reader of the document sees, in its order, but for those in pictures."""
    for label, message in document.cover:
        yield from (label, message)
    for block in document.blocks:
        match block:
            case Heading(text, _) | Paragraph(text, _):
                yield text
            case Bullets(texts, _):
                yield from texts
            case Figure(_, caption):
                yield caption
            case Table():
                yield block.caption
                cells = itertools.chain(block.heads, *block.rows)
                yield from (cell_text(cell) for cell in cells if not isinstance(cell, Drawing | Chart))
            case _:
                yield block.text
