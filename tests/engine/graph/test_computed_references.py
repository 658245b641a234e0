"""References worked out on the way: where they lead, as Excel documents it."""

from __future__ import annotations

import pytest

from xlmc.engine.graph.computed_references import join_areas
from xlmc.errors import ErrorCode, XlmcError
from xlmc.excel.address import Area
from xlmc.excel.formula import ir
from xlmc.excel.workbook.workbook import CellContent, Formula

CELLS = {f"{column}{row}": 10.0 * row + index for index, column in enumerate("ABCD", 1) for row in range(1, 5)} | {
    "E1": "=1/0", "E2": "B2", "E3": True, "E4": "text", "Other!A1": 100.0, "Other!B2": 200.0,
}  # fmt: skip
"""A1:D4 hold 11 to 44: ten times the row, and the column."""

REF, VALUE, NULL, DIV0 = ErrorCode.REF, ErrorCode.VALUE, ErrorCode.NULL, ErrorCode.DIV0

SINGLE = [
    ("OFFSET(A1,2,1)", 32.0),
    ("OFFSET(B2,-1,-1)", 11.0),
    ("OFFSET(B2,0.9,-0.9)", 22.0),
    ("OFFSET(B2,1.9,1.9)", 33.0),
    ("OFFSET(B2,,)", 22.0),
    ("OFFSET(B2,,1)", 23.0),
    ("OFFSET(B2,1,)", 32.0),
    ("SUM(OFFSET(B2:C3,1,1))", 33.0 + 34.0 + 43.0 + 44.0),
    ("SUM(OFFSET(B2:C3,0,0,1))", 45.0),
    ("SUM(OFFSET(B2:C3,0,0,,1))", 22.0 + 32.0),
    ("SUM(OFFSET(B2:C3,0,0,1,))", 22.0 + 23.0),
    ("SUM(OFFSET(C3,0,0,-2,-3))", 21.0 + 22.0 + 23.0 + 31.0 + 32.0 + 33.0),
    ("SUM(OFFSET(B2,0,0,2.9,1.9))", 22.0 + 32.0),
    ("SUM(OFFSET(B2,0,0,0.9,1))", 22.0 + 12.0),
    ("SUM(OFFSET(B2,0,0,-1,1))", 22.0),
    ("SUM(OFFSET(B2,0,0,0,1))", REF),
    ("SUM(OFFSET(B2,0,0,1,0))", REF),
    ("OFFSET(A1,0,-1)", REF),
    ("OFFSET(B1,-1,0)", REF),
    ("OFFSET(A1048576,1,0)", REF),
    ("ISREF(OFFSET(A1048575,1,0))", True),
    ("ISREF(OFFSET(XFC1,0,1))", True),
    ("OFFSET(XFD1,0,1)", REF),
    ("OFFSET(A1,E1,0)", DIV0),
    ("OFFSET(A1,E3,0)", 21.0),
    ("OFFSET(A1,E4,0)", VALUE),
    ("OFFSET(Other!A1,1,1)", 200.0),
    ('INDIRECT("C"&3)', 33.0),
    ('INDIRECT("R2C3",FALSE)', 23.0),
    ('INDIRECT("R2C3",0)', 23.0),
    ('INDIRECT("C3",1)', 33.0),
    ('INDIRECT("R[-7]C[-6]",FALSE)', 22.0),
    ('INDIRECT("C3",E4)', VALUE),
    ('INDIRECT("C3",E1)', DIV0),
    ('INDIRECT(E2)', 22.0),
    ('INDIRECT(E4)', REF),
    ('INDIRECT({"B1";"B2"})', 12.0),
    ('INDIRECT({"B1","B2"})', 12.0),
    ('INDIRECT("C3",{TRUE,FALSE})', 33.0),
    ("CHOOSE(E1,A1,B1)", DIV0),
    ("ROWS(CHOOSE(E1,A1,B1))", DIV0),
    ('INDIRECT("Other!B2")', 200.0),
    ('INDIRECT("S:Other!A1")', REF),
    ('SUM(INDIRECT("B2:C3"))', 110.0),
    ("SUM(B2:C3 C2:D4)", 23.0 + 33.0),
    ("SUM(B2:C3 C3:D4)", 33.0),
    ("B2:C2 D3:D4", NULL),
    ("SUM(A1:B2 A3:B4)", NULL),
    ("SUM(A1:A4 B1:B4)", NULL),
    ("SUM(A1:A2 A2:A4)", 21.0),
    ("SUM(A1:B4 B1:C4)", 12.0 + 22.0 + 32.0 + 42.0),
    ("SUM(OFFSET(B2,0,0):C3)", 110.0),
    ("SUM(C3:OFFSET(B2,0,0))", 110.0),
    ("SUM(B3:OFFSET(C2,0,0))", 110.0),
    ("SUM(INDEX(A1:D4,2,2):INDEX(A1:D4,3,3))", 110.0),
    ("SUM(INDEX(A1:A4,2):D2)", 21.0 + 22.0 + 23.0 + 24.0),
    ("INDEX(A1:D4,3,2)", 32.0),
    ("INDEX(A1:D4,3.9,2.9)", 32.0),
    ("INDEX(A1:D4,4,4)", 44.0),
    ("INDEX(A1:D4,5,1)", REF),
    ("INDEX(A1:D4,1,5)", REF),
    ("INDEX(A1:D4,-1,1)", VALUE),
    ("INDEX(A1:D4,1,-1)", VALUE),
    ("INDEX(A1:D4,2)", REF),
    ("INDEX(A1:D1,3)", 13.0),
    ("INDEX(A1:A4,3)", 31.0),
    ("INDEX(A1:A1,1)", 11.0),
    ("INDEX(A1:A4,5)", REF),
    ("INDEX(A1:D1,5)", REF),
    ("SUM(INDEX(A1:D4,0,2))", 12.0 + 22.0 + 32.0 + 42.0),
    ("SUM(INDEX(A1:D4,2,0))", 21.0 + 22.0 + 23.0 + 24.0),
    ("SUM(INDEX(A1:D4,2,))", 21.0 + 22.0 + 23.0 + 24.0),
    ("SUM(INDEX(A1:D4,0,0))", sum(10 * row + column for row in range(1, 5) for column in range(1, 5))),
    ("SUM(INDEX(A1:D1,0))", 11.0 + 12.0 + 13.0 + 14.0),
    ("INDEX((A1:B2,C3:D4),2,1,2)", 43.0),
    ("INDEX((A1:B2,C3:D4),2,1,1)", 21.0),
    ("INDEX((A1:B2,C3:D4),2,1)", 21.0),
    ("INDEX((A1:B2,C3:D4),2,1,)", VALUE),
    ("INDEX((A1:B2,C3:D4),2,1,3)", REF),
    ("INDEX({1,2;3,4},1,2,)", VALUE),
    ("INDEX({1,2;3,4},1,2,1)", 2.0),
    ("INDEX({1,2;3,4},1,2,2)", REF),
    ("INDEX((A1:B2,C3:D4),2,1,0)", VALUE),
    ("INDEX(A1:D4,E1,1)", DIV0),
    ("SUM(CHOOSE(2,A1:A2,B1:B2))", 12.0 + 22.0),
    ("SUM(CHOOSE(1,A1:A2,B1:B2))", 11.0 + 21.0),
    ("SUM(CHOOSE(2.9,A1:A2,B1:B2))", 12.0 + 22.0),
    ("SUM(CHOOSE(3,A1:A2,B1:B2))", VALUE),
    ("SUM(CHOOSE(0,A1:A2,B1:B2))", VALUE),
    ("ROWS(CHOOSE(2,A1:A2,B1:B4))", 4.0),
    ("ROW(CHOOSE(1,A3,B1))", 3.0),
    ("ROW(CHOOSE(2,5,B4))", 4.0),
    ("ROWS(IF(A1>0,A1:A3,B1:B2))", 3.0),
    ("ROWS(IF(A1<0,A1:A3,B1:B2))", 2.0),
    ("ROW(IF(TRUE,OFFSET(A1,2,0)))", 3.0),
    ("SUM(IF(FALSE,A1:A3))", 0.0),
    ("ISREF(CHOOSE(1,2,3))", False),
    ("ISREF((A1,B2))", True),
    ("AREAS((A1,B2:C3,(D1,D2)))", 4.0),
    ("LET(r,A1:B2,s,OFFSET(r,1,1),SUM(s))", 22.0 + 23.0 + 32.0 + 33.0),
    ("LET(r,5,ISREF(r))", False),
    ("SUM(OFFSET((A1:A2),1,0))", 21.0 + 31.0),
]  # fmt: skip


