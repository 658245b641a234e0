"""Books written with `Risk…`, `CB.…` and `RAND()`, saved as files and run unchanged, against exact answers.

Means lie within five standard errors of the exact one, which a right answer misses with a probability of 6e-7; shares
likewise, with the standard error of a proportion. The seed is fixed.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import xlsxwriter
from openpyxl import Workbook
from scipy import stats
from simulated import simulated

from xlmc.analysis.studies.scenario_answers import model_of, scenario_answers
from xlmc.engine.engines import ENGINES
from xlmc.errors import XlmcError
from xlmc.excel.address import Area
from xlmc.excel.workbook.workbook import CellContent, Formula
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

TRIALS = 25_000


def saved(cells, path):
    """A file with these formulas and values, as openpyxl writes it: no cached values."""
    book = Workbook()
    sheet = book.active
    sheet.title = "S"
    for address, value in cells.items():
        sheet[address] = value
    book.save(path)
    return path


@pytest.fixture
def model(tmp_path):
    return lambda cells: load(saved(cells, tmp_path / "book.xlsx"))


LOGNORMAL_SIGMA = math.sqrt(math.log(1.04))

BOOKS = {
    # cost with a contingency, @RISK
    "cost": (
        {
            "A1": '=RiskTriang(80,100,150,RiskName("steel"))',
            "A2": "=RiskUniform(40,60)",
            "A3": "=RiskDiscrete({0,25},{0.7,0.3})",
            "A4": '=RiskOutput("cost")+SUM(A1:A3)',
        },
        {"cost": (110 + 50 + 7.5, math.sqrt(216.6666666667 + 400 / 12 + 25**2 * 0.21))},
    ),
    # a call in a larger formula, with the add-in's prefix
    "prefix": (
        {"A1": "=10+_xll.RiskNormal(5,1)*2", "A2": "=A1/2+_xll.RiskOutput()"},
        {"S!A2": (10, 1)},
    ),
    # Crystal Ball, as saved with a link to the add-in
    "crystal ball": (
        {
            "A1": "=[1]!CB.Normal(100,10)",
            "A2": "=CB.Exponential(0.5)",
            "A3": "=A1*A2",
            "A4": "=CB.GetForeStatFN(A3,2)",
        },
        {"S!A3": (200, math.sqrt((100**2 + 10**2) * 8 - 200**2))},
    ),
    # Crystal Ball and @RISK count different things
    "counts": (
        {
            "A1": '=CB.Geometric(0.25)+RiskOutput("trials")',
            "A2": '=RiskGeomet(0.25)+RiskOutput("failures")',
            "A3": '=CB.NegBinomial(0.25,3)+RiskOutput("trials 3")',
            "A4": '=RiskNegbin(3,0.25)+RiskOutput("failures 3")',
        },
        {
            "trials": (4, math.sqrt(12)),
            "failures": (3, math.sqrt(12)),
            "trials 3": (12, 6),
            "failures 3": (9, 6),
        },
    ),
    # a dynamic parameter: Poisson with a gamma rate is negative binomial
    "mixture": (
        {"A1": "=RiskGamma(3,2)", "A2": '=RiskPoisson(A1)+RiskOutput("claims")'},
        {"claims": (6, math.sqrt(6 + 12))},
    ),
    # the same within one formula, the rate an expression
    "nested": (
        {"B1": 2, "A2": '=RiskOutput("claims")+RiskPoisson(RiskGamma(3,1)*B1)'},
        {"claims": (6, math.sqrt(6 + 12))},
    ),
    # Excel alone; the forecast is marked by a table-free RiskOutput
    "excel": (
        {
            "A1": "=NORM.INV(RAND(),50,5)",
            "A2": "=-LN(RAND())/0.5",
            "A3": "=RANDBETWEEN(1,6)",
            "A4": "=RAND()^2",
            "A5": '=RiskOutput("sum")+SUM(A1:A4)',
        },
        {"sum": (50 + 2 + 3.5 + 1 / 3, math.sqrt(25 + 4 + 35 / 12 + 4 / 45))},
    ),
    # filled down: each cell draws on its own
    "filled down": (
        {
            "A1": 3,
            **{f"B{i}": f"=RiskNormal($A$1,C{i})" for i in range(1, 10)},
            **{f"C{i}": i for i in range(1, 10)},
            "D1": '=RiskOutput("total")+SUM(B1:B9)',
        },
        {"total": (27, math.sqrt(285))},
    ),
    # truncated, then shifted
    "properties": (
        {
            "A1": '=RiskNormal(0,1,RiskTruncate(0,),RiskShift(10))+RiskOutput("half")',
            "A2": '=RiskNormal(0,1,RiskTruncate2(10,),RiskShift(10))+RiskOutput("same")',
            "A3": '=RiskUniform(0,10,RiskTruncateP(20%,60%))+RiskOutput("middle")',
        },
        {
            "half": (10 + math.sqrt(2 / math.pi), math.sqrt(1 - 2 / math.pi)),
            "same": (10 + math.sqrt(2 / math.pi), math.sqrt(1 - 2 / math.pi)),
            "middle": (4, 4 / math.sqrt(12)),
        },
    ),
    # rank correlations; the sum of two normals
    "matrix": (
        {
            "F1": 1,
            "F2": 0.6,
            "G2": 1,
            "A1": "=RiskNormal(0,1,RiskCorrmat(F1:G2,1))",
            "A2": "=RiskNormal(0,1,RiskCorrmat(F1:G2,2))",
            "A3": '=RiskOutput("sum")+A1+A2',
        },
        {"sum": (0, math.sqrt(2 + 2 * 2 * math.sin(math.pi * 0.6 / 6)))},
    ),
    # percentiles in place of parameters
    "percentiles": (
        {
            "A1": '=RiskNormalAlt(10%,8,90%,12)+RiskOutput("normal")',
            "A2": '=RiskUniformAlt(25%,3,75%,5)+RiskOutput("uniform")',
            "A3": '=RiskLognormAlt("mu",5,"sigma",1,"loc",2)+RiskOutput("lognormal")',
        },
        {
            "normal": (10, 2 / stats.norm.ppf(0.9)),
            "uniform": (4, 4 / math.sqrt(12)),
            "lognormal": (7, 1),
        },
    ),
    # a run of random numbers, averaged
    "array": (
        {"A1": '=RiskOutput("mean")+AVERAGE(RANDARRAY(4,5,0,10))'},
        {"mean": (5, math.sqrt(100 / 12 / 20))},
    ),
    # lists in ranges
    "lists": (
        {
            "C1": 1, "C2": 2, "C3": 5, "D1": 0.5, "D2": 0.25, "D3": "=1-D1-D2",
            "A1": '=RiskDiscrete(C1:C3,D1:D3)+RiskOutput("discrete")',
            "A2": '=CB.Custom(C1:D3)+RiskOutput("custom")',
        },
        {name: (2.25, math.sqrt(0.5 + 1 + 25 / 4 - 2.25**2)) for name in ("discrete", "custom")},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BOOKS)
def test_books_run_unchanged(model, name):
    cells, answers = BOOKS[name]
    run = simulated(model(cells), trials=TRIALS, seed=999)
    for forecast, (mean, deviation) in answers.items():
        result = run[forecast]
        assert result.values.size == TRIALS
        assert abs(result.mean.value - mean) < 5 * deviation / math.sqrt(TRIALS), forecast
        assert abs(result.standard_deviation.value - deviation) < 5 * result.standard_deviation.error, forecast


SHAPES = {
    "RiskPert(1,2,5)": stats.beta(2, 4, 1, 4),
    "RiskLognorm(10,2)": stats.lognorm(LOGNORMAL_SIGMA, scale=10 / math.sqrt(1.04)),
    "RiskLognorm2(1,0.5)": stats.lognorm(0.5, scale=math.e),
    "RiskExpon(4)": stats.expon(scale=4),
    "RiskWeibull(2,3)": stats.weibull_min(2, scale=3),
    "RiskRayleigh(3)": stats.rayleigh(scale=3),
    "RiskChiSq(5)": stats.chi2(5),
    "RiskErlang(3,2)": stats.gamma(3, scale=2),
    "RiskPareto(3,2)": stats.pareto(3, scale=2),
    "RiskExtvalue(5,2)": stats.gumbel_r(5, 2),
    "RiskExtvalueMin(5,2)": stats.gumbel_l(5, 2),
    "RiskStudent(4)": stats.t(4),
    "RiskBetaGeneral(2,3,1,10)": stats.beta(2, 3, 1, 9),
    "RiskBetaSubj(0,2,3,10)": stats.beta(1.8, 4.2, 0, 10),
    "RiskBurr12(1,2,3,1.5)": stats.burr12(3, 1.5, 1, 2),
    "RiskCauchy(10,2)": stats.cauchy(10, 2),
    "RiskDagum(1,2,3,1.5)": stats.burr(3, 1.5, 1, 2),
    "RiskErf(2)": stats.norm(0, 0.25 * math.sqrt(2)),
    "RiskF(3,10)": stats.f(3, 10),
    "RiskFatigueLife(1,2,0.5)": stats.fatiguelife(0.5, 1, 2),
    "RiskFrechet(1,2,3)": stats.invweibull(3, 1, 2),
    "RiskHypSecant(10,2)": stats.hypsecant(10, 4 / math.pi),
    "RiskInvGauss(3,5)": stats.invgauss(0.6, 0, 5),
    "RiskJohnsonMoments(10,2,0,3)": stats.norm(10, 2),
    "RiskJohnsonSB(1,2,10,20)": stats.johnsonsb(1, 2, 10, 10),
    "RiskJohnsonSU(-1,2,10,3)": stats.johnsonsu(-1, 2, 10, 3),
    "RiskLaplace(10,2)": stats.laplace(10, math.sqrt(2)),
    "RiskLevy(1,2)": stats.levy(1, 2),
    "RiskLogLogistic(1,2,3)": stats.fisk(3, 1, 2),
    "RiskPareto2(2,3)": stats.lomax(3, 0, 2),
    "RiskPearson5(3,2)": stats.invgamma(3, 0, 2),
    "RiskPearson6(3,4,2)": stats.betaprime(3, 4, 0, 2),
    "RiskReciprocal(1,100)": stats.loguniform(1, 100),
    "RiskFrechet(1,2,3,RiskShift(5))": stats.invweibull(3, 6, 2),
    "RiskLaplace(10,2,RiskTruncate2(15,),RiskShift(5))": stats.expon(15, math.sqrt(2)),
    "CB.Beta(2,3,10)": stats.beta(2, 3, 0, 10),
    "CB.Gamma(1,2,3)": stats.gamma(3, 1, 2),
    "CB.Weibull(1,2,3)": stats.weibull_min(3, 1, 2),
    "CB.StudentT(1,2,5)": stats.t(5, 1, 2),
    "CB.Normal(5,2,4,8)": stats.truncnorm(-0.5, 1.5, 5, 2),
    "BETA.INV(RAND(),2,3,1,10)": stats.beta(2, 3, 1, 9),
    "GAMMA.INV(RAND(),3,2)": stats.gamma(3, scale=2),
    "LOGNORM.INV(RAND(),1,0.5)": stats.lognorm(0.5, scale=math.e),
    "T.INV(RAND(),5.9)": stats.t(5),
    "CHISQ.INV(RAND(),5)": stats.chi2(5),
    "3*(-LN(RAND()))^(1/2)": stats.weibull_min(2, scale=3),
    "NORM.INV(1-RAND(),5,2)": stats.norm(5, 2),
}


def test_whole_distributions(model):
    """The share of draws below each decile that SciPy gives."""
    cells = {f"A{row}": f'=RiskOutput("{row}")+{formula}' for row, formula in enumerate(SHAPES, start=1)}
    run = simulated(model(cells), trials=TRIALS, seed=999)
    for row, (formula, oracle) in enumerate(SHAPES.items(), start=1):
        values = run[str(row)].values
        for share in np.arange(0.1, 0.95, 0.1):
            below = np.mean(values <= oracle.ppf(share))
            assert abs(below - share) < 5 * math.sqrt(share * (1 - share) / TRIALS), (formula, share)


def test_rank_correlation_of_a_matrix(model):
    """Its standard error is below 1/√n."""
    cells, _ = BOOKS["matrix"]
    run = simulated(model(cells), trials=TRIALS, seed=999)
    result = stats.spearmanr(run.inputs["S!A1#1"], run.inputs["S!A2#1"]).statistic
    assert abs(result - 0.6) < 5 / math.sqrt(TRIALS)


def test_another_cell_leaves_the_draws_of_all_others_untouched(model):
    cells = {"A1": "=RiskNormal(5,1)+RAND()", "A2": '=RiskUniform(0,1,RiskName("u"))', "A3": "=RiskOutput()+A1+A2"}
    more = {**cells, "A0": 1, "B9": "=RAND()*2", "A3": "=RiskOutput()+A1+A2+B9+RiskNormal(0,1)"}
    del more["A0"]
    before, after = (simulated(model(each), trials=5000, seed=3) for each in (cells, more))
    assert set(after.inputs) > set(before.inputs) == {"S!A1#1", "S!A1#2", "u"}
    for name, draws in before.inputs.items():
        np.testing.assert_array_equal(draws, after.inputs[name])


def test_draws_of_filled_down_cells_are_independent(model):
    cells = {f"A{i}": "=RAND()" for i in range(1, 5)} | {"B1": "=RiskOutput()+SUM(A1:A4)"}
    inputs = simulated(model(cells), trials=TRIALS, seed=999).inputs
    result = np.corrcoef([inputs[f"S!A{i}#1"] for i in range(1, 5)])
    assert np.abs(result - np.eye(4)).max() < 5 / math.sqrt(TRIALS)


@pytest.mark.parametrize("name", ["nested", "matrix", "array"])
def test_threads_and_processes_do_not_matter(model, name):
    made = model(BOOKS[name][0])
    one = simulated(made, trials=70_000, seed=5)
    others = (simulated(made, trials=70_000, seed=5, jobs=2, scheduler=s) for s in ("threads", "processes"))
    for other in others:
        for forecast, values in one.forecasts.items():
            np.testing.assert_array_equal(values, other.forecasts[forecast])


@pytest.mark.parametrize("name", ["cost", "prefix", "nested", "properties", "lists"])
def test_the_slow_reference_agrees(model, name):
    made = model(BOOKS[name][0])
    fast, slow = simulated(made, trials=20), simulated(made, trials=20, engine="formulas")
    for forecast, values in fast.forecasts.items():
        np.testing.assert_allclose(values, slow.forecasts[forecast], rtol=1e-12)


@pytest.mark.parametrize("name", ["cost", "nested", "excel", "properties"])
def test_the_compiled_engine_agrees(model, name):
    pytest.importorskip("llvmlite")
    made = model(BOOKS[name][0])
    fast, compiled = simulated(made, trials=2000), simulated(made, trials=2000, engine="jit")
    for forecast, values in fast.forecasts.items():
        np.testing.assert_allclose(values, compiled.forecasts[forecast], rtol=1e-12)


def test_an_array_of_draws_spills(workbook):
    """The cells that a dynamic array fills draw on their own: the variance of their sum is the sum of theirs."""
    array = Formula("RANDARRAY(3,1,0,6)", 1, 1, Area("S", 1, 1, 3, 1), dynamic=True)
    held = workbook({"A1": CellContent(1.0, array), "A2": 1.0, "A3": 1.0, "B1": "=RiskOutput()+SUM(A1:A3)"})
    run = simulated(CompiledModel(held, read_definitions(held, ENGINES), Path("book.xlsx")), trials=TRIALS, seed=999)
    result = run["S!B1"]
    assert abs(result.mean.value - 9) < 5 * 3 / math.sqrt(TRIALS)
    assert abs(result.standard_deviation.value - 3) < 5 * result.standard_deviation.error


@pytest.fixture
def array_formula(workbook):
    """A model whose answer is an array formula, as Excel saves what is typed today, over 100, 200, 300 in B1 to B3."""

    def make(text):
        formula = Formula(text, 1, 1, Area("S", 1, 1, 1, 1), dynamic=True)
        cells = {"A1": CellContent(1.0, formula), "B1": 100.0, "B2": 200.0, "B3": 300.0, "C1": "=RiskOutput()+A1"}
        held = workbook(cells)
        return CompiledModel(held, read_definitions(held, ENGINES), Path("book.xlsx"))

    return make


@pytest.mark.parametrize(
    ("text", "mean", "sd"),
    [
        ("SUM(NORM.INV(RAND(),B1:B3,1))", 600, 3),  # one uniform number for all three, as in Excel
        ("SUM(NORM.INV(RAND(),B1:B3*2,{1;2;3}))", 1200, 6),
        ("SUM(NORM.INV(RAND(),IF(B1:B3>150,B1:B3,0),2))", 500, 6),
        ("SUM(NORM.INV(RAND(),RANDARRAY(2,1,5,5),1))", 10, 2),
        ("SUM(GAMMA.INV(RAND(),1,{2,3}))", 5, 5),
        ("NORM.INV(RAND(),AVERAGE(B1:B3),1)", 200, 1),
        ("NORM.INV(RAND(),INDEX(B1:B3,2),1)", 200, 1),
    ],
)
def test_an_inverse_of_many_parameters_is_of_one_uniform_number(array_formula, text, mean, sd):
    result = simulated(array_formula(text), trials=TRIALS, seed=999)["S!C1"]
    assert abs(result.mean.value - mean) < 5 * sd / math.sqrt(TRIALS)
    assert abs(result.standard_deviation.value - sd) < 5 * result.standard_deviation.error


@pytest.mark.parametrize(
    "text",
    ["SUM(RiskNormal(B1:B3,1))", "SUM(CB.Normal({1,2},1))", "SUM(RANDBETWEEN(1,B1:B3))", "SUM(RANDARRAY(2,1,B1:B2,9))"],
)
def test_a_draw_of_many_parameters_is_refused(array_formula, text):
    """It was drawn from the first of them."""
    with pytest.raises(XlmcError, match="Several values stand where a draw takes one"):
        array_formula(text)


def test_a_locked_draw_is_held(model):
    made = model({"A1": "=RiskNormal(5,1,RiskLock(),RiskShift(1))+RAND()", "A2": "=A1+RiskOutput()"})
    assert [a.name for a in made.live] == ["S!A1#2"]
    values = simulated(made, trials=100)["S!A2"].values
    assert values.min() >= 6
    assert values.max() <= 7


def test_parameters_that_are_no_distribution_are_error_trials(model):
    run = simulated(model({"A1": "=RiskNormal(0,RAND()-0.5)", "A2": "=A1+RiskOutput()"}), trials=TRIALS)
    lost = run.error_trials / TRIALS
    assert abs(lost - 0.5) < 5 * 0.5 / math.sqrt(TRIALS)


@pytest.mark.parametrize(
    ("cells", "where", "message"),
    [
        ({"A1": "=RiskSplice(1,2)", "A2": "=A1+RiskOutput()"}, "S!A1", "RiskSplice is not supported"),
        ({"A1": "=RiskNormal(1,-1)+RiskOutput()"}, "S!A1", "Std dev (-1) must be above 0"),
        ({"A1": "=RiskMean(A3)", "A2": "=RAND()+A1", "A3": "=A2*2"}, "S!A1", "RiskMean shows results of the run"),
        ({"A1": "=RiskNormal(A2,1)", "A2": "=A1+RiskOutput()"}, "S!A1", "need each other in a circle"),
        ({"A1": "=RiskDiscrete({1,2},{0.5,-1})+RiskOutput()"}, "S!A1", "-1"),
        ({"A1": "=RiskNormalAlt(10%,8,90%,7)+RiskOutput()"}, "S!A1", "P10 (8) is not below P90 (7)"),
        ({"A1": "=SUM(RANDARRAY(100,100))+RAND()+RiskOutput()"}, "S!A1", "10,001 draws in cells"),
        ({"A1": "=RAND()"}, "book.xlsx", "marks no cell as an answer"),
    ],
)
def test_what_is_refused(model, cells, where, message):
    with pytest.raises(XlmcError) as refused:
        model(cells)
    assert message in str(refused.value)
    assert where in str(refused.value)
    assert refused.value.hint


def test_beside_tables(tmp_path):
    """A parameter cell of a table that draws makes the assumption's parameter vary; filters ask draws, too."""
    path = tmp_path / "book.xlsx"
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("S")
        sheet.write_row("A2", ["x", 1, "Normal"])
        sheet.write_formula("D2", "=RiskUniform(10,20)", value=15)
        sheet.write("E2", 1)
        headings = ["Name", "Value", "Distribution", "Mean", "Std dev"]
        sheet.add_table("A1:E2", {"name": "xlmc_assumptions", "columns": [{"header": h} for h in headings]})
        sheet.write_row("A5", ["answer"])
        sheet.write_formula("B5", "=B2+RAND()", value=1)
        sheet.add_table("A4:B5", {"name": "xlmc_forecasts", "columns": [{"header": h} for h in ("Name", "Value")]})
        sheet.write_row("A8", ["mean"])
        sheet.write_formula("B8", "=D2", value=15)
        sheet.write("C8", 15)
        columns = [{"header": h} for h in ("Name", "Value", "Below")]
        sheet.add_table("A7:C8", {"name": "xlmc_filters", "columns": columns})
    run = simulated(load(path), trials=TRIALS, seed=999)
    assert abs(run.acceptance.value - 0.5) < 5 * 0.5 / math.sqrt(TRIALS)
    deviation = math.sqrt(25 / 12 + 1 + 1 / 12)
    assert abs(run["answer"].mean.value - 13) < 5 * deviation / math.sqrt(run.accepted)


