"""Result sheets compared cell by cell, on sheets of a few cells without files."""

from __future__ import annotations

from itertools import cycle
from types import SimpleNamespace

import pytest

from xlmc.excel.address import parse_address
from xlmc.excel.workbook.number_formats import NumberFormat
from xlmc.outputs.replay import sheets as compared
from xlmc.outputs.replay.changes import Closeness
from xlmc.outputs.replay.sheets import (
    _bare,
    _compared,
    _likest,
    _match_sheets,
    _Pair,
    _rows_by_text,
    _share,
    _trial_rows,
    _without_common_rows,
)

EXACT = Closeness()


@pytest.fixture
def formats(monkeypatch):
    """`formats(built, file)`: the number formats of either, {address: code}."""
    given = {}
    monkeypatch.setattr(compared, "roles", lambda parts: SimpleNamespace(workbook=""))
    monkeypatch.setattr(compared, "number_formats", lambda parts, workbook, part: next(given["two"]))

    def of(codes):
        cells = {parse_address(address, "S"): code for address, code in codes.items()}
        return {(cell.row, cell.column): NumberFormat.of(code) for cell, code in cells.items()}

    def put(built=None, file=None):
        given["two"] = cycle([of(built or {}), of(file or {})])

    put()
    return put


@pytest.fixture
def pair(workbook, formats):
    """`pair(built, file, sheet="Results")`: the sheet of the run and that of the file, {address: content}."""

    def make(built, file, sheet="Results", closeness=EXACT):
        books = [workbook({f"{sheet}!{at}": content for at, content in cells.items()}) for cells in (built, file)]
        return _Pair(*books, *(each.sheets[sheet] for each in books), closeness)

    return make


def found(pair):
    """Address -> what the file says and what the run gives."""
    return {str(each.where).partition("!")[2]: (each.says, each.gives) for each in pair.differences()}


def test_the_same_cells(pair):
    cells = {"A1": "Mean", "B1": 4.5, "B2": True, "C7": "text"}
    assert found(pair(cells, cells)) == {}


@pytest.mark.parametrize(
    ("built", "file", "differences"),
    [
        ({"A1": "Mean", "B1": 4.5}, {"A1": "Mean", "B1": 4.6}, {"B1": (4.6, 4.5)}),
        ({"A1": "Mean"}, {"A1": "Median"}, {"A1": ("Median", "Mean")}),
        ({"A1": 1.0, "A2": 2.0}, {"A1": 1.0}, {"A2": (None, 2.0)}),
        ({"A1": 1.0}, {"A1": 1.0, "C5": "added"}, {"C5": ("added", None)}),
        ({"A1": 1.0}, {"A1": True}, {"A1": (True, 1.0)}),
        ({"A1": 1.0}, {"A1": ("=3-2", 1.0)}, {"A1": ("=3-2", 1.0)}),  # a formula where the run writes a number
        ({"A1": ("=1+1", 2.0)}, {"A1": ("=1+2", None)}, {"A1": ("=1+2", 2.0)}),
        ({"A1": ("=1+1", 2.0)}, {"A1": ("=1+2", 3.0)}, {"A1": (3.0, 2.0)}),
    ],
)
def test_cells_that_differ(pair, built, file, differences):
    assert found(pair(built, file)) == differences


@pytest.mark.parametrize(
    ("gives", "says"),
    [
        (True, ("=TRUE()", True)),  # as LibreOffice saves them
        (False, ("=FALSE()", False)),
        (("=1+1", 2.0), ("= 1 + 1", None)),  # saved by a program that does not compute
        (("=SUM(Bins!A1:A3)", 2.0), ("='Bins (2)'!A1:A3", 2.0)),  # its value is what is compared
    ],
)
def test_what_other_programs_write_otherwise(pair, gives, says):
    assert found(pair({"C3": gives}, {"C3": says})) == {}


def test_another_truth_is_a_difference(pair):
    assert found(pair({"A1": True}, {"A1": ("=FALSE()", False)})) == {"A1": ("=FALSE()", True)}


