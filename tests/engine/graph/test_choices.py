"""Choices by known conditions and by conditions that vary: which branch counts, and what a range in a branch is."""

from __future__ import annotations

import pytest

from xlmc.engine.graph.nodes import Apply, Constant, Input
from xlmc.errors import ErrorCode, XlmcError
from xlmc.excel.workbook.workbook import CellContent, Formula

CELLS = {
    "A1": 1.0, "A2": 2.0, "A3": 3.0, "B1": 10.0, "B2": 20.0, "B3": 30.0, "C1": "x", "C2": True, "D1": "=1/0",
    "D2": "=NA()", "E1": "=B1", "E3": 5.0,
}  # fmt: skip
NA, VALUE, DIV0 = ErrorCode.NA, ErrorCode.VALUE, ErrorCode.DIV0

KNOWN = [
    ("IF(A1>0,B1,B2)", 10.0),
    ("IF(A1<0,B1,B2)", 20.0),
    ("IF(A1<0,B1)", False),
    ("IF(A1>0,B1)", 10.0),
    ("IF(A1<0,B1,)", 0.0),
    ("IF(A1>0,Z9,5)", 0.0),
    ("IF(D1,1,2)", DIV0),
    ('IF("x",1,2)', VALUE),
    ('IF("TRUE",1,2)', 1.0),
    ("IF(Z9,1,2)", 2.0),
    ("IF(A1>0,1,1/0)", 1.0),
    ("IFS(A1>1,1,A1>0,2)", 2.0),
    ("IFS(A1>0,1,1/0,2)", 1.0),
    ("IFS(A1>1,1,A1>2,2)", NA),
    ("IFS(D1,1,TRUE,2)", DIV0),
    ("IFS(A1>1,1,D1,2,TRUE,3)", DIV0),
    ("SWITCH(A2,1,B1,2,B2,B3)", 20.0),
    ("SWITCH(A3,1,B1,2,B2,B3)", 30.0),
    ("SWITCH(A3,1,B1,2,B2)", NA),
    ('SWITCH("X","x",1,2)', 1.0),
    ("SWITCH(D1,1,2,3)", DIV0),
    ("SWITCH(A1,1,Z9)", 0.0),
    ("CHOOSE(2,B1,B2,B3)", 20.0),
    ("CHOOSE(3.9,B1,B2,B3)", 30.0),
    ("CHOOSE(0.9,B1,B2,B3)", VALUE),
    ("CHOOSE(4,B1,B2,B3)", VALUE),
    ("CHOOSE(-1,B1,B2,B3)", VALUE),
    ("CHOOSE(1,B1)", 10.0),
    ("CHOOSE(D1,B1,B2)", DIV0),
    ('CHOOSE("x",B1,B2)', VALUE),
    ("CHOOSE(TRUE,B1,B2)", 10.0),
    ("CHOOSE(1,Z9,2)", 0.0),
    ("IFERROR(D1,7)", 7.0),
    ("IFERROR(D2,7)", 7.0),
    ("IFERROR(A1,1/0)", 1.0),
    ("IFERROR(Z9,7)", 0.0),
    ("IFERROR(D1,Z9)", 0.0),
    ("IFNA(D1,7)", DIV0),
    ("IFNA(D2,7)", 7.0),
    ("IFNA(A2,7)", 2.0),
    ("COUNTA(IF(A1>0,C1:C3,1))", 2.0),
    ("COUNT(IF(A1>0,C1,1))", 0.0),
    ("SUM(IF(A1>0,C2,1))", 0.0),
    ("SUM(IF(A1>0,TRUE,1))", 1.0),
    ("SUM(CHOOSE(1,C2,1))", 0.0),
    ("SUM(IFS(A1>0,C2))", 0.0),
    ("COUNTBLANK(IF(A1>0,Z9,1))", 1.0),
    ("COUNT(IF(A1>0,B1:B3,1))", 3.0),
    ("SUM(IF(A1<0,B1:B3,A1:A3))", 6.0),
    ("@B1", 10.0),
    ("@B1:B3", VALUE),
    ("SUM(IF(A1>0,INDEX(C1:C3,2),1))", 0.0),
    ("SUM(IF(A1>0,XLOOKUP(2,A1:A3,C1:C3),1))", 0.0),
    ("SUM(IF(A1>0,INDEX(B1:B3,2),1))", 20.0),
]  # fmt: skip


@pytest.mark.parametrize(("formula", "expected"), KNOWN, ids=[formula for formula, _ in KNOWN])
def test_known_conditions(value_of, formula, expected):
    result = value_of(CELLS, formula)
    assert result == expected
    assert isinstance(result, type(expected))


