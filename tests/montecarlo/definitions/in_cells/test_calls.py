"""Every function that draws: formula -> family, parameters and cutoffs as understood; and what is refused, and how."""

from __future__ import annotations

from pathlib import Path

import pytest

from xlmc.engine.engines import ENGINES
from xlmc.errors import FormulaError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.workbook.workbook import CellContent, Formula
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.definitions.in_cells.crystal_ball_functions import CRYSTAL_BALL
from xlmc.montecarlo.definitions.in_cells.random_functions import INVERSES
from xlmc.montecarlo.definitions.in_cells.result_functions import RESULTS
from xlmc.montecarlo.definitions.in_cells.risk_functions import ALTERNATES, RISK
from xlmc.montecarlo.definitions.in_cells.suspects import holds_call

A1, A2 = Cell("S", 1, 1), Cell("S", 2, 1)
HERE = Cell("S", 9, 9)


def part(label):
    return InFormula.of(HERE, label)


DRAWS = {
    # Crystal Ball
    "CB.Uniform(1,2)": ("Uniform", {"low": 1, "high": 2}),
    "CB.Triangular(1,2,4)": ("Triangular", {"low": 1, "likeliest": 2, "high": 4}),
    "CB.Normal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "CB.Lognormal(5,2)": ("Lognormal", {"location": 0, "mean": 5, "std_dev": 2}),
    "CB.Lognormal2(1,5,2)": ("Lognormal", {"location": 1, "mean": 5, "std_dev": 2}),
    "CB.BetaPERT(1,2,4)": ("BetaPERT", {"low": 1, "likeliest": 2, "high": 4}),
    "CB.Beta(2,3,10)": ("Beta", {"low": 0, "high": 10, "alpha": 2, "beta": 3}),
    "CB.Beta2(1,10,2,3)": ("Beta", {"low": 1, "high": 10, "alpha": 2, "beta": 3}),
    "CB.Gamma(1,2,3)": ("Gamma", {"location": 1, "scale": 2, "shape": 3}),
    "CB.Weibull(1,2,3)": ("Weibull", {"location": 1, "scale": 2, "shape": 3}),
    "CB.Exponential(0.5)": ("Exponential", {"rate": 0.5}),
    "CB.Logistic(5,2)": ("Logistic", {"mean": 5, "scale": 2}),
    "CB.Pareto(1,3)": ("Pareto", {"location": 1, "shape": 3}),
    "CB.StudentT(1,2,5)": ("Student's t", {"midpoint": 1, "scale": 2, "degrees": 5}),
    "CB.MaxExtreme(5,2)": ("Maximum Extreme", {"likeliest": 5, "scale": 2}),
    "CB.MinExtreme(5,2)": ("Minimum Extreme", {"likeliest": 5, "scale": 2}),
    "CB.Custom(C1:D2)": ("Custom", {}),
    "CB.DiscreteUniform(1,6)": ("Discrete Uniform", {"low": 1, "high": 6}),
    "CB.Binomial(0.3,20)": ("Binomial", {"probability": 0.3, "trials": 20}),
    "CB.YesNo(0.3)": ("Yes-No", {"probability": 0.3}),
    "CB.Poisson(4)": ("Poisson", {"rate": 4}),
    "CB.Geometric(0.25)": ("Geometric", {"probability": 0.25}),
    "CB.NegBinomial(0.25,3)": ("Negative Binomial", {"probability": 0.25, "shape": 3}),
    "CB.Hypergeometric(0.4,10,50)": (
        "Hypergeometric",
        {"success": part("1 success"), "trials": 10, "population": 50},
    ),
    "CB.Hypergeometric2(20,10,50)": ("Hypergeometric", {"success": 20, "trials": 10, "population": 50}),
    "CB.Normal(5,2,1)": ("Normal", {"mean": 5, "std_dev": 2}, 1, None),
    "CB.Normal(5,2,,9)": ("Normal", {"mean": 5, "std_dev": 2}, None, 9),
    'CB.Normal(5,2,1,9,"speed")': ("Normal", {"mean": 5, "std_dev": 2}, 1, 9),
    "_xll.CB.Normal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "_xludf.RiskNormal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "_xlfn.RANDARRAY(1,1,1,6)+1": ("Uniform", {"low": 1, "high": 6}),
    "[1]!CB.Normal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "'C:\\Add-ins\\CB.xla'!CB.Normal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "cb.normal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    # @RISK and XLRisk
    "RiskUniform(1,2)": ("Uniform", {"low": 1, "high": 2}),
    "RiskNormal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "RiskTriang(1,2,4)": ("Triangular", {"low": 1, "likeliest": 2, "high": 4}),
    "RiskPert(1,2,4)": ("BetaPERT", {"low": 1, "likeliest": 2, "high": 4}),
    "RiskLognorm(5,2)": ("Lognormal", {"location": 0, "mean": 5, "std_dev": 2}),
    "RiskLognorm2(1,0.5)": ("Lognorm2", {"location": 0, "mu": 1, "sigma": 0.5}),
    "RiskDiscrete({1,2,3},{0.2,0.3,0.5})": ("Discrete", {}),
    "RiskDUniform({1,2,3})": ("DUniform", {}),
    "RiskHistogrm(0,3,{1,4,2})": ("Histogrm", {"low": 0, "high": 3}),
    "RiskCumul(0,3,{1,2},{0.2,0.7})": ("Cumul", {"low": 0, "high": 3}),
    "RiskGeneral(0,3,{1,2},{2,1})": ("General", {"low": 0, "high": 3}),
    "RiskTrigen(1,2,4,10,90)": (
        "Trigen",
        {"bottom": 1, "likeliest": 2, "top": 4, "bottom_percent": 10, "top_percent": 90},
    ),
    "RiskBeta(2,3)": ("Beta", {"low": 0, "high": 1, "alpha": 2, "beta": 3}),
    "RiskBetaGeneral(2,3,1,10)": ("Beta", {"low": 1, "high": 10, "alpha": 2, "beta": 3}),
    "RiskGamma(3,2)": ("Gamma", {"location": 0, "scale": 2, "shape": 3}),
    "RiskErlang(3,2)": ("Gamma", {"location": 0, "scale": 2, "shape": 3}),
    "RiskChiSq(7)": ("Gamma", {"location": 0, "scale": 2, "shape": 3.5}),
    "RiskWeibull(3,2)": ("Weibull", {"location": 0, "scale": 2, "shape": 3}),
    "RiskRayleigh(1)": ("Weibull", {"location": 0, "scale": 2**0.5, "shape": 2}),
    "RiskExpon(4)": ("Exponential", {"rate": 0.25}),
    "RiskLogistic(5,2)": ("Logistic", {"mean": 5, "scale": 2}),
    "RiskPareto(3,1)": ("Pareto", {"location": 1, "shape": 3}),
    "RiskStudent(5)": ("Student's t", {"midpoint": 0, "scale": 1, "degrees": 5}),
    "RiskBinomial(20,0.3)": ("Binomial", {"probability": 0.3, "trials": 20}),
    "RiskBernoulli(0.3)": ("Yes-No", {"probability": 0.3}),
    "RiskPoisson(4)": ("Poisson", {"rate": 4}),
    "RiskNegbin(3,0.25)": ("Negbin", {"probability": 0.25, "shape": 3}),
    "RiskGeomet(0.25)": ("Geomet", {"probability": 0.25}),
    "RiskHypergeo(10,20,50)": ("Hypergeometric", {"success": 20, "trials": 10, "population": 50}),
    "RiskIntUniform(1,6)": ("Discrete Uniform", {"low": 1, "high": 6}),
    "RiskExtvalue(5,2)": ("Maximum Extreme", {"likeliest": 5, "scale": 2}),
    "RiskExtvalueMin(5,2)": ("Minimum Extreme", {"likeliest": 5, "scale": 2}),
    "RiskTrigen(1,2,4,0.1,90%)": (
        "Trigen",
        {"bottom": 1, "likeliest": 2, "top": 4, "bottom_percent": 10, "top_percent": 90},
    ),
    "RiskBetaSubj(0,2,3,10)": ("BetaSubj", {"low": 0, "likeliest": 2, "mean": 3, "high": 10}),
    "RiskBurr12(1,2,3,1.5)": ("Burr12", {"location": 1, "scale": 2, "shape_1": 3, "shape_2": 1.5}),
    "RiskCauchy(10,2)": ("Cauchy", {"location": 10, "scale": 2}),
    "RiskCumulD(0,3,{1,2},{0.8,0.3})": ("CumulD", {"low": 0, "high": 3}),
    "RiskDagum(1,2,3,1.5)": ("Dagum", {"location": 1, "scale": 2, "shape_1": 3, "shape_2": 1.5}),
    "RiskDoubleTriang(0,4,10,0.76)": ("DoubleTriang", {"low": 0, "likeliest": 4, "high": 10, "lower_share": 0.76}),
    "RiskErf(2)": ("Normal", {"mean": 0, "std_dev": 0.5**0.5 / 2}),
    "RiskF(3,10)": ("F", {"degrees_1": 3, "degrees_2": 10}),
    "RiskFatigueLife(1,2,0.5)": ("Fatigue life", {"location": 1, "scale": 2, "shape": 0.5}),
    "RiskFrechet(1,2,3)": ("Frechet", {"location": 1, "scale": 2, "shape": 3}),
    "RiskHypSecant(10,2)": ("Hyperbolic secant", {"mean": 10, "std_dev": 2}),
    "RiskInvGauss(3,5)": ("Inverse Gaussian", {"location": 0, "mean": 3, "shape": 5}),
    "RiskJohnsonMoments(10,2,0.5,5)": (
        "Johnson moments",
        {"mean": 10, "std_dev": 2, "skewness": 0.5, "kurtosis": 5},
    ),
    "RiskJohnsonSB(1,2,10,20)": ("Johnson SB", {"shape_1": 1, "shape_2": 2, "low": 10, "high": 20}),
    "RiskJohnsonSU(-1,2,10,3)": ("Johnson SU", {"shape_1": -1, "shape_2": 2, "location": 10, "scale": 3}),
    "RiskKumaraswamy(2,3,0,10)": ("Kumaraswamy", {"shape_1": 2, "shape_2": 3, "low": 0, "high": 10}),
    "RiskLaplace(10,2)": ("Laplace", {"mean": 10, "std_dev": 2}),
    "RiskLevy(1,2)": ("Levy", {"location": 1, "scale": 2}),
    "RiskLogLogistic(1,2,3)": ("Log-logistic", {"location": 1, "scale": 2, "shape": 3}),
    "RiskPareto2(2,3)": ("Pareto2", {"location": 0, "scale": 2, "shape": 3}),
    "RiskPearson5(3,2)": ("Pearson5", {"location": 0, "scale": 2, "shape": 3}),
    "RiskPearson6(3,4,2)": ("Pearson6", {"location": 0, "scale": 2, "shape_1": 3, "shape_2": 4}),
    "RiskReciprocal(1,100)": ("Reciprocal", {"low": 1, "high": 100}),
    "_xll.RiskNormal(5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "RiskNormal(5,2,RiskTruncate(1,9))": ("Normal", {"mean": 5, "std_dev": 2}, 1, 9),
    "RiskNormal(5,2,RiskTruncate(,9))": ("Normal", {"mean": 5, "std_dev": 2}, None, 9),
    "RiskNormal(5,2,RiskShift(10),RiskTruncate(1,9))": ("Normal", {"mean": 5, "std_dev": 2}, 1, 9),
    "RiskNormal(5,2,RiskTruncate2(11,19),RiskShift(10))": ("Normal", {"mean": 5, "std_dev": 2}, 1, 9),
    "RiskUniform(0,10,RiskTruncateP(0.1,0.7))": ("Uniform", {"low": 0, "high": 10}, 1, 7),
    "RiskUniform(0,10,RiskTruncateP(10%))": ("Uniform", {"low": 0, "high": 10}, 1, None),
    # @RISK by percentiles
    "RiskNormalAlt(10%,8,90%,12)": ("Normal", {"p10": 8, "p90": 12}),
    'RiskNormalAlt("mu",10,90%,12)': ("Normal", {"mean": 10, "p90": 12}),
    'RiskNormalAlt("mu",10,"sigma",2)': ("Normal", {"mean": 10, "std_dev": 2}),
    "RiskNormalAltD(10%,12,90%,8)": ("Normal", {"p10": 8, "p90": 12}),
    'RiskTriangAlt("min",0,"m. likely",3,90%,8)': ("Triangular", {"low": 0, "likeliest": 3, "p90": 8}),
    'RiskPertAlt(5%,1,"M. Likely",3,0.95,8)': ("BetaPERT", {"p5": 1, "likeliest": 3, "p95": 8}),
    'RiskLognormAlt("mu",5,"sigma",2,"loc",1)': ("Lognormal", {"location": 1, "mean": 6, "std_dev": 2}),
    'RiskLognorm2Alt("mu",1,90%,8)': ("Lognorm2", {"mu": 1, "p90": 8}),
    'RiskExponAlt("beta",4)': ("Exponential", {"rate": 0.25}),
    "RiskExponAlt(50%,4)": ("Exponential", {"p50": 4}),
    'RiskGammaAlt("alpha",3,90%,8)': ("Gamma", {"shape": 3, "p90": 8}),
    'RiskWeibullAlt("alpha",3,90%,8)': ("Weibull", {"shape": 3, "p90": 8}),
    'RiskLogisticAlt("alpha",5,90%,8)': ("Logistic", {"mean": 5, "p90": 8}),
    'RiskParetoAlt("theta",3,90%,8)': ("Pareto", {"shape": 3, "p90": 8}),
    'RiskExtvalueAlt("a",5,90%,8)': ("Maximum Extreme", {"likeliest": 5, "p90": 8}),
    'RiskExtvalueMinAlt("a",5,90%,8)': ("Minimum Extreme", {"likeliest": 5, "p90": 8}),
    'RiskBetaGeneralAlt("alpha1",2,"alpha2",3,"min",1,90%,8)': ("Beta", {"low": 1, "alpha": 2, "beta": 3, "p90": 8}),
    'RiskStudentAlt("nu",5)': ("Student's t", {"midpoint": 0, "scale": 1, "degrees": 5}),
    'RiskBurr12Alt("gamma",1,"alpha1",3,"alpha2",2,90%,8)': (
        "Burr12",
        {"location": 1, "shape_1": 3, "shape_2": 2, "p90": 8},
    ),
    "RiskCauchyAlt(25%,3,75%,5)": ("Cauchy", {"p25": 3, "p75": 5}),
    'RiskChiSqAlt("nu",7)': ("Gamma", {"scale": 2, "shape": 3.5}),
    'RiskDagumAlt("alpha1",3,"alpha2",2,90%,8)': ("Dagum", {"shape_1": 3, "shape_2": 2, "p90": 8}),
    "RiskErfAlt(90%,8)": ("Normal", {"mean": 0, "p90": 8}),
    'RiskFatigueLifeAlt("alpha",0.5,90%,8)': ("Fatigue life", {"shape": 0.5, "p90": 8}),
    'RiskFrechetAlt("alpha",3,90%,8)': ("Frechet", {"shape": 3, "p90": 8}),
    'RiskHypSecantAlt("gamma",3,90%,8)': ("Hyperbolic secant", {"mean": 3, "p90": 8}),
    'RiskInvGaussAlt("mu",3,"lambda",5,"loc",1)': ("Inverse Gaussian", {"location": 1, "mean": 4, "shape": 5}),
    'RiskKumaraswamyAlt("alpha1",2,"alpha2",3,"min",1,90%,8)': (
        "Kumaraswamy",
        {"low": 1, "shape_1": 2, "shape_2": 3, "p90": 8},
    ),
    "RiskLaplaceAlt(10%,3,90%,8)": ("Laplace", {"p10": 3, "p90": 8}),
    'RiskLevyAlt("a",1,50%,8)': ("Levy", {"location": 1, "p50": 8}),
    'RiskLogLogisticAlt("gamma",1,"alpha",3,90%,8)': ("Log-logistic", {"location": 1, "shape": 3, "p90": 8}),
    'RiskPareto2Alt("q",3,90%,8)': ("Pareto2", {"shape": 3, "p90": 8}),
    'RiskPearson5Alt("alpha",3,90%,8)': ("Pearson5", {"shape": 3, "p90": 8}),
    'RiskPearson6Alt("alpha1",3,"alpha2",4,90%,8)': ("Pearson6", {"shape_1": 3, "shape_2": 4, "p90": 8}),
    "RiskRayleighAlt(50%,3)": ("Weibull", {"shape": 2, "p50": 3}),
    "RiskUniformAlt(25%,3,75%,5)": ("Uniform", {"low": 2, "high": 6}),
    'RiskUniformAlt("min",2,75%,5)': ("Uniform", {"low": 2, "high": 6}),
    # Excel
    "RAND()": ("Uniform", {"low": 0, "high": 1}),
    "RANDBETWEEN(1,6)": ("Discrete Uniform", {"low": 1, "high": 6}),
    "RANDBETWEEN(-1.5,2.5)": ("Discrete Uniform", {"low": -1, "high": 2}),
    "NORM.INV(RAND(),5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "NORMINV(RAND(),5,2)": ("Normal", {"mean": 5, "std_dev": 2}),
    "_xlfn.NORM.S.INV(RAND())": ("Normal", {"mean": 0, "std_dev": 1}),
    "NORMSINV(RAND())": ("Normal", {"mean": 0, "std_dev": 1}),
    "BETA.INV(RAND(),2,3)": ("Beta", {"low": 0, "high": 1, "alpha": 2, "beta": 3}),
    "BETAINV(RAND(),2,3,1,10)": ("Beta", {"low": 1, "high": 10, "alpha": 2, "beta": 3}),
    "GAMMA.INV(RAND(),3,2)": ("Gamma", {"location": 0, "scale": 2, "shape": 3}),
    "GAMMAINV(RAND(),3,2)": ("Gamma", {"location": 0, "scale": 2, "shape": 3}),
    "LOGNORM.INV(RAND(),1,0.5)": ("Lognorm2", {"location": 0, "mu": 1, "sigma": 0.5}),
    "LOGINV(RAND(),1,0.5)": ("Lognorm2", {"location": 0, "mu": 1, "sigma": 0.5}),
    "T.INV(RAND(),5.9)": ("Student's t", {"midpoint": 0, "scale": 1, "degrees": 5}),
    "CHISQ.INV(RAND(),7)": ("Gamma", {"location": 0, "scale": 2, "shape": 3.5}),
    "BINOM.INV(20,0.3,RAND())": ("Binomial", {"probability": 0.3, "trials": 20}),
    "CRITBINOM(20,0.3,RAND())": ("Binomial", {"probability": 0.3, "trials": 20}),
    "-LN(RAND())/4": ("Exponential", {"rate": 1}),
    "NORM.INV(1-RAND(),5,2)": ("Uniform", {"low": 0, "high": 1}),
    # arguments that are cells and expressions
    "RiskNormal(A1,A2)": ("Normal", {"mean": A1, "std_dev": A2}),
    "RiskNormal(A1*2,SUM(A1:A2))": ("Normal", {"mean": part("1 mean"), "std_dev": part("1 std_dev")}),
    "RiskNormal(Rate,2)": ("Normal", {"mean": A1, "std_dev": 2}),
    "10+RiskNormal(-5,(1+1)/4)*2": ("Normal", {"mean": -5, "std_dev": 0.5}),
    "RiskExpon(A1)": ("Exponential", {"rate": part("1 rate")}),
    "LET(x,RiskNormal(5,2),x*x)": ("Normal", {"mean": 5, "std_dev": 2}),
}