@pytest.mark.parametrize(
    ("first", "second"),
    [("SUM('Bins (2)'!A1, 2)", "sum(A1,2)"), ("Bins!$A$1+Curves!B2", "$A$1 + B2"), ("A1", "A1")],
)
def test_a_formula_without_what_each_program_writes(first, second):
    assert _bare(first) == _bare(second)


@pytest.mark.parametrize(
    ("gives", "says", "value", "differs"),
    [
        ("0.00", "0.000", 4.5, True),
        ("0.00", "#,##0.00", 4.5, False),
        ("0.00", "0.00E+00", 4.5, True),
        ("0%", "0", 0.5, True),
        ("General", "0.0", 4.5, False),  # 4.5 is shown to its last digit
        ("General", "0", 4.5, True),
        ("General", "0.00%", 0.1234, False),  # 12.34 %
        ("General", "0.00%", 0.12345, True),
        ("General", "0.0E+00", 4.5, True),
        ("0.0", "General", 4.5, True),
        ("0.0", None, 4.5, False),
        (None, "0.0", 4.5, False),
        ("0.0", "0.00", "text", False),
    ],
)
def test_a_number_shown_with_other_decimals(pair, formats, gives, says, value, differs):
    each = pair({"B2": value}, {"B2": value})
    formats({"B2": gives} if gives else {}, {"B2": says} if says else {})
    expected = (f"shown {NumberFormat.of(says or '')}", f"shown {NumberFormat.of(gives or '')}")
    assert found(each) == ({"B2": expected} if differs else {})


def test_sums_elsewhere_may_differ_by_the_rounding_of_the_largest_number_beside_them(pair):
    built, file = {"A1": 1e9, "B1": -3.0, "B2": -3.0}, {"A1": 1e9, "B1": -3.0000001, "B2": -3.0000001}
    assert found(pair(built, file)) == {"B1": (-3.0000001, -3), "B2": (-3.0000001, -3)}
    rest = found(pair(built, file, closeness=Closeness(elsewhere=True)))
    assert [*rest] == ["B2"]


RECORD = {
    "A1": "software",
    "A2": "software.python", "B2": "3.11",
    "A3": "processor", "B3": "x",
    "A4": "run", "B4": "Run",
    "A5": "run.trials", "B5": 100.0,
    "A6": "cells",
    "B7": "M!A1", "C7": 3.0,
    "A8": "forecasts",
    "B9": "x", "C9": 4.0,
}  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "differences"),
    [
        ({"B2": "3.12", "B3": "another"}, {}),  # compared elsewhere, as the cells are
        ({"C7": 3.5}, {}),
        ({"B5": 200.0}, {"B5": (200, 100)}),
        ({"C9": 5.0}, {"C9": (5, 4)}),
        ({"D9": "more"}, {"D9": ("more", None)}),
    ],
)
def test_the_record(pair, changes, differences):
    assert found(pair(RECORD, {**RECORD, **changes}, "Record")) == differences


@pytest.mark.parametrize("more", [1, 3])
def test_a_record_of_a_machine_that_tells_more(pair, more):
    """Rows of software above move what stands below; a difference is named where it is in the file."""
    file = {f"A{row + 1}": f"software.part{row}" for row in range(1, 1 + more)}
    for address, content in RECORD.items():
        row = int(address[1:])
        file[f"{address[0]}{row + (more if row > 1 else 0)}"] = content
    assert found(pair(RECORD, file, "Record")) == {}
    assert found(pair(file, RECORD, "Record")) == {}
    at = f"B{5 + more}"
    assert found(pair(RECORD, {**file, at: 7.0}, "Record")) == {at: (7, 100)}
    end = f"C{10 + more}"
    assert found(pair(RECORD, {**file, end: "below"}, "Record")) == {end: ("below", None)}


CERTAINTY = {"A5": 1.0, "B5": 3.0, "C5": ("=B5-A5", 2.0), "A6": 1.0, "B6": 4.0, "C6": ("=B6-A6", 3.0)}


