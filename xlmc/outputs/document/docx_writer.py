"""A document as a Word file that can be edited: headings, tables with a heading row, captions, numbered pages.

The same document gives the same bytes: the parts are packed without a clock, and the properties hold the case's date.
"""

from __future__ import annotations

import io
from datetime import UTC, datetime, time
from typing import Any, Final

from xlmc.excel.workbook.printable import printable
from xlmc.excel.workbook.writer import package_bytes
from xlmc.outputs.document.parts import (
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
from xlmc.outputs.document.typst_writer import UNDATED, pictures
from xlmc.outputs.document.unbroken import unbroken

__all__ = ["docx_bytes"]

_SIZES: Final = {"letter": (215.9, 279.4), "a4": (210.0, 297.0)}
"""Width and height of a page, in millimetres."""

_MARGIN: Final = 22.0
_INK: Final = (0x1F, 0x30, 0x44)
_LONGEST: Final = 255
"""Characters of a property of the file, the format's limit."""

_BODY, _SMALL, _CELL, _BEHIND = 10.5, 9.0, 8.5, 4.0
_BESIDE: Final = 50
"""Twentieths of a point beside the text of a cell."""


def docx_bytes(drawn: Document) -> bytes:
    """Return the document as a Word file.

    Raises:
        SimulationError: a picture holds a character that no font has.
    """
    return package_bytes(_parts(_Writer(drawn).written()))


class _Writer:
    """A Word file as it is written, from the top down."""

    def __init__(self, drawn: Document) -> None:
        import docx

        self._drawn = drawn
        self._file = docx.Document()
        self._pictures = iter(pictures(drawn.pictures))
        width, _ = _SIZES[drawn.paper]
        self._room = width - 2 * _MARGIN

    def written(self) -> Any:
        """Write all of it."""
        self._set_up()
        self._cover()
        for block, after in self._drawn.with_next:
            match block:
                case Heading(text, level):
                    self._file.add_heading(printable(text), level)
                case Paragraph(text, look):
                    self._paragraph(
                        text, _SMALL if look in ("small", "meaning") else _BODY, bold=look == "warning"
                    ).paragraph_format.keep_with_next = isinstance(after, Table | Figure)
                case Bullets(_, look):
                    for sentence in block.led:
                        paragraph = self._file.add_paragraph(style="List Bullet")
                        for text, bold in zip(sentence, (True, None), strict=True):
                            run = paragraph.add_run(_prose(text))
                            run.font.size, run.bold = _points(_SMALL if look == "small" else _BODY), bold
                case Code(text):
                    run = self._file.add_paragraph().add_run(printable(text))
                    run.font.name = "Courier New"
                    run.font.size = _points(_SMALL)
                case Figure():
                    self._figure(self._file, block)
                case tuple():
                    self._side_by_side(block)
                case Table():
                    if block.title:
                        self._file.add_heading(printable(block.title), 1)
                    if block.caption:
                        self._caption(block.caption, before=True)
                    self._table(block)
        return self._file

    def _set_up(self) -> None:
        from docx.oxml.ns import qn
        from docx.shared import Mm, RGBColor

        drawn, file = self._drawn, self._file
        properties = file.core_properties
        author = printable(drawn.author)[:_LONGEST]
        properties.title, properties.author = printable(drawn.title)[:_LONGEST], author
        properties.comments, properties.language = "", "en"
        properties.last_modified_by = author
        properties.created = properties.modified = datetime.combine(drawn.dated or UNDATED, time(), UTC).replace(
            tzinfo=None
        )
        for name, size in {"Normal": _BODY, "Caption": _SMALL, "Title": 24, "Heading 1": 15, "Heading 2": 12}.items():
            style = file.styles[name]
            style.font.name, style.font.size = "Times New Roman", _points(size)
            style.font.color.rgb = RGBColor(*_INK)
            fonts = style.element.get_or_add_rPr().get_or_add_rFonts()
            for theme in ("asciiTheme", "hAnsiTheme", "eastAsiaTheme", "cstheme"):
                fonts.attrib.pop(qn(f"w:{theme}"), None)
        file.styles["Caption"].font.bold = False
        section = file.sections[0]
        section.page_width, section.page_height = map(Mm, _SIZES[drawn.paper])
        section.left_margin = section.right_margin = section.top_margin = section.bottom_margin = Mm(_MARGIN)
        head = section.header.paragraphs[0]
        head.add_run(printable(drawn.head)).font.size = _points(_CELL)
        foot = section.footer.paragraphs[0]
        foot.paragraph_format.tab_stops.clear_all()
        foot.add_run(f"{printable(drawn.foot)}   Page ").font.size = _points(_CELL)
        _field(foot, "PAGE")
        foot.add_run(" of ").font.size = _points(_CELL)
        _field(foot, "NUMPAGES")

    def _cover(self) -> None:
        self._file.add_heading(printable(self._drawn.title), 0)
        for label, message in self._drawn.cover:
            paragraph = self._file.add_paragraph()
            paragraph.add_run(f"{printable(label)}: ").bold = True
            paragraph.add_run(printable(message))

    def _paragraph(self, text: str, size: float, *, bold: bool = False) -> Any:
        made = self._file.add_paragraph()
        run = made.add_run(_prose(text))
        run.font.size, run.bold = _points(size), bold or None
        return made

    def _caption(self, text: str, *, before: bool = False, within: Any = None) -> None:
        paragraph = (within or self._file).add_paragraph(_prose(text), style="Caption")
        paragraph.paragraph_format.keep_with_next = before

    def _figure(self, within: Any, figure: Figure, paragraph: Any = None) -> None:
        """Write a figure and its caption, in the file or in a cell of it whose first paragraph is given."""
        paragraph = paragraph or within.add_paragraph()
        paragraph.paragraph_format.keep_with_next = True
        self._picture(paragraph, figure.drawing)
        self._caption(figure.caption, within=within)

    def _side_by_side(self, figures: tuple[Figure, ...]) -> None:
        """Write one or two figures in the cells of a table without lines."""
        from docx.shared import Mm

        table = self._file.add_table(rows=1, cols=2)
        table.autofit = False
        _narrow_cells(table)
        _keep_whole(table.rows[0], repeated=False)
        for cell, figure in zip(table.rows[0].cells, figures, strict=False):
            cell.width = Mm(self._room / 2)
            self._figure(cell, figure, cell.paragraphs[0])

    def _picture(self, paragraph: Any, drawing: Picture) -> None:
        from docx.shared import Mm

        shape = paragraph.add_run().add_picture(io.BytesIO(next(self._pictures)), width=Mm(drawing.width))
        shape._inline.docPr.set("descr", printable(drawing.description))
        for side in ("distT", "distB", "distL", "distR"):  # or LibreOffice leaves 3 mm beside it
            shape._inline.set(side, "0")

    def _table(self, table: Table) -> None:
        from docx.shared import Mm

        lines = (table.heads, *table.rows) if table.heads else table.rows
        made = self._file.add_table(rows=len(lines), cols=table.columns)
        made.style = "Table Grid"
        made.autofit = False
        _narrow_cells(made)
        shares, at_right, letters = table.relative_widths, table.at_right, table.letters
        widths = [Mm(self._room * share / sum(shares)) for share in shares]
        for column, width in zip(made.columns, widths, strict=True):
            column.width = width
        for number, (row, contents) in enumerate(zip(made.rows, lines, strict=True)):
            heads = number == 0 and bool(table.heads)
            _keep_whole(row, repeated=heads)
            leads = number in (0, bool(table.heads), len(lines) - 2) and number < len(lines) - 1
            for index, (cell, content) in enumerate(zip(row.cells, contents, strict=True)):
                cell.width = widths[index]
                self._cell(cell.paragraphs[0], content, letters, bold=heads, right=index in at_right)
                cell.paragraphs[0].paragraph_format.keep_with_next = leads or None  # no row stands alone on a page
        behind = self._file.add_paragraph()
        behind.paragraph_format.space_after = _points(2)
        _shrink(behind, _BEHIND)

    def _cell(self, paragraph: Any, content: Content, size: float, *, bold: bool, right: bool) -> None:
        from docx.enum.text import WD_ALIGN_PARAGRAPH

        paragraph.paragraph_format.space_after = _points(0)
        if right:
            paragraph.alignment = WD_ALIGN_PARAGRAPH.RIGHT
        if isinstance(content, Drawing | Chart):
            self._picture(paragraph, content)
        else:
            run = paragraph.add_run(_prose(cell_text(content)))
            run.font.size, run.bold = _points(size), bold or None
            _shrink(paragraph, size)


def _prose(text: str) -> str:
    """Return a text to read, whose numbers stay with their units."""
    return printable(unbroken(text))


def _shrink(paragraph: Any, size: float) -> None:
    """Make the mark at the end of a paragraph as small as its text: an empty one is as high as its mark."""
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    mark, points = OxmlElement("w:rPr"), OxmlElement("w:sz")
    points.set(qn("w:val"), str(round(2.0 * size)))
    mark.append(points)
    paragraph._p.get_or_add_pPr().append(mark)


def _points(size: float) -> Any:
    from docx.shared import Pt

    return Pt(size)


def _field(paragraph: Any, instruction: str) -> None:
    """Add a field that Word fills in, such as the number of the page."""
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    field = OxmlElement("w:fldSimple")
    field.set(qn("w:instr"), instruction)
    paragraph._p.append(field)
    run = paragraph.add_run("1")  # until it is filled in
    run.font.size = _points(_CELL)
    field.append(run._r)


def _keep_whole(row: Any, *, repeated: bool) -> None:
    """Keep a row on one page; a row of headings stands on top of every page of its table."""
    from docx.oxml import OxmlElement

    properties = row._tr.get_or_add_trPr()
    for tag in ("w:cantSplit", *(["w:tblHeader"] if repeated else [])):
        properties.append(OxmlElement(tag))


def _narrow_cells(table: Any) -> None:
    """Leave as little room beside the texts of a table as in a PDF, so that its words stay whole."""
    from docx.oxml import OxmlElement
    from docx.oxml.ns import qn

    margins = OxmlElement("w:tblCellMar")
    for side in ("left", "right"):
        margin = OxmlElement(f"w:{side}")
        margin.set(qn("w:w"), str(_BESIDE))
        margin.set(qn("w:type"), "dxa")
        margins.append(margin)
    properties = table._tbl.tblPr
    look = properties.find(qn("w:tblLook"))
    properties.append(margins) if look is None else look.addprevious(margins)


class _Collected:
    """Takes the parts of a package, in place of a zip, which would ask a clock for their date."""

    def __init__(self) -> None:
        self.parts: dict[str, bytes] = {}

    def write(self, name: Any, content: bytes) -> None:
        self.parts[name.membername] = content


def _parts(file: Any) -> dict[str, bytes]:
    from docx.opc.pkgwriter import PackageWriter

    writer: Any = PackageWriter  # takes whatever writes a part by its name
    package, collected = file.part.package, _Collected()
    for part in package.parts:
        part.before_marshal()
    writer._write_content_types_stream(collected, package.parts)
    writer._write_pkg_rels(collected, package.rels)
    writer._write_parts(collected, package.parts)
    return collected.parts