@pytest.fixture
def understood(workbook):
    def read(formula, **cells):
        values = {"C1": 1.0, "C2": 2.0, "D1": 3.0, "D2": 1.0, "A1": 4.0, "A2": 2.0, "P1": "low", **cells}
        book = workbook({**values, "I9": f"={formula}", "Z1": "=RiskOutput()+I9"}, names={"Rate": "S!$A$1"})
        return read_definitions(book, ENGINES)

    return read


@pytest.mark.parametrize("formula", DRAWS)
def test_what_is_drawn(understood, formula):
    family, parameters, *cutoffs = DRAWS[formula]
    result = understood(formula)
    assert result.problems == ()
    (drawn,) = result.assumptions
    assert drawn.distribution == drawn.family.name == family
    assert drawn.parameters == pytest.approx(parameters) if _all_numbers(parameters) else drawn.parameters == parameters
    assert [*map(drawn.cutoffs.get, ("lower_cutoff", "upper_cutoff"))] == (cutoffs or [None, None])
    assert (drawn.cell, str(drawn.cell), drawn.row) == (part("1"), "S!I9#1", HERE)


def _all_numbers(parameters):
    return not any(isinstance(value, Cell) for value in parameters.values())


def test_every_function_has_a_row():
    tested = " ".join(DRAWS).upper()
    functions = [*CRYSTAL_BALL, *RISK, *INVERSES, *(f"{name}Alt" for name in ALTERNATES)]
    assert [name for name in functions if f"{name.upper()}(" not in tested] == []


