"""A section takes one row, and is in every output."""

from __future__ import annotations

import io
import re

import openpyxl
import pytest
from openpyxl.worksheet.table import Table as ExcelTable

import xlmc
from xlmc.cli.simulate import show_run
from xlmc.montecarlo.statistics import Estimate
from xlmc.outputs import save
from xlmc.outputs.document import SECTIONS, Wanted, document_bytes
from xlmc.outputs.document.build import build
from xlmc.outputs.document.cells import Shown
from xlmc.outputs.document.measured import Measured
from xlmc.outputs.document.parts import Bar, Bars, Bullets, Chart, Code, Figure, Heading, Line, Lines, Paragraph, Table
from xlmc.outputs.document.sections import OUTPUTS, Section, in_order
from xlmc.outputs.notebook import run_html
from xlmc.outputs.page import page_text
from xlmc.outputs.sheets.book import SHEETS

SAID = ("Moon phase", "The moon was new.", "Full moons", "1,234.5", "Phase of the night", "a <b>", "xlmc moon")


def blocks(_):
    yield Paragraph("The moon was new.")
    yield Bullets(("a <b>",))
    yield Code("xlmc moon")
    yield Table("", ("Kind", "Full moons"), (("seen", Shown(1234.5, "#,##0.0")),), caption="Phase of the night")
    rows = (("new", Measured(Estimate(0.5, 0.1), "share"), "dark"), ("old", "", "lost"))
    yield Table("", ("Moon", "Seen", "Because"), rows, spans=(1, 1, 3))
    yield Figure(Chart("", "Share", Bars((Bar("a", ((0.0, 1.0, "dark"),)),)), "a bar"), "Phase of the night")
    yield Figure(Chart("", "x", Lines((Line("a", ((0.0, 1.0), (1.0, 2.0))),), "y"), "a line"), "Phase of the night")


@pytest.fixture(scope="module")
def case_run(tmp_path_factory):
    """The run of a workbook with one assumption, which is the forecast."""
    book = openpyxl.Workbook()
    sheet = book.active
    for row in (("Name", "Value", "Low", "High"), ("x", 0.5, 0, 1)):
        sheet.append(row)
    sheet.add_table(ExcelTable(displayName="xlmc_assumptions", ref="A1:D2"))
    sheet["F1"], sheet["G1"], sheet["F2"], sheet["G2"] = "Name", "Value", "double", "=2*B2"
    sheet.add_table(ExcelTable(displayName="xlmc_forecasts", ref="F1:G2"))
    path = tmp_path_factory.mktemp("case") / "case.xlsx"
    book.save(path)
    return xlmc.load(path).simulate(500)._run


@pytest.fixture(autouse=True)
def section(monkeypatch):
    monkeypatch.setitem(SECTIONS, "moon", Section("Moon phase", blocks))


def test_it_is_in_the_report(case_run):
    document = build(case_run, Wanted(sections=("moon",)))
    pypdf, docx = pytest.importorskip("pypdf"), pytest.importorskip("docx")
    pdf = "".join(page.extract_text() for page in pypdf.PdfReader(io.BytesIO(document_bytes(document, ".pdf"))).pages)
    assert [each for each in SAID if "".join(each.split()) not in "".join(pdf.split())] == []
    word = docx.Document(io.BytesIO(document_bytes(document, ".docx")))
    cells = [cell.text for table in word.tables for row in table.rows for cell in row.cells]
    texts = "\n".join([*cells, *(each.text for each in word.paragraphs)])
    assert [each for each in SAID if each not in texts] == []


def test_it_is_on_the_page_and_in_a_notebook(case_run):
    for text in (page_text(case_run), run_html(case_run)):
        assert [each for each in SAID if each.replace("<", "&lt;").replace(">", "&gt;") not in text] == []
    assert '<a href="#moon">Moon phase</a>' in page_text(case_run)


