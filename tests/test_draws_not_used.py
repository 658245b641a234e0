"""A run with draws whose parameters are a distribution in some trials only, those that use them: what is made of it."""

from __future__ import annotations

import numpy as np
import openpyxl
import pytest
from simulated import simulated

from xlmc.analysis.results.saved import open_run
from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.api import Simulation
from xlmc.montecarlo.model.loading import load

CELLS = {
    "A1": "=RiskBernoulli(0.3)",
    "A2": "=IF(A1=1,RiskGamma(A1*3,2),0)",
    "A3": "=RiskNormal(10,2)",
    "B2": '=RiskOutput("y")+A2+A3',
}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("book") / "book.xlsx"
    book = openpyxl.Workbook()
    book.active.title = "S"
    for address, content in CELLS.items():
        book.active[address] = content
    book.save(path)
    return simulated(load(path), 20_000, seed=7)


def test_influences(run):
    result = {each.assumption: each.explained.value for each in sensitivities(run)["y"].influences}
    # Of the variance 15.16 the event explains 0.3 * 0.7 * 6²; a severity says whether it happens, and explains 11.16.
    assert result["S!A1#1"] == pytest.approx(7.56 / 15.16, abs=0.05)
    assert result["S!A2#1"] == pytest.approx(11.16 / 15.16, abs=0.05)
    assert result["S!A3#1"] == pytest.approx(4 / 15.16, abs=0.05)


def test_files(run, tmp_path):
    Simulation(run).extract(tmp_path / "trials.csv")
    Simulation(run).save_json(tmp_path / "run.json")
    Simulation(run).keep(tmp_path / "run.xlmcrun")
    assert "NaN" not in (tmp_path / "run.json").read_text(encoding="utf-8")
    again = open_run(tmp_path / "run.xlmcrun")
    assert np.array_equal(again.inputs["S!A2#1"], run.inputs["S!A2#1"], equal_nan=True)
    rows = [row.split(",") for row in (tmp_path / "trials.csv").read_text(encoding="utf-8").splitlines()]
    column = rows[0].index("S!A2#1")
    assert [row[column] == "" for row in rows[1:]] == np.isnan(run.inputs["S!A2#1"]).tolist()
