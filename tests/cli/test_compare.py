from __future__ import annotations

import json
import re
from pathlib import Path

import openpyxl
import pytest
from openpyxl.worksheet.table import Table

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
QUICK = "-n", "20000"


def book(path, formula, units="mph", name="Speed", above=None):
    """`a` and `b`, uniform on (0, 1), in Inputs!B2:B3; one forecast and perhaps one filter on `a`."""
    made = openpyxl.Workbook()
    sheet = made.active
    sheet.title = "Inputs"
    for row in (["Name", "Value", "Low", "High"], ["a", 0.5, 0, 1], ["b", 0.5, 0, 1]):
        sheet.append(row)
    sheet["F1"] = formula
    sheet.add_table(Table(displayName="xlmc_assumptions", ref="A1:D3"))
    answers = made.create_sheet("Answers")
    answers.append(["Name", "Cell", "Units"])
    answers.append([name, "=Inputs!F1", units])
    answers.add_table(Table(displayName="xlmc_forecasts", ref="A1:C2"))
    if above is not None:
        answers["E1"], answers["F1"], answers["G1"], answers["H1"] = "Name", "Cell", "Above", "Because"
        answers["E2"], answers["F2"], answers["G2"], answers["H2"] = "fast", "=Inputs!B2", above, "seen"
        answers.add_table(Table(displayName="xlmc_filters", ref="E1:H2"))
    made.save(path)
    return path


@pytest.fixture
def books(tmp_path):
    first = book(tmp_path / "rich.xlsx", "=B2+B3", above=0.5)
    return first, book(tmp_path / "plain.xlsx", "=B2+B3")


def test_within(xlmc, books):
    outcome = xlmc("compare", *books, "--tolerance", "0.5 mph", *QUICK)
    assert outcome.code == 0
    assert "The simpler model, plain.xlsx, is enough for Speed to 0.5 mph." in outcome.out
    assert "rich.xlsx alone 0" in outcome.out
    assert "percentiles, on average" in outcome.out


def test_a_comparison_fits_80_columns_as_a_table(xlmc, books, monkeypatch):
    """No number is cut, and none goes to a list, where a narrower space between the columns is enough."""
    from xlmc.cli import printing, terminal

    monkeypatch.setattr(terminal, "PIPE_WIDTH", 80)
    monkeypatch.setattr(printing, "_PIPE_WIDTH", 80)
    outcome = xlmc("compare", *books, "--tolerance", "0.5 mph", *QUICK)
    lines = outcome.out.split("\n")
    assert max(map(len, lines)) <= 80
    (row,) = [line for line in lines if line.startswith(" mean ")]
    assert re.fullmatch(r" mean {3,}\S+ ± \S+ +\S+ ± \S+ +\S+ ± \S+ +0\.5", row)
    assert [line for line in lines if line.startswith(" percentiles, ")]  # in the table, though it wraps


def test_beyond_is_a_verdict_with_its_cause(xlmc, books):
    outcome = xlmc("compare", *books, "--tolerance", "Speed=0.1", *QUICK)
    assert outcome.code == 0
    text = " ".join(outcome.out.split())
    assert "is not enough for Speed to 0.1 mph" in text
    assert "because the filter 'fast' of rich.xlsx moves it; without it" in text


def test_no_causes_makes_no_further_runs(xlmc, books):
    outcome = xlmc("compare", *books, "--tolerance", "0.1", "--no-causes", "--json", *QUICK)
    result = json.loads(outcome.out)
    assert result["runs"] == 2
    assert "cause" not in result["forecasts"][0]


def test_undecided_is_exit_code_1(xlmc, books):
    outcome = xlmc("compare", *books, "--tolerance", "0.25", "-n", "200")
    assert outcome.code == 1
    assert "Undecided for Speed at 200 trials" in outcome.out


def test_json(xlmc, books):
    outcome = xlmc("compare", *books, "--tolerance", "0.1", "--json", *QUICK)
    assert outcome.code == 0
    result = json.loads(outcome.out)
    assert result["simpler"] == "plain.xlsx"
    (speed,) = result["forecasts"]
    assert speed["verdict"] == "beyond"
    assert speed["cause"]["taken_out"] == [{"kind": "filter", "book": "rich.xlsx", "name": "fast"}]
    mean = speed["mean"]["difference"]
    assert abs(mean["value"] + 0.25) < 4 * mean["error"]
    assert result["filters_only_in"] == {"rich.xlsx": ["fast"], "plain.xlsx": []}


def test_pairs_and_units(xlmc, tmp_path):
    first = book(tmp_path / "mph.xlsx", "=B2+B3")
    second = book(tmp_path / "metric.xlsx", "=(B2+B3)*1.609344", "km/h", "v")
    assert "No forecast has the same name" in xlmc("compare", first, second).err
    outcome = xlmc("compare", first, second, "--pair", "Speed=v", "--tolerance", "1e-6", *QUICK)
    assert outcome.code == 0
    assert "Speed (second converted)" in outcome.out
    third = book(tmp_path / "angle.xlsx", "=B2", "deg", "Speed")
    outcome = xlmc("compare", first, third)
    assert outcome.code == 2
    assert "Inputs!F1: The forecasts 'Speed' and 'Speed' have the units 'mph' and 'deg'" in outcome.err


