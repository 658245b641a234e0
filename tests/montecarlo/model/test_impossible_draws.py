"""Calls whose numbers are no distribution: an error where no formula asks for them, refused where one always does."""

from __future__ import annotations

import numpy as np
import openpyxl
import pytest
from simulated import simulated

from xlmc.errors import DefinitionError
from xlmc.montecarlo.model import loading

BLANK = {"D1": 1, "E1": 3}
OTHER = "RiskUniform(D1,E1)"

UNUSED = {
    "blank cells": {"A1": "U", "B2": f'=IF(A1="G",RiskGamma(B1,C1),{OTHER})'},
    "texts": {"A1": "U", "B1": "n/a", "C1": "n/a", "B2": f'=IF(A1="G",RiskGamma(B1,C1),{OTHER})'},
    "out of order": {"A1": "U", "B1": 5, "C1": 2, "B2": f'=IF(A1="T",RiskTriang(B1,C1,D1),{OTHER})'},
    "chosen by number": {"A1": 2, "B1": -5, "C1": -2, "B2": f"=CHOOSE(A1,RiskGamma(B1,C1),{OTHER})"},
    "IFS": {"A1": "U", "B2": f'=IFS(A1="G",RiskGamma(B1,C1),TRUE,{OTHER})'},
    "cutoffs": {"A1": "U", "B2": f'=IF(A1="N",RiskNormal(D1,E1,RiskTruncate(9,8)),{OTHER})'},
    "percentiles": {"A1": "U", "B2": f'=IF(A1="N",RiskNormalAlt(5%,B1,95%,C1),{OTHER})'},
    "data": {"A1": "U", "B2": f'=IF(A1="D",RiskDiscrete(F1:F3,G1:G3),{OTHER})'},
    "Crystal Ball": {"A1": "U", "B2": '=IF(A1="G",CB.Gamma(B1,C1,F1),CB.Uniform(D1,E1))'},
    "a cell of its own": {"A1": "U", "A5": "=RiskGamma(B1,C1)", "B2": f'=IF(A1="G",A5,{OTHER})'},
    "within another draw": {"A1": "U", "B2": f'=IF(A1="N",RiskNormal(RiskGamma(B1,C1),1),{OTHER})'},
    "another row": {"A1": 1, "E5": f"={OTHER}", "E6": "=RiskGamma(B1,C1)", "B2": "=INDEX(E5:E6,A1)"},
    "IFERROR": {"B2": f"=IFERROR(RiskGamma(B1,C1),{OTHER})"},
    "correlated": {
        "A1": "U",
        "M1": 1,
        "N1": 0.5,
        "M2": 0.5,
        "N2": 1,
        "B2": '=IF(A1="U",RiskUniform(D1,E1,RiskCorrmat(M1:N2,1)),RiskGamma(B1,C1,RiskCorrmat(M1:N2,2)))',
    },
}
ALWAYS = {
    "alone": {"B2": "=RiskGamma(B1,C1)"},
    "in a sum": {"E5": f"={OTHER}", "E6": "=RiskGamma(B1,C1)", "B2": "=SUM(E5:E6)"},
    "as a parameter": {"B2": "=RiskNormal(RiskGamma(B1,C1),1)"},
    "as a condition": {"B2": "=IF(RiskGamma(B1,C1)>5,1,2)"},
}


@pytest.fixture
def load(tmp_path):
    def loaded(cells):
        book = openpyxl.Workbook()
        book.active.title = "S"
        for address, content in {**BLANK, **cells, "Z1": '=RiskOutput("y")+B2'}.items():
            book.active[address] = content
        book.save(tmp_path / "book.xlsx")
        return loading.load(tmp_path / "book.xlsx")

    return loaded


@pytest.mark.parametrize("cells", UNUSED.values(), ids=UNUSED)
def test_a_draw_that_no_trial_uses_needs_no_distribution(load, cells):
    model = load(cells)
    first, second = (simulated(model, 500, engine=engine) for engine in ("numpy", "jit"))
    y = first.forecasts["y"]
    assert np.array_equal(y, second.forecasts["y"])
    assert (first.accepted, first.error_trials, y.size) == (500, 0, 500)
    assert 1 <= y.min() < y.max() <= 3
    assert not any("no distribution" in notice.message for notice in model.notices) or "IFERROR" in cells["B2"]


