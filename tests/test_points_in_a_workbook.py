"""Cumul, General and Histogrm from the file to the forecasts: Low and High from columns, points from Data."""

from __future__ import annotations

import math

import pytest
import xlsxwriter
from scipy import stats
from simulated import simulated

from xlmc.analysis.results.statements.in_words import distribution_text
from xlmc.montecarlo.model.loading import load

TRIALS = 100_000
HEADINGS = ["Name", "Value", "Distribution", "Low", "High", "Data"]
ROWS = {
    "c": ("Cumul", 0.5, 2.5, "Points!A1:B2", stats.rv_histogram(([1, 2, 1], [0.5, 1.0, 1.5, 2.5]), density=False)),
    "g": ("General", 0.45, 1.05, "Points!C1:D2", stats.trapezoid(0.25 / 0.6, 0.4 / 0.6, 0.45, 0.6)),
    "h": ("Histogrm", 0, 3, "Points!E1:E3", stats.rv_histogram(([1, 4, 2], [0.0, 1.0, 2.0, 3.0]))),
}
POINTS = [[1.0, 0.25, 0.7, 2, 1], [1.5, 0.75, 0.85, 2, 4], [None, None, None, None, 2]]


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    path = tmp_path_factory.mktemp("books") / "points.xlsx"
    with xlsxwriter.Workbook(path) as book:
        inputs, answers, points = map(book.add_worksheet, ("Inputs", "Answers", "Points"))
        for row, (name, (distribution, low, high, data, _)) in enumerate(ROWS.items(), start=1):
            inputs.write_row(row, 0, [name, 1.0, distribution, low, high, data])
            answers.write(row, 0, name)
            answers.write_formula(row, 1, f"=Inputs!B{row + 1}", value=1.0)
        for row, numbers in enumerate(POINTS):
            points.write_row(row, 0, numbers)
        columns = [{"header": heading} for heading in HEADINGS]
        inputs.add_table(0, 0, len(ROWS), len(HEADINGS) - 1, {"name": "xlmc_assumptions", "columns": columns})
        columns = [{"header": "Name"}, {"header": "Value"}]
        answers.add_table(0, 0, len(ROWS), 1, {"name": "xlmc_forecasts", "columns": columns})
    return load(path)


def test_means(model):
    """Within five standard errors of what SciPy says."""
    run = simulated(model, trials=TRIALS, seed=999)
    for name, (*_, oracle) in ROWS.items():
        assert abs(run[name].mean.value - oracle.mean()) < 5 * oracle.std() / math.sqrt(TRIALS), name


def test_what_the_record_says(model):
    assert distribution_text(model.assumptions[0]) == "Cumul: Low 0.5, High 2.5, Data Points!A1:B2"
