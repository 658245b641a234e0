"""A workbook with an assumption of every continuous family, from the file to the forecasts."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xlsxwriter
from scipy import stats
from simulated import simulated

from xlmc.analysis.results.statements.in_words import distribution_text
from xlmc.montecarlo.model.loading import load

TRIALS = 50_000
COLUMNS = [
    *("Name", "Value", "Distribution", "Minimum", "Likeliest", "Maximum", "Mean", "Std dev", "Location", "Scale"),
    *("Shape", "Rate", "Alpha", "Beta", "Midpoint", "Degrees of freedom", "Mu", "Sigma", "Bottom", "Top", "Bottom %"),
    *("Top %", "P10", "P90", "P97.5", "Lower cutoff"),
]
LOGNORM = stats.lognorm(math.sqrt(math.log(1.09)), 0, 10 / math.sqrt(1.09))
HALF = 1 / (1 - math.sqrt(0.2))  # of a symmetric triangle whose percentiles 10 and 90 are 2 apart
TAIL = stats.gamma(2.0)
# Distribution, filled columns, and the same in SciPy.
ROWS = {
    "beta": ("Beta", {"Minimum": 10, "Maximum": 20, "Alpha": 2, "Beta": 3}, stats.beta(2, 3, 10, 10)),
    "pert": ("BetaPERT", {"Minimum": 0, "Likeliest": 1, "Maximum": 4}, stats.beta(2, 4, 0, 4)),
    "exponential": ("Exponential", {"Rate": 0.2}, stats.expon(0, 5)),
    "gamma": ("Gamma", {"Scale": 2, "Shape": 3}, stats.gamma(3, 0, 2)),
    "gamma moved": ("Gamma", {"Location": 1, "Scale": 2, "Shape": 3}, stats.gamma(3, 1, 2)),
    "logistic": ("Logistic", {"Mean": 3, "Scale": 2}, stats.logistic(3, 2)),
    "lognormal": ("Lognormal", {"Mean": 10, "Std dev": 3}, LOGNORM),
    "lognorm2": ("Lognorm2", {"Mu": 1, "Sigma": 0.5}, stats.lognorm(0.5, 0, math.e)),
    "largest": ("Max Extreme", {"Likeliest": 3, "Scale": 2}, stats.gumbel_r(3, 2)),
    "smallest": ("Minimum Extreme", {"Likeliest": 3, "Scale": 2}, stats.gumbel_l(3, 2)),
    "pareto": ("Pareto", {"Location": 10, "Shape": 5}, stats.pareto(5, scale=10)),
    "t": ("Student's t", {"Midpoint": 3, "Scale": 2, "Degrees of freedom": 6}, stats.t(6, 3, 2)),
    "trigen": (
        "Trigen",
        {"Bottom": 1, "Likeliest": 2, "Top": 3, "Bottom %": 10, "Top %": 90},
        stats.triang(0.5, 2 - HALF, 2 * HALF),
    ),
    "weibull": ("Weibull", {"Scale": 2, "Shape": 2.5}, stats.weibull_min(2.5, 0, 2)),
    "by percentiles": ("Normal", {"P10": 1, "P97.5": 5}, None),
    "by both": ("Triangular", {"Likeliest": 2, "P10": 1, "P90": 3}, stats.triang(0.5, 2 - HALF, 2 * HALF)),
    "tail": ("Gamma", {"Scale": 1, "Shape": 2, "Lower cutoff": 60}, None),
}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("books") / "every.xlsx"
    with xlsxwriter.Workbook(path) as book:
        inputs, answers = book.add_worksheet("Inputs"), book.add_worksheet("Answers")
        for row, (name, (distribution, filled, _)) in enumerate(ROWS.items(), start=1):
            cells = {"Name": name, "Value": 3.0, "Distribution": distribution, **filled}
            for heading, value in cells.items():
                inputs.write(row, COLUMNS.index(heading), value)
            answers.write(row, 0, name)
            answers.write_formula(row, 1, f"=Inputs!B{row + 1}", value=3.0)
        headings = [{"header": heading} for heading in COLUMNS]
        options = {"name": "xlmc_assumptions", "columns": headings}
        inputs.add_table(0, 0, len(ROWS), len(COLUMNS) - 1, options)
        options = {"name": "xlmc_forecasts", "columns": [{"header": "Name"}, {"header": "Value"}]}
        answers.add_table(0, 0, len(ROWS), 1, options)
    return path


@pytest.fixture(scope="module")
def run(path):
    return simulated(load(path), trials=TRIALS, seed=999)


def test_the_mean_of_every_assumption(run):
    """Within five standard errors of what SciPy says."""
    for name, (_, _, oracle) in ROWS.items():
        if oracle is not None:
            assert abs(run[name].mean.value - oracle.mean()) < 5 * oracle.std() / math.sqrt(TRIALS), name


def test_percentiles_are_where_they_were_put(run):
    """Within five standard errors of the share below."""
    for p, value in [(0.1, 1.0), (0.975, 5.0)]:
        above = run["by percentiles"].probability_above(value).value
        assert abs(1 - above - p) < 5 * math.sqrt(p * (1 - p) / TRIALS)


def test_a_far_tail(run):
    values = np.array([run["tail"].percentile(p).value for p in (1, 50, 99)])
    expected = TAIL.isf(TAIL.sf(60) * (1 - np.array([0.01, 0.5, 0.99])))
    np.testing.assert_allclose(values, expected, rtol=2e-3)


def test_what_the_record_says(path):
    assumptions = {each.name: each for each in load(path).assumptions}
    assert distribution_text(assumptions["gamma"]) == "Gamma: Location 0, Scale 2, Shape 3"
    assert distribution_text(assumptions["by both"]) == "Triangular: Likeliest 2, P10 1, P90 3"
    assert distribution_text(assumptions["by percentiles"]) == "Normal: P10 1, P97.5 5"
