"""Calls of one cell, read: what stands in the formula instead, and what the draws are."""

from __future__ import annotations

import pytest

from xlmc.engine.engines import ENGINES
from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, InFormula
from xlmc.excel.formula import formula_text, ir
from xlmc.excel.workbook.workbook import CellContent, Formula
from xlmc.montecarlo.definitions.definitions_reader import read_definitions

HERE = Cell("S", 9, 9)
CELLS = {
    "A1": 4.0, "A2": 2.0, "A3": "name", "B1": "=RiskUniform(1,3)*5", "B2": "=A1+1", "B3": "=RiskNormal(0,1)+RAND()",
    "C1": 1.0, "C2": 3.0, "D1": 0.25, "D2": 0.75,
}  # fmt: skip


def shown(tree):
    """The text of a tree, with cells of the sheet by their address, and whole numbers as such."""
    return formula_text(tree).replace("S!", "").replace(".0", "")


@pytest.fixture
def understood(workbook):
    """`understood(formula)`: the definitions of a book that has it in I9."""

    def read(formula, array=None, **more):
        if array is None:
            content = f"={formula}"
        elif array == "spills":
            content = CellContent(None, Formula(formula, 9, 9, dynamic=True))
        else:
            content = CellContent(None, Formula(formula, 9, 9, array=array))
        cells = {**CELLS, **more, "I9": content, "Z1": '=RiskOutput("z")+RiskNormal(0,1)'}
        return read_definitions(workbook(cells), ENGINES)

    return read


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("RiskTheoMean(RiskUniform(2,4))", 3.0),
        ("RiskTheoStdDev(RiskNormal(5,2))", 2.0),
        ("RiskTheoXtoP(RiskUniform(0,10),4)", 0.4),
        ("RiskTheoPtoX(RiskUniform(0,10),0.25)", 2.5),
        ("RiskTheoPtoX(RiskUniform(0,10),D1)", 2.5),
        ("RiskTheoMean(RiskUniform(2,4,RiskShift(10)))", 13.0),
        ("RiskTheoMean(RiskUniform(2,4,RiskShift(A1)))", 7.0),
        ("RiskTheoMean(RiskUniform(0,10,RiskTruncate(2,4)))", 3.0),
        ("RiskTheoMin(RiskUniform(0,10,RiskTruncate(2,)))", 2.0),
        ("RiskTheoMax(RiskUniform(0,10,RiskTruncate(,A1)))", 4.0),
        ("RiskTheoMax(RiskUniform(0,10,RiskTruncate(,A1*2)))", 8.0),
        ("RiskTheoMean(RiskUniform(0,10,RiskTruncateP(0.2,0.4)))", 3.0),
        ("RiskTheoMean(RiskNormal(A1,A2))", 4.0),
        ("RiskTheoMean(RiskNormal(A1,2))", 4.0),
        ("RiskTheoMean(RiskDiscrete(C1:C2,D1:D2))", 2.5),
        ("RiskTheoMean(RiskCompound(RiskPoisson(3),RiskUniform(0,4)))", 6.0),
        ("RiskTheoMean(B1)", 2.0),
        ("RiskTheoMean(CB.Uniform(1,7))", 4.0),
    ],
)
def test_numbers_of_distributions_themselves(understood, formula, value):
    """Nothing is drawn for them; as part of a formula they are that number."""
    result = understood(formula)
    tree = result.rewritten[HERE]
    assert isinstance(tree, ir.Number)
    assert tree.value == pytest.approx(value)
    assert [a.name for a in result.assumptions if a.row == HERE] == []
    (drawn,) = (a for a in understood(f"RiskNormal({formula},1)").assumptions if a.row == HERE)
    assert drawn.given["mean"] == pytest.approx(value)


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("RiskTheoMean()", "RiskTheoMean has 0 arguments"),
        ("RiskTheoMean(RiskNormal(1,1),2)", "RiskTheoMean has 2 arguments"),
        ("RiskTheoXtoP(RiskNormal(1,1))", "RiskTheoXtoP has 1 arguments"),
        ('RiskTheoXtoP(RiskNormal(1,1),"x")', "RiskTheoXtoP needs a number"),
        ("RiskTheoMean(5)", "RiskTheoMean needs one distribution whose numbers are known"),
        ("RiskTheoMean(A1)", "RiskTheoMean needs one distribution whose numbers are known"),
        ("RiskTheoMean(B3+B1)", "RiskTheoMean needs one distribution whose numbers are known"),
        ("RiskTheoMean(RiskNormal(RiskUniform(1,2),1))", "needs one distribution whose numbers are known"),
        ("RiskTheoMean(RiskNormal(1,1)+RiskNormal(2,1))", "needs one distribution whose numbers are known"),
        ("RiskTheoMean(RiskNormal(B2,1))", "needs a distribution whose parameters are numbers"),
        ("RiskTheoMean(RiskNormal(1,1,RiskShift(B2)))", "needs a distribution whose parameters are numbers"),
        ("RiskTheoMean(RiskNormal(1,-1))", "RiskTheoMean: "),
        ("RiskTheoMean(RiskUniform(0,1,RiskTruncate(B2,9)))", "RiskTheoMean: "),
    ],
)
def test_distributions_that_are_not_known(understood, formula, message):
    error = understood(formula).rewritten[HERE]
    assert isinstance(error, FormulaError)
    assert message in error.message


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        ("5+RiskNormal(1,1)*2", "(5+(<1>*2))"),
        ("RiskNormal(1,1)+RiskUniform(0,1)", "(<1>+<2>)"),
        ("RiskNormal(1,1,RiskShift(3))*2", "((<1>+3)*2)"),
        ('RiskOutput("x")+RiskNormal(1,1)', "(0+<1>)"),
        ("RAND()*A1", "(<1>*A1)"),
        ("SUM(RANDARRAY(1,2))", "SUM({<1(1,1)>,<1(1,2)>})"),
    ],
)  # fmt: skip
def test_what_stands_instead_of_calls(understood, formula, text):
    written = shown(understood(formula).rewritten[HERE])
    for label in ("1(1,1)", "1(1,2)", "1", "2"):
        written = written.replace(shown(InFormula.of(HERE, label)), f"<{label}>")
    assert written == text


