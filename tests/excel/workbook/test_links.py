"""Formulas that read other workbooks get the values that Excel stored with the link."""

from __future__ import annotations

import openpyxl
import pytest
from fewer_sheets import SHORT, keep_sheets
from openpyxl.packaging.relationship import Relationship
from openpyxl.workbook.external_link import ExternalLink
from openpyxl.xml.functions import fromstring
from simulated import simulated

from xlmc.analysis.studies.verify import Status, verify
from xlmc.api import Simulation
from xlmc.errors import ErrorCode, FormulaError, WorkbookError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.replay import Change, replay

MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
STORED = """<sheetNames><sheetName val="Prices"/><sheetName val="It's"/><sheetName val="Empty"/></sheetNames>
<definedNames><definedName name="Rate" refersTo="='Prices'!$B$2"/><definedName name="Own" refersTo="='It''s'!$A$1"
sheetId="1"/><definedName name="Rate" refersTo="=Prices!$B$3" sheetId="1"/><definedName name="Gone"/></definedNames>
<sheetDataSet><sheetData sheetId="0"><row r="1"><cell r="A1" t="str"><v>Hello</v></cell>
<cell r="B1" t="b"><v>1</v></cell></row>
<row r="2"><cell r="B2"><v>142</v></cell><cell r="C2" t="e"><v>#DIV/0!</v></cell></row><row r="3"><cell r="B3">
<v>0.5</v></cell></row></sheetData><sheetData sheetId="1"><row r="1"><cell r="A1"><v>7</v></cell></row></sheetData>
</sheetDataSet>"""


@pytest.fixture
def linked(book, rels):
    """`linked(rows, stored)`: a workbook with these rows on its sheet, and a link to prices.xlsx."""

    def make(rows, stored=STORED, read=book):
        book = f'<externalBook r:id="r1">{stored}</externalBook>'
        link = f'<externalLink xmlns="{MAIN}" xmlns:r="{OFFICE}">{book}</externalLink>'
        return read(
            {"S": f"<sheetData>{rows}</sheetData>"},
            in_workbook='<externalReferences><externalReference r:id="link"/></externalReferences>',
            rels=[("link", "externalLink", "externalLinks/externalLink1.xml")],
            more={
                "xl/externalLinks/externalLink1.xml": link,
                "xl/externalLinks/_rels/externalLink1.xml.rels": rels(
                    ("r1", "externalLinkPath", "prices.xlsx", "External")
                ),
            },
        )

    return make


def row_of(formula, value="0"):
    return f'<row r="1"><c r="A1"><f>{formula}</f><v>{value}</v></c></row>'


FORMULAS = {
    "[1]Prices!$B$2": 142.0,
    "[1]Prices!A1": "Hello",
    "[1]PRICES!B1": True,
    "[1]Prices!C2": ErrorCode.DIV0,
    "[1]Prices!Z99": 0.0,
    "'[1]It''s'!A1*2": 14.0,
    "SUM([1]Prices!B:B)": 142.5,
    "SUM([1]Prices!B2:B3)+1": 143.5,
    "VLOOKUP(142,[1]Prices!B2:C3,1,FALSE)": 142.0,
    "COUNTIF([1]Prices!B2:B9,&quot;&lt;1&quot;)": 1.0,
    "[1]!Rate": 142.0,
    "'[1]It''s'!Rate": 0.5,
    "[1]!Own+1": 8.0,
    "[1]Prices!Rate": 142.0,
    "ROWS([1]Prices!B2:B3)": 2.0,
    "[0]!S": ErrorCode.NAME,
}


@pytest.mark.parametrize("formula", FORMULAS)
def test_the_stored_value_is_used(linked, formula):
    expected = FORMULAS[formula]
    (check,) = verify(linked(row_of(formula))).cells
    assert check.got == expected
    assert type(check.got) is type(expected)


REFUSED = {
    "[2]Prices!A1": "the formula refers to another workbook",
    "[1]Empty!A1": "the formula refers to prices.xlsx, of which no values are stored",
    "[1]Nowhere!A1": "the formula refers to prices.xlsx, of which no values are stored",
    "[1]!Gone": "the formula refers to 'Gone' of prices.xlsx, which is not stored",
    "[1]!Nothing": "the formula refers to 'Nothing' of prices.xlsx, which is not stored",
    "SUM([1]Prices:Empty!A1)": "the formula refers to several sheets of another workbook",
}


@pytest.mark.parametrize("formula", REFUSED)
def test_what_is_not_stored_is_refused_by_cell(linked, formula):
    (check,) = verify(linked(row_of(formula))).cells
    assert check.status is Status.UNSUPPORTED
    assert REFUSED[formula] in check.reason