def test_a_range_that_a_person_typed_is_left_out_and_its_formula_counted(pair):
    each = pair(CERTAINTY, {**CERTAINTY, "B5": 9.0, "C5": ("=B5-A5", 8.0)}, "Certainty")
    assert found(each) == {}
    (sentence,) = each.left_out()
    assert sentence.startswith("Certainty!A5 holds a range that a person typed")
    wrong = pair(CERTAINTY, {**CERTAINTY, "B5": 9.0}, "Certainty")
    assert found(wrong) == {"C5": (2, 8)}


def test_no_range_of_a_persons_own(pair):
    assert [*pair(CERTAINTY, CERTAINTY, "Certainty").left_out()] == []


@pytest.mark.parametrize(
    ("sentence", "last", "rows"),
    [
        ("Only the first 2,500 of 10,000 accepted trials stand here.", 5, 2500),
        ("Only the first 20,000 of 30,000 accepted trials stand here.", 5, 20_000),
        ("Anything else", 5, 100),
        ("Anything else", 103, 100),
        ("Anything else", 105, 101),  # the first of them in row 5, below the headings in row 4
        (None, 5, 100),
    ],
)
def test_how_many_trials_were_to_be_written(workbook, monkeypatch, sentence, last, rows):
    monkeypatch.setattr(compared, "TRIAL_ROWS", 100)
    cells = {"Trials!A3": sentence, f"Trials!A{last}": 1.0, f"Trials!B{last + 3}": 1.0}
    assert _trial_rows(workbook(cells).sheets["Trials"]) == rows


@pytest.mark.parametrize(
    ("file", "share"),
    [
        ({"A1": 1.0, "A2": 2.0, "A3": 3.0, "A4": 4.0}, 1.0),
        ({"A1": 1.0, "A2": 2.0, "A3": 3.1, "A9": 4.0}, 0.5),
        ({"A1": 1.0, "A2": 2.0, "A3": 3.0, "A4": 4.1}, 0.75),
        ({}, 0.0),
    ],
)
def test_the_share_of_cells_that_two_sheets_have_in_common(workbook, file, share):
    built = workbook({"A1": 1.0, "A2": 2.0, "A3": 3.0, "A4": 4.0, "B1": None}).sheets["S"]
    assert _share(built, workbook(file).sheets["S"]) == share
    assert _share(workbook({}).sheets["S"], built) == 0


def test_a_number_that_another_program_wrote_with_15_digits_is_the_same(workbook):
    built, file = (workbook({"A1": number}).sheets["S"] for number in (0.12345678901234568, 0.123456789012346))
    assert _share(built, file) == 1


def test_some_hundreds_of_cells_of_a_long_sheet_are_looked_at(workbook):
    long, odd = ({f"A{row}": float(row) for row in range(1, 1202)} for _ in range(2))
    for row in range(1, 1202, 2):
        odd[f"A{row}"] = 0.0
    assert _share(workbook(long).sheets["S"], workbook(odd).sheets["S"]) == pytest.approx(0.5, abs=0.01)


CELLS = {"A1": 1.0, "A2": 2.0, "A3": 3.0, "A4": 4.0}


@pytest.mark.parametrize(
    ("sheets", "likest"),
    [
        ({"Other": CELLS}, "Other"),
        ({"Other": {**CELLS, "A4": 5.0}}, "Other"),
        ({"Other": {**CELLS, "A3": 5.0, "A4": 5.0}}, None),  # half is not enough
        ({"Results": {**CELLS, "A3": 5.0, "A4": 5.0, "A2": 5.0}}, "Results"),  # enough of the same name
        ({"Results": {"B1": 1.0}}, None),
        ({"Other": CELLS, "Results": CELLS}, "Results"),
        ({"Other": CELLS, "Results": {**CELLS, "A4": 5.0}}, "Other"),
        ({"Taken": CELLS}, None),
    ],
)
def test_the_likest_sheet(workbook, sheets, likest):
    built = workbook({f"Results!{at}": content for at, content in CELLS.items()}).sheets["Results"]
    file = workbook({f"{name}!{at}": content for name, cells in sheets.items() for at, content in cells.items()})
    result = _likest(built, file, {"Taken"})
    assert (result and result.name) == likest


