"""The guide's second case can be followed: what it types into the camera's book and into its own gives its numbers."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from simulated import simulated
from typed_cells import model_of, named_cells, with_typed

from xlmc.excel.address import Cell
from xlmc.excel.workbook.reader import read_workbook

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "guide.md").read_text(encoding="utf-8")
CASE = PAGE[PAGE.index("## 12. A second case") : PAGE.index("## 13. Pitfalls")]
PROSE = " ".join(CASE.split())
READINGS = re.findall(r"^\| (Chevrolet [^|]+) \| ([-\d.]+) \| ([\d.]*) ?\|$", CASE, re.MULTILINE)
MOVES = re.findall(r"^\| ([a-zE][^|]+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", CASE, re.MULTILINE)
FORECASTS = ("Chevrolet delta-V", "Chevrolet impact speed", "Nissan impact speed")


@pytest.fixture(scope="module")
def camera():
    """The run of the book with what the page says of the video."""
    made = read_workbook(ROOT / "templates" / "video-speed.xlsx")
    at = named_cells(made)
    ends = {
        "d": re.search(r"gives ([\d.]+) to ([\d.]+) ft between them", PROSE).groups(),
        "rate": re.search(r"say ([\d.]+) to ([\d.]+) frames a second", PROSE).groups(),
    }
    typed = {at["n"]: int(re.search(r"the hydrant: (\d+) frames", PROSE)[1])}
    for symbol, given in ends.items():
        low, high = map(float, given)
        for column, value in zip((4, 7, 8), ((low + high) / 2, low, high), strict=True):
            typed[at[symbol]._replace(column=column)] = value
    return simulated(model_of(with_typed(made, typed)))


@pytest.fixture(scope="module")
def book(workbook):
    """`book(speed)`: the guide's case with the readings, the video's speed another one if given."""
    labels = {content.value: row for (row, column), content in workbook.sheets["Evidence"].cells.items() if column == 1}

    def make(speed=None):
        typed = {}
        for name, reading, deviation in READINGS:
            typed[Cell("Evidence", labels[name], 4)] = speed if speed and deviation else float(reading)
            if deviation:
                typed[Cell("Evidence", labels[name], 7)] = float(deviation)
        return model_of(with_typed(workbook, typed))

    return make


def test_the_video_gives_the_speed_that_is_then_a_reading(camera):
    speed = camera["Vehicle speed at the last mark"]
    assert f"a mean of {speed.mean.value:.3f} mph" in PROSE
    assert f"a standard deviation of {speed.standard_deviation.value:.3f} mph" in PROSE
    (_, edr, none), (_, reading, deviation) = READINGS
    assert (edr, none) == ("-12.4", "")
    assert (reading, deviation) == (f"{speed.mean.value:.2f}", f"{speed.standard_deviation.value:.2f}")
    assert camera.warnings == []


def test_the_case_gives_what_the_page_says(book):
    model = book()
    (edr,) = [each for each in model.filters if "EDR delta-V" in each.name]
    assert f"a delta-V from {edr.at_least:.6g} to {edr.at_most:.6g} mph" in PROSE
    run = simulated(model)
    result = run.agreement
    assert f"accepts fewer trials, {run.accepted}, and" in PROSE
    assert f"together they keep {result.ratio.value:.3g} times" in PROSE
    assert result.sentence.partition(":")[0] in PROSE
    first, second = (round(100 * each.chance) for each in result.items)
    assert f"has a chance of {first} %; one as far as the camera's has a chance of {second} %" in PROSE
    means = {(each.used.partition(" alone")[0], each.forecast): each for each in result.answers}
    used = ["no evidence", "all evidence", *(name for name, *_ in READINGS)]
    shown = [[f"{means[way, name].mean.value:.3f}" for name in FORECASTS] for way in used]
    assert [list(line[1:]) for line in MOVES] == shown
    before, after = (means[way, FORECASTS[1]] for way in ("no evidence", "all evidence"))
    spreads = f"from {before.standard_deviation.value:.2f} to {after.standard_deviation.value:.2f} mph"
    assert spreads in PROSE
    assert f"{after.mean.value:.1f} mph, with a standard deviation of {after.standard_deviation.value:.1f} mph" in PROSE
    assert run.warnings == []


def test_the_contradicting_video_is_out_of_reach(book):
    run = simulated(book(39.5))
    assert run.settings.evidence == "weights"
    assert "the evidence is inconsistent" in run.warnings[0]
    assert "is out of reach of the model given the other evidence" in run.warnings[0]
    assert f"the effective sample size, {run.weighting.effective:.0f}, says" in PROSE
    assert 0.5 < run.weighting.mean * run.accepted < 1.5
