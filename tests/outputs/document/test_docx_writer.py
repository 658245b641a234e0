"""A document of every block as python-docx reads it from the written bytes."""

from __future__ import annotations

import io
from datetime import date, datetime

import docx
import pytest
from docx.enum.text import WD_ALIGN_PARAGRAPH
from docx.oxml.ns import qn

from xlmc.outputs.document import docx_writer
from xlmc.outputs.document.docx_writer import docx_bytes
from xlmc.outputs.document.parts import Bullets, Code, Document, Drawing, Figure, Heading, Paragraph, Table

PICTURE = Drawing('<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm"/>', "a blank picture", 120.0)
NARROW = Drawing(PICTURE.svg, "a narrow one", 60.0)
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b550000000a49444154789c6360000000020001e221bc33"
    "0000000049454e44ae426082"
)


@pytest.fixture
def written(monkeypatch):
    """`written(*blocks, **of_document)`: the document as it is read again."""
    monkeypatch.setattr(docx_writer, "pictures", lambda drawn: [PNG] * len(drawn))

    def make(*blocks, **of_document):
        given = {"title": "The report", "author": "", "dated": None, "head": "head", "foot": "foot", "cover": ()}
        return docx.Document(io.BytesIO(docx_bytes(Document(**{**given, **of_document}, blocks=blocks))))

    return make


def paragraphs(book):
    """Text -> the paragraph, below the title."""
    return {each.text: each for each in book.paragraphs}


def size(paragraph):
    return paragraph.runs[0].font.size.pt


@pytest.mark.parametrize(("paper", "width", "height"), [("letter", 215.9, 279.4), ("a4", 210.0, 297.0)])
def test_pages_and_their_margins(written, paper, width, height):
    section = written(paper=paper).sections[0]
    assert (section.page_width.mm, section.page_height.mm) == pytest.approx((width, height), abs=0.02)
    for side in ("left", "right", "top", "bottom"):
        assert getattr(section, f"{side}_margin").mm == pytest.approx(22, abs=0.02)
    assert section.header.paragraphs[0].text == "head"
    foot = section.footer.paragraphs[0]
    fields = [each.get(qn("w:instr")) for each in foot._p.iter(qn("w:fldSimple"))]
    assert fields == ["PAGE", "NUMPAGES"]
    assert foot.text.startswith("foot   Page ")
    assert {run.font.size.pt for run in (*section.header.paragraphs[0].runs, *foot.runs)} == {8.5}


@pytest.mark.parametrize(
    ("dated", "created"), [(date(2026, 3, 1), datetime(2026, 3, 1)), (None, None)], ids=["dated", "undated"]
)
def test_properties_have_no_clock(written, dated, created):
    book = written(title="T" * 300, author="A" * 300, dated=dated)
    properties = book.core_properties
    assert (properties.title, properties.author) == ("T" * 255, "A" * 255)
    assert properties.last_modified_by == properties.author
    assert (properties.comments, properties.language) == ("", "en")
    assert properties.created == properties.modified
    if created:
        assert properties.created.replace(tzinfo=None) == created


def test_the_same_document_gives_the_same_bytes(monkeypatch):
    monkeypatch.setattr(docx_writer, "pictures", lambda drawn: [PNG] * len(drawn))
    drawn = Document("T", "", None, "", "", (), (Paragraph("x"), Figure(PICTURE, "c")))
    assert docx_bytes(drawn) == docx_bytes(drawn)


def test_styles_are_those_of_a_printed_page(written):
    styles = written().styles
    sizes = {name: styles[name].font.size.pt for name in ("Normal", "Caption", "Title", "Heading 1", "Heading 2")}
    assert sizes == {"Normal": 10.5, "Caption": 9, "Title": 24, "Heading 1": 15, "Heading 2": 12}
    assert {styles[name].font.name for name in sizes} == {"Times New Roman"}
    assert {str(styles[name].font.color.rgb) for name in sizes} == {"1F3044"}
    assert styles["Caption"].font.bold is False


def test_the_cover(written):
    book = written(cover=(("Case", "17"), ("Client", "nobody")))
    title, case, client = book.paragraphs[:3]
    assert (title.text, title.style.name) == ("The report", "Title")
    assert (case.text, client.text) == ("Case: 17", "Client: nobody")
    assert [run.bold for run in case.runs] == [True, None]


@pytest.mark.parametrize(
    ("look", "points", "bold"),
    [("text", 10.5, None), ("small", 9, None), ("meaning", 9, None), ("warning", 10.5, True), ("notice", 10.5, None)],
)
def test_paragraphs(written, look, points, bold):
    paragraph = paragraphs(written(Paragraph("it is so", look)))["it is so"]
    assert (size(paragraph), paragraph.runs[0].bold) == (points, bold)


@pytest.mark.parametrize(
    ("after", "kept"), [(Paragraph("y"), False), (Table("", ("A",), (("1",),)), True), (Figure(PICTURE, "c"), True)]
)
def test_a_paragraph_stays_with_a_table_or_a_figure(written, after, kept):
    assert paragraphs(written(Paragraph("x"), after))["x"].paragraph_format.keep_with_next is kept