@pytest.mark.parametrize("cells", ALWAYS.values(), ids=ALWAYS)
def test_a_draw_that_every_trial_uses_is_refused(load, cells):
    with pytest.raises(DefinitionError, match=r"Scale \(0\) must be above 0"):
        load(cells)


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_trials_that_use_it_are_errors_and_that_is_told(load, engine):
    drawn = {"A1": "=RiskDiscrete({1,2},{1,3})", "B1": -1, "C1": 2}
    model = load({**drawn, "B2": f"=CHOOSE(A1,RiskGamma(B1,C1),{OTHER})"})
    run = simulated(model, 4000, engine=engine)
    assert any("RiskGamma" not in each.message and "no distribution" in each.message for each in model.notices)
    assert run.error_trials == np.isnan(run.forecasts["y"]).sum()
    assert abs(run.error_trials - 1000) <= 4 * np.sqrt(4000 * 3 / 16)


def test_a_register_of_kinds(load):
    kinds = {"A11": "N", "B11": 1, "C11": 2, "A12": "U", "B12": 3, "C12": 5}
    kinds |= {"A13": "T", "B13": 1, "C13": 2, "D13": 4, "A14": "G", "B14": 4, "C14": 0.5}
    rows = {
        f"E{i}": f'=SWITCH(A{i},"N",RiskNormal(B{i},C{i}),"U",RiskUniform(B{i},C{i}),'
        f'"T",RiskTriang(B{i},C{i},D{i}),RiskGamma(B{i},C{i}))'
        for i in range(11, 15)
    }
    run = simulated(load({**kinds, **rows, "B2": "=SUM(E11:E14)"}), 20_000)
    y = run.forecasts["y"]
    assert run.error_trials == 0
    variance = 2**2 + 2**2 / 12 + (1 + 4 + 16 - 2 - 4 - 8) / 18 + 4 * 0.5**2
    assert abs(y.mean() - (1 + 4 + 7 / 3 + 2)) <= 4 * np.sqrt(variance / y.size)


REGISTER = {
    "A1": "=RiskBernoulli(0.3)",
    "A2": "=IF(A1=1,RiskGamma(A1*3,2),0)",
    "A3": "=RiskNormal(10,2)",
    "A4": "=IFERROR(RiskUniform(1,A1*2-0.5),5)",
    "B2": "=A2+A3",
}


@pytest.mark.parametrize("options", [{}, {"engine": "jit"}, {"sampling": "lhs"}], ids=["numpy", "jit", "lhs"])
def test_trials_that_do_not_use_a_draw_need_no_distribution_of_it(load, options):
    run = simulated(load(REGISTER), 20_000, seed=7, **options)
    y, severity = run.forecasts["y"], run.inputs["S!A2#1"]
    happens = run.inputs["S!A1#1"] == 1
    assert (run.accepted, run.error_trials, dict(run.invalid)) == (y.size, 0, {})
    assert np.array_equal(np.isnan(severity), ~happens)
    assert np.array_equal(y, np.where(happens, severity, 0) + run.inputs["S!A3#1"])
    deviation = np.sqrt(0.3 * (6**2 + 12) - 1.8**2 + 4)
    assert abs(y.mean() - 11.8) <= 4 * deviation / np.sqrt(y.size)


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_a_draw_that_a_formula_handles_when_it_is_none(load, engine):
    run = simulated(load({**REGISTER, "B2": "=A4"}), 4000, seed=7, engine=engine)
    y, happens = run.forecasts["y"], run.inputs["S!A1#1"] == 1
    assert run.error_trials == 0
    assert (y[~happens] == 5).all()
    assert ((y[happens] >= 1) & (y[happens] <= 1.5)).all()


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_trials_that_use_it_are_lost(load, engine):
    run = simulated(load({**REGISTER, "B2": "=RiskGamma(A1*3,2)"}), 4000, seed=7, engine=engine)
    lost = (run.prior["S!A1#1"] == 0).sum()
    assert (run.error_trials, dict(run.invalid), run.accepted) == (lost, {"S!B2#1": lost}, 4000 - lost)
