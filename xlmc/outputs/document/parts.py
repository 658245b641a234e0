"""The blocks of a document, whatever it is written as: all writers read the same blocks, so they cannot disagree.

Sections make the blocks from a run or a study. They are written as PDF (`typst_writer`), for Word (`docx_writer`), as
HTML for pages and notebooks (`html_writer`), onto sheets (`xlmc.outputs.sheets.xlsx_writer`) and to the terminal
(`xlmc.cli.blocks`). All texts are plain; a writer makes sure that none becomes markup. No writer formats a number: a
cell that holds one brings its format along.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import date
from typing import Final

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.number_text import signs
from xlmc.outputs.document.cells import Shown, shown_text
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.summary import Phrase

__all__ = [
    "HALF",
    "NUMBERS",
    "Bar",
    "Bars",
    "Block",
    "Bullets",
    "Chart",
    "Code",
    "Content",
    "Document",
    "Drawing",
    "Figure",
    "Heading",
    "Line",
    "Lines",
    "Paper",
    "Paragraph",
    "Picture",
    "Shape",
    "Table",
    "blocks_of",
    "cell_text",
]

Paper = str
"""`a4` or `letter`."""

HALF: Final = 81.0
"""The width of a figure that stands beside another on paper, in millimetres."""


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading; level 1 begins a section."""

    text: str
    level: int = 1


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph.

    Attributes:
        text: all that it says.
        look: `text`, `small`, `meaning`, `warning`, `notice`, `quote` or `subtitle`.
        phrases: the same in parts, of which some are names of the workbook; empty where none is known to be one.
    """

    text: str
    look: str = "text"
    phrases: tuple[Phrase, ...] = ()


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list of sentences.

    Attributes:
        texts: the sentences.
        look: `text` or `small`.
        leads: what each begins with that is to be seen first; empty for nothing.
    """

    texts: tuple[str, ...]
    look: str = "text"
    leads: tuple[str, ...] = ()

    @property
    def led(self) -> list[tuple[str, str]]:
        """Return what each sentence begins with, and the rest of it."""
        leads = self.leads or [""] * len(self.texts)
        return [(lead, text.removeprefix(lead)) for lead, text in zip(leads, self.texts, strict=True)]


@dataclass(frozen=True, slots=True)
class Code:
    """What a person can type, or a fingerprint, in letters of equal width."""

    text: str


@dataclass(frozen=True, slots=True)
class Drawing:
    """A picture.

    Attributes:
        svg: an SVG document of our own making.
        description: what it shows, for those who cannot see it.
        width: in millimetres.
    """

    svg: str
    description: str
    width: float


@dataclass(frozen=True, slots=True)
class Bar:
    """A named row of pieces, each from one number to another, in a look (`dark`, `light`), and a whisker."""

    name: str
    pieces: tuple[tuple[float, float, str], ...]
    whisker: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Bars:
    """Bars from left to right, the first on top, with a line at 0; the axis shows numbers in a form.

    Attributes:
        bars: from the top down.
        form: how the numbers of the axis are written.
        looks: what pieces in each look mean; empty where the difference needs no words.
    """

    bars: tuple[Bar, ...]
    form: Form = PLAIN
    looks: tuple[tuple[str, str], ...] = ()

    @property
    def ends(self) -> list[float]:
        """All ends of pieces and whiskers that are numbers."""
        result = [end for bar in self.bars for piece in bar.pieces for end in piece[:2]]
        result += [end for bar in self.bars for end in bar.whisker or ()]
        return [end for end in result if math.isfinite(end)]


@dataclass(frozen=True, slots=True)
class Line:
    """A line through points `(x, y)` or `(x, y, error of y)`; an error may be None."""

    name: str
    points: tuple[tuple[float, float] | tuple[float, float, float | None], ...]


