"""Excel's own random functions as draws: families, parameters as trees, and which expressions may be arrays."""

from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, formula_text
from xlmc.excel.workbook.workbook import Formula
from xlmc.montecarlo.definitions.in_cells.call_arguments import number_of
from xlmc.montecarlo.definitions.in_cells.random_functions import may_be_many, random_draw


@pytest.fixture(scope="module")
def tree(workbook):
    """`tree(text)`: a resolved formula of sheet S."""
    resolver = Resolver(workbook({"A1": 1.0, "A2": 2.0}))
    return lambda text: resolver.formula(Cell("S", 9, 9), Formula(text, 9, 9))


def number_or_text(part):
    number = number_of(part)
    return formula_text(part).replace("S!", "") if number is None else number


@pytest.mark.parametrize(
    ("formula", "family", "parameters"),
    [
        ("RAND()", "Uniform", {"low": 0.0, "high": 1.0}),
        ("RANDBETWEEN(1,6)", "Discrete Uniform", {"low": 1.0, "high": 6.0}),
        ("RANDBETWEEN(A1,A2)", "Discrete Uniform", {"low": "(-(INT((-(A1)))))", "high": "INT(A2)"}),
        ("RANDBETWEEN(1.2,5.8)", "Discrete Uniform", {"low": 2.0, "high": 5.0}),
        ("-LN(RAND())", "Exponential", {"rate": 1.0}),
        ("RANDARRAY()", "Uniform", {"low": 0.0, "high": 1.0}),
        ("RANDARRAY(1,1,2,3)", "Uniform", {"low": 2.0, "high": 3.0}),
        ("RANDARRAY(1,1,,3)", "Uniform", {"low": 0.0, "high": 3.0}),
        ("RANDARRAY(1,1,-2,)", "Uniform", {"low": -2.0, "high": 1.0}),
        ("RANDARRAY(,,2,9,TRUE)", "Discrete Uniform", {"low": 2.0, "high": 9.0}),
        ("RANDARRAY(,,2,9,FALSE)", "Uniform", {"low": 2.0, "high": 9.0}),
        ("NORM.INV(RAND(),A1,2)", "Normal", {"mean": "A1", "std_dev": 2.0}),
        ("NORM.S.INV(RAND())", "Normal", {"mean": 0.0, "std_dev": 1.0}),
        ("BETA.INV(RAND(),2,3)", "Beta", {"alpha": 2.0, "beta": 3.0, "low": 0.0, "high": 1.0}),
        ("BETA.INV(RAND(),2,3,4,9)", "Beta", {"alpha": 2.0, "beta": 3.0, "low": 4.0, "high": 9.0}),
        ("GAMMA.INV(RAND(),3,2)", "Gamma", {"shape": 3.0, "scale": 2.0, "location": 0.0}),
        ("LOGNORM.INV(RAND(),1,2)", "Lognorm2", {"mu": 1.0, "sigma": 2.0, "location": 0.0}),
        ("T.INV(RAND(),5.9)", "Student's t", {"degrees": 5.0, "midpoint": 0.0, "scale": 1.0}),
        ("CHISQ.INV(RAND(),7.9)", "Gamma", {"shape": 3.5, "scale": 2.0, "location": 0.0}),
        ("BINOM.INV(20.9,0.3,RAND())", "Binomial", {"trials": 20.0, "probability": 0.3}),
    ],
)
def test_draws(tree, formula, family, parameters):
    drawn = random_draw(tree(formula))
    assert drawn.family.name == family
    assert {key: number_or_text(part) for key, part in drawn.parameters.items()} == parameters
    assert drawn.grid is None


@pytest.mark.parametrize(
    ("formula", "grid"),
    [
        ("RANDARRAY(2)", (2, 1)), ("RANDARRAY(2,3)", (2, 3)), ("RANDARRAY(,3)", (1, 3)), ("RANDARRAY(2.9,3.9)", (2, 3)),
        ("RANDARRAY(10000)", (10_000, 1)), ("RANDARRAY(100,100)", (100, 100)), ("RANDARRAY(1,1)", None),
    ],
)  # fmt: skip
def test_arrays_of_draws(tree, formula, grid):
    assert random_draw(tree(formula)).grid == grid


@pytest.mark.parametrize(
    "formula",
    ["A1+RAND()", "LN(RAND())", "-LN(A1)", "NORM.INV(0.5,0,1)", "NORM.INV(1-RAND(),0,1)", "NORM.INV(RAND(),,1)",
     "NORM.INV(RAND(),0)", "BETA.INV(RAND(),1,2,3)", "BINOM.INV(RAND(),0.5,0.5)", "SUM(A1:A2)", "5", "-RAND()"],
)  # fmt: skip
def test_what_is_no_draw_by_itself(tree, formula):
    assert random_draw(tree(formula)) is None


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("RAND(1)", "RAND takes no arguments"),
        ("RANDBETWEEN(1)", "RANDBETWEEN takes two numbers"),
        ("RANDBETWEEN(1,)", "RANDBETWEEN takes two numbers"),
        ("RANDBETWEEN(1,2,3)", "RANDBETWEEN takes two numbers"),
        ("RANDARRAY(1,2,3,4,5,6)", "RANDARRAY has 6 arguments; it takes 0 to 5"),
        ("RANDARRAY(1,1,0,1,A1)", "last argument must be TRUE or FALSE"),
        ("RANDARRAY(1,1,0,1,1)", "last argument must be TRUE or FALSE"),
        ("RANDARRAY(A1)", "a fixed size of 1 to 10,000 draws"),
        ("RANDARRAY(0)", "a fixed size of 1 to 10,000 draws"),
        ("RANDARRAY(10001)", "a fixed size of 1 to 10,000 draws"),
        ("RANDARRAY(101,100)", "a fixed size of 1 to 10,000 draws"),
        ("RANDARRAY(2,0.9)", "a fixed size of 1 to 10,000 draws"),
    ],
)
def test_refusals(tree, formula, message):
    with pytest.raises(FormulaError, match=message):
        random_draw(tree(formula))


@pytest.mark.parametrize(
    ("formula", "plain", "in_array"),
    [
        ("A1", False, False), ("5", False, False), ("A1:A2", False, True), ("A1:B1", False, True),
        ("A1:A1", False, False), ("{1,2}", True, True), ("{1;2}", True, True), ("{1}", False, False),
        ("-{1,2}", True, True), ("-A1:A2", False, True), ("1+{1,2}", True, True), ("{1,2}+1", True, True),
        ("A1+A2", False, False), ("A1:A2+1", False, True), ("1*A1:A2", False, True), ("SUM(A1:A2)", False, True),
        ("SUM({1,2})", False, True), ("SUM(A1,5)", False, False), ("SUM(A1:A1)", False, False),
        ("SQRT(SEQUENCE(2))", False, True), ("SEQUENCE(2)", False, True), ("RANDARRAY(2)", False, True),
        ("MAKEARRAY(2,2,LAMBDA(r,c,r))", False, True), ("LET(x,A1,x)", False, False), ("LET(x,A1:A2,x)", False, True),
    ],
)  # fmt: skip
def test_what_may_give_several_values(tree, formula, plain, in_array):
    assert may_be_many(tree(formula), in_array=False) == plain
    assert may_be_many(tree(formula), in_array=True) == in_array