DATA = {
    "CB.Custom(C1:D2)": ((1.0, 3.0), (2.0, 1.0)),
    "CB.Custom({5;6})": ((5.0,), (6.0,)),
    "RiskDiscrete({1,2},{0.2,0.8})": ((1.0, 0.2), (2.0, 0.8)),
    "RiskDiscrete(C1:C2,D1:D2)": ((1.0, 3.0), (2.0, 1.0)),
    "RiskDiscrete(C1:C2,{1,3})": ((1.0, 1.0), (2.0, 3.0)),
    "RiskDUniform(C1:D2)": ((1.0,), (3.0,), (2.0,), (1.0,)),
    "RiskHistogrm(0,3,{1,4,2})": ((1.0,), (4.0,), (2.0,)),
    "RiskCumul(0,3,{1,2},{0.2,0.7})": ((1.0, 0.2), (2.0, 0.7)),
}


@pytest.mark.parametrize("formula", DATA)
def test_data(understood, formula):
    (drawn,) = understood(formula).assumptions
    assert drawn.data.rows == DATA[formula]


def test_properties(understood):
    result = understood('RiskNormal(5,2,RiskName("speed"),RiskUnits("mph"),RiskStatic(4),RiskSeed(1,2),RiskLock())')
    (drawn,) = result.assumptions
    assert (drawn.name, drawn.units, drawn.base, drawn.frozen) == ("speed", "mph", 4.0, True)
    assert [notice.message.split()[0] for notice in result.notices] == ["RiskSeed"]