@pytest.mark.parametrize(
    ("formula", "array", "drawn"),
    [
        ("NORM.INV(RAND(),A1:A2,1)", None, "Normal"),
        ("NORM.INV(RAND(),A1:A2,1)", "spills", "Uniform"),
        ("NORM.INV(RAND(),A1:A2,1)", Area("S", 9, 9, 10, 9), "Uniform"),
        ("NORM.INV(RAND(),A1,1)", "spills", "Normal"),
        ("NORM.INV(RAND(),A1,1)", Area("S", 9, 9, 10, 9), "Normal"),
        ("NORM.INV(RAND(),{1,2},1)", None, "Uniform"),
        ("NORM.INV(RAND(),{1},1)", None, "Normal"),
        ("NORM.INV(RAND(),-A1:A2,1)", "spills", "Uniform"),
        ("NORM.INV(RAND(),1+A1:A2,1)", "spills", "Uniform"),
        ("NORM.INV(RAND(),A1:A2+1,1)", "spills", "Uniform"),
        ("NORM.INV(RAND(),SUM(SEQUENCE(2)),1)", "spills", "Uniform"),
        ("NORM.INV(RAND(),SUM(A1),1)", "spills", "Normal"),
        ("NORM.INV(RAND(),SUM(SEQUENCE(2)),1)", None, "Normal"),
    ],
)
def test_one_uniform_number_for_all_values_of_an_array(understood, formula, array, drawn):
    """An inverse function of several values is computed for each of them, from one random number."""
    (assumption,) = (a for a in understood(formula, array).assumptions if a.row == HERE)
    assert assumption.distribution == drawn


def test_partners_have_a_coefficient(understood):
    result = understood('RiskNormal(0,1,RiskDepC("p",A2/4))', K1='=RiskNormal(0,1,RiskIndepC("p"))')
    (correlation,) = result.correlations
    assert {correlation.first, correlation.second} == {"S!K1#1", "S!I9#1"}
    assert shown(result.rewritten[correlation.value]) == "(A2/4)"
    (plain,) = understood('RiskNormal(0,1,RiskDepC("p",0.5))', K1='=RiskNormal(0,1,RiskIndepC("p"))').correlations
    assert plain.value == 0.5


@pytest.mark.parametrize(
    ("formula", "name", "units", "source", "frozen"),
    [
        ("RiskNormal(1,1)", "S!I9#1", "", "RiskNormal in the cell", False),
        ("RiskNormal(1,1,RiskShift(2))", "S!I9#1", "", "RiskNormal in the cell, before its shift", False),
        ('RiskNormal(1,1,RiskName("n"),RiskUnits("kg"))', "n", "kg", "RiskNormal in the cell", False),
        ("RiskNormal(1,1,RiskName(A3),RiskLock())", "name", "", "RiskNormal in the cell", True),
        ("RAND()", "S!I9#1", "", "RAND in the cell", False),
    ],
)
def test_what_a_call_says_beside(understood, formula, name, units, source, frozen):
    (drawn,) = (a for a in understood(formula).assumptions if a.row == HERE)
    assert (drawn.name, drawn.units, drawn.source, drawn.frozen) == (name, units, source, frozen)
    assert drawn.notes["Call"].replace("S!", "").replace(".0", "").upper() == formula.upper()
    assert drawn.own_family is None