VARYING = [  # for A1 = 0, 1, 2, 3
    ("IF(A1>1,B1,B2)", [20.0, 20.0, 10.0, 10.0]),
    ("IF(A1>1,B1)", [0.0, 0.0, 10.0, 10.0]),
    ("IF(A1,B1,Z9)", [0.0, 10.0, 10.0, 10.0]),
    ("IF(1/A1>0.4,1,2)", ["#DIV/0!", 1.0, 1.0, 2.0]),
    ("IFS(A1>2,1,A1>1,2,A1>0,3)", ["#N/A", 3.0, 2.0, 1.0]),
    ("IFS(A1>2,1,FALSE,2,TRUE,3,A1>0,4)", [3.0, 3.0, 3.0, 1.0]),
    ("IFS(A1>2,1,D1,2,TRUE,3)", ["#DIV/0!", "#DIV/0!", "#DIV/0!", 1.0]),
    ("SWITCH(A1,1,B1,2,B2,B3)", [30.0, 10.0, 20.0, 30.0]),
    ("SWITCH(A1,1,B1,2,B2)", ["#N/A", 10.0, 20.0, "#N/A"]),
    ("SWITCH(2,A1,B1,2,B2)", [20.0, 20.0, 10.0, 20.0]),
    ("CHOOSE(A1,B1,B2)", ["#VALUE!", 10.0, 20.0, "#VALUE!"]),
    ("CHOOSE(A1+0.9,B1,B2)", ["#VALUE!", 10.0, 20.0, "#VALUE!"]),
    ("CHOOSE(A1+1,Z9,B2,B3,A1)", [0.0, 20.0, 30.0, 3.0]),
    ("IFERROR(1/A1,7)", [7.0, 1.0, 0.5, 1 / 3]),
    ("IFNA(1/A1,7)", ["#DIV/0!", 1.0, 0.5, 1 / 3]),
    ("IFNA(MATCH(A1,{1,2},0),7)", [7.0, 1.0, 2.0, 7.0]),
    ("IFERROR(1/A1,Z9)", [0.0, 1.0, 0.5, 1 / 3]),
    ("SUM(IF(A1>1,C2,5))", [5.0, 5.0, 0.0, 0.0]),
    ("SUM(IF(A1>1,TRUE,5))", [5.0, 5.0, 1.0, 1.0]),
    ('SUM(IF(A1>1,C2,"5"))', [5.0, 5.0, 0.0, 0.0]),
    ("SUM(IF(A1>1,OFFSET(A1,-1,0),5))", [5.0, 5.0, "#REF!", "#REF!"]),
    ("COUNTA(IF(A1>1,OFFSET(A1,-1,0),5))", [1.0] * 4),
    ("COUNT(IF(A1>1,C1:C2,B1:B2))", [2.0, 2.0, 0.0, 0.0]),
    ("COUNTA(IF(A1>1,C2:C3,B1:B2))", [2.0, 2.0, 1.0, 1.0]),
    ("COUNT(IF(A1>1,C1,B1))", [1.0, 1.0, 0.0, 0.0]),
    ("COUNT(IF(A1>1,C1:C3,B1))", [1.0, 1.0, 0.0, 0.0]),
    ("COUNTBLANK(IF(A1>1,B3:B4,B1:B2))", [0.0, 0.0, 1.0, 1.0]),
    ("AVERAGE(IF(A1>1,B3:B4,B1:B2))", [15.0, 15.0, 30.0, 30.0]),
    ("SUM(CHOOSE(A1+1,C2,B1,B2:B3,1))", [0.0, 10.0, 50.0, 1.0]),
    ("COUNT(CHOOSE(A1+1,Z9,B1,C1,1))", [0.0, 1.0, 0.0, 1.0]),
    ("SUM(IF(A1>1,INDEX(C1:C3,2),5))", [5.0, 5.0, 0.0, 0.0]),
    ("SUM(IF(A1>1,E1,5))", [5.0, 5.0, 10.0, 10.0]),
    ("SUM(IFERROR(1/A1,B1:B3))", [60.0, 1.0, 0.5, 1 / 3]),
    ("ROWS(IF(A1>1,B1:B3,B1:B2))*1", [2.0, 2.0, 3.0, 3.0]),
]


@pytest.mark.parametrize(("formula", "expected"), VARYING, ids=[formula for formula, _ in VARYING])
def test_conditions_that_vary(run, formula, expected):
    (column,) = run({**CELLS, "H9": f"={formula}"}, {"A1": [0.0, 1.0, 2.0, 3.0]}, ["H9"]).forecasts
    assert column == expected


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("SUM(IF(A1:A3>1,B1:B3,0))", [50.0, 60.0]),
        ("SUM(IFERROR(B1:B3/(A1:A3-2),1))", [-10.0 + 1 + 30, 1.0 + 1 + 30]),
        ("SUM(CHOOSE({1,2},A1:A3,B1:B3))", [66.0, 67.0]),
        ("SUM(SWITCH(A1:A3,2,B1:B3,1))", [1.0 + 20 + 1, 10.0 + 20 + 1]),
        ("SUM(IFS(A1:A3>1,B1:B3,TRUE,1))", [51.0, 60.0]),
    ],
)
def test_conditions_of_many_cells(run, formula, expected):
    cells = CELLS | {"H9": CellContent(None, Formula(formula, 9, 8, dynamic=True))}
    assert run(cells, {"A1": [1.0, 2.0]}, ["H9"]).forecasts == [expected]


@pytest.mark.parametrize(
    "formula", ["IF(TRUE,A1,LN(A1))", "IF(FALSE,LN(A1),A1)", "IFS(FALSE,LN(A1),TRUE,A1,A1>0,LN(A1))",
                "SWITCH(1,2,LN(A1),1,A1,LN(A1))", "CHOOSE(2,LN(A1),A1,LN(A1))", "IFERROR(D1,A1)", "IF(D1,LN(A1),2)"],
)  # fmt: skip
def test_branches_that_are_excluded_are_not_lowered(lower, formula):
    lowering, _ = lower({**CELLS, "H9": f"={formula}"}, ["A1"], ["H9"])
    assert not [node for node in lowering.dag.nodes if isinstance(node, Apply)]
    assert all(isinstance(node, Input | Constant) for node in lowering.dag.nodes)


def test_what_is_refused(value_of):
    with pytest.raises(XlmcError, match="IFS takes pairs of a condition and a value"):
        value_of(CELLS, "IFS(A1>1,1,TRUE)")
