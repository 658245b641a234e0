"""Books without a single xlmc table, from the command line."""

from __future__ import annotations

import pytest
from openpyxl import Workbook, load_workbook

pytestmark = pytest.mark.usefixtures("short_books")


@pytest.fixture
def risk_book(tmp_path):
    book = Workbook()
    sheet = book.active
    sheet.title = "S"
    for address, value in {
        "A1": "=10+_xll.RiskNormal(5,1)*2",
        "A2": '=RiskOutput("total")+A1+RAND()',
        "A3": "=RiskMean(A2)",
        "A4": "=1+1",
    }.items():
        sheet[address] = value
    path = tmp_path / "risk.xlsx"
    book.save(path)
    return path


def test_check_shows_calls_with_their_cells(xlmc, risk_book):
    outcome = xlmc("check", risk_book)
    assert outcome.code == 0
    for shown in ("S!A1#1", "Normal: Mean 5, Std dev 1", "S!A2#1", "Uniform: Low 0, High 1", "total"):
        assert shown in outcome.out


def test_check_says_how_to_mark_an_answer(xlmc, tmp_path):
    book = Workbook()
    book.active["A1"] = "=RAND()"
    book.save(tmp_path / "rand.xlsx")
    outcome = xlmc("check", tmp_path / "rand.xlsx")
    assert outcome.code == 2
    assert "marks no cell as an answer" in outcome.err
    assert "RiskOutput" in outcome.err


def test_simulate(xlmc, risk_book, tmp_path):
    outcome = xlmc("simulate", risk_book, "-n", "2000")
    assert outcome.code == 0
    assert "total" in outcome.out
    assert (tmp_path / "risk-results.xlsx").exists()


def test_verify_says_what_cannot_be_compared(xlmc, risk_book):
    outcome = xlmc("verify", risk_book, "--all")
    assert outcome.code == 0
    assert "3 volatile" in outcome.out
    assert "draws at random or shows results of a simulation" in outcome.out
    assert "(S!A1, S!A2, S!A3)" in outcome.out


def test_a_result_that_cannot_be_computed_ends_with_exit_code_1(xlmc, risk_book):
    assert xlmc("simulate", risk_book, "-n", 500, "-o", "good.xlsx").code == 0
    book = load_workbook(risk_book)
    book["S"]["A5"] = "=RiskCpk(A2,0.95)"
    book.save(risk_book)
    outcome = xlmc("simulate", risk_book, "-n", 500, "-o", "bad.xlsx")
    assert outcome.code == 1
    assert "S!A5 (RiskCpk is not computed by xlmc)" in " ".join((outcome.out + outcome.err).split())
    assert load_workbook(risk_book.parent / "bad.xlsx", data_only=True)["S"]["A5"].value == "#N/A"
