"""Copulas and partners of draws in cells: what is understood, what is refused and how, and what is drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest
from openpyxl import Workbook
from scipy import stats
from simulated import simulated

from xlmc.errors import XlmcError
from xlmc.montecarlo.model.loading import load

TRIALS = 20_000
TWO = {
    "A1": "=RiskNormal(0,1,RiskCopula($K$1:$L$3,1))",
    "A2": "=RiskExpon(1,RiskCopula($K$1:$L$3,2))",
    "A3": '=RiskOutput("sum")+A1+A2',
}
CLAYTON = {"K1": "Pattern", "L1": "Clayton", "K2": "Theta", "L2": 2}
T = {"K1": "t", "L1": None, "K2": 1, "K3": 0.5, "L3": 1, "M1": "Degrees of freedom", "N1": 3}


@pytest.fixture
def model(tmp_path):
    def made(cells):
        book = Workbook()
        sheet = book.active
        sheet.title = "S"
        for address, value in cells.items():
            sheet[address] = value
        book.save(tmp_path / "book.xlsx")
        return load(tmp_path / "book.xlsx")

    return made


@pytest.mark.parametrize(
    ("cells", "message", "tau"),
    [
        ({**TWO, **CLAYTON}, "the copula Clayton of theta 2", 0.5),
        ({**TWO, **CLAYTON, "L1": "claytonRX"}, "the copula ClaytonRX of theta 2", -0.5),
        ({**TWO, **CLAYTON, "L1": "Gumbel R"}, "the copula GumbelR of theta 2", 0.5),
        ({**TWO, **CLAYTON, "L1": "Frank", "L2": "=3+2"}, "", 0.4567),
        ({**TWO, "K1": "Gaussian", "K2": 1, "K3": 0.5, "L3": 1}, "the copula Gaussian", 1 / 3),
        (
            {
                **{key: value.replace("$L$3", "$N$3") for key, value in TWO.items()},
                **T,
            },
            "the copula t of df 3",
            1 / 3,
        ),
    ],
)
def test_what_is_drawn(model, cells, message, tau):
    """Kendall's tau, whose standard error is at most 2·√((1 − τ²)/n), and the margins."""
    if cells.get("L2") == "=3+2":  # openpyxl saves no value, and the parameter of a copula is a saved number
        with pytest.raises(XlmcError, match="The parameter of the copula has never been calculated"):
            model(cells)
        return
    made = model(cells)
    assert any(message in notice.message for notice in made.notices)
    run = simulated(made, trials=TRIALS, seed=999)
    first, second = run.inputs["S!A1#1"], run.inputs["S!A2#1"]
    result = stats.kendalltau(first[:4000], second[:4000]).statistic
    assert abs(result - tau) < 4 * 2 * math.sqrt((1 - tau**2) / 4000)
    assert stats.kstest(first, stats.norm.cdf).pvalue > 1e-3
    assert stats.kstest(second, stats.expon.cdf).pvalue > 1e-3
    with pytest.raises(KeyError):
        run.inputs["S!A3#1"]


@pytest.mark.parametrize(
    ("change", "where", "message"),
    [
        ({"L1": "Joe"}, "S!K1", "The range S!K1:L3 does not say which copula it is"),
        ({"L2": None}, "S!L1", "has no Theta"),
        ({"L2": -1}, "S!L1", "Theta (-1) of Clayton must be above 0, and at most 500"),
        ({"L1": "Gumbel", "L2": 0.5}, "S!L1", "Theta (0.5) of Gumbel must be at least 1"),
        ({"L1": "Gaussian"}, "S!L1", "has no matrix with 2 rows"),
        ({"L1": "t"}, "S!L1", "has no degrees of freedom"),
        ({"L1": None, "K1": "Gaussian", "K2": 1, "L2": None, "L3": 1}, "S!L2", "The cell of a correlation is blank"),
        ({"A2": "=RiskExpon(1,RiskCopula($K$1:$L$3,1))"}, "S!A2", "has a position of the copula"),
        ({"A2": "=RiskExpon(1,RiskCopula($K$1:$L$3,0))"}, "S!A2", "position must be a whole number from 1"),
        ({"A2": "=RiskExpon(1,RiskCopula(K1,2))"}, "S!A2", "first argument is not a range of cells"),
        (
            {
                "A1": '=RiskNormal(0,1,RiskCopula($K$1:$L$3,1),RiskIndepC("x"))',
                "A4": '=RiskNormal(0,1,RiskDepC("x",0.5))',
                "A3": '=RiskOutput("sum")+A1+A2+A4',
            },
            "S!A1",
            "is joined by a copula, and correlated in another way, too",
        ),
    ],
)
def test_what_is_refused(model, change, where, message):
    with pytest.raises(XlmcError) as refused:
        model({**TWO, **CLAYTON, **change})
    assert message in str(refused.value)
    assert where in str(refused.value)
    assert refused.value.hint


