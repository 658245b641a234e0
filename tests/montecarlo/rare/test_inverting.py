"""Conditions undone down to one assumption: what it may be is what the condition itself says of each value."""

from __future__ import annotations

import math
import operator

import numpy as np
import pytest

from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import Resolver, ir
from xlmc.montecarlo.rare import inverting
from xlmc.montecarlo.rare.inverting import Inverting, conjuncts
from xlmc.montecarlo.rare.limit_state import Fails, Leaf, Together, comparisons_of

X = Cell("S", 1, 1)
GRID = np.concatenate([np.linspace(-9.7, 9.7, 389) + 0.0123, [0.013, 0.5001, 123.4, -87.3]])
CELLS = {
    "A2": 2.0, "A3": 3.0, "A4": -1.5, "A5": 0.0,
    "C1": "=A1*2+1", "C2": "=C1-A3", "C3": "=SUM(A2:A4)", "C4": "=A1", "C5": "=EXP(A1/4)",
}  # fmt: skip

OPERATORS = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": np.divide, "^": np.power, ">": np.greater,
    ">=": np.greater_equal, "<": np.less, "<=": np.less_equal, "=": np.equal, "<>": np.not_equal,
}  # fmt: skip
FUNCTIONS = {
    "SQRT": np.sqrt, "EXP": np.exp, "LN": np.log, "LOG10": np.log10,
    "LOG": lambda x, base=10.0: np.log(x) / np.log(base),
    "ABS": np.abs, "SIN": np.sin,
    "IF": np.where, "POWER": np.power, "AND": lambda *x: math.prod(x) > 0, "NOT": np.logical_not,
    "OR": lambda *x: sum(1 * one for one in x) > 0,
    "SUM": lambda *x: sum(x), "SUMSQ": lambda *x: sum(one * one for one in x), "PI": lambda: np.pi,
    "MAX": lambda *x: np.maximum.reduce(np.broadcast_arrays(*x)), "PRODUCT": lambda *x: math.prod(x),
    "MIN": lambda *x: np.minimum.reduce(np.broadcast_arrays(*x)),
}  # fmt: skip


class Case:
    """The trees of the cells, their values with x in A1, and what depends on A1."""

    def __init__(self, workbook, formula):
        book = workbook(CELLS | {"A1": 0.0, "B1": f"={formula}"})
        resolver = Resolver(book)
        cells = [Cell("S", row, column) for column in (1, 2, 3) for row in range(1, 6)]
        held = {cell: book.content(cell) for cell in cells}
        self.formulas = {cell: resolver.formula(cell, each.formula) for cell, each in held.items() if each.formula}
        self.numbers = {cell: each.value for cell, each in held.items() if each.value is not None}
        self.condition = self.formulas[Cell("S", 1, 2)]

    def value(self, tree, x):
        match tree:
            case Cell():
                own = self.formulas.get(tree)
                return x if tree == X else self.value(own, x) if own is not None else self.numbers[tree]
            case ir.Number(number):
                return number
            case ir.Unary(sign, part):
                part = self.value(part, x)
                return {"-": -part, "+": part, "%": part / 100}[sign]
            case ir.Binary(sign, left, right):
                return OPERATORS[sign](self.value(left, x), self.value(right, x))
            case ir.Call(name, parts):
                cells = [cell for part in parts for cell in (part.cells() if isinstance(part, Area) else [part])]
                return FUNCTIONS[name](*(self.value(part, x) for part in cells))

    def known(self, target):
        """What a target gives, whatever x is."""
        return np.broadcast_to(self.value(target.tree, np.nan), GRID.shape).astype(float)

    def depends(self, tree):
        match tree:
            case Cell():
                return tree == X or (tree in self.formulas and self.depends(self.formulas[tree]))
            case Area():
                return any(map(self.depends, tree.cells()))
            case ir.Unary(_, part):
                return self.depends(part)
            case ir.Binary(_, left, right):
                return self.depends(left) or self.depends(right)
            case ir.Call(_, parts):
                return any(map(self.depends, parts))
        return False

    def region(self, gates=()):
        undoing = Inverting(X, self.formulas, self.depends, gates)
        of = comparisons_of(self.condition, Cell("S", 1, 2), self.formulas, wanted=True)
        return undoing, undoing.region(of)


