"""What a document is made of: headings, paragraphs, lists, tables and pictures, of plain text without any markup."""

from __future__ import annotations

from dataclasses import dataclass, field

__all__ = ["Block", "Bullets", "Document", "Heading", "Paragraph", "Picture", "Table"]


@dataclass(frozen=True, slots=True)
class Heading:
    """The heading of a section (level 1) or of a part of one (level 2)."""

    text: str
    level: int = 1


@dataclass(frozen=True, slots=True)
class Paragraph:
    """Some sentences.

    Attributes:
        text: the sentences.
        name: stands before them, in bold.
        look: `plain`; `small` for a remark; `warning`; `code` for what is typed.
    """

    text: str
    name: str = ""
    look: str = "plain"


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list."""

    items: tuple[Paragraph, ...]


@dataclass(frozen=True, slots=True)
class Picture:
    """A drawing.

    Attributes:
        svg: the drawing.
        words: what it shows, for who cannot see it.
        caption: stands below it; empty in a table.
        width: of the text's width.
    """

    svg: str
    words: str
    caption: str = ""
    width: float = 1.0


_PADDING = 3.0
"""What stands beside a column's text, in characters."""

_WORD = 16
"""Characters of a word for which a column is made wider."""


@dataclass(frozen=True, slots=True)
class Table:
    """Rows below headings.

    Attributes:
        heads: one a column.
        rows: as many cells each.
        numbers: the columns that hold numbers.
        weights: of the columns' widths; by default from what they hold.
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[str | Picture, ...], ...]
    numbers: frozenset[int] = frozenset()
    weights: tuple[float, ...] = ()

    @property
    def widths(self) -> tuple[float, ...]:
        """The share of each column in the width."""
        weights = self.weights or tuple(self._weight(at) for at in range(len(self.heads)))
        return tuple(weight / sum(weights) for weight in weights)

    def _weight(self, at: int) -> float:
        texts = [self.heads[at], *(row[at] for row in self.rows)]
        words = [text for text in texts if isinstance(text, str)]
        longest = max(len(line) for text in words for line in text.split("\n"))
        most = max((len(word) for text in words for word in text.split()), default=1)
        # Numbers stay whole; texts wrap, the longer the more.
        wide = longest if at in self.numbers else min(longest, 10.0 + longest**0.75)
        return _PADDING + max(wide, min(most, _WORD))


Block = Heading | Paragraph | Bullets | Table | Picture


@dataclass(frozen=True, slots=True)
class Document:
    """A whole document.

    Attributes:
        title: of the whole.
        cover: what stands below it, by name.
        running: stands on top of every page.
        author: who signs it; may be empty.
        date: year, month and day.
        paper: `letter` or `a4`.
        blocks: all that follows.
    """

    title: str
    cover: tuple[tuple[str, str], ...]
    running: str
    author: str
    date: tuple[int, int, int]
    paper: str
    blocks: tuple[Block, ...] = field(default=())
