from __future__ import annotations

import pytest

from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.parse import parse
from xlmc.excel.formula.substitute import substitute
from xlmc.montecarlo.definitions.in_cells.call_arguments import number_of

CELLS = {Cell("S", 1, 1): 3.0, Cell("S", 2, 1): None}


def _cell(reference):
    return Cell(reference.sheet, reference.first.row, reference.first.column)


@pytest.mark.parametrize(
    ("formula", "number"),
    [
        ("2", 2.0),
        ("-2", -2.0),
        ("+2", 2.0),
        ("50%", 0.5),
        ("-50%", -0.5),
        ("7+2", 9.0),
        ("7-2", 5.0),
        ("7*2", 14.0),
        ("7/2", 3.5),
        ("7/0", None),
        ("0/7", 0.0),
        ("7^2", None),
        ("INT(2.7)", 2.0),
        ("INT(-2.2)", -3.0),
        ("IF(1<=2,10,20)", 10.0),
        ("IF(2<=2,10,20)", 10.0),
        ("IF(3<=2,10,20)", 20.0),
        ("IF(1<2,10,20)", None),
        ("S!A1", 3.0),
        ("S!A1*2+1", 7.0),
        ("INT(S!A1/2)", 1.0),
        ("S!A2", None),
        ("-S!A2", None),
        ("1+S!A2", None),
        ("S!A2+1", None),
        ("INT(S!A2)", None),
        ("IF(S!A2<=1,10,20)", None),
        ("IF(1<=S!A2,10,20)", None),
        ("IF(1<=2,10,S!A2)", 10.0),
        ('"2"', None),
        ("SQRT(4)", None),
    ],
)
def test_a_number_is_known_where_plain_arithmetic_gives_it(formula, number):
    resolved = substitute(parse(formula), lambda part: _cell(part) if isinstance(part, ir.Reference) else None)
    assert number_of(resolved, CELLS.get) == number


def test_no_cell_is_known_by_default():
    assert number_of(Cell("S", 1, 1)) is None