@pytest.mark.parametrize(("formula", "expected"), SINGLE, ids=[formula for formula, _ in SINGLE])
def test_where_they_lead(value_of, formula, expected):
    assert value_of(CELLS, formula) == expected


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("OFFSET((A1,B2),1,1)", "OFFSET starts from a reference to one area"),
        ("OFFSET(A1&1,1,1)", "OFFSET starts from a reference to one area"),
        ("SUM(OFFSET(A1,0,0):Other!B2)", "not areas of one sheet"),
        ("SUM(Other!A1:OFFSET(A1,0,0))", "not areas of one sheet"),
        ("SUM(OFFSET(A1,0,0):(A1,B2))", "needs references on both sides|not areas of one sheet"),
    ],
)
def test_what_leads_nowhere_is_refused(value_of, formula, message):
    with pytest.raises(XlmcError, match=message):
        value_of(CELLS, formula)


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("SUM(A1:INDEX(B1:B4,A1))", "an end of a range must be fixed"),
        ("SUM(INDEX(B1:B4,A1):B4)", "an end of a range must be fixed"),
        ("OFFSET(B1,A1,0)", "OFFSET depends on a value that varies"),
        ("OFFSET(B1,0,0,A1)", "OFFSET depends on a value that varies"),
        ('INDIRECT("B"&A1)', "INDIRECT depends on a value that varies"),
        ('INDIRECT("B1",A1>20)', "whether INDIRECT reads A1 or R1C1 must not vary"),
    ],
)
def test_what_varies_is_refused(lower, formula, message):
    with pytest.raises(XlmcError, match=f"(?i){message}"):
        lower({**CELLS, "H9": f"={formula}"}, ["A1"], ["H9"])