def test_a_name_may_stand_in_a_cell(understood):
    (drawn,) = understood("RiskNormal(5,2,RiskName(A3))", A3="speed").assumptions
    assert drawn.name == "speed"


NAMED = {
    '"fast "&"car"': "fast car",
    'A3&" cost"': "labor cost",
    'UPPER(A3)&" in "&A4': "LABOR in 2020",
    'CONCATENATE("Year ",TEXT(A4+1,"0"))': "Year 2021",
    "A5": "labor/7",
    'IF(A4>2000,"new","old")': "new",
}


@pytest.mark.parametrize("expression", NAMED)
def test_names_may_be_expressions_of_constants(understood, expression):
    """A5 was never calculated."""
    cells = {"A3": "labor", "A4": 2020.0, "A5": '=A3&"/"&7'}
    (drawn,) = understood(f"RiskNormal(5,2,RiskName({expression}),RiskUnits({expression}))", **cells).assumptions
    assert (drawn.name, drawn.units) == (NAMED[expression], NAMED[expression])


@pytest.mark.parametrize("expression", ["A3&RiskNormal(0,1)", "RAND()", "NoSuch&1", "1/0", "A3&Nothing()"])
def test_names_that_are_no_constant_texts_are_refused(understood, expression):
    result = understood(f'RiskNormal(5,2,RiskName({expression}))+RiskOutput("x")', A3="labor")
    (problem,) = result.problems
    assert problem.where == "S!I9"