def test_it_is_a_sheet(case_run, tmp_path):
    path = save(case_run, tmp_path / "results.xlsx")
    book = openpyxl.load_workbook(path)
    cells = [cell.value for row in book["Moon phase"].iter_rows() for cell in row if cell.value is not None]
    texts = "\n".join(map(str, cells))
    assert [each for each in SAID if each != "1,234.5" and each not in texts] == []
    assert 1234.5 in cells
    rows = {row[0]: row[1:4] for row in book["Moon phase"].iter_rows(values_only=True)}
    assert (rows["Moon"], rows["new"], rows["old"]) == (
        ("Seen", "±", "Because"),
        (0.5, 0.1, "dark"),
        (None, None, "lost"),
    )
    assert "D13:F13" in {str(each) for each in book["Moon phase"].merged_cells.ranges}
    assert len(book["Moon phase"]._charts) == 2


def test_it_is_on_the_terminal(case_run, capsys):
    show_run(case_run)
    out = capsys.readouterr().out
    assert [each for each in SAID if each not in out] == []


def test_every_row_says_where_an_output_has_it_otherwise():
    for name, row in SECTIONS.items():
        assert {*row.elsewhere, *row.own} <= {*OUTPUTS}, name
        assert not {*row.elsewhere} & {*row.own}, name
        assert all((*row.elsewhere.values(), *row.own.values())), name


def parts_of(page):
    """The sections of a page, and the links to them, by their keys in their order."""
    return re.findall('<section id="([^"]*)"', page), re.findall('<a href="#([^"]*)"', page)


def named(output):
    """The names of what an output shows, in the order of the rows."""
    result = [row.own.get(output, (name,)) for name, row in SECTIONS.items() if output not in row.elsewhere]
    return [*dict.fromkeys(each for names in result for each in names)]


def test_the_page_has_its_parts_in_the_order_of_the_rows(case_run):
    parts, links = parts_of(page_text(case_run, beside=case_run))
    assert links == parts
    assert {*parts} <= {*named("page")}
    assert parts == [each for each in named("page") if each in parts]
    assert {"answer", "second", "forecasts", "sensitivity", "moon", "record"} <= {*parts}


def test_sheets_stand_in_the_order_of_the_rows(case_run, tmp_path):
    assert {sheet.name for sheet in SHEETS} <= {*named("sheets")}
    for row in SECTIONS.values():
        assert {*row.own.get("sheets", ())} <= {sheet.name for sheet in SHEETS}
    titles = {name: row.heading for name, row in SECTIONS.items()}
    expected = [titles.get(name, name) for name in named("sheets")]
    book = openpyxl.load_workbook(save(case_run, tmp_path / "results.xlsx"))
    result = [name for name in book.sheetnames if name in expected]
    assert result == [name for name in expected if name in result]
    assert result[0] == "Results"
    assert result[-2:] == ["Record", "Moon phase"]


def test_what_no_row_names_comes_last():
    assert [*in_order("sheets", dict.fromkeys(("New", "Record", "Results"), 1), {"pairs": 2})] == [
        *("Results", "pairs", "Record", "New")
    ]


def test_long_sections_are_in_a_report_that_asks_for_them(case_run):
    long = [name for name, row in SECTIONS.items() if row.asked_for]
    messages = [block.text for block in build(case_run, Wanted()).blocks if isinstance(block, Heading)]
    asked = build(case_run, Wanted(sections=long)).blocks
    heads = [block.text for block in asked if isinstance(block, Heading) and block.level == 1]
    assert heads == [SECTIONS[name].heading for name in long if name not in ("pairs", "limits")]  # it has no such
    assert not {*heads} & {*messages}
    numbers = [
        cell.estimate
        for block in asked
        if isinstance(block, Table)
        for row in block.rows
        for cell in row[1:]
        if isinstance(cell, Measured)
    ]
    assert case_run["double"].statistics.median in numbers
