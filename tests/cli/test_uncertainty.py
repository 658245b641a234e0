"""`xlmc uncertainty`, and the page that shows it."""

from __future__ import annotations

import csv
import importlib.util
import json
import re
from pathlib import Path

import openpyxl
import pytest
from workbook_files import add_tables, workbook_of

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    spec = importlib.util.spec_from_file_location("unknown_mean", ROOT / "examples" / "unknown_mean.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    path = tmp_path_factory.mktemp("unknown") / "unknown-mean.xlsx"
    script.write(path)
    return path


def _words(text):
    """Numbers apart: the last digits differ between processors."""
    return re.sub(r"\d[\d.]*(e[-+]?\d+)?", "#", " ".join(text.split()))


def test_the_page_shows_the_output(xlmc, book):
    outcome = xlmc("uncertainty", book)
    assert outcome.code == 0
    page = (ROOT / "docs" / "uncertainty.md").read_text(encoding="utf-8")
    begin = "<!-- output of `xlmc uncertainty unknown-mean.xlsx` -->\n```text\n"
    shown = page.partition(begin)[2].partition("\n```")[0]
    assert "with 90 % confidence" in shown
    assert _words(outcome.out) == _words(shown)


def test_json_holds_the_bands_and_the_curve(xlmc, book):
    outcome = xlmc("uncertainty", book, "--outer", "40", "--inner", "50", "--percentile", "97.5", "--json", "--quiet")
    result = json.loads(outcome.out)
    assert (result["outer"], result["inner"], result["seed"], result["accepted"]) == (40, 50, 999, 2_000)
    assert result["uncertain"] == ["Mean friction", "Scatter of friction", "Skid"]
    friction, speed = result["forecasts"]
    assert [each["number"] for each in speed["numbers"]] == ["mean", "SD", "97.5th percentile", "P(> 50)"]
    assert all(each["low"]["value"] <= each["high"]["value"] for each in friction["numbers"])
    assert {"share", "all_trials", "low", "high"} == set(friction["curve"][0])
    assert speed["rank_correlations_with_mean"]["Mean friction"]["value"] > 0.8


def test_the_sheet_has_a_chart_of_three_lines(xlmc, book, tmp_path):
    sheet = tmp_path / "found.xlsx"
    assert xlmc("uncertainty", book, "--outer", "40", "--inner", "50", "--forecast", "Speed", "-o", sheet).code == 0
    made = openpyxl.load_workbook(sheet)
    (chart,) = made["Uncertainty"]._charts
    assert len(chart.series) == 3


def test_ends_without_an_error_have_the_digits_of_the_mean_and_equal_ones_stand_once(xlmc, tmp_path):
    inputs = [["Name", "Value", "Distribution", "Low", "High"], ["x", 1.5, "Uniform", 1, 2]]
    formulas = {
        "Wide": "=Tables!B2*3",
        "Tiny": "=Tables!B2*1E-9",
        "Steps": "=ROUND(Tables!B2*9,0)",
        "Same": "=7+0*Tables!B2",
    }
    rows = [["Name", "Cell"], *([name, f"=Model!B{row}"] for row, name in enumerate(formulas, 1))]
    book = workbook_of({"Model": list(formulas.items()), "Tables": []}, {})
    add_tables(book["Tables"], {"xlmc_assumptions": inputs, "xlmc_forecasts": rows})
    book.save(tmp_path / "book.xlsx")
    outcome = xlmc("uncertainty", tmp_path / "book.xlsx", "--outer", "30", "--inner", "20", "--uncertain", "x")
    words = " ".join(outcome.out.split())
    assert re.search(r"The 95th percentile of Wide is between \d\.\d\d and \d\.\d\d with", words), words
    assert re.search(r"The 95th percentile of Tiny is between \d\.\d{3}e-09 and \d\.\d{3}e-09 with", words), words
    steps = words.partition(" Steps Number")[2].partition("Drawn in files")[0]
    assert re.search(r"5th percentile \d+ ", steps), steps
    assert "The mean of Same is 7 with 90 % confidence." in words
    tiny = words.partition(" Tiny Number")[2].partition("Drawn in files")[0]
    assert re.search(r"SD \(\S+ ± \S+\)e-10 0 0 ", tiny)


def test_check_and_results_say_what_is_uncertain(xlmc, book):
    assert xlmc("check", book).out.count(" uncertain") == 3
    outcome = xlmc("simulate", book, "-n", "2000", "-o", "run.json", "--quiet")
    assert outcome.code == 0, outcome.err
    rows = json.loads(Path("run.json").read_text(encoding="utf-8"))["assumptions"]
    assert [row["uncertain"] for row in rows] == [True, True, False, True]


def test_a_book_without_uncertain_assumptions_is_refused_with_the_cure(xlmc, case_study):
    outcome = xlmc("uncertainty", case_study)
    assert outcome.code == 2
    assert "Uncertain under Kind of uncertainty" in outcome.err
    assert "--uncertain" in outcome.err


def test_trials_are_written_with_their_outer_draws(xlmc, book, tmp_path):
    """Each outer draw has one value of what is uncertain, and as many trials as were asked for."""
    outcome = xlmc("uncertainty", book, "--outer", "20", "--inner", "30", "--quiet", "-o", tmp_path / "trials.csv")
    assert outcome.code == 0, outcome.err
    with open(tmp_path / "trials.csv", encoding="utf-8", newline="") as file:
        rows = [*csv.DictReader(file)]
    assert [int(row["Outer draw"]) for row in rows] == [trial // 30 for trial in range(600)]
    assert len({(row["Outer draw"], row["Mean friction"]) for row in rows}) == 20
    assert len({row["Friction"] for row in rows}) == 600
