"""Checks and errors are heard by check, simulate and replay before anything else."""

from __future__ import annotations

import json

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

pytestmark = pytest.mark.usefixtures("short_books")


@pytest.fixture
def failing(tmp_path):
    """A check that 0.7 % of the trials fail, and a forecast that is an error in few of them."""

    def make(base=1.0, formula="=D11*B3", rounded="=1/ROUND(B2*100,0)"):
        book = openpyxl.Workbook()
        sheet = book.active
        sheet.title = "Model"
        rows = [["Name", "Value", "Low", "High", "Source"], ["x", 2, 0, 10, "Example, to be replaced"]]
        rows += [["y", base, 0.5, 2, "tape"], [], ["Name", "Cell"], ["r", "=Model!D12"], ["q", "=Model!D13"]]
        for row in rows:
            sheet.append(row)
        sheet["D11"], sheet["D12"], sheet["D13"], sheet["D15"] = rounded, formula, "=B3*2", "=B3<1.99"
        for address, value in {"G1": "Name", "H1": "Cell", "I1": "Because", "G2": "y is small"}.items():
            sheet[address] = value
        sheet["H2"], sheet["I2"] = "=Model!D15", "FALSE: y is large."
        for name, area in (("xlmc_assumptions", "A1:E3"), ("xlmc_forecasts", "A5:B7"), ("xlmc_checks3", "G1:I2")):
            sheet.add_table(Table(displayName=name, ref=area))
        book.save(tmp_path / "case.xlsx")
        return tmp_path / "case.xlsx"

    return make


def test_simulate_says_first_which_check_fails_and_which_cell_is_an_error(xlmc, failing, tmp_path):
    outcome = xlmc("simulate", failing(), "-n", 20_000, "--json", tmp_path / "case.json")
    assert outcome.code == 1
    before, _, after = outcome.out.partition("case.xlsx: accepted trials")
    assert "fail the check 'y is small' (Model!D15): y is large" in " ".join(before.split())
    assert "Model!D12 #DIV/0! in " in before
    assert "from Model!D11 #DIV/0!: =1/ROUND(B2*100,0)" in " ".join(before.split())
    assert "Statistics of 'r' rest on 19,9" in before
    assert "Accepted" not in after
    result = json.loads((tmp_path / "case.json").read_text(encoding="utf-8"))
    assert list(result)[:4] == ["format", "version", "warnings", "checks"]
    assert result["checks"][0]["holds"] is True
    assert result["checks"][0]["failed"] > 60
    assert result["errors"][0]["from"] == "Model!D11 #DIV/0!"
    repeated = xlmc("replay", tmp_path / "case-results.xlsx")
    assert repeated.out.splitlines()[1].endswith("(Model!D15): y is large.")
    assert repeated.code == 0  # it is identical, whether or not it may be used


def test_results_say_it_right_below_the_title(xlmc, failing, tmp_path):
    xlmc("simulate", failing(base=1.995), "-n", 20_000)
    sheet = openpyxl.load_workbook(tmp_path / "case-results.xlsx")["Results"]
    column = [sheet.cell(row, 1).value for row in range(3, 8)]
    assert "the base case fails the check 'y is small': Model!D15 is FALSE" in column[0]
    assert "accepted trials" in column[1]
    assert column[2].startswith("Model!D12 #DIV/0! in")


def test_check_names_what_fails_at_the_base_case(xlmc, failing):
    outcome = xlmc("check", failing(base=1.995))
    assert outcome.code == 1
    assert outcome.out.splitlines()[2].startswith("The base case fails the check 'y is small': Model!D15 is FALSE")
    assert "No problem found" not in outcome.out


def test_check_names_the_cell_that_errors_come_from(xlmc, failing):
    outcome = xlmc("check", failing(rounded="=1/ROUND((B2-2)*100,0)"))
    assert outcome.code == 1
    assert "Model!D11 #DIV/0!: =1/ROUND((B2-2)*100,0)" in outcome.out
    assert "are errors because of these: Model!D12 #DIV/0!" in outcome.out
    assert "at the base case Model!D11 is #DIV/0!" in outcome.err


def test_an_error_that_the_book_handles_is_a_remark(xlmc, failing):
    outcome = xlmc("check", failing(formula="=IFERROR(D11,0)", rounded="=1/ROUND((B2-2)*100,0)"))
    assert outcome.code == 0
    assert "Model!D11 #DIV/0! (handled" in outcome.out
    assert "No problem found." in outcome.out


def test_sources_that_are_examples_are_named(xlmc, failing):
    outcome = xlmc("check", failing())
    assert "still says \"Example\": 'x'" in outcome.err


def test_a_run_in_which_nothing_varies_is_named(xlmc, failing, tmp_path):
    path = failing()
    book = openpyxl.load_workbook(path)
    sheet = book["Model"]
    sheet["C2"], sheet["D2"], sheet["C3"], sheet["D3"] = 2, 2, 1, 1
    book.save(path)
    for command in ("check", "simulate"):
        assert (
            "Nothing varies: the range of every assumption that is drawn has a single value" in xlmc(command, path).err
        )
    sheet["C3"], sheet["D3"], sheet["D13"] = 0.5, 2, "=B2*2"
    book.save(path)
    assert "The forecast 'q' does not vary" in xlmc("check", path).err


def test_a_failing_example_is_not_passed_over(xlmc, case_study):
    outcome = xlmc("check", case_study.with_name("textbook-claim.xlsx"))
    assert outcome.code == 1
    assert "The claimed speed is possible" in outcome.err


def test_a_reason_that_is_a_question_ends_as_one(xlmc, failing, tmp_path):
    book = openpyxl.load_workbook(failing(base=1.995))
    book["Model"]["I2"] = "FALSE: a percentage?"
    book.save(tmp_path / "case.xlsx")
    for command in (["check"], ["simulate", "-n", "2000"]):
        outcome = xlmc(command[0], tmp_path / "case.xlsx", *command[1:])
        assert outcome.out.splitlines()[2].endswith("is FALSE: a percentage?")