TRUNCATED = {
    "RiskTnormal(5,2,1,9)": "RiskNormal(5,2,RiskTruncate(1,9))",
    "RiskTlognorm(5,2,,9)": "RiskLognorm(5,2,RiskTruncate(,9))",
    "RISKTEXPON(3,1,9,RiskShift(2))": "RiskExpon(3,RiskTruncate(1,9),RiskShift(2))",
    "RiskTWeibull(2,3,1,9)": "RiskWeibull(2,3,RiskTruncate(1,9))",
    "RiskTstudent(4,-1,A1)": "RiskStudent(4,RiskTruncate(-1,A1))",
}


@pytest.mark.parametrize("formula", TRUNCATED)
def test_forms_of_earlier_versions_are_cut_off_by_their_last_numbers(understood, formula):
    one, other = (understood(each).assumptions[0] for each in (formula, TRUNCATED[formula]))
    assert (one.distribution, one.given, one.base) == (other.distribution, other.given, other.base)


BASES = {
    "RiskNormal(5,2)": 5,
    "RiskNormal(A1,2)": 4,
    "RiskNormal(A1*2,2)": 8,
    "RiskNormal(RiskUniform(0,6),1)": 3,
    "RiskUniform(0,10,RiskTruncate(2,4))": 3,
    "RiskNormal(5,2,RiskShift(10),RiskStatic(16))": 6,
    "RiskDiscrete({1,2},{0.25,0.75})": 1.75,
    "RiskStudent(1)": None,
    "RAND()": 0.5,
    "RiskIntUniform(1,6,RiskTruncate(1.5,4))": 3,
    "RiskBinomial(2,0.5,RiskTruncate(1,))": 4 / 3,
    "RiskDiscrete({1,5,9},{1,2,3},RiskTruncate(2,))": 7.4,
    "RiskBeta(2,6,10,50)": 20,
}