def test_the_record_has_the_correlation_of_each_pair(model):
    from xlmc.analysis.results.record.definition_tables import correlations_met

    (met,) = correlations_met(simulated(model({**TWO, **CLAYTON}), trials=TRIALS, seed=999))
    assert str(met.row) == "S!L1"
    assert met.asked == met.used == pytest.approx(0.6822, abs=2e-3)
    assert abs(met.accepted.value - met.used) < 5 / math.sqrt(TRIALS)


PARTNERS = {
    "A1": '=RiskNormal(0,1,RiskIndepC("p"))',
    "A2": '=RiskNormal(0,1,RiskDepC("P",0.8))',
    "A3": '=RiskUniform(0,1,RiskDepC("p",-0.5))',
    "A4": "=A1+A2+A3+RiskOutput()",
}


def test_partners(model):
    """Both have their rank correlation with the first, and what follows from it with each other: no repair."""
    made = model(PARTNERS)
    assert not any("nearest" in notice.message for notice in made.notices)
    inputs = simulated(made, trials=TRIALS, seed=999).inputs
    columns = [inputs[f"S!A{row}#1"] for row in (1, 2, 3)]
    result = stats.spearmanr(np.stack(columns, axis=1)).statistic
    implied = 6 / math.pi * math.asin(2 * math.sin(math.pi / 6 * 0.8) * math.sin(math.pi / 6 * -0.5))
    for (i, j), wanted in (((0, 1), 0.8), ((0, 2), -0.5), ((1, 2), implied)):
        assert abs(result[i, j] - wanted) < 5 / math.sqrt(TRIALS)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"A1": "=RiskNormal(0,1)"}, "RiskIndepC('p') stands in 0 draws that vary, and must stand in one"),
        ({"A2": '=RiskNormal(0,1,RiskDepC("p",1.5))'}, "Correlation (1.5) must lie between -1 and 1"),
        ({"A2": "=RiskNormal(0,1,RiskDepC(A9,0.5))"}, "RiskDepC needs a text"),
    ],
)
def test_mistakes_of_partners(model, change, message):
    with pytest.raises(XlmcError) as refused:
        model({**PARTNERS, **change})
    assert message in str(refused.value)


def test_a_coefficient_may_be_a_formula_that_was_never_calculated(model):
    """In a matrix and of a partner; and one that varies by trial is refused."""
    cells = {
        "F1": 1, "F2": "=0.3+G1/2", "G2": 1, "G1": 0.6,
        "A1": "=RiskNormal(0,1,RiskCorrmat(F1:G2,1))",
        "A2": "=RiskNormal(0,1,RiskCorrmat(F1:G2,2))",
        "B1": '=RiskNormal(0,1,RiskIndepC("p"))',
        "B2": '=RiskNormal(0,1,RiskDepC("p",-G1/2))',
        "A3": "=A1+A2+B1+B2+RiskOutput()",
    }  # fmt: skip
    inputs = simulated(model(cells), trials=TRIALS, seed=999).inputs
    for column, wanted in (("A", 0.6), ("B", -0.3)):
        result = stats.spearmanr(inputs[f"S!{column}1#1"], inputs[f"S!{column}2#1"]).statistic
        assert abs(result - wanted) < 5 / math.sqrt(TRIALS)
    for formula, message in (("=A1", "varies with an assumption"), ("=1+1", "Correlation (2) must lie between")):
        with pytest.raises(XlmcError, match=message.replace("(", r"\(").replace(")", r"\)")):
            model({**cells, "F2": formula})


MATRIX = {
    "A1": "=RiskNormal(0,1,RiskCorrmat($K$1:$M$3,1))",
    "A2": "=RiskNormal(0,1,RiskCorrmat($K$1:$M$3,2))",
    "A3": "=RiskNormal(0,1,RiskCorrmat($K$1:$M$3,3))",
    "A4": '=RiskOutput("sum")+A1+A2+A3',
    "K1": 1,
    "L2": 1,
    "M3": 1,
    "K2": 0.9,
    "K3": 0.0,
    "L3": 0.9,
}


def spearman_of(run, first, second):
    return stats.spearmanr(run.inputs[f"S!A{first}#1"], run.inputs[f"S!A{second}#1"]).statistic


