"""What a report is made of, whatever it is written as: both writers read the same parts, so they cannot disagree.

All texts are plain; a writer makes sure that none becomes markup.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date

__all__ = [
    "Block",
    "Bullets",
    "Code",
    "Content",
    "Document",
    "Drawing",
    "Figure",
    "Heading",
    "Paper",
    "Paragraph",
    "Table",
]

Paper = str
"""`a4` or `letter`."""


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading; level 1 begins a section."""

    text: str
    level: int = 1


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph; `look` is `text`, `small`, or `warning`."""

    text: str
    look: str = "text"


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list of sentences; `look` is `text` or `small`."""

    texts: tuple[str, ...]
    look: str = "text"


@dataclass(frozen=True, slots=True)
class Code:
    """What a person can type, or a fingerprint, in letters of equal width."""

    text: str


@dataclass(frozen=True, slots=True)
class Drawing:
    """A picture.

    Attributes:
        svg: an SVG document of our own making.
        said: what it shows, for those who cannot see it.
        width: in millimetres.
    """

    svg: str
    said: str
    width: float


Content = str | Drawing
"""The content of a cell of a table."""


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture with its caption."""

    drawing: Drawing
    caption: str


@dataclass(frozen=True, slots=True)
class Table:
    """A table with one row of headings, and its caption above it.

    Attributes:
        heads: `(c,)` headings.
        rows: each of `(c,)` cells.
        widths: `(c,)` relative widths of the columns.
        right: the columns whose cells stand at the right.
    """

    caption: str
    heads: tuple[str, ...]
    rows: tuple[tuple[Content, ...], ...]
    widths: tuple[float, ...]
    right: frozenset[int] = frozenset()


Block = Heading | Paragraph | Bullets | Code | Figure | Table


@dataclass(frozen=True, slots=True)
class Document:
    """A report.

    Attributes:
        title: of the report.
        author: the analyst; empty where nobody is named.
        dated: the day that the case gives; None where it gives none.
        head: stands at the top of every page.
        foot: stands at the bottom of every page, before the page's number.
        cover: fields of the cover: label and text.
        blocks: everything else, from the first page to the last.
        paper: of the pages.
    """

    title: str
    author: str
    dated: date | None
    head: str
    foot: str
    cover: tuple[tuple[str, str], ...]
    blocks: tuple[Block, ...]
    paper: Paper = "letter"

    @property
    def with_next(self) -> list[tuple[Block, Block | None]]:
        """Every block with the one after it."""
        return list(zip(self.blocks, (*self.blocks[1:], None), strict=True))

    @property
    def drawings(self) -> list[Drawing]:
        """Every picture, in the order of the document."""
        found: list[Drawing] = []
        for block in self.blocks:
            if isinstance(block, Figure):
                found.append(block.drawing)
            elif isinstance(block, Table):
                found += [cell for row in block.rows for cell in row if isinstance(cell, Drawing)]
        return found