@pytest.mark.parametrize(
    ("formula", "base"),
    [
        ("RiskNormal(5,1,RiskShift(2),RiskStatic(9))", 7.0),
        ("RiskNormal(5,1,RiskStatic(9))", 9.0),
        ("RiskNormal(5,1,RiskStatic(A1))", 4.0),
        ("RiskNormal(5,1,RiskShift(SQRT(-1)),RiskStatic(9))", None),
        ("RiskUniform(0,10,RiskTruncate(A1,A1*2))", 6.0),
        ("RiskUniform(0,10,RiskTruncate(A1,))", 7.0),
        ("RiskNormal(A1*2,1)", 8.0),
    ],
)
def test_base_cases(understood, formula, base):
    (drawn,) = (a for a in understood(formula).assumptions if a.row == HERE)
    assert drawn.base == (base if base is None else pytest.approx(base))


@pytest.mark.parametrize(
    ("formula", "cutoffs"),
    [
        ("RiskNormal(5,1,RiskTruncate(1,9))", (1.0, 9.0)),
        ("RiskNormal(5,1,RiskTruncate(1,9),RiskShift(2))", (1.0, 9.0)),
        ("RiskNormal(5,1,RiskTruncate2(1,9),RiskShift(2))", (-1.0, 7.0)),
        ("RiskNormal(5,1,RiskTruncate2(1,9))", (1.0, 9.0)),
        ("RiskUniform(0,10,RiskTruncateP(0.1,0.4))", (1.0, 4.0)),
        ("RiskNormal(5,1,RiskTruncate(A1,))", (Cell("S", 1, 1), None)),
        ("RiskNormal(5,1,RiskTruncate(,A1*2))", (None, InFormula.of(HERE, "1 high cutoff"))),
    ],
)
def test_cutoffs(understood, formula, cutoffs):
    (drawn,) = (a for a in understood(formula).assumptions if a.row == HERE)
    assert tuple(map(drawn.cutoffs.get, ("lower_cutoff", "upper_cutoff"))) == cutoffs


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("RiskCompound(RiskPoisson(3))", "RiskCompound has 1 arguments"),
        ("RiskCompound(RiskPoisson(3),RiskNormal(1,1)*2)", "the severity of RiskCompound is a formula that draws"),
        ("RiskCompound(RiskPoisson(3),B1)", "the severity of RiskCompound is a formula that draws (S!B1)"),
        ('RiskOutput("a")+RiskOutput("b")', "the formula has two RiskOutput"),
        ("RiskNormal(RAND(),1,RiskTruncateP(0.1,0.9))", "needs parameters that are fixed"),
        ("RiskDiscrete({1,2},{1,1},RiskTruncate(1,2))+LET(x,2,RiskNormal(x,1))", "a name that LET binds"),
    ],
)
def test_refusals(understood, formula, message):
    error = understood(formula).rewritten[HERE]
    assert isinstance(error, FormulaError)
    assert message in error.message


def test_draws_within_a_compound_are_no_assumptions(understood):
    """The severity may stand in a cell of its own, a value there is taken as it is."""
    for severity in ("RiskExpon(2)", "K1", "A1"):
        result = understood(f"RiskCompound(RiskPoisson(3),{severity})", K1="=RiskExpon(2)")
        (drawn,) = (a for a in result.assumptions if a.row == HERE)
        assert drawn.base == pytest.approx(3 * (4.0 if severity == "A1" else 2.0))
        assert drawn.own_family is not None
        assert drawn.own_family is drawn.family


@pytest.mark.parametrize(
    ("formula", "name", "units"),
    [
        ('RiskOutput("out")', "out", ""),
        ("RiskOutput()", "S!I9", ""),
        ('RiskOutput("out",RiskUnits("kg"))', "out", "kg"),
        ('RiskOutput(RiskUnits("t"))', "S!I9", "t"),
    ],
)
def test_outputs(understood, formula, name, units):
    result = understood(f"{formula}+RiskNormal(0,1)")
    forecast = next(f for f in result.forecasts if f.cell == HERE)
    assert (forecast.name, forecast.units) == (name, units)
