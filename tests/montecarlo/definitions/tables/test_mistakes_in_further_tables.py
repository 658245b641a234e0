"""Ordinary mistakes in decisions, solved cells, a correlation matrix, files of functions: one clear line for each."""

from __future__ import annotations

import openpyxl
import pytest
from beam_books import beam
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.table import Table

DECISIONS = ["Name", "Cell", "Low", "High", "Step"]
SOLVE = ["Name", "Cell", "To", "By", "Low", "High"]
FREE = {"Model!F1": 1, "Model!F2": "=F1*load"}
NO_PAIRS = {f"Answers!{column}11": None for column in "ABC"}


def decided(*row, headings=DECISIONS):
    return {"xlmc_decisions": [headings, row]}


def solved(*row, headings=SOLVE):
    return {"xlmc_solve": [headings, ("Factor", *row)]}


def matrix(*rows, headings=("load", "strength")):
    return {"xlmc_correlation_matrix": [("Name", *headings), *rows]}


CASES = {
    "a step of 0": (
        decided("W", "=Model!F1", 800, 950, 0),
        "T!C2",
        "in steps of 0 there are no values",
        "Step above 0",
    ),
    "low above high": (decided("W", "=Model!F1", 950, 800, 50), "T!C2", "From 950 to 800", "Give Low below High"),
    "a decision that is drawn": (
        decided("W", "=Inputs!B2", 1, 2, 1),
        "T!A2",
        "Inputs!B2, is drawn or solved for in each trial",
        "Decide on another cell",
    ),
    "a decision on a formula": (
        decided("W", "=Model!B2", 1, 2, 1),
        "T!A2",
        "Model!B2, holds a formula",
        "Decide on a cell that holds a number",
    ),
    "values that are words": (
        decided("W", "=Model!F1", "800; big", headings=["Name", "Cell", "Values"]),
        "T!C2",
        "Values lists numbers and 'big'",
        "separated by semicolons",
    ),
    "a heading misspelt": (
        decided("W", "=Model!F1", 800, 950, 50, headings=["Name", "Cell", "Low", "Hihg", "Step"]),
        "T!D1",
        "The column 'Hihg' is not read: did you mean High?",
        "Rename the column High",
    ),
    "a high left out": (
        decided("W", "=Model!F1", 800, None, 50),
        "T!D2",
        "The decision has no High",
        "Fill in Low and High",
    ),
    "too many values": (
        decided("W", "=Model!F1", 0, 1e9, 0.001),
        "T!E2",
        "are more than 100,000",
        "Give a larger Step",
    ),
    "a range turned round": (
        solved("=Model!F2", 50, "=Model!F1", 10, 0),
        "T!F2",
        "Low (10) is not below High (0)",
        "Give the least and the largest value",
    ),
    "by a formula": (
        solved("=Model!F2", 50, "=Model!B2", 0, 9),
        "T!D2",
        "Model!B2 holds a formula, and only a cell without one can be solved for",
        "Point By to the input",
    ),
    "by an assumption": (
        solved("=Model!F2", 50, "=Inputs!B2", 0, 9),
        "T!A2",
        "Inputs!B2 is the cell of an assumption",
        "Solve for another cell",
    ),
    "by a cell that does not matter": (
        solved("=Model!B2", 50, "=Model!F1", 0, 9),
        "T!A2",
        "Model!B2 does not depend on Model!F1",
        "Choose an input that Model!B2 is computed from",
    ),
    "a target in words": (
        solved("=Model!F2", "fifty", "=Model!F1", 0, 9),
        "T!C2",
        "To holds the text 'fifty'",
        "Type a number",
    ),
    "To misspelt": (
        solved("=Model!F2", 50, "=Model!F1", 0, 9, headings=["Name", "Cell", "Too", "By", "Low", "High"]),
        "T!A1",
        "The table xlmc_solve has no column To",
        "Rename the column 'Too' to To",
    ),
    "a diagonal that is not 1": (
        matrix(("load", 1, None), ("strength", 0.2, 0.9)),
        "T!C3",
        "The correlation of 'strength' with itself is 1",
        "Type 1, or clear the cell",
    ),
    "two halves that differ": (
        matrix(("load", 1, 0.5), ("strength", 0.2, 1)),
        "T!B3",
        "The matrix gives 'strength' and 'load' two correlations",
        "Correct one of them, or clear one half",
    ),
    "a correlation above 1": (
        matrix(("load", 1, None), ("strength", 1.2, 1)),
        "T!B3",
        "Correlation (1.2) must lie between -1 and 1",
        "Type a rank correlation",
    ),
    "a correlation in words": (
        matrix(("load", 1, None), ("strength", "high", 1)),
        "T!B3",
        "Correlation holds the text 'high'",
        "Type a number",
    ),
    "a name misspelt in a matrix": (
        matrix(("load", 1, None), ("strenght", 0.2, 1)),
        "T!A3",
        "There is no assumption 'strenght'",
        "Did you mean strength?",
    ),
    "a row twice": (
        matrix(("load", 1, None), ("load", 0.2, 1)),
        "T!A3",
        "Two rows are named 'load', this one and T!A2",
        "Correct one name",
    ),
    "a pair in a matrix and in the list": (
        matrix(("load", 1, None), ("span", -0.2, 1), headings=("load", "span")) | {"pairs": []},
        "T!B3",
        "'load' and 'span' are correlated here and in Answers!A11",
        "Clear one of them",
    ),
}


def book_with(path, tables):
    """The beam with a further table on the sheet T."""
    beam(path, FREE if "pairs" in tables else FREE | NO_PAIRS)
    book = openpyxl.load_workbook(path)
    sheet = book.create_sheet("T")
    for name, rows in tables.items():
        if rows:
            for row in rows:
                sheet.append(list(row))
            corner = f"{get_column_letter(len(rows[0]))}{len(rows)}"
            sheet.add_table(Table(displayName=name, ref=f"A1:{corner}"))
    book.save(path)


@pytest.mark.parametrize(("tables", "where", "fault", "cure"), CASES.values(), ids=CASES)
def test_one_mistake_is_one_line_with_its_cell_and_cure(xlmc, tmp_path, tables, where, fault, cure):
    book_with(tmp_path / "beam.xlsx", tables)
    done = xlmc("simulate", "beam.xlsx", "-o", "r.json")
    assert (done.code, done.err.count("\n")) == (2, 1), done.err
    assert where in done.err
    assert fault in done.err
    assert cure in done.err
    assert not (tmp_path / "r.json").exists()


FILES = {
    "a workbook": (lambda path: beam(path, {}), "The file is not Python", "Name a file of Python"),
    "a folder": (lambda path: path.mkdir(), "The file cannot be read", "Name a file of Python"),
    "no colon": (lambda path: path.write_text("def f(x)\n  return x\n", "utf-8"), "(line 1)", "Correct that line"),
}


@pytest.mark.parametrize(("make", "fault", "cure"), FILES.values(), ids=FILES)
def test_a_file_that_holds_no_functions_is_one_line(xlmc, tmp_path, make, fault, cure):
    beam(tmp_path / "beam.xlsx", {"Model!B2": "=BeamMoment(load,span)"})
    make(tmp_path / "mine.py")
    done = xlmc("simulate", "beam.xlsx", "--functions", "mine.py")
    assert (done.code, done.err.count("\n")) == (2, 1), done.err
    assert done.err.startswith("xlmc: mine.py: ")
    assert fault in done.err
    assert cure in done.err
    assert "None" not in done.err
