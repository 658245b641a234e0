"""Assumptions as people have them: a mean with its CoV, a value with ±; and what a row with a mistake is told."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from workbook_files import workbook_of

HEADINGS = ["Name", "Value", "Distribution", "Low", "High", "Mean", "Std dev", "CoV %", "±", "± %", "Scale", "Shape"]


@pytest.fixture
def book(tmp_path):
    """Write one assumption, `a`, and the forecast that is the same number."""

    def write(**cells):
        row = ["a", cells.pop("Value", 50.0), *(cells.pop(heading, None) for heading in HEADINGS[2:])]
        assert not cells
        sheets = {"S": [HEADINGS, row, [], ["Name", "Value"], ["y", "=B2*1"]]}
        path = tmp_path / "case.xlsx"
        workbook_of(sheets, {"xlmc_assumptions": "S!A1:L2", "xlmc_forecasts": "S!A4:B5"}).save(path)
        return path

    return write


DRAWN = {
    "Gumbel by CoV": ({"Distribution": "Gumbel", "Mean": 50, "CoV %": 20}, 50, 10),
    "Weibull by CoV": ({"Distribution": "Weibull", "Mean": 50, "CoV %": 20}, 50, 10),
    "Normal by CoV": ({"Distribution": "Normal", "Mean": 50, "CoV %": 20}, 50, 10),
    "Gamma by SD": ({"Distribution": "Gamma", "Mean": 50, "Std dev": 10}, 50, 10),
    "Beta on ends": ({"Distribution": "Beta", "Low": 0, "High": 100, "Mean": 50, "Std dev": 10}, 50, 10),
    "value ± 6": ({"±": 6}, 50, 6 / math.sqrt(3)),
    "value ± 10 %": ({"Distribution": "Triangular", "± %": 10}, 50, 5 / math.sqrt(6)),
}


@pytest.mark.parametrize(("cells", "mean", "deviation"), DRAWN.values(), ids=DRAWN)
def test_draws_have_these_moments(xlmc, book, cells, mean, deviation):
    assert xlmc("simulate", book(**cells), "-n", 40_000, "-o", "run.json").code == 0
    result = json.loads(Path("run.json").read_text(encoding="utf-8"))["forecasts"][0]["statistics"]
    assert result["mean"]["value"] == pytest.approx(mean, abs=4 * result["mean"]["error"])
    spread = result["standard_deviation"]
    assert spread["value"] == pytest.approx(deviation, abs=4 * spread["error"])


MISTAKES = {
    "the family as typed": ({"Distribution": "Gumbel"}, ["Gumbel (Maximum Extreme) needs Likeliest"]),
    "CoV without a mean": ({"Distribution": "Normal", "CoV %": 5}, ["S!H2", "CoV % is given without a Mean"]),
    "moments without a family": ({"Mean": 50, "CoV %": 5}, ["S!A2", "no Distribution", "Normal"]),
    "two spreads": ({"Distribution": "Gamma", "Mean": 5, "Std dev": 1, "CoV %": 5}, ["S!H2", "Clear one"]),
    "a family of three": ({"Distribution": "Triangular", "Mean": 5, "CoV %": 5}, ["S!H2", "do not determine"]),
    "± of a normal": ({"Distribution": "Normal", "±": 5}, ["S!I2", "the distribution is Normal"]),
    "± and ends": ({"±": 5, "Low": 40}, ["S!D2", "both given"]),
    "± of nothing": ({"±": 5, "Value": None}, ["S!I2", "needs a value"]),
    "two distances": ({"±": 5, "± %": 5}, ["S!J2", "Clear one"]),
    "no such member": ({"Distribution": "Gamma", "Mean": -5, "CoV %": 5}, ["S!H2", "No Gamma has"]),
}


@pytest.mark.parametrize(("cells", "message"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_names_its_cell_and_the_cure(xlmc, book, cells, message):
    outcome = xlmc("check", book(**cells))
    assert outcome.code == 2
    assert all(each in outcome.err for each in message), outcome.err


def test_a_percentage_below_one_is_pointed_out(xlmc, book):
    assert "not 10 %" in xlmc("check", book(**{"± %": 0.1})).err
