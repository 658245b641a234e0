"""What a call that shows a result asks for, as @RISK's and Crystal Ball's manuals give its arguments."""

from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.parse import parse
from xlmc.excel.formula.substitute import substitute
from xlmc.montecarlo.definitions.in_cells.result_functions import (
    CRYSTAL_BALL_STATISTICS,
    NOT_COMPUTED,
    RESULTS,
    Limits,
    ResultCall,
    is_result,
    mentions_result,
    not_computed,
    result_call,
)

B9, B8 = Cell("S", 9, 2), Cell("S", 8, 2)


def _resolved(reference):
    if not isinstance(reference, ir.Reference):
        return None
    first, last = reference.first, reference.last or reference.first
    if first == last:
        return Cell(reference.sheet, first.row, first.column)
    return Area(reference.sheet, first.row, first.column, last.row, last.column)


def call(formula):
    return substitute(parse(formula), _resolved)


@pytest.mark.parametrize(
    ("formula", "result"),
    [
        ("RiskMean(S!B9)", ResultCall("RiskMean", B9, "mean", None)),
        ("RISKMEAN(S!B9:B9)", ResultCall("RiskMean", B9, "mean", None)),
        ('RiskMean("Profit")', ResultCall("RiskMean", "Profit", "mean", None)),
        ("RiskMean(S!B9,2)", ResultCall("RiskMean", B9, "mean", None, simulation=ir.Number(2))),
        ("RiskMean(S!B9,)", ResultCall("RiskMean", B9, "mean", None)),
        ("RiskPercentile(S!B9,0.95)", ResultCall("RiskPercentile", B9, "share", ir.Number(0.95))),
        (
            "RiskPercentile(S!B9,0.95,3)",
            ResultCall("RiskPercentile", B9, "share", ir.Number(0.95), simulation=ir.Number(3)),
        ),
        ("RiskPtoXD(S!B9,S!B8)", ResultCall("RiskPtoXD", B9, "share from above", B8)),
        ("RiskCIMean(S!B9,0.9)", ResultCall("RiskCIMean", B9, "confidence", ir.Number(0.9))),
        ("RiskCIMean(S!B9,0.9,TRUE)", ResultCall("RiskCIMean", B9, "confidence", ir.Number(0.9))),
        ("RiskCIMean(S!B9,0.9,FALSE)", ResultCall("RiskCIMean", B9, "confidence", ir.Number(0.9), upper=True)),
        ("RiskCIMean(S!B9,0.9,)", ResultCall("RiskCIMean", B9, "confidence", ir.Number(0.9))),
        (
            "RiskCIMean(S!B9,0.9,FALSE,2)",
            ResultCall("RiskCIMean", B9, "confidence", ir.Number(0.9), upper=True, simulation=ir.Number(2)),
        ),
        (
            "RiskCIMean(S!B9,0.9,2)",
            ResultCall("RiskCIMean", B9, "confidence", ir.Number(0.9), simulation=ir.Number(2)),
        ),
        ("RiskCorrel(S!B9,S!B8,1)", ResultCall("RiskCorrel", B9, "correlation", ir.Number(1), other=B8)),
        (
            "RiskMean(S!B9,RiskTruncate(1,2))",
            ResultCall("RiskMean", B9, "mean", None, limits=Limits(ir.Number(1), ir.Number(2), False)),
        ),
        (
            "RiskMean(S!B9,RiskTruncate(1))",
            ResultCall("RiskMean", B9, "mean", None, limits=Limits(ir.Number(1), None, False)),
        ),
        (
            "RiskMean(S!B9,RiskTruncate(,S!B8),4)",
            ResultCall("RiskMean", B9, "mean", None, limits=Limits(None, B8, False), simulation=ir.Number(4)),
        ),
        (
            "RiskPercentile(S!B9,0.5,RiskTruncateP(0.1,0.9))",
            ResultCall(
                "RiskPercentile", B9, "share", ir.Number(0.5), limits=Limits(ir.Number(0.1), ir.Number(0.9), True)
            ),
        ),
        ("CB.GetForeStatFN(S!B9,2)", ResultCall("CB.GetForeStatFN", B9, "statistic", ir.Number(2))),
        ("CB.GetAssumFN(S!B9,6)", ResultCall("CB.GetAssumFN", B9, "assumption", ir.Number(6))),
        ("CB.GetRunPrefsFN(1)", ResultCall("CB.GetRunPrefsFN", None, "preference", ir.Number(1))),
        ("CB.IterationsFN()", ResultCall("CB.IterationsFN", None, "trials run", None)),
    ],
)
def test_what_a_call_asks_for(formula, result):
    assert is_result(call(formula))
    assert result_call(call(formula)) == result


@pytest.mark.parametrize("name", RESULTS)
def test_every_function_takes_its_cell_and_its_number(name):
    what, count = RESULTS[name]
    own = {"CB.GetRunPrefsFN": ["1"], "CB.IterationsFN": [], "RiskCorrel": ["S!B9", "S!B8", "1"]}
    arguments = own.get(name, ["S!B9", "0.5"][:count])
    result = result_call(call(f"{name}({','.join(arguments)})"))
    assert (result.function, result.what) == (name, what)
    assert result.of == (B9 if "S!B9" in arguments else None)
    assert (result.number is not None) == (arguments[-1:] != ["S!B9"] and bool(arguments))
    if count:
        with pytest.raises(FormulaError, match=f"{name} has {count - 1} arguments"):
            result_call(call(f"{name}({','.join(arguments[:-1])})"))


