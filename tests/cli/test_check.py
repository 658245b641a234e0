from __future__ import annotations

import openpyxl
import pytest
from workbook_files import workbook_of

pytestmark = pytest.mark.usefixtures("short_books")


def test_shows_what_was_understood(xlmc, case_study):
    outcome = xlmc("check", case_study)
    assert outcome.code == 0
    assert "Uniform: Low 181, High 191" in outcome.out
    assert "at least 0 and at most 0.25" in outcome.out
    assert "Model!D54" in outcome.out
    assert "No problem found." in outcome.out
    assert outcome.err == ""


@pytest.fixture
def spoiled(plain_book):
    """The plain book with some cells changed, as a person would."""

    def change(sheet: str, **cells: object):
        book = openpyxl.load_workbook(plain_book)
        for address, value in cells.items():
            book[sheet][address] = value
        book.save(plain_book.with_name("spoiled.xlsx"))
        return plain_book.with_name("spoiled.xlsx")

    return change


def test_lists_every_problem_with_its_cell(xlmc, spoiled):
    outcome = xlmc("check", spoiled("Inputs", F2="Unifrom", C3=500))
    assert outcome.code == 2
    assert "Inputs!F2" in outcome.err
    assert "Did you mean Uniform?" in outcome.err
    assert "Inputs!C3" in outcome.err
    assert "2 problems found" in outcome.err


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("=SQRTT(Inputs!B2)", "Did you mean SQRT?"),
        ("=SQRT(Inputs!B2", "cannot be read"),
        ("=Inptus!B2", "There is no sheet 'Inptus'"),
        ("=weihgt_1", "There is no name 'weihgt_1'"),
        ("=Model!A1*2", "in a circle: Model!A1"),
        ("=SQRT(1,2)", "SQRT has 2 arguments; it takes 1"),
    ],
)
def test_a_formula_that_cannot_be_computed_is_named_with_its_cell(xlmc, spoiled, formula, message):
    outcome = xlmc("check", spoiled("Model", A1=formula))
    assert outcome.code == 2
    assert "Model!A1" in outcome.err
    assert message in outcome.err


def test_a_file_that_is_no_workbook(xlmc, tmp_path):
    (tmp_path / "book.xlsx").write_bytes(b"no zip")
    outcome = xlmc("check", tmp_path / "book.xlsx")
    assert outcome.code == 2
    assert "book.xlsx" in outcome.err
    assert "Traceback" not in outcome.err


def test_a_file_that_is_not_there(xlmc):
    outcome = xlmc("check", "nowhere.xlsx")
    assert outcome.code == 2
    assert "nowhere.xlsx" in outcome.err


def test_a_workbook_without_tables_is_told_how_to_begin(xlmc, tmp_path):
    openpyxl.Workbook().save(tmp_path / "plain.xlsx")
    outcome = xlmc("check", tmp_path / "plain.xlsx")
    assert outcome.code == 2
    assert "xlmc_assumptions" in outcome.err


def test_limits_that_are_computed_from_the_own_cell_are_shown_as_numbers(xlmc, spoiled):
    base = 0.5
    outcome = xlmc("check", spoiled("Inputs", C2="=B2*0.97", D2="=B2*1.03"))
    assert outcome.code == 0, outcome.err
    shown = f"Low {base * 0.97:g}, High {base * 1.03:g}"
    in_table = f"Low {base * 0.97:g} (Inputs!C2: =B2*0.97), High {base * 1.03:g} (Inputs!D2: =B2*1.03)"
    assert f"Uniform: {in_table}" in outcome.out
    text = " ".join(outcome.err.split())
    assert f"computed from the base value of the assumption's own cell ({base:g}): {shown}" in text


@pytest.mark.parametrize("command", [("check",), ("simulate", "-n", "100", "--quiet")])
def test_a_filter_without_a_limit_over_a_quantity_is_refused_by_what_its_cell_computes(
    xlmc, small_book, tmp_path, command
):
    book = openpyxl.load_workbook(small_book)  # which saves no values of formulas
    book["Wanted"]["C6"] = None
    book.save(tmp_path / "spoiled.xlsx")
    outcome = xlmc(command[0], tmp_path / "spoiled.xlsx", *command[1:])
    assert outcome.code == 2
    assert outcome.err.count("Model!A3: The filter 'root' has no limit, and its cell is 0.94868") == 1
    assert "Fill in At least, At most, Above or Below" in outcome.err
    assert not list(tmp_path.glob("*-results.xlsx"))


def test_solved_cells_and_decisions_are_shown(xlmc, tmp_path):
    sheets = {
        "Inputs": [["Name", "Value", "Low", "High"], ["a", 2, 1, 3], [], ["What", "Value"], ["x", 1], ["size", 5]],
        "Model": [["Name", "Value"], ["y", "=Inputs!B2*Inputs!B5*Inputs!B6"]],
        "Solve": [["Name", "Cell", "To", "By", "Low", "High"], ["the x", "=Model!B2", 30, "=Inputs!B5", 0, 100]],
        "Decide": [["Name", "Cell", "Values", "Units"], ["Size", "=Inputs!B6", "5; 7.5", "m"]],
    }
    tables = {
        "xlmc_assumptions": "Inputs!A1:D2",
        "xlmc_forecasts": "Model!A1:B2",
        "xlmc_solve": "Solve!A1:F2",
        "xlmc_decisions": "Decide!A1:D2",
    }
    workbook_of(sheets, tables).save(tmp_path / "book.xlsx")
    words = " ".join(xlmc("check", "book.xlsx").out.split())
    assert "the x Inputs!B5 only 0 100 Model!B2 30" in words
    assert "Size Inputs!B6 m 5; 7.5" in words


def test_only_forecasts_that_are_numbers_have_a_central_range(xlmc, tmp_path):
    rows = {
        "Inputs": [["Name", "Value", "Low", "High"], ["a", 0.5, 0.12345678901234, 0.9]],
        "Model": [["A"], ["=Inputs!B2*2"], ["=Inputs!B2>0.5"], ['=IF(Inputs!B2>0.5,"yes","no")'], ["=Inputs!B2+1"]],
        "Wanted": [
            ["Name", "Cell", "Kind"],
            ["number", "=Model!A2", ""],
            ["derived", "=Model!A3", ""],
            ["text", "=Model!A4", ""],
            ["said", "=Model!A5", "yes/no"],
        ],
    }
    tables = {"xlmc_assumptions": "Inputs!A1:D2", "xlmc_forecasts": "Wanted!A1:C5"}
    workbook_of(rows, tables).save(tmp_path / "kinds.xlsx")
    outcome = xlmc("check", "kinds.xlsx")
    assert outcome.code == 0
    lines = {line.split()[0]: line for line in outcome.out.splitlines() if line.strip()}
    assert {name: "51 %" in lines[name] for name in ("number", "derived", "text", "said")} == {
        "number": True,
        "derived": False,
        "text": False,
        "said": False,
    }
    assert "Low 0.12345678901234, High 0.9" in outcome.out