@dataclass(frozen=True, slots=True)
class Lines:
    """Lines over one axis, six at most.

    Attributes:
        lines: the first is the thickest where the others are compared with it.
        upwards: the name of the vertical axis.
        share: the vertical axis runs from 0 to 1, in percent; else it reaches over all points.
        dots: mark the points.
        now: where a dashed upright line stands.
        from_zero: the vertical axis reaches to 0, too.
        form_across: how the numbers of the horizontal axis are written.
        form_upwards: how those of the vertical axis are written.
        cloud: points without a line, behind the lines.
    """

    lines: tuple[Line, ...]
    upwards: str
    share: bool = False
    dots: bool = False
    now: float | None = None
    from_zero: bool = False
    form_across: Form = PLAIN
    form_upwards: Form = PLAIN
    cloud: Line | None = None

    @property
    def all(self) -> tuple[Line, ...]:
        """The cloud, where there is one, and the lines over it."""
        return self.lines if self.cloud is None else (self.cloud, *self.lines)

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the largest x."""
        result = [point[0] for line in self.all for point in line.points]
        return min(result), max(result)

    @property
    def heights(self) -> list[float]:
        """What the vertical axis reaches over: all finite y and the ends of their errors; also 0 where wanted."""
        points = (point for line in self.all for point in line.points if math.isfinite(point[1]))
        errors = ((point[1], (point[2] if len(point) > 2 else None) or 0.0) for point in points)
        return [*[0.0] * self.from_zero, *(end for y, error in errors for end in (y - error, y + error))]


@dataclass(frozen=True, slots=True)
class Shape:
    """How often an assumption has each value: `(b + 1,)` edges, `(b,)` shares before filtering and accepted, and how
    its values are written.
    """

    edges: tuple[float, ...]
    before: tuple[float, ...]
    accepted: tuple[float, ...]
    form: Form = PLAIN


@dataclass(frozen=True, slots=True)
class Chart:
    """A chart, which each writer draws in its own way.

    Attributes:
        title: above it; empty for none.
        across: the name of the horizontal axis.
        data: what it shows, which says of which kind it is.
        description: what it shows, for those who cannot see it.
        width: in millimetres, where it is printed.
    """

    title: str
    across: str
    data: Bars | Lines | Shape
    description: str
    width: float = 150.0

    @property
    def across_and_looks(self) -> str:
        """The name of the horizontal axis, and what the looks of bars mean, where no legend says so."""
        looks = ", ".join(f"{look}: {meaning}" for look, meaning in getattr(self.data, "looks", ()))
        return f"{self.across} ({looks})" if looks else self.across


Picture = Drawing | Chart

Content = str | Shown | Measured | Drawing | Chart
"""The content of a cell of a table: a text, a number with its format, a number with its error, or a picture."""

NUMBERS: Final = frozenset({"number", "answer", "range", "error", "second number", "second error", "moved", "trial"})
"""Looks of cells that hold numbers, which stand at the right."""


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture with its caption."""

    drawing: Picture
    caption: str

    @property
    def is_half(self) -> bool:
        """Whether paper has room for another one beside it."""
        return self.drawing.width <= HALF


@dataclass(frozen=True, slots=True)
class Table:
    """A table with one row of headings.

    Attributes:
        title: the heading of its own above it; empty for none.
        heads: `(c,)` headings; empty for none.
        rows: each of `(c,)` cells.
        right: the columns whose cells stand at the right; those of numbers do so anyway.
        widths: `(c,)` relative widths of the columns; by default what the cells need.
        caption: what it shows; empty for none.
        spans: `(c,)` how many columns of a sheet the texts of each take; by default one.
        over: begins a row of its own, in which the headings stand on a sheet, over those of their several cells.
    """

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[Content, ...], ...]
    right: Sequence[int] = ()
    widths: tuple[float, ...] = ()
    caption: str = ""
    spans: tuple[int, ...] = ()
    over: str = ""

    @property
    def columns(self) -> int:
        """How many there are."""
        return len(self.heads) or max(map(len, self.rows), default=0)

    @property
    def at_right(self) -> frozenset[int]:
        """The columns whose cells stand at the right."""
        result = ((index, cell) for row in self.rows for index, cell in enumerate(row))
        return frozenset(self.right) | {index for index, cell in result if _is_number(cell)}

    @property
    def relative_widths(self) -> tuple[float, ...]:
        """How wide each column is beside the others: words and numbers stay whole, sentences need not.

        Widths that were given are raised to those of the longest words; those of the other columns are cut for it.
        """
        needed = self._longest_words
        least = [count / max(_LINE, sum(needed)) for count in needed]
        if self.widths:
            return _enough(self.widths, least)
        widest = _WIDEST if self.columns <= _FEW else _NARROW
        lengths = [len(head) for head in self.heads] or [0] * self.columns
        for row in self.rows:
            for index, cell in enumerate(row):
                lengths[index] = max(lengths[index], len(cell_text(cell)))
        wanted = [3.0 + min(length, widest) for length in lengths]
        share = [each / sum(wanted) for each in wanted]
        enough = all(width >= each for width, each in zip(share, least, strict=True))
        return tuple(wanted) if enough else _enough(wanted, least)

    @property
    def crowded(self) -> float:
        """How many times as wide as a page the table would have to be for every word to stay whole; 1 at least."""
        return max(sum(self._longest_words) / _LINE, 1.0)

    @property
    def letters(self) -> float:
        """Points of its letters: fewer where words would not stay whole else."""
        return max(_LETTERS / self.crowded, _SMALLEST)

    @property
    def lines(self) -> int:
        """About how many lines of text its rows take."""
        widths = self.relative_widths
        room = [max(_LINE * share / sum(widths) - _BESIDE, 1.0) for share in widths]
        return sum(max(map(_lines, row, room), default=1) for row in self.rows)

    @property
    def _longest_words(self) -> list[float]:
        """`(c,)` characters of the longest word in each column, with the space beside it; a number with its error is
        one word where the letters of the table need not be too small for that.
        """
        whole = self._words(whole=True)
        return whole if sum(whole) <= _SMALL * _LINE else self._words(whole=False)

    def _words(self, *, whole: bool) -> list[float]:
        result = [float(max(map(len, head.split()), default=0)) for head in self.heads] or [0.0] * self.columns
        at_right = self.at_right
        for row in self.rows:
            for index, cell in enumerate(row):
                text = cell_text(cell) if not isinstance(cell, Drawing | Chart) else ""
                words = _AT_LINES.split(text) if whole and index in at_right else text.split()
                wide = _DIGIT if index in at_right else 1.0
                longest = max((len(word) for word in words if len(word) < _WIDEST), default=0)
                result[index] = max(result[index], wide * longest)
        return [count + _BESIDE for count in result]


