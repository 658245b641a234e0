"""Every call that people bring: it has a test against an exact answer, or is refused and says what to use instead."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from xlmc.engine.engines import ENGINES
from xlmc.errors import FormulaError
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.definitions.in_cells.stand_ins import REFUSED

CALLS = [
    "CB.Uniform",
    "CB.Triangular",
    "CB.Normal",
    "CB.Lognormal",
    "CB.Lognormal2",
    "CB.BetaPERT",
    "CB.Beta",
    "CB.Beta2",
    "CB.Gamma",
    "CB.Weibull",
    "CB.Exponential",
    "CB.Logistic",
    "CB.Pareto",
    "CB.StudentT",
    "CB.MaxExtreme",
    "CB.MinExtreme",
    "CB.Custom",
    "CB.DiscreteUniform",
    "CB.Binomial",
    "CB.YesNo",
    "CB.Poisson",
    "CB.Geometric",
    "CB.NegBinomial",
    "CB.Hypergeometric2",
    "CB.GetForeStatFN",
    "CB.GetForePercentFN",
    "CB.GetCertaintyFN",
    "CB.GetForeDataFN",
    "CB.GetAssumFN",
    "CB.GetAssumPercentFN",
    "CB.GetRunPrefsFN",
    "CB.IterationsFN",
    "RiskUniform",
    "RiskNormal",
    "RiskTriang",
    "RiskPert",
    "RiskLognorm",
    "RiskLognorm2",
    "RiskDiscrete",
    "RiskDUniform",
    "RiskHistogrm",
    "RiskCumul",
    "RiskGeneral",
    "RiskTrigen",
    "RiskBeta",
    "RiskBetaGeneral",
    "RiskGamma",
    "RiskWeibull",
    "RiskExpon",
    "RiskLogistic",
    "RiskPareto",
    "RiskStudent",
    "RiskBinomial",
    "RiskBernoulli",
    "RiskPoisson",
    "RiskNegbin",
    "RiskGeomet",
    "RiskHypergeo",
    "RiskIntUniform",
    "RiskExtvalue",
    "RiskTruncate",
    "RiskTruncate2",
    "RiskTruncateP",
    "RiskShift",
    "RiskName",
    "RiskStatic",
    "RiskSeed",
    "RiskLock",
    "RiskCorrmat",
    "RiskOutput",
    "RiskMean",
    "RiskStdDev",
    "RiskMin",
    "RiskMax",
    "RiskPercentile",
    "RiskTarget",
    "RiskCompound",
    "RiskSimtable",
    "RiskMakeInput",
    "RiskDepC",
    "RiskIndepC",
    "RiskCopula",
    "RiskTheoMean",
    "RiskTheoXtoP",
    "RiskTheoPtoX",
    "RiskCIMean",
    "RiskCorrel",
    "RiskJohnsonSU",
    "RiskJohnsonSB",
    "RiskJohnsonMoments",
    "RiskLaplace",
    "RiskLogLogistic",
    "RiskLevy",
    "RiskPearson5",
    "RiskPearson6",
    "RiskInvGauss",
    "RiskErf",
    "RiskErlang",
    "RiskDagum",
    "RiskBurr12",
    "RiskKumaraswamy",
    "RiskReciprocal",
    "RiskBetaSubj",
    "RiskDoubleTriang",
    "RiskCumulD",
    "RiskF",
    "RiskChiSq",
    "RiskRayleigh",
    "RiskHypSecant",
    "RiskCauchy",
    "RiskFatigueLife",
    "RiskFrechet",
    "RiskExtvalueMin",
]
TESTS = (
    "tests/montecarlo/definitions/in_cells/test_functions_in_cells.py",
    "tests/montecarlo/definitions/in_cells/test_risk_books.py",
    "tests/montecarlo/definitions/in_cells/test_calls.py",
    "tests/montecarlo/definitions/in_cells/test_joined_draws.py",
    "tests/montecarlo/diagnostics/test_result_cells.py",
    "tests/montecarlo/diagnostics/test_more_results.py",
)


def test_every_call_has_a_test():
    root = Path(__file__).parents[4]
    text = "\n".join((root / name).read_text(encoding="utf-8") for name in TESTS).upper()
    assert [call for call in CALLS if f"{call.upper()}(" not in text] == []


@pytest.mark.parametrize("call", [*REFUSED, "RiskTSGARCH"])
def test_what_is_refused_says_which_call_where_and_what_to_use(workbook, call):
    """In one line; RiskLibrary as a property of a draw, too."""
    result = read_definitions(workbook({"I9": f"={call}(A1)", "Z1": "=RiskOutput()+I9+RAND()"}), ENGINES)
    error = next(each for each in result.rewritten.values() if isinstance(each, FormulaError))
    assert re.match(f"(the function )?{call} is not (supported|computed by xlmc)$", error.message, re.IGNORECASE)
    assert error.where == "S!I9"
    assert error.hint
    assert "\n" not in error.hint