@pytest.mark.parametrize("formula", BASES)
def test_the_base_case_is_the_static_value_or_the_mean(understood, formula):
    drawn = understood(formula).assumptions[0]
    assert drawn.base == (BASES[formula] if BASES[formula] is None else pytest.approx(BASES[formula], rel=1e-12))


def test_calls_are_counted_from_the_left_and_from_without(understood):
    result = understood("RAND()+RiskNormal(RiskUniform(1,2),RiskTriang(1,2,3))*NORM.INV(RAND(),0,1)")
    assert {a.name: a.distribution for a in result.assumptions} == {
        "S!I9#1": "Uniform",
        "S!I9#2": "Normal",
        "S!I9#3": "Uniform",
        "S!I9#4": "Triangular",
        "S!I9#5": "Normal",
    }


def test_an_array_of_draws(understood):
    result = understood("SUM(RANDARRAY(2,3,1,6,TRUE))")
    assert [a.name for a in result.assumptions] == [f"S!I9#1({r},{c})" for r in (1, 2) for c in (1, 2, 3)]
    assert {a.distribution for a in result.assumptions} == {"Discrete Uniform"}


def test_one_name_for_two(workbook):
    cells = {"A1": '=RiskNormal(1,1,RiskName("x"))', "A2": '=RiskNormal(2,1,RiskName("X"))', "A3": "=RiskOutput()+A1"}
    result = read_definitions(workbook(cells), ENGINES)
    assert [a.name for a in result.assumptions] == ["x", "X (S!A2#1)"]
    assert "Another assumption is called 'X'" in result.notices[0].message


@pytest.mark.parametrize(
    ("setting", "family", "noticed"),
    [(None, "Lognormal", True), ("@RISK", "Lognormal", False), ("xlrisk", "Lognorm2", False)],
)
def test_lognorm_of_xlrisk(workbook, table, setting, family, noticed):
    cells = {"A1": "=RiskLogNorm(1,0.5)+RiskOutput()", "C1": "Setting", "D1": "Value"}
    cells |= {"C2": "Lognorm", "D2": setting} if setting else {"C2": "Seed", "D2": 1}
    result = read_definitions(workbook(cells, tables=[table("xlmc_settings", "C1:D2", "Setting", "Value")]), ENGINES)
    assert result.assumptions[0].distribution == family
    assert any("XLRisk" in notice.message for notice in result.notices) == noticed


