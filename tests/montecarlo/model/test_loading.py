"""Which filters are no tests, whatever the file holds as the value of their cells."""

from __future__ import annotations

import openpyxl
import pytest
from simulated import simulated
from workbook_files import workbook_of

from xlmc.errors import DefinitionError
from xlmc.excel.workbook import lazy_sheets
from xlmc.montecarlo.model.loading import filter_faults, load

INPUTS = {"speed": {"cell": "A1", "low": 0, "high": 2}, "mass": {"cell": "A2", "low": 1, "high": 3}}
CELLS = {"A1": 0.75, "A2": 2.0, "B1": "=A1*A2"}


def faults(book, formula, **limits):
    model = book({**CELLS, "C1": formula}, INPUTS, {"answer": "B1"}, {"possible": {"cell": "C1", **limits}})
    return [str(fault) for fault in filter_faults(model)]


@pytest.mark.parametrize("saved", [None, 0.0, 1.0, True, 7.5, "a text"])
@pytest.mark.parametrize(
    ("formula", "held"),
    [
        ("=A1*2", "1.5 at the base case"),
        ("=B1", "1.5 at the base case"),
        ("=-A1", "-0.75 at the base case"),
        ("=(A1>0)+(A2>0)", "2 at the base case"),
        ("=ROUND(A1,0)*A2/2", "in a trial"),  # 1 at the base case
        ("=A1-0.75", "in a trial"),  # 0 at the base case
        ("=IF(A1>1,5,1)", "5 in a trial"),
    ],
)
def test_a_quantity_without_a_limit_is_refused_whatever_was_saved(book, formula, held, saved):
    (fault,) = faults(book, (formula, saved))
    assert fault.startswith("S!C1: The filter 'possible' has no limit, and its cell is ")
    assert held in fault
    assert "neither TRUE nor FALSE. Fill in At least, At most, Above or Below" in fault


@pytest.mark.parametrize("saved", [None, 0.0, 1.0, True, 7.5, "a text"])
@pytest.mark.parametrize(
    "formula",
    [
        "=A1<1",
        "=IF(A1<1,1,0)",
        "=(A1<1)*(A2>1)",
        "=AND(A1<1,A2>1)",
        "=--(A1<1)",
        "=SIGN(A1)",
        "=IFERROR(SQRT(A1-1)>0.5,FALSE)",
        "=1/(A1-0.75)>0",
        "=TRUE",
    ],
)
def test_a_test_without_a_limit_is_kept_whatever_was_saved(book, formula, saved):
    assert faults(book, (formula, saved)) == []


@pytest.mark.parametrize("saved", [None, 0.0, 7.5, "a text"])
def test_a_quantity_with_a_limit_is_kept(book, saved):
    assert faults(book, ("=A1*2", saved), above=0) == []


def test_a_text_is_refused_with_limits_too(book):
    (fault,) = faults(book, '=IF(A1<1,"ok","no")', above=0)
    assert fault.startswith("S!C1: The cell of the filter 'possible' is a text at the base case. Fill in At least")
    (fault,) = faults(book, '=IF(A1<1,"ok","no")')
    assert "is a text at the base case" in fault


def test_a_saved_text_that_is_stale_is_no_mistake(book):
    assert faults(book, ("=A1*2", "ok"), above=0) == []
    assert faults(book, '=IF(A1<1,"",A1)', above=0) == []  # nothing, where there is nothing to test


def test_without_a_base_case_trials_are_looked_at(book):
    cells = {**CELLS, "A1": None, "C1": "=A1*2", "C2": "=A1<1"}
    filters = {"possible": "C1", "slow": "C2"}
    (fault,) = filter_faults(book(cells, INPUTS, {"answer": "B1"}, filters))
    assert str(fault).startswith("S!C1: ")
    assert "in a trial" in str(fault)


def test_an_assumption_without_a_limit_is_refused(book):
    (fault,) = filter_faults(book(CELLS, INPUTS, {"answer": "B1"}, {"possible": "A2"}))
    assert "its cell is 2 at the base case" in str(fault)


def test_looking_changes_no_run(book):
    cells, filters = {**CELLS, "C1": "=A1<1"}, {"possible": "C1"}
    plain, seen = (book(cells, INPUTS, {"answer": "B1"}, filters) for _ in range(2))
    assert filter_faults(seen) == []
    assert simulated(plain, 500).forecasts["answer"].tobytes() == simulated(seen, 500).forecasts["answer"].tobytes()


def test_every_fault_is_listed_however_many_there_are(small_book, tmp_path):
    book = openpyxl.load_workbook(small_book)
    blank, wrong = (
        ("Inputs!C2", "Inputs!D2", "Inputs!C3", "Inputs!D3"),
        ("Wanted!B2", "Wanted!B3", "Wanted!C6", "Wanted!B9"),
    )
    for cell in (*blank, *wrong):
        sheet, _, place = cell.partition("!")
        book[sheet][place] = None if cell in blank else f"many {'words ' * 100}"
    path = tmp_path / "faulty.xlsx"
    book.save(path)
    with pytest.raises(DefinitionError) as caught:
        load(path)
    lines = str(caught.value).splitlines()
    assert {line.partition(":")[0] for line in lines} >= {*blank, *wrong}
    assert all(line.endswith(".") and len(line) < 1200 for line in lines)


def test_a_sheet_that_nothing_needs_is_not_parsed(tmp_path, monkeypatch):
    parsed, parse_sheet = [], lazy_sheets.parse_sheet
    monkeypatch.setattr(
        lazy_sheets, "parse_sheet", lambda xml, at, own: parsed.append(at.name) or parse_sheet(xml, at, own)
    )
    sheets = {
        "Inputs": [["Name", "Value", "Low", "High"], ["a", 0.5, 0, 1]],
        "Answers": [["Name", "Value"], ["b", "=Inputs!B2*2"]],
        "Data": [[number] for number in range(50)],
    }
    path = tmp_path / "book.xlsx"
    workbook_of(sheets, {"xlmc_assumptions": "Inputs!A1:D2", "xlmc_forecasts": "Answers!A1:B2"}).save(path)
    load(path)
    assert sorted(parsed) == ["Answers", "Inputs"]