def _lines(cell: Content, room: float) -> int:
    """Return how many lines the text of a cell takes in a column with room for so many letters; 1 of a picture."""
    if isinstance(cell, Drawing | Chart):
        return 1
    wide = _DIGIT if _is_number(cell) else 1.0
    return sum(max(math.ceil(wide * len(line) / room), 1) for line in cell_text(cell).split("\n"))


def _enough(widths: Sequence[float], least: Sequence[float]) -> tuple[float, ...]:
    """Return widths as shares of their sum, none below its least share, as far as there is room for that."""
    whole = sum(widths)
    result = [width / whole for width in widths]
    raised: set[int] = set()
    while low := {index for index, share in enumerate(result) if index not in raised and share < least[index]}:
        raised |= low
        left, rest = 1.0 - sum(least[index] for index in raised), [i for i in range(len(result)) if i not in raised]
        if left <= 0.0 or not rest:
            return tuple(each / sum(least) for each in least)
        free = sum(widths[index] for index in rest)
        result = [least[i] if i in raised else widths[i] / free * left for i in range(len(result))]
    return tuple(result)


_LETTERS, _SMALLEST = 8.5, 6.0
"""Points of the letters of a table, and of one whose words would not stay whole else."""

_LINE, _BESIDE = 105.0, 2
"""Characters in a line of a table as wide as the page, and those that the space between two columns takes."""

_AT_LINES = re.compile(r"\n|(?<=,) ")
"""Where the text of a number may be broken: `100 %, at least 99.9980 %`."""

_DIGIT = 0.82
"""How wide a digit is, in letters of which so many make a line."""

_SMALL = 1.4
"""How many times as wide as a page a table may have to be for its numbers to stay beside their errors."""

_WIDEST, _NARROW, _FEW = 40, 14, 8
"""Characters of a column that may stay in one line: of a table of few columns, and of one of more."""


def _is_number(cell: Content) -> bool:
    return isinstance(cell, Measured) or (isinstance(cell, Shown) and cell.look in NUMBERS)


def cell_text(cell: Content) -> str:
    """Return the text of a cell; of a picture, what it shows."""
    if isinstance(cell, Shown):
        return cell.written or shown_text(cell)
    if isinstance(cell, Measured):
        return cell.text
    return cell if isinstance(cell, str) else cell.description


Block = Heading | Paragraph | Bullets | Code | Figure | Table


def blocks_of(result: Iterable[str | Block]) -> tuple[Block, ...]:
    """Blocks, of which paragraphs may be given as their texts."""
    return tuple(Paragraph(each) if isinstance(each, str) else each for each in result)


def _narrow(blocks: Sequence[Block]) -> tuple[Figure, ...]:
    """Return the narrow figures that these blocks begin with."""
    figures: list[Figure] = []
    for each in blocks:
        if not isinstance(each, Figure) or not each.is_half:
            break
        figures.append(each)
    return tuple(figures)


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
        signs: of thousands and decimals: by default those of where the document is made.
        units: which numbers in its texts may have behind them, in the same line.
    """

    title: str
    author: str
    dated: date | None
    head: str
    foot: str
    cover: tuple[tuple[str, str], ...]
    blocks: tuple[Block, ...]
    paper: Paper = "letter"
    signs: tuple[str, str] = field(default_factory=signs)
    units: tuple[str, ...] = ()

    @property
    def with_next(self) -> list[tuple[Block | tuple[Figure, ...], Block | None]]:
        """Every block with the one after it; narrow figures that follow each other stand side by side, two in a row."""
        result: list[tuple[Block | tuple[Figure, ...], Block | None]] = []
        rest = self.blocks
        while rest:
            narrow = _narrow(rest[:2])
            rest, first = rest[len(narrow) or 1 :], narrow or rest[0]
            result.append((first, rest[0] if rest else None))
        return result

    @property
    def pictures(self) -> list[Picture]:
        """Every picture, in the order of the document."""
        result: list[Picture] = []
        for block in self.blocks:
            if isinstance(block, Figure):
                result.append(block.drawing)
            elif isinstance(block, Table):
                result += [cell for row in block.rows for cell in row if isinstance(cell, Drawing | Chart)]
        return result