REFUSED = {
    "RiskSplice(1,2)": "the function RiskSplice is not supported",
    "CB.Bang(1)": "the function CB.BANG is not supported",
    "RiskTruncate(1,2)": "the function RISKTRUNCATE is not supported",
    "RiskNormal(RAND(),1)+RiskTruncate(1,2)": "the function RISKTRUNCATE is not supported",
    "RiskNormal(1)": "RiskNormal has 1 arguments",
    "RiskNormal(,1)": "RiskNormal leaves out its argument 'mean'",
    "CB.Normal(1,2,3,4,5,6)": "CB.Normal has 6 arguments",
    "CB.Custom(C1:D2,1,2)": "CB.Custom has 3 arguments",
    "RiskDiscrete({1,2},{1})": "the lists of RiskDiscrete have 2 and 1 elements",
    "RiskNormal(1,1,RiskTruncate(1,2),RiskTruncateP(0.1,0.2))": "RiskTruncateP beside another like it",
    "RiskNormal(1,1,RiskTruncateP(0.9,0.1))": "RiskTruncateP takes two probabilities",
    "RiskNormal(RAND(),1,RiskTruncateP(0.1,0.9))": "RiskTruncateP of RiskNormal needs parameters that are fixed",
    "RiskNormal(1,1,RiskShift())": "RiskShift has 0 arguments",
    "RiskNormal(1,1,RiskShift(1),5)": "an argument behind its property functions",
    "RiskNormal(1,1,RiskName(Q1))": "RiskName needs a text",
    "RiskNormal(1,1,RiskCorrmat(C1:D1,1))": "RiskCorrmat's matrix is not a square range",
    "RiskNormal(1,1,RiskCorrmat(C1:D2,3))": "RiskCorrmat's position must be a whole number from 1 to 2",
    "RiskNormal(1,1,RiskCorrmat(C1:D2,1E308*10))": "RiskCorrmat's position must be a whole number from 1 to 2",
    "RiskNormal(SQRT(Q1),1,RiskLock())": "RiskNormal is locked, and its value is not known",
    "RiskNormalAlt(10%,8)": "RiskNormalAlt",
    "RiskNormalAlt(10,8,90,12)": "a percentile that is not between 0 and 1",
    'RiskNormalAlt("nu",8,90%,12)': "RiskNormalAlt has no parameter 'nu'",
    "RiskNormalAlt(10%,8,10%,12)": "RiskNormalAlt is given 10 % twice",
    "LET(m,2,RiskNormal(m,1))": "an argument of a draw uses a name that LET binds",
    "SUM(MAP(C1:C2,LAMBDA(x,x*RAND())))": "a LAMBDA draws at random",
    "SUM(RANDARRAY(A1))": "RANDARRAY must have a fixed size of 1 to 10,000 draws",
    "SUM(RANDARRAY(200,100))": "RANDARRAY must have a fixed size of 1 to 10,000 draws",
    "RANDBETWEEN(1)": "RANDBETWEEN takes two numbers",
    "RiskMean(A1)+RAND()": "both draws and shows results",
    "RiskMean(A1)": "RiskMean shows results of the run",
    "RiskDUniform(P1:P2)": "The data cell holds the text 'low', not a number (S!P1)",
    "RiskMean(3)": "RiskMean must name the cell of an output",
}


@pytest.mark.parametrize("formula", REFUSED)
def test_what_is_refused_is_told_of_its_cell(understood, formula):
    error = understood(formula).rewritten[HERE]
    assert isinstance(error, FormulaError)
    assert error.where == "S!I9"
    assert REFUSED[formula] in error.message
    assert error.hint


@pytest.mark.parametrize(
    ("text", "holds"),
    [
        ("A1+rand()", True),
        ("_xll.RiskNormal(1,2)", True),
        ("[1]!CB.GetForeStatFN(A1,2)", True),
        ("_xlfn.RANDARRAY(2)", True),
        ("_xludf.RiskNormal(1,2)+1", True),
        ("'C:\\Risk.xla'!RiskNormal(1,2)", True),
        ('"RAND() is random"&A1', False),
        ("BRAND()+MyRiskNormal(1)", False),
        ("SUM(Risk)", False),
    ],
)
def test_which_formulas_are_looked_at(text, holds):
    assert holds_call(text) == holds


def test_no_answer_is_marked(workbook):
    result = read_definitions(workbook({"A1": "=RAND()"}), ENGINES)
    (problem,) = result.problems
    assert "marks no cell as an answer" in problem.message
    assert "RiskOutput" in problem.hint


def test_outputs(workbook):
    cells = {
        "A1": '=_xll.RiskOutput("Speed",,,RiskUnits("mph"))+RAND()',
        "A2": '=RAND()+RiskOutput(RiskUnits("kg"))',
        "A3": '=RiskOutput("sp"&LOWER("EED"),"all",2,RiskSixSigma(1,2,1.5),RiskConvergence(3%))+RAND()',
        "A4": "=RAND()*3",
        "B4": "=RiskMean(A4)+CB.GetForePercentFN(A4,5)",
        "B5": '=RiskMean("speed")',
        "B6": '=RiskMean("spede")',
        "B7": "=RiskMean(Q7)",
    }
    result = read_definitions(workbook(cells), ENGINES)
    assert [(f.name, f.units) for f in result.forecasts] == [
        ("Speed", "mph"),
        ("S!A2", "kg"),
        ("speed (S!A3)", ""),
        ("S!A4", ""),
    ]
    assert [str(cell) for cell in result.results] == ["S!B4", "S!B5", "S!B6", "S!B7"]
    expected = " ".join(notice.message for notice in result.notices)
    assert "S!A4 is taken for a forecast" in expected
    assert "no forecast is called so" in expected
    assert "which nothing computes" in expected