def test_what_has_no_mean_says_so(model):
    """And with cutoffs at both ends it has one."""
    cells = {
        "A1": "=RiskCauchy(0,1)",
        "A2": "=RiskCauchy(0,1,RiskTruncate(-5,5))",
        "A3": "=RiskLevy(0,1,RiskTruncate(1,))",
        "A4": "=RiskPareto(1.5,1)",
        "A5": "=SUM(A1:A4)+RiskOutput()",
    }
    expected = [notice for notice in model(cells).notices if "has no finite mean" in notice.message]
    assert [str(notice.where) for notice in expected] == ["S!A1", "S!A3"]
    assert "'S!A1#1' (Cauchy) has no finite mean" in expected[0].message


def test_draws_that_nothing_needs_are_told_of_together(model):
    cells = {f"A{i}": "=RAND()" for i in range(1, 6)} | {"B1": "=RiskOutput()+A1"}
    notices = model(cells).notices
    assert [(str(n.where), n.message) for n in notices] == [
        ("S!A2#1", "No forecast or filter needs 4 draws in cells, of which this is the first")
    ]


SUMS = {
    # claims of a year: mean 5·10,000, variance 5·(mean square of an amount)
    '=RiskOutput("a")+RiskCompound(RiskPoisson(5),RiskLognorm(10000,10000))': (50_000, math.sqrt(5 * 2e8)),
    # of each amount, 500 are deducted, and at most 2,000 count
    '=RiskOutput("b")+RiskCompound(RiskPoisson(5),RiskExpon(1000),500,2000)': (
        5 * 1000 * (math.exp(-0.5) - math.exp(-2.5)),
        math.sqrt(5 * math.exp(-0.5) * 2e6 * (1 - 3 * math.exp(-2))),
    ),
    # a risk that occurs or not
    '=RiskOutput("c")+RiskCompound(RiskBinomial(1,0.4),RiskNormal(100,10))': (40, math.sqrt(0.4 * 100 + 0.24 * 1e4)),
    # frequency and severity in cells of their own; a frequency whose rate is drawn
    '=RiskOutput("d")+RiskCompound(B1,B2)': (30, math.sqrt(3 * 20 + 3 * 100)),
    '=RiskOutput("e")+RiskCompound(RiskPoisson(RiskGamma(3,2)),RiskUniform(0,2))': (6, math.sqrt(6 / 3 + 18)),
    # a value of each trial that stays the same for all amounts
    '=RiskOutput("f")+RiskCompound(RiskPoisson(4),B3)': (40, math.sqrt(20 * (100 + 4) - 1600)),
    # amounts cut off and shifted, counts of a continuous distribution cut to whole numbers
    '=RiskOutput("g")+RiskCompound(RiskUniform(0,4),RiskNormal(0,1,RiskTruncate(0,),RiskShift(10)))': (
        1.5 * (10 + math.sqrt(2 / math.pi)),
        math.sqrt(1.5 * (1 - 2 / math.pi) + 1.25 * (10 + math.sqrt(2 / math.pi)) ** 2),
    ),
    '=RiskOutput("h")+RiskMakeInput(RiskNormal(5,1)+RiskNormal(3,1),RiskName("x"))': (8, math.sqrt(2)),
    '=RiskOutput("i")+RiskNormal(0,1)+RiskSimtable({10,20,30})': (10, 1),
    '=RiskOutput("j")+RiskNormal(0,1)+RiskSimtable(C1:C3)': (7, 1),
}


