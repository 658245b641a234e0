"""Workbooks whose assumptions are made from data, simulated from file to file."""

from __future__ import annotations

from contextlib import closing

import numpy as np
import openpyxl
import pytest
from fewer_sheets import CHARTS, SENSITIVITY, leave_out
from openpyxl.worksheet.table import Table
from scipy import stats
from simulated import simulated

from xlmc.api import Simulation
from xlmc.errors import DefinitionError
from xlmc.montecarlo.model.loading import load

HEADINGS = ["Name", "Value", "Distribution", "Data", "Cumulative", "Bandwidth", "Low", "High"]
UNIT_COST = [
    (10, 20, 0.2, None),
    (20, 30, 0.1, None),
    (40, 50, 0.3, None),
    (60, 80, 0.3, 1),
    (90, None, 0.05, None),
    (100, None, 0.05, None),
]
"""The example of Crystal Ball's User's Guide: ranges, whole dollars from 60 to 80, and two single values."""
MEASURED = [0.71, 0.74, 0.75, 0.78, 0.78, 0.80, 0.83]


@pytest.fixture
def book(tmp_path):
    def make(rows, changes=None):
        made = openpyxl.Workbook()
        inputs, data = made.active, made.create_sheet("Data")
        inputs.title = "Inputs"
        for row in (HEADINGS, *rows):
            inputs.append(row)
        inputs.add_table(Table(displayName="xlmc_assumptions", ref=f"A1:H{1 + len(rows)}"))
        for row in UNIT_COST:
            data.append(row)
        for row, value in enumerate(["Friction", *MEASURED], start=1):
            data.cell(row, 8, value)
        data.add_table(Table(displayName="Tests", ref=f"H1:H{1 + len(MEASURED)}"))
        answers = made.create_sheet("Answers")
        answers.append(["Name", "Cell"])
        for row in range(len(rows)):
            inputs.cell(20 + row, 1, f"=B{2 + row}*1")
            answers.append([f"x{row}", f"=Inputs!A{20 + row}"])
        answers.add_table(Table(displayName="xlmc_forecasts", ref=f"A1:B{1 + len(rows)}"))
        for address, value in (changes or {}).items():
            made["Data"][address] = value
        made.save(tmp_path / "book.xlsx")
        return tmp_path / "book.xlsx"

    return make


def test_custom_data_from_file_to_file(book, tmp_path, monkeypatch):
    run = simulated(load(book([["Unit cost", 45, "Custom", "Data!A1:D6"]])), trials=60_000, seed=999)
    draws = run["x0"].values
    cells = [10, 20, 30, 40, 50, 60, *(np.arange(60, 81) + 0.5), 91, 101]
    counts, _ = np.histogram(draws, cells)
    shares = [0.2, 0.1, 0, 0.3, 0, *[0.3 / 21] * 21, 0.05, 0.05]
    possible = np.array(shares) > 0
    assert counts[~possible].sum() == 0
    assert stats.chisquare(counts[possible], 60_000 * np.array(shares)[possible]).pvalue > 1e-4
    assert stats.kstest(draws[draws < 20], stats.uniform(10, 10).cdf).pvalue > 1e-4
    mean = 0.2 * 15 + 0.1 * 25 + 0.3 * 45 + 0.3 * 70 + 0.05 * 190
    assert abs(run["x0"].mean.value - mean) < 4 * run["x0"].mean.error
    leave_out(monkeypatch, *CHARTS, *SENSITIVITY)
    Simulation(run).save(tmp_path / "results.xlsx")
    with closing(openpyxl.load_workbook(tmp_path / "results.xlsx", read_only=True)) as sheets:
        shown = [value for row in sheets["Assumptions"].iter_rows(values_only=True) for value in row]
    assert "Custom: Data Data!A1:D6" in shown


def test_empirical_data_as_they_are_and_smoothed(book):
    rows = [
        ["Resampled", 0.77, "Empirical", "Tests[Friction]"],
        ["Smoothed", 0.77, "Empirical smoothed", "Tests[Friction]", None, 0.02],
    ]
    run = simulated(load(book(rows)), trials=60_000, seed=999)
    values, counts = np.unique(run["x0"].values, return_counts=True)
    np.testing.assert_array_equal(values, sorted(set(MEASURED)))
    expected = [60_000 / 7 * MEASURED.count(value) for value in values]
    assert stats.chisquare(counts, expected).pvalue > 1e-4
    mixture = stats.norm(np.array(MEASURED)[:, None], 0.02)
    assert stats.kstest(run["x1"].values, lambda x: mixture.cdf(x).mean(axis=0)).pvalue > 1e-4


def test_many_draws(book):
    """Chi-square at 1e-4: pieces of Custom by their weights, Empirical smoothed in fifty equally likely cells."""
    rows = [["Unit cost", 45, "Custom", "Data!A1:D6"], ["Smoothed", 0.77, "Empirical smoothed", "Tests", None, 0.02]]
    draws = load(book(rows)).sampler(999, 60_000).draw(0)
    counts, _ = np.histogram(draws["Unit cost"], [10, 20, 30, 55, 85, 95, 101])
    assert stats.chisquare(counts, 60_000 * np.array([0.2, 0.1, 0.3, 0.3, 0.05, 0.05])).pvalue > 1e-4
    mixture = stats.norm(np.array(MEASURED)[:, None], 0.02)
    x = np.linspace(0.6, 0.94, 10_001)  # by interpolation the edges are right to 1e-7 of a probability
    edges = np.interp(np.linspace(0, 1, 51)[1:-1], mixture.cdf(x).mean(axis=0), x)
    counts, _ = np.histogram(draws["Smoothed"], [-np.inf, *edges, np.inf])
    assert stats.chisquare(counts).pvalue > 1e-4


def test_data_may_be_computed_from_what_does_not_vary(book):
    given = book([["Cost", 45, "Empirical", "Data!K1:K2"]], {"J1": 3, "K1": "=J1*2", "K2": "=K1+1"})
    run = simulated(load(given), trials=1000)
    np.testing.assert_array_equal(np.unique(run["x0"].values), [6, 7])


def test_faults_of_computed_data_are_told_with_their_cell(book):
    given = book([["Cost", 45, "Custom", "Data!K1:L2"]], {"K1": 1, "L1": "=0-2", "K2": 2, "L2": 1})
    with pytest.raises(DefinitionError, match=r"The weight \(-2\) is below 0") as caught:
        load(given)
    assert caught.value.where == "Data!L1"


@pytest.mark.parametrize(
    ("formula", "where"), [("=Inputs!B3*2", "Data!K1"), ("=IF(Inputs!B3>5,1,2)", "Data!K1"), (None, "Inputs!B3")]
)
def test_data_that_vary_are_refused(book, formula, where):
    data = "Data!K1:K2" if formula else "Inputs!B3:B3"
    rows = [["Cost", 45, "Empirical", data], ["Other", 5, "Uniform", None, None, None, 0, 9]]
    with pytest.raises(DefinitionError, match="The data of 'Cost' vary with an assumption in this cell") as caught:
        load(book(rows, {"K1": formula, "K2": 7}))
    assert caught.value.where == where
    assert "Draw from fixed data" in caught.value.hint


def test_the_same_draws_for_any_number_of_threads(book):
    model = load(book([["Unit cost", 45, "Custom", "Data!A1:D6"], ["F", 0.77, "Empirical smoothed", "Tests"]]))
    one, two = simulated(model, trials=70_000), simulated(model, trials=70_000, jobs=2)
    for name in ("x0", "x1"):
        np.testing.assert_array_equal(one[name].values, two[name].values)
