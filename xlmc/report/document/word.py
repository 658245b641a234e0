"""A document as .docx, for a word processor: headings, tables and captions that can be edited.

The same document gives the same bytes: the file's times are the document's date.
"""

from __future__ import annotations

import io
import zipfile
from datetime import UTC, datetime
from typing import Any, Final

from xlmc.errors import SimulationError
from xlmc.report.document.parts import Block, Bullets, Document, Heading, Paragraph, Picture, Table
from xlmc.report.document.typeset import picture_png

__all__ = ["docx_bytes"]

_PAPERS: Final = {"letter": (612.0, 792.0), "a4": (595.3, 841.9)}
"""Width and height in points."""

_MARGIN: Final = 56.7
_FONT: Final = "Times New Roman"
_TEXT, _SMALL, _IN_TABLES = 10.5, 9.0, 8.5
_BLUE, _GREY, _RED = "173F5F", "555555", "9C1C1C"
_LONGEST: Final = 255
"""Characters of a title or an author, the format's limit."""

_EARLIEST: Final = (1980, 1, 1, 0, 0, 0)


def docx_bytes(document: Document) -> bytes:
    """The document as a .docx file.

    Raises:
        SimulationError: python-docx or Typst, which draws the pictures, is not installed.
    """
    try:
        import docx
    except ImportError:
        hint = "Install it: pip install 'xlmc[report]'"
        raise SimulationError("reports for a word processor need python-docx", hint=hint) from None
    found = _Writer(docx.Document(), document)
    written = io.BytesIO()
    found.write().save(written)
    return _without_times(written.getvalue())


class _Writer:
    """Writes a document into one of python-docx's."""

    def __init__(self, file: Any, document: Document) -> None:
        self._file, self._document = file, document
        self._width = _PAPERS[document.paper][0] - 2 * _MARGIN

    def write(self) -> Any:
        """The file with everything in it."""
        from docx.shared import Pt

        self._set_up()
        self._file.add_heading(_plain(self._document.title), 0)
        cover = Table(("", ""), self._document.cover, weights=(26, 74))
        self._table(cover, heads=False)
        for block in self._document.blocks:
            self._block(block)
        for style in ("Normal", "List Bullet"):
            self._file.styles[style].paragraph_format.space_after = Pt(5)
        return self._file

    def _set_up(self) -> None:
        from docx.shared import Pt, RGBColor

        document, file = self._document, self._file
        section = file.sections[0]
        section.page_width, section.page_height = (Pt(points) for points in _PAPERS[document.paper])
        for side in ("left_margin", "right_margin", "top_margin", "bottom_margin"):
            setattr(section, side, Pt(_MARGIN))
        file.styles["Normal"].font.name, file.styles["Normal"].font.size = _FONT, Pt(_TEXT)
        for name, size in (("Title", 22), ("Heading 1", 15), ("Heading 2", 11.5)):
            style = file.styles[name]
            style.font.name, style.font.size = _FONT, Pt(size)
            style.font.color.rgb = RGBColor.from_string(_BLUE)
        self._run(section.header.paragraphs[0], document.running, size=8.5, colour=_GREY)
        foot = section.footer.paragraphs[0]
        foot.alignment = 1
        for part in ("PAGE", " of ", "NUMPAGES"):
            run = self._run(foot, "" if part.isupper() else part, size=8.5, colour=_GREY)
            if part.isupper():
                _add_field(run, part)
        about = file.core_properties
        about.title, about.author = _plain(document.title)[:_LONGEST], _plain(document.author)[:_LONGEST]
        about.comments = about.last_modified_by = ""
        about.created = about.modified = datetime(*document.date, tzinfo=UTC).replace(tzinfo=None)
        about.language = "en"

    def _block(self, block: Block) -> None:
        match block:
            case Heading(text, level):
                self._file.add_heading(_plain(text), level)
            case Paragraph():
                self._paragraph(self._file.add_paragraph(), block)
            case Bullets(items):
                for item in items:
                    self._paragraph(self._file.add_paragraph(style="List Bullet"), item)
            case Picture():
                self._picture(self._file.add_paragraph(), block, self._width * block.width)
                self._file.add_paragraph(_plain(block.caption), style="Caption")
            case Table():
                self._table(block)

    def _paragraph(self, at: Any, paragraph: Paragraph) -> None:
        if paragraph.name:
            self._run(at, paragraph.name).bold = True
        look = paragraph.look
        size = _SMALL if look == "small" else _TEXT
        run = self._run(at, paragraph.text, size=size, colour=_RED if look == "warning" else None)
        run.bold = True if look == "warning" else None
        if look == "code":
            run.font.name = "Consolas"

    def _picture(self, at: Any, picture: Picture, width: float) -> None:
        from docx.shared import Pt

        shape = at.add_run().add_picture(io.BytesIO(picture_png(picture, width)), width=Pt(width))
        about = shape._inline.docPr
        about.set("descr", _plain(picture.words))
        if picture.caption:
            at.alignment = 1
            at.paragraph_format.keep_with_next = True

    def _table(self, table: Table, *, heads: bool = True) -> None:
        from docx.shared import Pt

        lines: list[tuple[str | Picture, ...]] = [*([table.heads] if heads else []), *table.rows]
        found = self._file.add_table(rows=len(lines), cols=len(table.heads))
        found.style = "Table Grid" if heads else "Normal Table"
        found.autofit = False
        widths = [self._width * share for share in table.widths]
        for at, width in enumerate(widths):
            found.columns[at].width = Pt(width)
        for number, (row, line) in enumerate(zip(found.rows, lines, strict=True)):
            _keep_whole(row, header=heads and number == 0)
            for column, (cell, value) in enumerate(zip(row.cells, line, strict=True)):
                cell.width = Pt(widths[column])
                at = cell.paragraphs[0]
                at.paragraph_format.space_after = Pt(0)
                if isinstance(value, Picture):
                    self._picture(at, value, widths[column] - 16)
                    continue
                run = self._run(at, value, size=_IN_TABLES)
                run.bold = heads and number == 0
                if column in table.numbers:
                    at.alignment = 2
        self._file.add_paragraph().paragraph_format.space_after = Pt(2)

    def _run(self, at: Any, text: str, *, size: float = _TEXT, colour: str | None = None) -> Any:
        from docx.shared import Pt, RGBColor

        run = at.add_run(_plain(text))
        run.font.size = Pt(size)
        if colour is not None:
            run.font.color.rgb = RGBColor.from_string(colour)
        return run


def _plain(text: str) -> str:
    """The text without characters that no XML can hold."""
    return "".join(c for c in text if c == "\n" or c.isprintable())


def _add_field(run: Any, name: str) -> None:
    """A number that the word processor fills in."""
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    for kind, text in (("begin", None), (None, name), ("separate", None), ("end", None)):
        part = OxmlElement("w:instrText" if kind is None else "w:fldChar")
        if kind is None:
            part.text = text
        else:
            part.set(qn("w:fldCharType"), kind)
        run._r.append(part)


def _keep_whole(row: Any, *, header: bool) -> None:
    """Not divided by the end of a page; a header stands on top of every page."""
    from docx.oxml import OxmlElement

    about = row._tr.get_or_add_trPr()
    about.append(OxmlElement("w:cantSplit"))
    if header:
        about.append(OxmlElement("w:tblHeader"))


def _without_times(file: bytes) -> bytes:
    """The same zip, each part as if written at the earliest time a zip can hold."""
    written = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(file)) as old, zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            new.writestr(zipfile.ZipInfo(name, _EARLIEST), old.read(name), zipfile.ZIP_DEFLATED)
    return written.getvalue()
