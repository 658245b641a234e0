"""Calls of Analytic Solver and ModelRisk are named with their program, and with what to write instead."""

from __future__ import annotations

import openpyxl
import pytest
from simulated import simulated

from xlmc.errors import ErrorCode, XlmcError
from xlmc.montecarlo.definitions.in_cells.suspects import holds_call
from xlmc.montecarlo.model.loading import load

CALLS = {
    "PsiNormal(5,1)": ("PSINORMAL is a function of Analytic Solver", "RiskNormal(mean, std_dev)"),
    "_xll.PsiTriangular(1,2,3)": ("PSITRIANGULAR is a function of Analytic Solver", "RiskTriang(low, likeliest, high)"),
    "PsiBetaGen(1,2,0,4)+1": ("PSIBETAGEN is a function of Analytic Solver", "RiskBetaGeneral("),
    "VoseLognormal(3,1)": ("VOSELOGNORMAL is a function of ModelRisk", "RiskLognorm(mean, std_dev)"),
    "VosePERT(1,2,3)": ("VOSEPERT is a function of ModelRisk", "RiskPert("),
    "VoseAggregateMC(3,1)": ("VOSEAGGREGATEMC is a function of ModelRisk", "a row of xlmc_assumptions"),
    "2*PsiOutput()": ("PSIOUTPUT is a function of Analytic Solver", "RiskOutput("),
    "PsiMean(A1)+1": ("PSIMEAN is a function of Analytic Solver", "RiskMean"),
}


@pytest.fixture
def book(tmp_path):
    def made(cells):
        result = openpyxl.Workbook()
        result.active.title = "S"
        for address, content in cells.items():
            result.active[address] = content
        result.save(tmp_path / "book.xlsx")
        return tmp_path / "book.xlsx"

    return made


@pytest.mark.parametrize("call", CALLS)
def test_a_forecast_that_needs_one_is_refused_by_its_program(book, call):
    message, instead = CALLS[call]
    with pytest.raises(XlmcError) as refused:
        load(book({"A1": f"={call}", "A2": '=RiskOutput("x")+A1+RAND()'}))
    assert message in str(refused.value)
    assert instead in str(refused.value)
    assert "S!A1" in str(refused.value)


def test_a_book_of_which_nothing_else_is_known_names_the_program(book):
    with pytest.raises(XlmcError) as refused:
        load(book({"A1": "=PsiNormal(5,1)", "A2": "=A1*2+PsiOutput()", "A3": "=PsiMean(A2)"}))
    assert "Analytic Solver" in str(refused.value)
    assert "no xlmc tables" not in str(refused.value)


def test_a_result_of_such_a_program_is_never_left_as_it_was(book):
    run = simulated(load(book({"A1": "=RiskNormal(5,1)+RiskOutput()", "A2": "=VoseSimMean(A1)", "A3": "=A2+1"})), 200)
    assert {cell.a1: value for cell, value in run.shown_results.cells.items()} == dict.fromkeys(
        ("A2", "A3"), ErrorCode.NA
    )
    assert "VOSESIMMEAN is a function of ModelRisk" in run.shown_results.warning


@pytest.mark.parametrize("formula", ["PsiAngle(A1)", "Psi(A1)", "Psi_deg*2", 'LEN("PsiNormal(1,2)")', "Vose+1"])
def test_names_that_only_look_alike_are_left_alone(formula):
    assert not holds_call(formula)
