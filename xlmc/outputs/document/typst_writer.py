"""A document as PDF, typeset by Typst: PDF/A-2a and PDF/UA-1, with embedded fonts; the same document, the same bytes.

Every text is handed over as a string literal, which Typst shows as it is: no text of a workbook becomes markup, and the
source names no file and no package.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import date
from typing import Any, Final

from xlmc.errors import SimulationError
from xlmc.excel.workbook.printable import printable
from xlmc.outputs.document.drawings import drawn
from xlmc.outputs.document.parts import (
    Block,
    Bullets,
    Chart,
    Code,
    Content,
    Document,
    Drawing,
    Figure,
    Heading,
    Paragraph,
    Picture,
    Table,
    cell_text,
)
from xlmc.outputs.document.unbroken import unbroken

__all__ = ["UNDATED", "pdf_bytes", "pictures"]

UNDATED: Final = date(1980, 1, 1)
"""The date in the properties of a file whose case gives none: PDF/A asks for one, and a run has no clock. It is the
earliest that a zip package can hold, as in the other files."""

_STANDARDS: Final = ["a-2a", "ua-1"]
_PAPERS: Final = {"letter": "us-letter", "a4": "a4"}
_RESOLUTION: Final = 220.0
"""Pixels in an inch, of pictures for Word."""

_STYLE: Final = """
#set text(font: "Libertinus Serif", size: 10.5pt, lang: "en", fill: rgb("#1F3044"), hyphenate: false)
#set par(justify: false, leading: .6em, spacing: .9em)
#set heading(numbering: none)
#show heading.where(level: 1): set text(size: 15pt)
#show heading.where(level: 1): set block(above: 1.5em, below: .8em, sticky: true)
#show heading.where(level: 2): set text(size: 12pt)
#show figure: set block(breakable: true)
#show figure.caption: set text(size: 9pt)
#show figure.caption: it => block(width: 100%, align(left, it))
#show figure.where(kind: table): set figure.caption(position: top)
#show figure.where(kind: table): it => { show figure.caption: set block(sticky: true); it }
#show figure.where(kind: table): set block(breakable: true)
#show figure.where(kind: image): set block(breakable: false)
#set figure(numbering: none, supplement: none, gap: .6em)
#let below(row) = if row == 0 { .8pt + rgb("#2F6DA8") } else { .4pt + rgb("#D5DBE3") }
#set table(stroke: (x, y) => (bottom: below(y)), inset: (x: 4pt, y: 3.2pt))
#show table: set text(size: 8.5pt)
#show table: set par(leading: .45em)
#show table.cell.where(y: 0): strong
#show raw: set text(font: "DejaVu Sans Mono", size: 8pt)
#show title: set text(size: 24pt)
"""


_WHOLE: Final = 14
"""Lines of a table up to which it stays on one page."""


def pdf_bytes(document: Document) -> bytes:
    """Return the document as PDF.

    Raises:
        SimulationError: it holds a character that no font has.
    """
    return bytes(_compiled(_source(document), pdf_standards=_STANDARDS))


def pictures(drawings: Sequence[Picture]) -> list[bytes]:
    """Drawings as PNG, as large as they are printed.

    Raises:
        SimulationError: one holds a character that no font has.
    """
    if not drawings:
        return []
    pages = "\n".join(f"#page[#{_image(each)}]" for each in drawings)
    source = f"#set page(width: auto, height: auto, margin: 0pt, fill: none)\n{pages}\n"
    value = _compiled(source, format="png", ppi=_RESOLUTION)
    return [bytes(value)] if isinstance(value, bytes) else [bytes(each) for each in value]


def _compiled(source: str, **options: Any) -> Any:
    """Compile a source with Typst's own fonts, or with those of the system where Typst's lack a letter.

    Raises:
        SimulationError: no font has a character, or Typst refuses the source for another reason.
    """
    import typst

    data = source.encode()
    try:
        return typst.compile(data, ignore_system_fonts=True, **options)
    except typst.TypstError:  # a letter that they lack, or a fault that is met again
        pass
    try:
        return typst.compile(data, ignore_system_fonts=False, **options)
    except typst.TypstError as error:
        what = str(error).splitlines()[0]
        hint = "Install a font that has the letter, or name a .docx file" if "font" in what else "Name a .docx file"
        raise SimulationError(f"a PDF cannot be made: {what}", hint=hint) from error


def _source(document: Document) -> str:
    dated = document.dated or UNDATED
    day = f"datetime(year: {dated.year}, month: {dated.month}, day: {dated.day})"
    author = f"({_text(document.author)},)" if document.author else "()"
    lines = [
        f"#set document(title: {_text(document.title)}, author: {author}, date: {day})",
        f'#set page(paper: "{_PAPERS[document.paper]}", margin: (x: 2.2cm, top: 1.9cm, bottom: 1.6cm),',
        f"  header: [#text(size: 8.5pt, {_text(document.head)})],",
        f"  footer: [#set text(size: 8.5pt); #{_text(document.foot)} #h(1fr) "
        '#context [#{"Page "}#counter(page).display("1 of 1", both: true)]])',
        _STYLE,
        "#v(.6cm)\n#title()\n#v(.4cm)",
        *_cover(document),
        "#v(.4cm)",
        *(line for block, after in document.with_next for line in _block(block, isinstance(after, Table | Figure))),
    ]
    return "\n".join(lines) + "\n"


def _cover(document: Document) -> Iterator[str]:
    cells = "".join(f"  strong({_text(label)}), [#{_text(message)}],\n" for label, message in document.cover)
    yield f"#grid(columns: (5cm, 1fr), row-gutter: .9em,\n{cells})"


def _block(block: Block | tuple[Figure, ...], leads: bool) -> Iterator[str]:
    """Yield the Typst code of a block, or of figures side by side; a paragraph that `leads` to a table or a figure
    stays on its page.
    """
    match block:
        case tuple():
            yield f"#grid(columns: (1fr, 1fr), column-gutter: 5mm, {', '.join(map(_figure, block))})"
        case Heading(text, level):
            yield f"#heading(level: {level}, {_text(text)})"
        case Paragraph(text, "warning"):
            yield f'#block(inset: 6pt, stroke: (left: 3pt + rgb("#9C0006")), strong({_prose(text)}))'
        case Paragraph(text, look):
            yield f"#block(sticky: {str(leads).lower()}, par(text(size: {_size(look)}, {_prose(text)})))"
        case Bullets(_, look):
            items = ", ".join(f"[#strong({_prose(lead)})#{_prose(rest)}]" for lead, rest in block.led)
            yield f"#text(size: {_size(look)}, list(spacing: {'.5em' if look == 'small' else '.7em'}, {items}))"
        case Code(text):
            yield f"#raw({_text(text)}, block: true)"
        case Figure():
            yield f"#{_figure(block)}"
        case Table():
            if block.title:
                yield f"#heading(level: 1, {_text(block.title)})"
            yield _table(block)


def _figure(figure: Figure) -> str:
    return f"figure({_image(figure.drawing)}, caption: [#{_prose(figure.caption)}])"


def _size(look: str) -> str:
    return "9pt" if look in ("small", "meaning") else "10.5pt"


def _table(table: Table) -> str:
    columns = ", ".join(f"{width:g}fr" for width in table.relative_widths)
    at_right = table.at_right
    aligned = ", ".join("right" if index in at_right else "left" for index in range(table.columns))
    heads = ", ".join([_NO_CELL, *(f"[#{_prose(head)}]" for head in table.heads)])
    top = f"table.header({heads}), " if heads else ""
    rows = "".join(
        f"  {side}{', '.join(map(_cell, row))},\n" for side, row in zip(_sides(table), table.rows, strict=True)
    )
    inner = f"table(columns: (0pt, {columns},), align: (left, {aligned},), {top}\n{rows})"
    figure = f"#figure(kind: table, caption: [#{_prose(table.caption)}], {inner})"
    looks = []
    if table.crowded > 1.0:
        looks.append(f"#show table: set text(size: {table.letters:.3g}pt)")
    if table.lines <= _WHOLE and not any(isinstance(cell, Drawing | Chart) for row in table.rows for cell in row):
        looks.append("#show figure: set block(breakable: false)")
    return "\n".join(["#[", *looks, f"{figure}]"]) if looks else figure


def _sides(table: Table) -> list[str]:
    """Return what begins each row: in a column without width, a cell that keeps the first two rows, or the last two,
    together on a page, so that no row stands alone there.
    """
    count = len(table.rows)
    sides = [f"{_NO_CELL}, "] * count
    for first in {0, count - 2} if count > _TOGETHER else ():
        sides[first : first + 2] = "table.cell(rowspan: 2, breakable: false, inset: 0pt)[], ", ""
    return sides


_NO_CELL: Final = "table.cell(inset: 0pt)[]"
_TOGETHER: Final = 3
"""Rows of a table of which some may be kept together."""


def _cell(content: Content) -> str:
    if isinstance(content, Drawing | Chart):
        return f"[#{_image(content)}]"
    return f"table.cell(breakable: false, [#{_prose(cell_text(content))}])"


def _image(picture: Picture) -> str:
    drawing = drawn(picture) if isinstance(picture, Chart) else picture
    size = f'width: {drawing.width:g}mm, format: "svg"'
    return f"image(bytes({_text(drawing.svg)}), {size}, alt: {_text(drawing.description)})"


def _prose(text: str) -> str:
    """Return a text to read, whose numbers stay with their units, as a string literal of Typst."""
    return _text(unbroken(text))


def _text(text: str) -> str:
    """Return a text as a string literal of Typst."""
    escaped = printable(text).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
    return f'"{escaped}"'
