"""A document as PDF, typeset by Typst: PDF/A-2a with embedded fonts, tagged; the same document gives the same bytes.

Every text goes to Typst as a string, so nothing in a workbook is markup.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, Final

from xlmc.errors import SimulationError
from xlmc.report.document.parts import Block, Bullets, Document, Heading, Paragraph, Picture, Table

__all__ = ["pdf_bytes", "picture_png"]

_PAPERS: Final = {"letter": "us-letter", "a4": "a4"}
_STANDARDS: Final = ("a-2a", "ua-1")
_DOTS: Final = 220.0
"""Of a picture, in an inch."""

_FIRST_OF_OTHERS: Final = "\u2e80"
"""Typst's own fonts have the characters of Europe and of the Near East; from here on the system's are used, too."""

_LACKING: Final = re.compile("the text `(.*?)` could not be displayed")

_BEGIN: Final = """
#set text(font: "Libertinus Serif", size: 10.5pt, lang: "en", hyphenate: false)
#set par(leading: 0.62em, spacing: 0.9em)
#set heading(numbering: none)
#show heading.where(level: 1): it => block(above: 1.5em, below: 0.8em, text(size: 15pt, fill: rgb("#173f5f"), it.body))
#show heading.where(level: 2): it => block(above: 1.2em, below: 0.6em, text(size: 11.5pt, it.body))
#set table(stroke: (x, y) => (bottom: 0.4pt + rgb("#bbbbbb")), inset: (x: 4pt, y: 3.2pt))
#show table: set text(size: 8.6pt)
#show table: set par(leading: 0.45em)
#show table.cell.where(y: 0): set text(weight: "bold")
#show figure: set block(breakable: false)
#show figure.caption: set text(size: 9pt)
#set figure(supplement: none, numbering: none, gap: 0.5em)
"""


def pdf_bytes(document: Document) -> bytes:
    """The document as PDF.

    Raises:
        SimulationError: Typst is not installed, or it cannot write the document.
    """
    found: bytes = _compile("\n".join(_source(document)), format="pdf", pdf_standards=list(_STANDARDS))
    return found


def picture_png(picture: Picture, width: float) -> bytes:
    """A picture as PNG.

    Args:
        picture: the drawing.
        width: in points.

    Raises:
        SimulationError: Typst is not installed.
    """
    page = f"#set page(width: {width:g}pt, height: auto, margin: 0pt)"
    found: bytes = _compile(f"{page}\n#{_image(picture, '100%')}", format="png", ppi=_DOTS)
    return found


def _compile(source: str, **options: Any) -> Any:
    try:
        import typst
    except ImportError:
        raise SimulationError("reports need Typst", hint="Install it: pip install 'xlmc[report]'") from None
    own_fonts = max(source, default="") < _FIRST_OF_OTHERS
    try:
        return typst.compile(source.encode(), ignore_system_fonts=own_fonts, **options)
    except typst.TypstError as error:
        lacking = _LACKING.search(str(error))
        if lacking is None:
            raise SimulationError(f"Typst cannot write the report: {error}", hint="Please report this") from error
        message = f"no font of this system has {lacking[1]}, which is in the report"
        hint = "Install a font that has it (of Noto, such as fonts-noto-cjk), or write a .docx"
        raise SimulationError(message, hint=hint) from error


def _source(document: Document) -> Iterable[str]:
    year, month, day = document.date
    author = f"({_string(document.author)},)" if document.author else "()"
    date = f"datetime(year: {year}, month: {month}, day: {day})"
    yield f"#set document(title: {_string(document.title)}, author: {author}, date: {date})"
    head = f'text(size: 8.5pt, fill: rgb("#555555"), {_string(document.running)})'
    foot = 'text(size: 8.5pt, fill: rgb("#555555"), context counter(page).display("1 of 1", both: true))'
    yield (
        f"#set page(paper: {_string(_PAPERS[document.paper])}, margin: (x: 2cm, y: 2.1cm), "
        f"header: {head}, footer: align(center, {foot}))"
    )
    yield _BEGIN
    title = f'text(size: 22pt, weight: "bold", fill: rgb("#173f5f"), {_string(document.title)})'
    yield f"#block(above: 0.6em, below: 1em, {title})"
    yield "#grid(columns: (auto, 1fr), column-gutter: 1em, row-gutter: 0.55em,"
    for name, text in document.cover:
        yield f'text(size: 9.5pt, fill: rgb("#555555"), {_string(name)}), text(size: 9.5pt, {_wrapping(text)}),'
    yield ")"
    for block in document.blocks:
        yield _block(block)


def _block(block: Block) -> str:
    match block:
        case Heading(text, level):
            return f"#heading(level: {level}, {_string(text)})"
        case Paragraph():
            return f"#par({_paragraph(block)})"
        case Bullets(items):
            return f"#list({', '.join(_paragraph(item) for item in items)})"
        case Picture():
            image = _image(block, f"{100 * block.width:g}%")
            return f"#figure({image}, caption: {_string(block.caption)}, alt: {_string(block.words)})"
        case Table():
            return _table(block)


def _paragraph(paragraph: Paragraph) -> str:
    text = _string(paragraph.text)
    match paragraph.look:
        case "small":
            text = f'text(size: 9pt, fill: rgb("#444444"), {text})'
        case "warning":
            text = f'text(weight: "bold", fill: rgb("#9c1c1c"), {text})'
        case "code":
            text = f"raw({text})"
    return f"[#strong({_string(paragraph.name)})#{text}]" if paragraph.name else f"[#{text}]"


def _image(picture: Picture, width: str) -> str:
    return f'image(bytes({_string(picture.svg)}), format: "svg", width: {width}, alt: {_string(picture.words)})'


def _table(table: Table) -> str:
    columns = ", ".join(f"{width:.4f}fr" for width in table.widths)
    align = ", ".join("right" if at in table.numbers else "left" for at in range(len(table.heads)))
    heads = ", ".join(f"[#{_string(head)}]" for head in table.heads)
    rows = ",\n".join(", ".join(_cell(cell) for cell in row) for row in table.rows)
    return f"#table(columns: ({columns},), align: ({align},), table.header({heads}),\n{rows})"


def _cell(cell: str | Picture) -> str:
    return _image(cell, "100%") if isinstance(cell, Picture) else f"[#{_wrapping(cell)}]"


_UNBROKEN: Final = 64


def _wrapping(text: str) -> str:
    """A text that may also be broken within words that are too long for a column, such as fingerprints."""
    words = [
        "\u200b".join(word[at : at + 8] for at in range(0, len(word), 8)) if len(word) > _UNBROKEN else word
        for word in text.split(" ")
    ]
    return _string(" ".join(words))


def _string(text: str) -> str:
    """The text as a string of Typst's; characters that steer a screen are left out."""
    kept = "".join(c for c in text if c == "\n" or c.isprintable() or c == "\u200b")
    return '"' + kept.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
