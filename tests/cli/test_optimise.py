"""`xlmc optimise`."""

from __future__ import annotations

import json

import openpyxl
import pytest
from workbook_files import workbook_of


@pytest.fixture
def book(tmp_path):
    """A newsvendor: demand uniform from 0 to 100, a cost of 3, a price of 5."""
    sheets = {
        "Inputs": [["Name", "Value", "Low", "High"], ["Demand", 50, 0, 100], [], ["What", "Value"], ["Order", 50]],
        "Model": [["Name", "Value", "Units"], ["Profit", "=5*MIN(Inputs!B5,Inputs!B2)-3*Inputs!B5", "$"]],
        "Decisions": [["Name", "Cell", "Low", "High", "Step", "Units"], ["Order", "=Inputs!B5", 0, 100, 5, "pieces"]],
    }
    tables = {
        "xlmc_assumptions": "Inputs!A1:D2",
        "xlmc_forecasts": "Model!A1:C2",
        "xlmc_decisions": "Decisions!A1:F2",
    }
    path = tmp_path / "newsvendor.xlsx"
    workbook_of(sheets, tables).save(path)
    return path


GIVEN = ("--maximise", "mean of Profit", "-n", "5000", "--quiet")


def test_the_terminal_says_what_is_best_and_how_sure_that_is(xlmc, book):
    outcome = xlmc("optimise", book, *GIVEN, "--subject-to", "P5 of Profit >= -110", "--subject-to", "Order <= 90")
    assert outcome.code == 0, outcome.err
    words = " ".join(outcome.out.split())
    assert "Mean of Profit is largest, 39" in words or "Mean of Profit is largest, 40" in words
    assert "$, with Order = 40." in words
    assert "P5 of Profit >= -110 holds with more than 99.9 % confidence" in words
    assert "Order <= 90: met, 40." in words
    assert "Of 19 candidates, no other that was tried and meets this as surely is better by more than" in words
    assert "With the workbook's own decisions mean of Profit is" in words
    assert "xlmc optimise newsvendor.xlsx --maximise 'mean of Profit' --subject-to 'P5 of Profit >= -110'" in words


def test_no_margin_is_said_where_none_matters(xlmc, book):
    outcome = xlmc("optimise", book, "--maximise", "P1 of Profit", "-n", "500", "--indifference", "0")
    words = " ".join(outcome.out.split())
    assert "candidates, no other that was tried is better: " in words
    assert "a difference that does not matter" not in words


def test_every_kind_of_file_and_the_run_repeats(xlmc, book, tmp_path):
    for library in ("typst", "docx", "pyarrow"):
        pytest.importorskip(library)
    names = [f"found.{ending}" for ending in ("xlsx", "pdf", "docx", "html", "json", "csv", "parquet", "xlmcrun")]
    outcome = xlmc("optimise", book, *GIVEN, *(part for name in names for part in ("-o", tmp_path / name)))
    assert outcome.code == 0, outcome.err
    sheet = openpyxl.load_workbook(tmp_path / "found.xlsx")["Optimum"]
    texts = [str(cell) for row in sheet.iter_rows(values_only=True) for cell in row]
    assert any("with Order = 40" in text for text in texts)
    assert len(sheet._charts) == 1
    assert "with Order = 40" in (tmp_path / "found.html").read_text(encoding="utf-8")
    written = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert written.pop("seal")
    assert written == json.loads(xlmc("optimise", book, *GIVEN, "--json").out)
    assert written["decisions"][0] == {"name": "Order", "cell": "Inputs!B5", "units": "pieces", "value": 40}
    assert written["confidence"] > 0.9
    replayed = xlmc("replay", tmp_path / "found.xlmcrun")
    assert replayed.code == 0, replayed.err
    assert "identical" in replayed.out
    again = xlmc("report", tmp_path / "found.xlmcrun", "-o", tmp_path / "again.csv")
    assert again.code == 0, again.err
    assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "found.csv").read_bytes()


def test_a_requirement_that_nothing_meets_ends_with_code_1(xlmc, book):
    outcome = xlmc("optimise", book, *GIVEN, "--subject-to", "P5 of Profit >= 100")
    assert outcome.code == 1
    assert "No candidate that was found meets what is required" in outcome.err


def test_what_is_not_understood_is_refused_with_the_cure(xlmc, book):
    for given, message in (
        (("--maximise", "mean of Porfit"), "Did you mean Profit?"),
        ((), "What is to be largest, or smallest?"),
        (("--minimise", "mean of Profit", "--subject-to", "Profit >= 0"), "a statistic of it is asked for"),
    ):
        outcome = xlmc("optimise", book, *given)
        assert outcome.code == 2
        assert message in outcome.err