def test_several_ranges_at_once_are_refused(value_of):
    with pytest.raises(XlmcError, match="OFFSET leads to several ranges at once"):
        value_of(CELLS, "OFFSET(A1,{0,1},0)", array=True)
    assert value_of(CELLS, "OFFSET(A1,{1},0)", array=True) == [[21.0]]


ARRAYS = [
    ("OFFSET(A1,1,1,2,2)", [[22.0, 23.0], [32.0, 33.0]]),
    ("INDEX(A1:D4,0,2)", [[12.0], [22.0], [32.0], [42.0]]),
    ("INDEX(A1:D4,2,0)", [[21.0, 22.0, 23.0, 24.0]]),
    ("INDEX(A1:D4,{1;3},2)", [[12.0], [32.0]]),
    ("INDEX(A1:A4,1):INDEX(A1:A4,2)", [[11.0], [21.0]]),
    ('INDIRECT("B2:B3")', [[22.0], [32.0]]),
    ("IF(A1>0,A1:A2,B1:B2)", [[11.0], [21.0]]),
    ("B2:C3 C2:D3", [[23.0], [33.0]]),
]


@pytest.mark.parametrize(("formula", "expected"), ARRAYS)
def test_in_array_formulas(value_of, formula, expected):
    assert value_of(CELLS, formula, array=True) == expected


def test_areas_are_joined_in_order():
    first, second, third = (Area("S", row, 1, row, 2) for row in (1, 2, 3))
    assert join_areas([first]) == first
    assert join_areas([first, second, third]) == ir.Binary(",", ir.Binary(",", first, second), third)


def _spilled(values=(1.0, 2.0), formula="A1:A2*2", dynamic=True, rows=2):
    anchor = CellContent(values[0], Formula(formula, 1, 7, array=Area("S", 1, 7, rows, 7), dynamic=dynamic))
    return {**CELLS, "G1": anchor, "G2": values[1]}


@pytest.mark.parametrize(
    ("cells", "formula", "expected"),
    [
        (_spilled(), "SUM(_xlfn.ANCHORARRAY(G1))", 64.0),
        (_spilled(), "ROWS(_xlfn.ANCHORARRAY(G1))", 2.0),
        (_spilled((22.0, None)), "SUM(_xlfn.ANCHORARRAY(G1))", 64.0),
        (_spilled((22.0, 42.0), "A1:A3*2"), "SUM(_xlfn.ANCHORARRAY(G1))", 126.0),
        (_spilled(dynamic=False), "SUM(_xlfn.ANCHORARRAY(G1))", REF),
        (_spilled(), "SUM(_xlfn.ANCHORARRAY(A1))", REF),
        (_spilled(), "SUM(_xlfn.ANCHORARRAY(G2))", REF),
        ({**CELLS, "G1": "=A1"}, "SUM(_xlfn.ANCHORARRAY(G1))", REF),
    ],
)
def test_what_a_dynamic_array_fills(value_of, cells, formula, expected):
    """A size that the file does not declare is that of the array; nothing spills from other cells."""
    assert value_of(cells, formula) == expected


@pytest.mark.parametrize("formula", ["EDATE({},1)", "WORKDAY({},1)", "DEC2BIN({})"])
@pytest.mark.parametrize(
    ("argument", "fails"),
    [
        ("A1:A2", True), ("(A1,A2)", True), ("OFFSET(A1,0,0,2,1)", True), ("INDEX(A1:A2,0)", True),
        ("CHOOSE(1,A1:A2,A1)", True), ("CHOOSE(2,A1:A2,A1)", False), ("IF(A1>0,A1:A2,A1)", True),
        ("IF(A1<0,A1:A2,A1)", False), ("OFFSET(A1,0,0)", False), ("INDEX(A1:A2,1)", False),
        ("LET(r,A1:A2,r)", True), ("A1:A1", False),
    ],
)  # fmt: skip
def test_functions_of_single_cells(value_of, formula, argument, fails):
    """Functions of the former toolpak give `#VALUE!` for a range of several cells, wherever it comes from."""
    result = value_of(CELLS | {"A1": 3.0}, formula.replace("{}", argument))
    assert (result == VALUE) == fails