MATRIX = {"F1": 1.0, "F2": 0.5, "G2": 1.0, "F3": -0.2, "G3": 0.0, "H3": 1.0}


def test_correlations(workbook):
    draws = {f"A{i}": f"=RiskNormal(0,1,RiskCorrmat($F$1:$H$3,{i}))" for i in (1, 2, 3)}
    other = {"B1": '=RiskNormal(0,1,RiskCorrmat(F1:H3,1,"b"))', "B2": '=RiskNormal(0,1,RiskCorrmat(F1:H3,2,"B"))'}
    result = read_definitions(workbook({**MATRIX, **draws, **other, "C1": "=RiskOutput()+SUM(A1:B3)"}), ENGINES)
    assert result.problems == ()
    assert {(c.first, c.second): c.value for c in result.correlations} == {
        ("S!A1#1", "S!A2#1"): 0.5,
        ("S!A1#1", "S!A3#1"): -0.2,
        ("S!B1#1", "S!B2#1"): 0.5,
    }


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"F2": None}, "The cell of a rank correlation is blank"),
        ({"F2": 2.0}, "must lie between -1 and 1"),
        ({"F2": "x"}, "holds the text 'x'"),
        ({"A2": "=RiskNormal(0,1,RiskCorrmat($F$1:$H$3,1))"}, "have the same row of the matrix"),
    ],
)
def test_mistakes_in_a_matrix(workbook, change, message):
    draws = {f"A{i}": f"=RiskNormal(0,1,RiskCorrmat($F$1:$H$3,{i}))" for i in (1, 2)}
    cells = {**MATRIX, **draws, "C1": "=RiskOutput()+SUM(A1:B3)", **change}
    (problem,) = read_definitions(workbook(cells), ENGINES).problems
    assert message in problem.message


TABLE = {"J1": "First", "K1": "Second", "L1": "Correlation", "J2": "S!A1#1", "K2": "S!A2#1", "L2": 0.3}


def test_a_table_may_correlate_draws_in_cells(workbook, table):
    cells = {**TABLE, "A1": "=RAND()", "A2": "=RAND()", "A3": "=RiskOutput()+A1+A2"}
    tables = [table("xlmc_correlations", "J1:L2", "First", "Second", "Correlation")]
    result = read_definitions(workbook(cells, tables=tables), ENGINES)
    assert [(c.first, c.second, c.value) for c in result.correlations] == [("S!A1#1", "S!A2#1", 0.3)]


def test_a_pair_is_correlated_once(workbook, table):
    draws = {f"A{i}": f"=RiskNormal(0,1,RiskCorrmat($F$1:$H$3,{i}))" for i in (1, 2)}
    cells = {**MATRIX, **draws, **TABLE, "C1": "=RiskOutput()+A1+A2"}
    tables = [table("xlmc_correlations", "J1:L2", "First", "Second", "Correlation")]
    (problem,) = read_definitions(workbook(cells, tables=tables), ENGINES).problems
    assert "are correlated by this row and by the matrix" in problem.message
    assert problem.where == "S!J2"


def test_crystal_balls_hidden_sheet_is_pointed_out(workbook):
    result = read_definitions(workbook({"A1": "=RiskOutput()+RAND()"}, sheets=["CB_DATA_"]), ENGINES)
    assert any("Crystal Ball's dialogs are lost" in notice.message for notice in result.notices)


def test_an_answer_that_cannot_be_read_is_never_left_out(workbook):
    result = read_definitions(workbook({"A1": '=RiskOutput("x")+RiskSplice(1)', "A2": "=RiskOutput()+RAND()"}), ENGINES)
    (problem,) = result.problems
    assert (problem.where, problem.message) == ("S!A1", "the function RiskSplice is not supported")


def test_a_refused_cell_that_nothing_needs_is_left_alone(workbook):
    result = read_definitions(workbook({"A1": "=RiskSplice(1)", "A2": "=RiskOutput()+RAND()"}), ENGINES)
    assert result.problems == ()


def test_a_shared_formula_draws_in_each_cell(workbook):
    master = Formula("RiskNormal(B1,$C$1)", 1, 1)
    cells = {f"A{row}": CellContent(1.0, master) for row in (1, 2, 3)}
    result = read_definitions(workbook({**cells, "D1": "=RiskOutput()+SUM(A1:A3)"}), ENGINES)
    assert {a.name: a.parameters["mean"] for a in result.assumptions} == {
        f"S!A{row}#1": Cell("S", row, 2) for row in (1, 2, 3)
    }


def test_the_documentation_names_every_function():
    text = (Path(__file__).parents[4] / "docs" / "workbooks.md").read_text(encoding="utf-8")
    section = text[text.index("## Functions in cells") : text.index("## What formulas may use")]
    missing = [name for name in (*RISK, *CRYSTAL_BALL, *RESULTS) if f"`{name}" not in section]
    assert missing == []
    assert [name for name in ALTERNATES if name.removeprefix("Risk") not in section] == []