@pytest.mark.parametrize(
    ("above", "expected"),
    [
        ({"L1": 0.9, "M1": None}, []),
        ({"L1": 0.2}, ["S!K2 is 0.9, and S!L1 is 0.2"]),
        ({"L1": "0.9"}, ["S!K2 is 0.9, and S!L1 is '0.9'"]),
        ({"L1": "=K2", "M1": 0, "M2": -0.9}, ["S!L3 is 0.9, and S!M2 is -0.9"]),
        ({"L1": "#N/A"}, ["S!K2 is 0.9, and S!L1 is '#N/A'"]),
    ],
    ids=["alike", "another number", "a text", "one of two", "an error"],
)
def test_halves_that_contradict_each_other_are_told_and_the_lower_one_holds(model, above, expected):
    made = model({**MATRIX, **above})
    result = [notice.message for notice in made.notices if "contradict each other" in notice.message]
    assert len(result) == len(expected)
    assert all(text in message for text, message in zip(expected, result, strict=True))
    assert {(c.first, c.second): c.value for c in made.definitions.correlations} == {
        ("S!A1#1", "S!A2#1"): 0.9,
        ("S!A2#1", "S!A3#1"): 0.9,
    }


def test_halves_of_a_copula_that_contradict_each_other_are_told(model):
    cells = {**TWO, "K1": "Gaussian", "K2": 1, "K3": 0.5, "L2": 0.4, "L3": 1}
    assert any("S!K3 is 0.5, and S!L2 is 0.4" in notice.message for notice in model(cells).notices)


@pytest.fixture
def weighted(tmp_path):
    """A model of `MATRIX` whose matrix is called Matrix1, with these weights in P1:R3."""

    def made(weights, name="Matrix1_Weights", area="S!$P$1:$R$3"):
        from openpyxl.workbook.defined_name import DefinedName

        book = Workbook()
        sheet = book.active
        sheet.title = "S"
        named = {key: str(value).replace("$K$1:$M$3", "Matrix1") for key, value in MATRIX.items() if key[0] == "A"}
        for address, value in {**MATRIX, **named, **weights}.items():
            sheet[address] = value
        book.defined_names["Matrix1"] = DefinedName("Matrix1", attr_text="S!$K$1:$M$3")
        book.defined_names[name] = DefinedName(name, attr_text=area)
        book.save(tmp_path / "book.xlsx")
        return load(tmp_path / "book.xlsx")

    return made


@pytest.mark.parametrize(
    ("weights", "kept"),
    [
        ({"P2": 100, "Q3": 100}, {(1, 2): 0.9, (2, 3): 0.9}),
        ({"Q1": 100, "R2": 100}, {(1, 2): 0.9, (2, 3): 0.9}),
        ({"P2": 100, "P3": 0, "Q3": 0}, {(1, 2): 0.9}),
        ({"P3": 100, "P2": 20, "Q3": 20}, {(1, 3): 0.0, (1, 2): 6 / math.pi * math.asin(math.sqrt(0.5) / 2)}),
    ],
    ids=["two stay", "above the diagonal", "one stays", "that of 0 stays"],
)
def test_adjustment_weights_keep_a_correlation(weighted, weights, kept):
    """In normal scores the cosines of three directions: where the two ends are at right angles, at most √½ each."""
    made = weighted(weights, name="MATRIX1_weights")
    assert any("as their adjustment weights say" in notice.message for notice in made.notices)
    run = simulated(made, trials=TRIALS, seed=7)
    for pair, value in kept.items():
        assert abs(spearman_of(run, *pair) - value) < 4 / math.sqrt(TRIALS)


@pytest.mark.parametrize(
    ("weights", "area", "message"),
    [
        ({"P2": 101}, "S!$P$1:$R$3", "S!P2: The adjustment weight (101) must lie between 0 and 100"),
        ({"P2": "high"}, "S!$P$1:$R$3", "S!P2"),
        ({}, "S!$P$1:$Q$2", "The name Matrix1_Weights is no range of 3 rows and columns"),
    ],
    ids=["too large", "a text", "too small a range"],
)
def test_weights_that_are_none_are_refused(weighted, weights, area, message):
    with pytest.raises(XlmcError) as refused:
        weighted(weights, area=area)
    assert message in str(refused.value)
    assert refused.value.hint


@pytest.mark.parametrize(("size", "blank"), [(3, "S!M3"), (2, "S!L2")])
def test_a_blank_correlation_is_named_by_its_cell(model, size, blank):
    """In a square of three, and in one of two, that stand below the name of the copula."""
    square = {"K1": "Gaussian", "K2": 1, "K3": 0.5, "L3": 1, "K4": 0.2, "M4": 1}
    if size == 2:
        square = {"K1": "Gaussian", "K2": 1, "L3": 1}
    cells = {key: value.replace("$L$3", "$M$4") for key, value in TWO.items()}
    with pytest.raises(XlmcError, match="The cell of a correlation is blank") as refused:
        model(cells | square)
    assert blank in str(refused.value)