def test_sums_and_values(model):
    """Within 5 standard errors, as the books above."""
    cells = {f"A{row}": formula for row, formula in enumerate(SUMS, start=1)}
    cells |= {"B1": "=RiskPoisson(3)", "B2": "=RiskNormal(10,SQRT(20))", "B3": "=B4*2", "B4": "=RiskNormal(5,1)"}
    made = model({**cells, "C1": 7, "C2": 8, "C3": 9})
    expected = [str(notice.where) for notice in made.notices if "a run uses the first" in notice.message]
    assert expected == ["S!A9"]
    run = simulated(made, trials=TRIALS, seed=999)
    for name, (mean, deviation) in zip("abcdefghij", SUMS.values(), strict=True):
        assert abs(run[name].mean.value - mean) < 5 * deviation / math.sqrt(TRIALS), name
        assert abs(run[name].standard_deviation.value - deviation) < 5 * run[name].standard_deviation.error, name
    bases = {a.name: a.base for a in made.assumptions}
    assert bases["S!A1#1"] == pytest.approx(50_000)
    assert bases["S!A2#1"] == pytest.approx(SUMS[cells["A2"]][0], rel=1e-9)


def test_a_correlated_frequency(model):
    """The ranks of the counts have the correlation; a compound that is correlated itself is refused."""
    cells = {
        "F1": 1, "F2": 0.7, "G2": 1,
        "A1": "=RiskCompound(RiskPoisson(50,RiskCorrmat(F1:G2,1)),1)",
        "A2": "=RiskNormal(0,1,RiskCorrmat(F1:G2,2))",
        "A3": "=A1+A2+RiskOutput()",
    }  # fmt: skip
    inputs = simulated(model(cells), trials=TRIALS, seed=999).inputs
    result = stats.spearmanr(inputs["S!A1#1"], inputs["S!A2#1"]).statistic
    assert abs(result - 0.7) < 5 / math.sqrt(TRIALS)
    for formula, message in (
        ("=RiskCompound(RiskPoisson(50),1,RiskCorrmat(F1:G2,1))", "RiskCompound itself cannot be correlated"),
        ("=RiskCompound(3,RiskNormal(1,1,RiskCorrmat(F1:G2,1)))", "The severity of RiskCompound cannot be correlated"),
        ("=RiskCompound(3,RiskNormal(1,1,RiskCopula(F1:G2,1)))", "The severity of RiskCompound cannot be correlated"),
        ("=RiskCompound(RiskPoisson(5),2*RiskExpon(3))", "The severity of RiskCompound is a formula that draws"),
        ("=RiskCompound(RiskPoisson(5),RiskExpon(3),RiskTruncate(1,2))", "RiskCompound cannot be cut off"),
        ("=RiskCompound(RiskPoisson(5))", "RiskCompound has 1 arguments"),
        ("=RiskNormal(1,1,RiskLibrary(1,2))", "RiskLibrary replaces the distribution"),
        ("=RiskSimtable()", "RiskSimtable has 0 arguments"),
    ):
        with pytest.raises(XlmcError) as refused:
            model({**cells, "A1": formula})
        assert str(refused.value).startswith(f"S!A1: {message}"), formula
        assert refused.value.hint


def test_simtables_are_scenarios(model):
    """With common random numbers, the means differ by as much as the values, with hardly any error."""
    cells = {
        "A1": "=RiskNormal(RiskSimtable({10,20,40}),1)",
        "A2": "=A1+RiskSimtable(C1:C3)+RiskOutput()",
        "C1": 0, "C2": 1, "C3": 2,
    }  # fmt: skip
    made = model(cells)
    assert [each.name for each in made.definitions.scenarios] == ["simulation 2", "simulation 3"]
    run = simulated(made, trials=2000, seed=999, scenarios=True)
    own, *others = scenario_answers(run)
    assert own.forecasts[0].mean.value == run["S!A2"].mean.value
    for answer, difference in zip(others, (11, 32), strict=True):
        result = answer.forecasts[0].differences["mean"]
        assert result.value == pytest.approx(difference, rel=1e-12)
        assert result.error < 1e-9
    short = model({**cells, "A2": "=A1+RiskSimtable(C1:C2)+RiskOutput()"})
    with pytest.raises(XlmcError, match="RiskSimtable has 2 values, and value 3 is asked for"):
        model_of(short, "simulation 3")
