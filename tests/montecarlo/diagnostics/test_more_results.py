"""Results of parts of the values, correlations, intervals, and numbers of distributions, in cells of the result."""

from __future__ import annotations

import io
import math

import numpy as np
import openpyxl
import pytest
from openpyxl import Workbook
from scipy import stats
from simulated import simulated

from xlmc.excel.workbook.writer import package_bytes
from xlmc.montecarlo.diagnostics.result_cells import filled_sheets
from xlmc.montecarlo.model.loading import load

MODEL = {
    "A1": "=RiskNormal(5,1)",
    "A2": "=RiskGamma(2,3,RiskShift(1),RiskTruncate(,8))",
    "A3": '=RiskOutput("x")+A1*A2',
    "A4": '=CB.Normal(10,2,8,14,"cb")',
    "A5": '=RiskOutput("y")+A4+A1-RiskTheoMean(A1)',
    "A6": "=RiskDiscrete({1,2,9},{0.5,0.25,0.25})",
    "A7": "=RiskCauchy(0,1)",
    "A8": "=RiskNormal(A1,1)",
}
CUT = stats.gamma(2, 0, 3)
MASS = CUT.cdf(8)
CUT_MEAN = CUT.expect(lambda x: x, ub=8) / MASS
CUT_SQUARE = CUT.expect(lambda x: x * x, ub=8) / MASS
THEORY = {
    "RiskTheoMean(A1)": 5,
    "RiskTheoStdDev(A1)": 1,
    "RiskTheoKurtosis(A1)": 3,
    "RiskTheoPtoX(A1,97.5%)": stats.norm.ppf(0.975, 5),
    "RiskTheoPtoXD(A1,97.5%)": stats.norm.ppf(0.025, 5),
    "RiskTheoXtoP(A1,6)": stats.norm.cdf(1),
    "RiskTheoXtoQ(A1,6)": stats.norm.sf(1),
    "RiskTheoMean(A2)": 1 + CUT_MEAN,
    "RiskTheoVariance(A2)": CUT_SQUARE - CUT_MEAN**2,
    "RiskTheoTarget(A2,5)": CUT.cdf(4) / MASS,
    "RiskTheoPercentile(A2,0.5)": 1 + CUT.ppf(MASS / 2),
    "RiskTheoMin(A2)": 1,
    "RiskTheoMax(A2)": 9,
    "RiskTheoRange(A2)": 8,
    "RiskTheoSkewness(RiskExpon(3))": 2,
    "RiskTheoKurtosis(RiskExpon(3))": 9,
    "RiskTheoMeanAbsDev(RiskExpon(3))": 6 / math.e,
    "RiskTheoSkewness(RiskPoisson(4))": 0.5,
    "RiskTheoKurtosis(RiskBinomial(10,0.3))": 3 + (1 - 6 * 0.21) / 2.1,
    "RiskTheoSkewness(RiskLognorm2(0,0.5))": (math.exp(0.25) + 2) * math.sqrt(math.exp(0.25) - 1),
    "RiskTheoCoeffOfVariation(RiskGamma(4,2))": 0.5,
    "RiskTheoMean(A6)": 3.25,
    "RiskTheoStdDev(A6)": math.sqrt(0.5 + 1 + 81 / 4 - 3.25**2),
    "RiskTheoXtoP(A7,1)": 0.75,
    "RiskTheoMean(RiskCompound(RiskPoisson(5),RiskExpon(2)))": 10,
    "RiskTheoStdDev(RiskCompound(RiskPoisson(5),RiskExpon(2)))": math.sqrt(40),
    "CB.GetAssumPercentFN(A4,50)": stats.truncnorm(-1, 2, 10, 2).ppf(0.5),
    "CB.GetAssumFN(A4,6)": 8,
    "CB.IterationsFN()": 5000,
    "CB.GetRunPrefsFN(1)": 5000,
}
OF_TRIALS = {
    "RiskMean(A3,RiskTruncate(20,30))": lambda x, y: x[(x >= 20) & (x <= 30)].mean(),
    "RiskStdDev(A3,RiskTruncate(,30))": lambda x, y: x[x <= 30].std(ddof=1),
    "RiskPercentile(A3,0.5,RiskTruncateP(0.5,1))": lambda x, y: np.percentile(x[x >= np.median(x)], 50),
    "RiskTarget(A3,25,1,RiskTruncate(20,))": lambda x, y: np.mean(x[x >= 20] <= 25),
    "RiskMax(A3,,RiskTruncate(,30))": lambda x, y: x[x <= 30].max(),
    "CB.GetForeDataFN(A3,3)": lambda x, y: x[2],
    "RiskMeanAbsDev(A3)": lambda x, y: np.abs(x - x.mean()).mean(),
    "RiskCorrel(A3,A5,1)": lambda x, y: np.corrcoef(x, y)[0, 1],
    'RiskCorrel("x","y",2)': lambda x, y: stats.spearmanr(x, y).statistic,
    "RiskMean(A3)-RiskTheoMean(A1)": lambda x, y: x.mean() - 5,
}
MISSING = {
    "RiskTheoMean(A7)": "RiskTheoMean: this number of the distribution is infinite, or there is none",
    "RiskTheoMean(A8)": "RiskTheoMean needs a distribution whose parameters are numbers",
    "RiskTheoMean(A3)": "RiskTheoMean needs one distribution whose numbers are known",
    "RiskTheoPtoX(A1,1.5)": "RiskTheoPtoX: a probability must be from 0 to 1",
    "RiskTheoMean(A1,1)": "RiskTheoMean has 2 arguments",
    "RiskTheoXtoP(RiskCompound(RiskPoisson(5),RiskExpon(2)),5)": "RiskTheoXtoP of RiskCompound has no formula",
    "RiskSensitivity(A3,1)": "RiskSensitivity is not computed by xlmc",
    "RiskMean(A3,2)": "RiskMean asks for simulation 2, and RiskSimtable has no values",
    "RiskMean(A3,RiskShift(2))": "RiskMean has a property that it cannot have",
    "RiskCIMean(A3,0.95,RiskTruncate(1,2))": "RiskCIMean of a part of the values is not computed",
}


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """The run, and formula -> what the result workbook shows for it; without result sheets.

    A sixteenth of the quantiles that stand for a piece of a distribution: the mean of the middles of 2¹⁶ equal parts is
    off by less than 1e-8 of it, the variance by less than 1e-7, and the tolerance is 1e-6.
    """
    folder = tmp_path_factory.mktemp("results")
    book = Workbook()
    sheet = book.active
    sheet.title = "S"
    for address, formula in MODEL.items():
        sheet[address] = formula
    more = ["CB.GetAssumFN(A4,1)", "CB.GetAssumFN(A1,6)", "CB.GetRunPrefsFN(3)", "RiskCIMean(A3,0.9)"]
    asked = [*THEORY, *OF_TRIALS, *MISSING, *more, "RiskCIMean(A3,0.9,FALSE)"]
    for row, formula in enumerate(asked, start=1):
        sheet[f"B{row}"] = f"={formula}"
    book.save(folder / "book.xlsx")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("xlmc.montecarlo.definitions.in_cells.theory._GRID", 1 << 16)
        run = simulated(load(folder / "book.xlsx"), trials=5000, seed=999)
    filled = {**run.model.workbook.parts, **filled_sheets(run.model.workbook, run.shown_results)}
    values = openpyxl.load_workbook(io.BytesIO(package_bytes(filled)), data_only=True)["S"]
    return run, {formula: values[f"B{row}"].value for row, formula in enumerate(asked, start=1)}


