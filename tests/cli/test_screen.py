from __future__ import annotations

import json
import re

import pytest
from workbook_files import workbook_of

from xlmc.analysis.studies import screening


@pytest.fixture(autouse=True)
def screened_once(made_once):
    made_once(screening, "screen")


GEOMETRY = "*impact centre*, Orientation of tangent"
OF_THE_CASE_STUDY = "--tolerance", "0.4 mph", "--freeze", GEOMETRY, "-n", "40000"


def test_the_case_study(xlmc, case_study):
    """The inertias are not needed; what impact centre and tangent cost stands in the table, alone and together."""
    outcome = xlmc("screen", case_study, *OF_THE_CASE_STUDY, "--json")
    assert outcome.code == 0
    result = json.loads(outcome.out)
    held = set(result["held_together"]["names"])
    assert {"Chevrolet yaw moment of inertia", "Nissan yaw moment of inertia"} <= held
    costs = {entry["names"][0]: entry for entry in result["held_alone"]}
    assert len(costs) == 17
    assert sum("impact centre" in name for name in costs) == 4
    (asked,) = result["held_as_asked"]
    assert len(asked["names"]) == 5
    spread = asked["forecasts"]["Nissan impact speed"]["standard_deviation"]["difference"]
    assert spread["value"] < -3 * spread["error"]
    assert {"Model!D7", "Model!D8"} <= set(result["cells"]["constant_then"])  # the masses


def test_the_case_study_in_words(xlmc, case_study):
    outcome = xlmc("screen", case_study, *OF_THE_CASE_STUDY)
    assert outcome.code == 0
    alone, _, rest = outcome.out.partition("Held at once, as asked")
    asked, _, text = rest.partition("Each filter left out")
    assert re.search(r"Orientation of tangent +\d", alone)  # its row, with the cost
    assert re.search(r"Chevrolet impact centre x +\d", alone)
    assert re.search(r"Chevrolet impact centre x[^\n]* \d", asked)
    needless = " ".join(outcome.out.split()).partition("Not needed: ")[2].partition("With all of them held")[0]
    assert outcome.out.index("Not needed: ") < outcome.out.index("Each assumption held")
    assert "Chevrolet yaw moment of inertia" in needless
    assert "Nissan yaw moment of inertia" in needless
    assert "Formula cells that then do not vary: Model!D7, Model!D8" in text


def test_what_is_printed(xlmc, plain_book):
    outcome = xlmc("screen", plain_book, "--tolerance", "Speed=0.3 mph", "--acceptance", "75", "-n", "40")
    assert outcome.code == 0
    text = " ".join(outcome.out.split())
    assert re.search(r"Speed 0.3 mph, and P\(> 2\) [\d.]+ points; Double [\d.]+ mph \(a tenth of the SD\);", text)
    assert "; acceptance 75 % of itself" in text
    assert re.search(r"Undecided at 40 trials, and therefore kept: c \(about [\d,]+ trials would decide\); fast", text)
    assert "Of 2 formula cells that the book needs" in text
    assert "runs of 40 trials, seed 7" in text


def test_a_pattern_that_fits_nothing(xlmc, case_study):
    outcome = xlmc("screen", case_study, "--freeze", "*wheelbase*")
    assert outcome.code == 2
    assert "No assumption that is drawn has the name '*wheelbase*'" in outcome.err


def test_a_tolerance_that_cannot_be_read(xlmc, case_study):
    outcome = xlmc("screen", case_study, "--tolerance", "small")
    assert outcome.code == 2
    assert "The tolerance 'small' cannot be read" in outcome.err


def test_no_table_is_wider_than_80_columns_where_that_is_all_there_is(xlmc, case_study, monkeypatch):
    """No number is cut, and no table becomes a list."""
    from xlmc.cli import printing

    monkeypatch.setattr(printing, "_PIPE_WIDTH", 80)
    lines = xlmc("screen", case_study, *OF_THE_CASE_STUDY).out.splitlines()
    assert max(len(line) for line in lines if line.startswith(" ")) <= 80
    headings = [line for line in lines if "Held or left out" in line]
    assert len(headings) == 4
    assert all("Moves by" in line and "Tolerances" in line for line in headings)


def test_an_answer_that_needs_no_better_input(xlmc, plain_book):
    """Judged by one forecast; `c` may lie anywhere in its range, `a` and `b` may not."""
    asked = "--forecast", "Speed", "--tolerance", "0.05 mph", "--acceptance", "30", "-n", "10000"
    outcome = xlmc("screen", plain_book, *asked, "--ends")
    assert outcome.code == 0
    text = " ".join(outcome.out.split())
    assert "Judged by Speed only." in text
    assert "Double" not in text
    assert "Not needed, wherever in its range it lies: c. Held at either end" in text
    assert re.search(r"c = 0.00025\d* +\d", outcome.out)  # 2.5 % of the way from 0 to 0.01
    result = json.loads(xlmc("screen", plain_book, *asked, "--ends", "--json").out)
    assert {entry["name"] for entry in result["held_at_ends"] if entry["free"]} == {"c"}
    assert result["forecasts_not_asked"] == ["Double"]
    assert list(result["held_alone"][0]["forecasts"]) == ["Speed"]


def test_a_forecast_that_is_not_there(xlmc, case_study):
    outcome = xlmc("screen", case_study, "--forecast", "Speed*")
    assert outcome.code == 2
    assert "No forecast has the name 'Speed*'" in outcome.err


def test_of_many_forecasts_one_table_is_printed_and_all_are_written(xlmc, tmp_path):
    """Of five forecasts the terminal names what moves each most; the file and --forecast have every change."""
    names = [f"f{number}" for number in range(1, 6)]
    sheets = {
        "Inputs": [
            ["Name", "Value", "Low", "High", "Distribution"],
            *([n, 2, 1, 3, "Uniform"] for n in ("wide", "narrow")),
        ],
        "Model": [[f"={number}*Inputs!B2+Inputs!B3/2" for number in range(1, 6)]],
        "Wanted": [
            ["Name", "Cell"],
            *([name, f"=Model!{letter}1"] for name, letter in zip(names, "ABCDE", strict=True)),
        ],
    }
    book = tmp_path / "five.xlsx"
    workbook_of(sheets, {"xlmc_assumptions": "Inputs!A1:E3", "xlmc_forecasts": "Wanted!A1:B6"}).save(book)
    page = tmp_path / "found.html"
    outcome = xlmc("screen", book, "-n", "200", "-o", page)
    assert outcome.code == 0
    _, _, table = outcome.out.partition("What moves each forecast most")
    rows = [line.split()[:2] for line in table.splitlines() if re.match(r" *f\d ", line)]
    assert rows == [[name, "wide"] for name in names]
    assert "the 2 changes moves in each of the 5 forecasts" in " ".join(table.split())
    assert "Tolerances: those of the 5 forecasts, a tenth of the SD for numbers, stand in the files" in " ".join(
        table.split()
    )
    assert ": what each moves most" not in outcome.out
    assert page.read_text(encoding="utf-8").count(": what each moves most") >= len(names)
    assert xlmc("screen", book, "-n", "200", "--forecast", "f3").out.count(": what each moves most") == 1