def test_a_link_whose_part_is_not_there_holds_nothing(book):
    result = book(
        {"S": f"<sheetData>{row_of('[1]Prices!A1')}</sheetData>"},
        in_workbook='<externalReferences><externalReference r:id="link"/></externalReferences>',
        rels=[("link", "externalLink", "externalLinks/externalLink1.xml")],
    )
    (check,) = verify(result).cells
    assert check.status is Status.UNSUPPORTED
    assert "of which no values are stored" in check.reason


def test_nothing_stored_at_all(linked):
    (check,) = verify(linked(row_of("[1]Prices!A1"), stored="")).cells
    assert "of which no values are stored" in check.reason


def test_formulas_filled_down(linked):
    shared = (
        '<row r="1"><c r="A1"><f t="shared" ref="A1:A3" si="0">[1]Prices!B1+[1]!Rate</f><v>143</v></c></row>'
        '<row r="2"><c r="A2"><f t="shared" si="0"/><v>284</v></c></row>'
        '<row r="3"><c r="A3"><f t="shared" si="0"/><v>142.5</v></c></row>'
    )
    assert [check.status for check in verify(linked(shared)).cells] == [Status.MATCHED] * 3


@pytest.mark.parametrize(
    ("stored", "message"),
    [
        (STORED.replace("142", "x"), "externalLink1.xml: the value of B2 holds 'x' where a number should be"),
        (STORED.replace('"B2"', '"2B"'), "holds a value of the cell '2B', which is none"),
        (STORED.replace(' r="B2"', ""), "externalLink1.xml holds a value without a cell"),
        ("<open>", "externalLink1.xml is not well-formed XML"),
    ],
)
def test_a_damaged_link_is_told_of_when_it_is_read(linked, stored, message):
    assert verify(linked(row_of("1+1"), stored=stored)).cells
    with pytest.raises((WorkbookError, FormulaError), match=message):
        verify(linked(row_of("[1]Prices!A1"), stored=stored))


def test_cells_that_a_link_does_not_hold_are_blank(linked):
    result = linked(row_of("1"))
    assert result.content(Cell("[1]Prices", 2, 2)) == CellContent(142.0)
    assert result.content(Cell("[1]Prices", 9, 9)) == CellContent()
    assert result.content(Cell("[7]Prices", 2, 2)) == CellContent()
    assert result.sheet_of(Cell("[x", 1, 1)) is None


BROKEN = """<sheetNames><sheetName val="Prices"/><sheetName val="Whole"/></sheetNames>
<definedNames><definedName name="Rate" refersTo="=Prices!$B$2"/></definedNames><sheetDataSet>
<sheetData sheetId="0" refreshError="1"><row r="2"><cell r="B2"><v>142</v></cell></row></sheetData>
<sheetData sheetId="1"><row r="1"><cell r="A1"><v>7</v></cell></row></sheetData></sheetDataSet>"""


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("[1]Prices!$B$2", ErrorCode.REF),
        ("[1]Prices!C9", ErrorCode.REF),
        ("SUM([1]Prices!A1:B3)", ErrorCode.REF),
        ("[1]!Rate", ErrorCode.REF),
        ("ROWS([1]Prices!A1:B3)", ErrorCode.REF),
        ("IFERROR([1]Prices!B2,5)", 5.0),
        ("[1]Whole!A1+1", 8.0),
    ],
)
def test_a_sheet_that_excel_could_not_read_again_is_an_error(linked, formula, expected):
    result = linked(row_of(formula), BROKEN)
    assert any("Links to prices.xlsx are broken" in str(notice) for notice in result.notices)
    (compared,) = verify(result).cells
    assert compared.got == expected


def test_a_run_records_what_it_read_of_another_workbook_and_a_replay_names_a_change(small_book, tmp_path, monkeypatch):
    keep_sheets(monkeypatch, *SHORT)
    book = openpyxl.load_workbook(small_book)
    book["Model"]["B1"] = "=SUM(Inputs!B6:D6)+[1]Prices!B2"
    xml = f'<externalLink xmlns="{MAIN}"><externalBook>{STORED}</externalBook></externalLink>'
    link = ExternalLink.from_tree(fromstring(xml))
    link.file_link = Relationship(type="externalLinkPath", Target="prices.xlsx", TargetMode="External")
    book._external_links.append(link)
    path = tmp_path / "linked.xlsx"
    book.save(path)
    run = simulated(load(path), 300)
    assert run["area"].mean.value == pytest.approx(142 + simulated(load(small_book), 300)["area"].mean.value)
    results = Simulation(run).save(tmp_path / "r.xlsx")
    assert replay(results).to_the_last_bit
    book = openpyxl.load_workbook(results, keep_links=True)
    [cell] = [c for c in book._external_links[0].externalBook.sheetDataSet.sheetData[0].row[1].cell if c.r == "B2"]
    cell.v = "150"
    book.save(results)
    assert replay(results).changes == (Change("cell", "'[1]Prices'!B2", "142", "150"),)