@pytest.mark.parametrize("pair", ["Speed", "=v", "Speed="])
def test_pairs_that_are_none(xlmc, books, pair):
    outcome = xlmc("compare", *books, "--pair", pair)
    assert outcome.code == 2
    assert "must be written" in outcome.err


def test_a_forecast_in_two_pairs(xlmc, books):
    outcome = xlmc("compare", *books, "--pair", "Speed=v", "--pair", "Speed=w")
    assert outcome.code == 2
    assert "has a name that another --pair has" in outcome.err


def test_nothing_accepted_is_a_warning_and_exit_code_1(xlmc, books, tmp_path):
    never = book(tmp_path / "never.xlsx", "=B2+B3", above=2)
    outcome = xlmc("compare", books[1], never, *QUICK)
    assert outcome.code == 1
    assert "never.xlsx: no trial was accepted" in outcome.err


def test_the_case_study_on_two_rungs(xlmc):
    rungs = EXAMPLES / "intersection.xlsx", EXAMPLES / "intersection-momentum.xlsx"
    outcome = xlmc("compare", *rungs, "--tolerance", "1.5 mph", "-n", "20000")
    assert outcome.code == 0
    text = " ".join(outcome.out.split())
    assert "is enough for Chevrolet delta-V to 1.5 mph, Nissan delta-V to 1.5 mph and Chevrolet impact speed" in text
    assert "because the filter 'Restitution, tangential' of intersection.xlsx moves it" in text
    assert "they give the same number: they differ only in which trials they accept" in text


def test_two_models_of_one_answer(xlmc, tmp_path):
    """Each draws what the other does not: which tells more; where they contradict each other, the exit code is 1."""
    first, second = book(tmp_path / "first.xlsx", "=B2"), book(tmp_path / "second.xlsx", "=0.45+B3/10")
    outcome = xlmc("compare", first, second, *QUICK)
    assert outcome.code == 0
    text = " ".join(outcome.out.split())
    assert "Speed: second.xlsx tells more, with a standard deviation of 0.0289" in text
    assert "The two answers agree." in text
    apart = book(tmp_path / "apart.xlsx", "=2+B3/10")
    outcome = xlmc("compare", first, apart, "--json", *QUICK)
    assert outcome.code == 1
    result = json.loads(outcome.out)
    rivals = result["forecasts"][0]["two_models"]
    assert rivals["tells_more"] == "apart.xlsx"
    assert rivals["drawn_only_for"] == {"first.xlsx": ["a"], "apart.xlsx": ["b"]}
    assert (rivals["agreement"], rivals["chance_of_such_a_difference"]) == ("contradict", 0.0)
    assert "in all 20,000 trials that both accept they differ in one direction" in result["verdict"][0]


def test_whether_a_book_needs_another(xlmc, tmp_path):
    first, second = book(tmp_path / "first.xlsx", "=B2+B3"), book(tmp_path / "second.xlsx", "=B2/100", "")
    outcome = xlmc("compare", first, second, "--feed", "a=Speed", "--tolerance", "0.1", *QUICK)
    assert outcome.code == 0
    text = " ".join(outcome.out.split())
    assert "first.xlsx (first) and first.xlsx fed by second.xlsx (second)" in text
    assert "first.xlsx without second.xlsx is not enough for Speed to 0.1 mph: " in text
    assert "'a' is not the same: Uniform: Low 0, High 1 | from second.xlsx" in text
    assert json.loads(xlmc("compare", first, second, "--feed", "a=Speed", "--no-causes", "--json", "-n", "2000").out)[
        "fed_by"
    ] == ("second.xlsx")
    outcome = xlmc("compare", first, second, "--feed", "b", *QUICK)
    assert outcome.code == 2
    assert "--feed 'b' must be written 'assumption of the first=forecast of the second'" in outcome.err


def test_a_direction_whose_numbers_jump_is_told_of(xlmc, short_books, tmp_path):
    """Both answer with directions around 180°, within 20°: mean and SD of their numbers, from -180 to 180, are none."""
    first = book(tmp_path / "first.xlsx", "=180-MOD(20-40*B2,360)", units="°", name="PDOF")
    second = book(tmp_path / "second.xlsx", "=180+40*(B2-0.5)", units="°", name="PDOF")
    outcome = xlmc("compare", first, second, *QUICK)
    assert "note: first.xlsx: 'PDOF' is a direction, and its numbers jump by a full turn" in outcome.err
    assert "second.xlsx: 'PDOF'" not in outcome.err
    outcome = xlmc("simulate", first, *QUICK)
    assert outcome.code == 0
    assert "=x-360*ROUND((x-180)/360,0)" in " ".join(outcome.out.split())