@pytest.mark.parametrize(
    ("formula", "message", "hint"),
    [
        ("RiskMean()", "RiskMean has 0 arguments", "it takes the cell of an output"),
        ("RiskPercentile(S!B9)", "RiskPercentile has 1 arguments", "it takes the cell of an output, and a number"),
        ("RiskCorrel(S!B9,S!B8)", "RiskCorrel has 2 arguments", "it takes two cells, and a number"),
        ("CB.GetRunPrefsFN()", "CB.GetRunPrefsFN has 0 arguments", "it takes the cell of an output"),
        ("RiskMean(S!B9,1,2)", "RiskMean has 1 arguments too many", "take them out"),
        ("RiskMean(S!B9,1,2,3)", "RiskMean has 2 arguments too many", "take them out"),
        ("CB.GetForeStatFN(S!B9,2,1)", "CB.GetForeStatFN has 1 arguments too many", "take them out"),
        ("RiskMean(2)", "RiskMean must name the cell of an output first", "such as RiskMean(B9)"),
        ("RiskMean(S!B8:B9)", "RiskMean must name the cell of an output first", "such as RiskMean(B9)"),
        ("RiskMean(S!B9:C9)", "RiskMean must name the cell of an output first", "such as RiskMean(B9)"),
        ("RiskCorrel(S!B9,2,1)", "RiskCorrel must name the cell", "such as"),
        ("RiskMean(S!B9,RiskTruncate(1,2),RiskTruncate(1,2))", "has a property that it cannot have", "RiskTruncateP"),
        ('RiskMean(S!B9,RiskName("x"))', "has a property that it cannot have", "RiskTruncateP"),
        ("RiskData(S!B9,2,RiskTruncate(1,2))", "of a part of the values is not computed", "leave RiskTruncate out"),
        ("RiskCIMean(S!B9,0.9,RiskTruncate(1,2))", "of a part of the values", "leave RiskTruncate out"),
        ("RiskCorrel(S!B9,S!B8,1,RiskTruncate(1,2))", "of a part of the values", "leave RiskTruncate out"),
    ],
)
def test_what_no_call_may_be(formula, message, hint):
    with pytest.raises(FormulaError) as caught:
        result_call(call(formula))
    assert message in caught.value.message
    assert hint in caught.value.hint


@pytest.mark.parametrize(
    ("formula", "name"),
    [
        *((f"{name}(S!B9)", name) for name in NOT_COMPUTED),
        ("RISKCPK(S!B9)", "RiskCpk"),
        ("RiskFuture(S!B9)", "RISKFUTURE"),
        ("CB.FutureFN(S!B9)", "CB.FUTUREFN"),
        *((f"{name}(S!B9)", None) for name in ("RiskMean", "RiskOutput", "RiskNormal", "RiskTheoMean", "RiskName")),
        *((f"Risk{name}(S!B9)", None) for name in ("TSGBM", "NormalAlt", "NormalAltD", "Compound", "Vary", "Tnormal")),
        ("CB.Normal(1,2)", None),
        ("MEAN(S!B9)", None),
        ("SUM(RiskCpk(S!B9))", None),
        ("S!B9", None),
    ],
)
def test_what_shows_a_result_that_is_not_computed(formula, name):
    assert not_computed(call(formula)) == name


@pytest.mark.parametrize(
    ("text", "mentions"),
    [
        ("RiskMean(B9", True),
        ("1+_xll.RiskMean (B9", True),
        ("_xlfn._xll.riskcpk(B9", True),
        ("CB.GetForeStatFN(B9", True),
        ("RiskNormal(1", False),
        ("RiskNormal(1,2)+RiskMax(", True),
        ("MyRiskMean(B9", False),
        ("X.RiskMean(B9", False),
        ("RiskMean+1", False),
    ],
)
def test_what_a_formula_that_cannot_be_read_mentions(text, mentions):
    assert mentions_result(text) is mentions


def test_a_call_needs_the_numbers_of_its_arguments_and_the_values_of_its_forecasts():
    asked = result_call(call("RiskPercentile(S!B9,0.5,RiskTruncate(1,S!B8),3)"))
    assert asked.arguments == (ir.Number(0.5), ir.Number(1), B8, ir.Number(3))
    assert asked.forecasts == (B9,)
    assert result_call(call("RiskMean(S!B9)")).arguments == ()
    assert result_call(call("RiskCorrel(S!B9,S!B8,1)")).forecasts == (B9, B8)
    assert result_call(call("CB.GetAssumFN(S!B9,1)")).forecasts == ()
    assert result_call(call("CB.GetAssumPercentFN(S!B9,50)")).forecasts == ()
    assert result_call(call("CB.IterationsFN()")).forecasts == ()


def test_crystal_ball_counts_its_statistics_from_1():
    """Index of `CB.GetForeStatFN`, after Decisioneering's Developer Kit of Crystal Ball 2000."""
    assert dict(enumerate(CRYSTAL_BALL_STATISTICS, 1)) == {
        1: "trials",
        2: "mean",
        3: "median",
        4: "mode",
        5: "standard_deviation",
        6: "variance",
        7: "skewness",
        8: "kurtosis",
        9: "coefficient_of_variation",
        10: "minimum",
        11: "maximum",
        12: "range_width",
        13: "mean_standard_error",
    }
