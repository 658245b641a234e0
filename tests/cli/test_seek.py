"""`xlmc seek`."""

from __future__ import annotations

import datetime as dt
import json
import re

import openpyxl
import pytest
from workbook_files import workbook_of


@pytest.fixture
def book(tmp_path):
    path = tmp_path / "plain.xlsx"
    workbook_of({"Model": [["x", 3], ["y", "=B1^2-4"]]}, {}).save(path)
    return path


def test_the_terminal_tells_all_values(xlmc, book):
    outcome = xlmc("seek", book, "--cell", "Model!B2", "--to", "0", "--by", "Model!B1")
    assert outcome.code == 0, outcome.err
    words = " ".join(outcome.out.split())
    assert "2 values of Model!B1 from" in words
    assert "make Model!B2 equal to 0." in words
    one = xlmc("seek", book, "--cell", "B2", "--to", "0", "--by", "B1", "--low", "0", "--high", "10")
    assert "Model!B2 is 0 where Model!B1 is 2." in one.out  # of a workbook with one sheet


def test_no_value_is_exit_code_1(xlmc, book):
    outcome = xlmc("seek", book, "--cell", "B2", "--to", "-5", "--by", "B1", "--low", "0", "--high", "10")
    assert outcome.code == 1
    assert "No value of Model!B1 from 0 to 10 makes Model!B2 equal to -5." in outcome.out


def test_ends_of_a_range_within_one_day_are_told_apart(xlmc, tmp_path):
    book = workbook_of({"Model": [["start", dt.date(2026, 9, 1)], ["end", "=WORKDAY(B1,30)"]]}, {})
    book["Model"]["B1"].number_format = book["Model"]["B2"].number_format = "yyyy-mm-dd"
    book.save(tmp_path / "days.xlsx")
    outcome = xlmc("seek", tmp_path / "days.xlsx", "--cell", "B2", "--to", "46300", "--by", "B1")
    words = " ".join(outcome.out.split())
    (ends,) = re.findall(r"is 2026-10-05 wherever Model!B1 is from (2026-08-24) \((.*?)\) to \1 \((.*?)\),", words)
    assert 46_258.0 <= float(ends[1].replace(",", "")) < float(ends[2].replace(",", "")) < 46_259.0


def test_mistakes_are_one_message_and_exit_code_2(xlmc, book):
    for given, message in (
        (["--cell", "B2", "--to", "0", "--by", "B2"], "Model!B2 holds a formula"),
        (["--cell", "B2", "--to", "0", "--by", "B9"], "Model!B2 does not depend on Model!B9"),
        (["--cell", "B2", "--to", "0", "--by", "B1", "--low", "0"], "Only one end of the range is given"),
        (["--cell", "B2", "--by", "B1"], "--to"),
    ):
        outcome = xlmc("seek", book, *given)
        assert outcome.code == 2
        assert message in outcome.err


def test_files_hold_the_same(xlmc, book, tmp_path):
    sheet, page, result = tmp_path / "found.xlsx", tmp_path / "found.html", tmp_path / "found.json"
    given = ["seek", book, "--cell", "B2", "--to", "0", "--by", "B1", "--low", "0", "--high", "10"]
    assert xlmc(*given, "-o", sheet, "-o", page, "-o", result).code == 0
    texts = [str(cell) for row in openpyxl.load_workbook(sheet)["Seek"].iter_rows(values_only=True) for cell in row]
    assert "Model!B2 is 0 where Model!B1 is 2." in texts
    assert "Model!B2 is 0 where Model!B1 is 2." in page.read_text(encoding="utf-8")
    written = json.loads(result.read_text(encoding="utf-8"))
    assert written["values"] == [{"by": 2.0, "cell": 0.0}]
    assert written.pop("seal")
    assert written == json.loads(xlmc(*given, "--json").out)


def test_a_cell_that_is_no_number_is_told_as_such(xlmc, tmp_path):
    made = openpyxl.Workbook()
    for row in ([3], ['=IF(A1>2,"a","b")']):
        made.active.append(row)
    path = tmp_path / "text.xlsx"
    made.save(path)
    outcome = xlmc("seek", path, "--cell", "A2", "--to", "1", "--by", "A1", "--low", "0", "--high", "5")
    assert outcome.code == 1
    assert "is no number for any value of" in " ".join(outcome.out.split())
