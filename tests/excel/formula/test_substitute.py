"""Parts of a tree replaced: where, and in which order they are asked about."""

from __future__ import annotations

import pytest

from xlmc.excel.address import Cell, InFormula, host_of
from xlmc.excel.formula import formula_text, ir, parse
from xlmc.excel.formula.resolve import Resolver
from xlmc.excel.formula.substitute import is_bound, substitute

HOST = Cell("S", 1, 1)


@pytest.fixture
def resolved(workbook):
    return lambda text: Resolver(workbook({"A1": 1.0})).tree(parse(text), HOST)


REPLACED = {
    "X()": "7.0",
    "1+X()*2-X()": "((1.0+(7.0*2.0))-7.0)",
    "-X()%": "((-(7.0))%)",
    "SUM(1,X(),MAX(X()))": "SUM(1.0,7.0,MAX(7.0))",
    "LET(a,X(),a+X())": "LET(_xlpm.a,7.0,(_xlpm.a+7.0))",
    "LAMBDA(a,a+X())(X())": "LAMBDA(_xlpm.a,(_xlpm.a+7.0))(7.0)",
    "B2+{1,2}": "(S!B2+{1.0,2.0})",
}


@pytest.mark.parametrize("text", REPLACED)
def test_every_part_is_found(resolved, text):
    def change(part):
        return ir.Number(7.0) if isinstance(part, ir.Call) and part.name == "X" else None

    assert formula_text(substitute(resolved(text), change)) == REPLACED[text]


def test_the_order_is_from_without_and_from_the_left(resolved):
    asked = []

    def look(part):
        if isinstance(part, ir.Call):
            asked.append(part.name)

    substitute(resolved("F(G(1),H(2))+K(3)*L(4)"), look)
    assert asked == list("FGHKL")


def test_a_long_sum(resolved):
    tree = substitute(resolved("+".join(["X()"] * 500)), lambda p: ir.Number(1.0) if p == ir.Call("X", ()) else None)
    assert formula_text(tree).count("1.0") == 500


@pytest.mark.parametrize(("text", "bound"), [("A1+1", False), ("LET(a,1,a)", True)])
def test_bound_variables(resolved, text, bound):
    assert is_bound(resolved(text)) == bound


def test_parts_of_formulas_are_cells_of_their_own():
    part = InFormula.of(Cell("My sheet", 7, 2), "2 mean")
    assert part != Cell("My sheet", 7, 2)
    assert part == InFormula.of(Cell("My sheet", 7, 2), "2 mean")
    assert (str(part), host_of(part)) == ("'My sheet'!B7#2 mean", Cell("My sheet", 7, 2))
    assert host_of(HOST) is HOST