@pytest.fixture
def undone(workbook):
    """`undone(formula)`: whether x may be each number of the grid, and whether the condition then holds."""

    def make(formula, gates=()):
        case = Case(workbook, formula)
        undoing, region = case.region(gates)
        if region is None:
            return None
        with np.errstate(all="ignore"):
            known = [
                np.broadcast_to(case.value(each.tree, np.nan), GRID.shape).astype(float) for each in undoing.targets
            ]
            holds = case.value(case.condition, GRID)
        return region(known).contain(GRID), np.broadcast_to(holds, GRID.shape)

    return make


EXACT = [
    "A1>1", "A1>=A2", "A1<A3", "A1<=-2.5", "1<A1", "A3>=A1", "A2>A1", "-4<=A1", "A1-A2>A3-A1", "A1<A1*3-A2",
    "A1+A2>3", "A2+A1>3", "A1-A2<1", "A2-A1<1", "A2-A1>=-1", "A1*A4>3", "A4*A1>3", "A1/A4<1", "A3/A1>1", "A3/A1<-1",
    "A1^2<9", "A1^3>-8", "POWER(A1,2)>4", "A2^A1>3", "-A1>2", "+A1>2", "A1%>0.02",
    "SQRT(A1)>1.5", "EXP(A1)<5", "LN(A1)>0.5", "LOG10(A1)>0.25", "LOG(A1)<0.25", "LOG(A1,10)<0.25", "ABS(A1)>3",
    "ABS(A1-1)<=3", "C1>4", "C2<3", "C4>2", "SUM(A1:A4)>1", "SUM(A2:A4,A1)<5", "SUM(A1,A1,A2)>4",
    "SUMSQ(A1,A2)>10", "MAX(A1,A2)>3", "MAX(A1,A2,A3)<4", "MIN(A1,A3)>1", "MIN(A1:A3)>1", "PRODUCT(A1,A2)>5",
    "SUM(A1)>1", "MAX(A1)>1", "IF(A2>1,A1,A3)>2", "IF(A2>9,A1,A1*2)>2", "IF(A2>9,A1,5)>2", "IF(A2>1,1,A1)>2",
    "IF(A2>1,7,A1)>2", "2*A1+3*A1>7", "A1*3-A1>5", "(A1+1)/2+A1/4>3", "A1+SUM(A1,A2)>3", "-A1+A1*A3>2", "A2*(A1+C1)>9",
    "(1+A1)/(3+A1)>0.5", "(2*A1-1)/(A1+A2)<1", "AND(A1>1,A1<4)", "OR(A1>5,A1<-5)", "NOT(A1>3)",
    "AND(A1>A2,A2>1)", "AND(A1>A2,A2>5)", "OR(A1>3,A2>1)", "A2>1", "A2<1", "NOT(OR(A1>3,A1<0))", "C3+A1>5",
    "(A1-C4)*1+A1>2", "A1-C1>2", "C1/C2>2",
]  # fmt: skip


@pytest.mark.parametrize("formula", EXACT)
def test_what_is_undone_exactly(undone, formula):
    may_be, holds = undone(formula)
    assert may_be.tolist() == holds.tolist()