@pytest.mark.parametrize(
    ("marks", "names"),
    [
        ((), {"Results": "Results", "Bins": "Bins"}),
        (("Results (2)", "Bins"), {"Results": "Results (2)", "Bins": "Bins"}),
        (("Gone",), {"Results": "Results", "Bins": "Bins"}),
    ],
)
def test_marked_sheets_come_first(workbook, monkeypatch, marks, names):
    monkeypatch.setattr(compared, "marked_names", lambda names: marks)
    built = workbook({"Results!A1": 1.0, "Bins!A1": 2.0})
    file = workbook({"Results!A1": 1.0, "Bins!A1": 2.0, "Results (2)!A1": 7.0})
    built.sheets.pop("S")
    result = _match_sheets(file, built)
    assert {name: sheet.name for name, sheet in result.items()} == names


def test_what_is_missing_and_what_was_compared(workbook, formats):
    built, file = workbook({"Results!A1": 1.0, "Bins!A1": 2.0}), workbook({"Mine!A1": 1.5})
    built.sheets.pop("S")
    result = _compared(file, built, {"Results": file.sheets["Mine"]}, EXACT)
    assert (result.sheets, result.missing, result.left_out) == (("Mine",), ("Bins",), ())
    assert [str(each.where) for each in result.differences] == ["Mine!A1"]
    assert not result.same


def sheet_of(*rows, before=b"", after=b""):
    return b"<worksheet>" + before + b"<sheetData>" + b"".join(rows) + b"</sheetData>" + after + b"</worksheet>"


def row(number, value, style=1, cell=b""):
    return b'<row r="%d"><c r="A%d" s="%d"><v>%s</v></c>%s</row>' % (number, number, style, value, cell)


def test_common_rows_are_taken_out_but_for_the_first_of_each_style():
    first = sheet_of(row(1, b"1.5"), row(2, b"2.5"), row(3, b"3.5"), row(4, b"4.5", 2))
    second = sheet_of(row(1, b"1.5", 7), row(2, b"2.5", 7), row(3, b"9.5", 7), row(4, b"4.5", 7))
    short_first, short_second = _without_common_rows(first, second)
    # of rows 1 and 2, which are the same with the styles 1 and 7, one stays; 3 differs; 4 has a style of its own
    assert [short_first.count(b"<v>%s</v>" % value) for value in (b"1.5", b"2.5")] in ([1, 0], [0, 1])
    assert short_first.count(b"<row ") == short_second.count(b"<row ") == 3
    for value in (b"3.5", b"4.5"):
        assert value in short_first
    assert b"9.5" in short_second


@pytest.mark.parametrize(
    "odd",
    [
        row(5, b"1", cell=b'<c r="B5" t="s"><v>0</v></c>'),
        row(5, b"1", cell=b'<c r="B5"><f>A1</f><v>1</v></c>'),
        row(5, b"1", cell=b"<is><t>x</t></is>"),
    ],
)
def test_rows_with_texts_or_formulas_stay(odd):
    rows = _rows_by_text(sheet_of(row(1, b"1.5"), odd))
    assert rows == {b'<row r="1"><c r="A1"><v>1.5</v></c></row>': (b"1",)}


@pytest.mark.parametrize(
    "xml",
    [
        b"<worksheet/>",
        sheet_of(row(1, b"1.5"), b"<other/>"),
        sheet_of(row(1, b"1.5"), before=b"<!-- note -->"),
        sheet_of(row(1, b"1.5"), before=b"<row/>"),
        sheet_of(row(1, b"1.5"), after=b'<row r="3"/>'),
        sheet_of(row(1, b"1.5")).replace(b"</sheetData>", b""),
    ],
)
def test_a_worksheet_with_anything_else_stays_as_it_is(xml):
    assert _rows_by_text(xml) == {}
    whole = sheet_of(row(1, b"1.5"), row(2, b"1.5"))
    assert _without_common_rows(xml, whole) == (xml, whole)