def test_numbers_of_distributions(shown):
    _, result = shown
    for formula, exact in THEORY.items():
        assert result[formula] == pytest.approx(exact, rel=1e-6), formula


def test_numbers_of_trials(shown):
    run, result = shown
    x, y = run["x"].values, run["y"].values
    for formula, of in OF_TRIALS.items():
        assert result[formula] == pytest.approx(of(x, y), rel=1e-9, abs=1e-12), formula


def test_the_interval_of_the_mean(shown):
    """Both ends are those of the statistic; about ±1.645 standard errors for so many trials."""
    run, result = shown
    low, high = result["RiskCIMean(A3,0.9)"], result["RiskCIMean(A3,0.9,FALSE)"]
    error = run["x"].mean.error
    assert (run["x"].mean.value - low) / error == pytest.approx(1.645, abs=0.05)
    assert (high - run["x"].mean.value) / error == pytest.approx(1.645, abs=0.05)


def test_an_assumption_by_its_name(shown):
    _, result = shown
    assert result["CB.GetAssumFN(A4,1)"] == "cb"
    assert result["CB.GetAssumFN(A1,6)"] == result["CB.GetRunPrefsFN(3)"] == "#N/A"


def test_what_cannot_be_shown_is_named(shown):
    run, result = shown
    for formula, reason in MISSING.items():
        assert result[formula] == "#N/A", formula
        assert any(why.startswith(reason) for why in run.shown_results.missing.values()), formula
    expected = " ".join(notice.message for notice in run.model.notices)
    assert "RiskSensitivity is not computed by xlmc" in expected


def test_a_run_may_depend_on_a_number_of_a_distribution(shown):
    """A5 subtracts the mean of A1, so that its own is that of A4."""
    run, _ = shown
    oracle = stats.truncnorm(-1, 2, 10, 2)
    assert abs(run["y"].mean.value - oracle.mean()) < 5 * math.sqrt((oracle.var() + 1) / 5000)