NOT_UNDONE = [
    "A1=2", "A1<>2", "A1*A1>4", "SUMSQ(A1,A1)>4", "MAX(A1,A1)>2", "A1^A1>3", "PI()*SQRT(A1)+A1>2", "IF(A1>1,A1,2)>3",
    "PRODUCT(A1:A3)>5", "A1^5000>2", "A1^0.0005>2", "TRUNC(A1)>2", "OR(A1>3,A1*A1>4)", "A1&A2>1", "LOG(A1,2)>1",
    "A1^A2>3", "A1^-1>0.5", "ABS(A1)+A1>3", "IF(A2>1,A1*A1,A1)>2", "IF(A2>1,A1,A1*A1)>2", "A1/(A1*A1)>2",
    "MIN(A1*A1,2)>1",
    "SUM(A1*A1,A1)>1", "-(A1*A1)>1", "(A1*A1)^2>1",
]  # fmt: skip


@pytest.mark.parametrize("formula", NOT_UNDONE)
def test_what_is_not_undone(undone, formula):
    assert undone(formula) is None


@pytest.mark.parametrize(
    ("formula", "rest"),
    [("AND(A1>1,A1*A1<9)", "A1>1"), ("AND(A1*A1<9,A1<2,A1>-7)", "AND(A1<2,A1>-7)")],
)
def test_what_must_all_hold_is_undone_as_far_as_it_can_be(undone, formula, rest):
    assert undone(formula)[0].tolist() == undone(rest)[1].tolist()


def test_a_gate_is_undone_in_turn(undone):
    """C5 stands twice, and A1 depends on nothing else there: C5 first, then its own formula."""
    formula = "3*C5-C5>4"
    assert undone(formula) is None
    may_be, holds = undone(formula, gates=[Cell("S", 5, 3)])
    assert may_be.tolist() == holds.tolist()
    assert undone("3*C5-C5+A1>4", gates=[Cell("S", 5, 3)]) is None


def test_turning_functions_ask_for_their_arguments(workbook):
    """Within 2π of 0 all of it is found; the argument is among what must be known."""
    case = Case(workbook, "SIN(A1/2)>0.5")
    undoing, region = case.region()
    (turned,) = undoing.turned
    assert case.value(undoing.targets[turned].tree, 3.0) == 1.5
    known = [case.known(target) for target in undoing.targets]
    assert region(known).contain(GRID)[:-2].tolist() == (np.sin(GRID / 2) > 0.5)[:-2].tolist()
    assert not Case(workbook, "EXP(A1)>0.5").region()[0].turned


def test_long_formulas_are_not_undone(undone, monkeypatch):
    deep = "-" * 10 + "A1>1"
    monkeypatch.setattr(inverting, "_DEEPEST", 10)
    assert undone(deep) is not None
    monkeypatch.setattr(inverting, "_DEEPEST", 9)
    assert undone(deep) is None
    for most, found in ((6, True), (5, False)):  # A1+(A1+A1)·2 has six parts that are looked at
        monkeypatch.setattr(inverting, "_MOST_STEPS", most)
        monkeypatch.setattr(inverting, "_DEEPEST", 150)
        assert (undone("A1+(A1+A1)*2>1") is not None) == found


def test_large_areas_are_not_written_out(undone, monkeypatch):
    monkeypatch.setattr(inverting, "_MOST_CELLS", 4)
    assert undone("SUM(A1:A4,A5)>1") is not None
    monkeypatch.setattr(inverting, "_MOST_CELLS", 3)
    assert undone("MAX(A1:A4,2)+A5>1") is None


def test_what_must_hold_in_its_smallest_parts():
    one, two, three, four = (Leaf(None) for _ in range(4))
    either, never = Together((one, two), every=False), Fails(three)
    inner = Together((three, Together((four,), every=True), either), every=True)
    assert list(conjuncts([one, inner, never])) == [one, three, four, either, never]
    assert list(conjuncts([])) == []


def test_a_condition_that_must_not_hold_is_not_undone(workbook):
    case = Case(workbook, "A1>1")
    undoing, _ = case.region()
    leaf = comparisons_of(case.condition, Cell("S", 1, 2), case.formulas, wanted=True)
    assert undoing.region(Fails(leaf)) is None
    assert undoing.region(Together((), every=True)) is None
