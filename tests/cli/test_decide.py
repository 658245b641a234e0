"""`xlmc decide`."""

from __future__ import annotations

import json

import openpyxl
import pytest
from workbook_files import workbook_of


@pytest.fixture
def book(tmp_path):
    sheets = {
        "Inputs": [
            ["Name", "Value", "Low", "High"],
            ["Demand", 50, 0, 100],
            [],
            ["What", "Value"],
            ["Order", 50],
            ["Price", 5],
        ],
        "Model": [["Name", "Value", "Units"], ["Profit", "=Inputs!B6*MIN(Inputs!B5,Inputs!B2)-3*Inputs!B5", "$"]],
        "Decisions": [
            ["Name", "Cell", "Low", "High", "Step", "Values"],
            ["Order", "=Inputs!B5", 20, 60, 10, None],
            ["Price", "=Inputs!B6", None, None, None, "5; 6"],
        ],
    }
    tables = {
        "xlmc_assumptions": "Inputs!A1:D2",
        "xlmc_forecasts": "Model!A1:C2",
        "xlmc_decisions": "Decisions!A1:F3",
    }
    path = tmp_path / "newsvendor.xlsx"
    workbook_of(sheets, tables).save(path)
    return path


def test_the_terminal_says_which_is_best_and_by_how_much(xlmc, book):
    outcome = xlmc("decide", book, "-n", "20000", "--table", "Order", "--quiet")
    assert outcome.code == 0, outcome.err
    words = " ".join(outcome.out.split())
    assert "5 combinations of Order, 20,000 trials each, seed 999." in words
    assert "with Order = 40; that is" in words
    assert "these trials cannot tell the two apart" in words  # 20 and 60 are equally bad


def test_a_yes_or_no_has_a_probability(xlmc, tmp_path):
    path = tmp_path / "book.xlsx"
    sheets = {
        "Model": [[50], [40], ["=A1<=A2"]],
        "A": [["Name", "Cell", "Low", "High"], ["demand", "=Model!A1", 0, 100]],
        "F": [["Name", "Cell"], ["enough", "=Model!A3"]],
        "D": [["Name", "Cell", "Values"], ["order", "=Model!A2", "20; 80"]],
    }
    tables = {"xlmc_assumptions": "A!A1:D2", "xlmc_forecasts": "F!A1:B2", "xlmc_decisions": "D!A1:C2"}
    workbook_of(sheets, tables).save(path)
    outcome = xlmc("decide", path, "-n", "2000")
    assert outcome.code == 0, outcome.err
    assert "The probability of enough is largest" in outcome.out


def test_files_have_the_table_and_the_trend(xlmc, book, tmp_path):
    sheet, page, result = tmp_path / "found.xlsx", tmp_path / "found.html", tmp_path / "found.json"
    given = ["decide", book, "-n", "2000", "--quiet"]
    outcome = xlmc(*given, "-o", sheet, "-o", page, "-o", result)
    assert outcome.code == 0, outcome.err
    made = openpyxl.load_workbook(sheet)["Decisions"]
    rows = [row[:2] for row in made.iter_rows(values_only=True)]
    assert ("Order", "Price") in rows
    assert (20, 6) in rows
    (chart,) = made._charts
    assert len(chart.series) == 2  # a line for each price
    assert "Order = 60, Price = 5" in page.read_text(encoding="utf-8")
    written = json.loads(result.read_text(encoding="utf-8"))
    assert written.pop("seal")
    assert written == json.loads(xlmc(*given, "--json").out)
    assert [each["values"] for each in written["combinations"][:2]] == [[20, 5], [20, 6]]
    assert written["combinations"][0]["forecasts"][0]["mean"]["difference"]["value"] is not None
    assert written["as_it_is"]["name"] is None


def test_a_book_without_decisions_is_refused_with_the_cure(xlmc, case_study):
    outcome = xlmc("decide", case_study)
    assert outcome.code == 2
    assert "xlmc_decisions" in outcome.err


def test_the_record_of_a_run_says_what_was_decided(xlmc, book, tmp_path):
    assert xlmc("simulate", book, "-n", "500", "-o", tmp_path / "run.xlsx").code == 0
    sheet = openpyxl.load_workbook(tmp_path / "run.xlsx")["Record"]
    rows = [[cell for cell in row[1:] if cell is not None] for row in sheet.iter_rows(values_only=True)]
    at = rows.index(["Decision", "Cell", "Value", "Units", "May be"])
    assert rows[at + 1][:3] == ["Order", "Inputs!B5", "50"]
    assert rows[at + 1][-1] == "20 to 60 in steps of 10"
    assert rows[at + 2][-1] == "5; 6"
    assert xlmc("replay", tmp_path / "run.xlsx").code == 0


def test_what_is_the_same_in_every_trial_is_sure_and_ties_are_told(xlmc, tmp_path):
    """A cost of 100 times the order is the same difference in each trial; the colour changes nothing."""
    path = tmp_path / "book.xlsx"
    sheets = {
        "Model": [[0.1], [40], [1], ["=A1+100.1*A2"], ["=A1*2"]],
        "A": [["Name", "Cell", "Low", "High"], ["price", "=Model!A1", 0, 1]],
        "F": [["Name", "Cell"], ["cost", "=Model!A4"], ["fee", "=Model!A5"]],
        "D": [["Name", "Cell", "Values"], ["order", "=Model!A2", "20; 80"], ["colour", "=Model!A3", "1; 2"]],
    }
    tables = {"xlmc_assumptions": "A!A1:D2", "xlmc_forecasts": "F!A1:B3", "xlmc_decisions": "D!A1:C3"}
    workbook_of(sheets, tables).save(path)
    outcome = xlmc("decide", path, "-n", "2000", "--quiet")
    words = " ".join(outcome.out.split())
    assert "with order = 80, colour = 1, and the same with order = 80, colour = 2." in words
    assert "Whatever order and colour are, these stay as they are: fee." in words
    assert "cannot tell" not in words
    one = " ".join(xlmc("decide", path, "-n", "2000", "--quiet", "--table", "order").out.split())
    assert "that is 6,006 above the next, order = 20." in one