def test_headings_lists_and_code(written):
    bullets = Bullets(("first", "second"), leads=("Mind: ", ""))
    book = paragraphs(
        written(Heading("One"), Heading("Two", 2), bullets, Bullets(("little",), "small"), Code("xlmc run"))
    )
    assert (book["One"].style.name, book["Two"].style.name) == ("Heading 1", "Heading 2")
    led = next(each for text, each in book.items() if text.startswith("Mind"))
    assert [run.bold for run in led.runs] == [True, None]
    assert {each.style.name for each in (led, book["second"], book["little"])} == {"List Bullet"}
    assert [run.font.size.pt for run in led.runs] == [10.5, 10.5]
    assert size(book["little"]) == 9
    assert (book["xlmc run"].runs[0].font.name, size(book["xlmc run"])) == ("Courier New", 9)


def test_a_figure_stays_with_its_caption(written):
    book = written(Figure(PICTURE, "what it shows"))
    shape = book.inline_shapes[0]
    assert shape.width.mm == pytest.approx(120, abs=0.01)
    assert shape._inline.docPr.get("descr") == "a blank picture"
    assert {shape._inline.get(side) for side in ("distT", "distB", "distL", "distR")} == {"0"}
    caption = paragraphs(book)["what it shows"]
    assert (caption.style.name, caption.paragraph_format.keep_with_next) == ("Caption", False)
    (drawn,) = (each for each in book.paragraphs if each._p.findall(f".//{qn('w:drawing')}"))
    assert drawn.paragraph_format.keep_with_next is True


def test_narrow_figures_stand_side_by_side(written):
    book = written(Figure(NARROW, "left"), Figure(NARROW, "right"))
    (table,) = book.tables
    cells = table.rows[0].cells
    assert len(table.rows) == 1
    assert [[each.text for each in cell.paragraphs] for cell in cells] == [["", "left"], ["", "right"]]
    assert [cell.width.mm for cell in cells] == pytest.approx([(215.9 - 44) / 2] * 2, abs=0.02)
    assert table.autofit is False
    assert table.rows[0]._tr.findall(f".//{qn('w:cantSplit')}")
    assert not table.rows[0]._tr.findall(f".//{qn('w:tblHeader')}")


ROWS = tuple((f"a{number}", str(number)) for number in range(4))


def test_tables(written):
    book = written(Table("Numbers", ("Name", "Mean"), ROWS, caption="of each"))
    (table,) = book.tables
    assert [[cell.text for cell in row.cells] for row in table.rows] == [["Name", "Mean"], *map(list, ROWS)]
    assert (table.style.name, table.autofit) == ("Table Grid", False)
    own = Table("Numbers", ("Name", "Mean"), ROWS)
    shares = own.relative_widths
    room = 215.9 - 44
    for row in table.rows:
        assert [cell.width.mm for cell in row.cells] == pytest.approx(
            [room * each / sum(shares) for each in shares], abs=0.02
        )
    heads, *rows = table.rows
    assert [cell.paragraphs[0].runs[0].bold for cell in heads.cells] == [True, True]
    assert {cell.paragraphs[0].runs[0].bold for row in rows for cell in row.cells} == {None}
    assert {cell.paragraphs[0].runs[0].font.size.pt for row in rows for cell in row.cells} == {own.letters}
    assert [bool(row._tr.findall(f".//{qn('w:tblHeader')}")) for row in table.rows] == [True, *[False] * 4]
    assert all(row._tr.findall(f".//{qn('w:cantSplit')}") for row in table.rows)
    # the heads and the first row, and the last two rows, stay together
    kept = [row.cells[0].paragraphs[0].paragraph_format.keep_with_next for row in table.rows]
    assert kept == [True, True, None, True, None]
    assert {cell.paragraphs[0].paragraph_format.space_after.pt for row in rows for cell in row.cells} == {0}
    for margin in table._tbl.tblPr.find(qn("w:tblCellMar")):
        assert (margin.get(qn("w:w")), margin.get(qn("w:type"))) == ("50", "dxa")
    texts = paragraphs(book)
    assert texts["Numbers"].style.name == "Heading 1"
    assert (texts["of each"].style.name, texts["of each"].paragraph_format.keep_with_next) == ("Caption", True)
    behind = book.paragraphs[-1]
    assert (behind.text, behind.paragraph_format.space_after.pt) == ("", 2)
    assert behind._p.pPr.find(qn("w:rPr")).find(qn("w:sz")).get(qn("w:val")) == "8"


def test_columns_of_numbers_are_aligned_to_the_right(written):
    own = Table("", ("Name", "Mean"), ROWS, right=(1,))
    (table,) = written(own).tables
    for index in range(2):
        alignments = {row.cells[index].paragraphs[0].alignment for row in table.rows[1:]}
        assert alignments == {WD_ALIGN_PARAGRAPH.RIGHT if index in own.at_right else None}
    assert own.at_right == {1}


def test_a_table_without_heads(written):
    (table,) = written(Table("", (), ROWS[:2])).tables
    assert [bool(row._tr.findall(f".//{qn('w:tblHeader')}")) for row in table.rows] == [False, False]
    assert [row.cells[0].paragraphs[0].paragraph_format.keep_with_next for row in table.rows] == [True, None]
    assert [row.cells[0].paragraphs[0].runs[0].bold for row in table.rows] == [None, None]


def test_a_picture_in_a_cell(written):
    book = written(Table("", ("Name", "Shape"), (("a", Drawing(PICTURE.svg, "tiny", 20.0)),)))
    assert len(book.inline_shapes) == 1
    assert book.inline_shapes[0].width.mm == pytest.approx(20, abs=0.01)
