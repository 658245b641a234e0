"""Functions that take references: what they tell of places, sizes, sheets and formulas."""

from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode, XlmcError
from xlmc.excel.address import Cell

CELLS = {
    "A1": 1.0, "A2": 2.0, "A3": 3.0, "A4": 4.0, "B1": 10.0, "B2": 20.0, "B3": 30.0, "B4": 40.0,
    "C1": "x", "C2": True, "C4": '=""', "D1": "=A1+1", "D2": "=SUM(A1:A2)", "E1": "=1/0", "Other!A1": 100.0,
    "Other!B2": "=A1", "Third!A1": 5.0,
}  # fmt: skip

REF, VALUE, DIV0, NA = ErrorCode.REF, ErrorCode.VALUE, ErrorCode.DIV0, ErrorCode.NA

SINGLE = [  # in H9 of the first sheet
    ("ROW()", 9.0),
    ("COLUMN()", 8.0),
    ("ROW(C3)", 3.0),
    ("COLUMN(C3)", 3.0),
    ("ROW(B2:D7)", 2.0),
    ("COLUMN(B2:D7)", 2.0),
    ("ROW(Other!D5)", 5.0),
    ("ROWS(B2:D7)", 6.0),
    ("COLUMNS(B2:D7)", 3.0),
    ("ROWS(B:B)", 1048576.0),
    ("COLUMNS(2:3)", 16384.0),
    ("ROWS({1,2,3;4,5,6})", 2.0),
    ("COLUMNS({1,2,3;4,5,6})", 3.0),
    ("AREAS(A1:B2)", 1.0),
    ("AREAS((A1:B2,C1))", 2.0),
    ("ISREF(A1:B2)", True),
    ("ISREF(A1+1)", False),
    ("ISREF(E1)", True),
    ("ISREF(INDEX(A1:B4,2,2))", True),
    ("ISREF(INDEX({1,2},2))", False),
    ("ISREF(INDEX(A1:B4,9,9))", False),
    ("ISREF(IF(A1=1,A1,2))", True),
    ("ISREF(IF(A1=2,A1,2))", False),
    ("N(A2:B4)", 2.0),
    ("N(C2)", 1.0),
    ("N(C1)", 0.0),
    ('N("7")', 0.0),
    ("N(E1)", DIV0),
    ("T(C1:C2)", "x"),
    ("T(A1)", ""),
    ("T(C2)", ""),
    ('T("y")', "y"),
    ("ISFORMULA(D1)", True),
    ("ISFORMULA(D1:E1)", True),
    ("ISFORMULA(A1:D1)", False),
    ("ISFORMULA(Other!B2)", True),
    ("ISFORMULA(Z99)", False),
    ("FORMULATEXT(D2)", "=SUM(A1:A2)"),
    ("FORMULATEXT(D1:D2)", "=A1+1"),
    ("FORMULATEXT(Other!B2)", "=A1"),
    ("FORMULATEXT(A1)", NA),
    ("FORMULATEXT(H9)", "=FORMULATEXT(H9)"),
    ("SHEET()", 1.0),
    ("SHEET(Third!A1)", 3.0),
    ('SHEET("THIRD")', 3.0),
    ('SHEET("none")', NA),
    ("SHEETS()", 3.0),
    ("SHEETS(A1)", 1.0),
    ("SHEETS(S:Third!A1)", 3.0),
    ("SHEETS(Other:Third!A1)", 2.0),
    ('CELL("row",B3:C4)', 3.0),
    ('CELL("row")', 9.0),
    ('CELL("COL",C3)', 3.0),
    ('CELL("col")', 8.0),
    ('CELL("address",AB12)', "$AB$12"),
    ('CELL("address",Other!C1)', "'[book.xlsx]Other'!$C$1"),
    ('CELL("contents",A3:B4)', 3.0),
    ('CELL("contents",Z99)', 0.0),
    ('CELL("contents",C1)', "x"),
    ('CELL("type",Z99)', "b"),
    ('CELL("type",C1)', "l"),
    ('CELL("type",C4)', "l"),
    ('CELL("type",C2)', "v"),
    ('CELL("type",A1)', "v"),
    ('CELL("type",D1)', "v"),
    ('CELL("filename",A1)', "[book.xlsx]S"),
    ('CELL("filename",Third!A1)', "[book.xlsx]Third"),
    ('SUMIF(A1:A4,">2",B1)', 70.0),
    ('SUMIF(A1:A4,">2",B1:B2)', 70.0),
    ('SUMIF(A1:A2,">1",B1:B4)', 20.0),
    ('SUMIF(A1:B1,">1",A3:A4)', 30.0),
    ('AVERAGEIF(A1:A4,">2",B1)', 35.0),
    ('AVERAGEIF(A1:A4,">2",B2:C3)', 40.0),
    ('SUMIF(A:A,">2",B1)', 70.0),
    ('SUMIF(A:A,">2",B:B)', 70.0),
    ('COUNTIF(A:A,">2")', 2.0),
    ('COUNTIF(A:A,"")', 1048572.0),
    ('COUNTIF(A:B,"<>x")', 2097152.0),
    ('COUNTIF(C:C,"x")', 1.0),
    ('COUNTIFS(A:A,"",B:B,"")', 1048572.0),
    ('COUNTIFS(A:A,">1",B:B,"<40")', 2.0),
    ('COUNTIFS(A:A,">1",B1:B4,"<40")', VALUE),
    ("COUNTBLANK(C:C)", 1048574.0),
    ("COUNTBLANK(C1:C4)", 2.0),
    ("COUNTBLANK(A:C)", 3 * 1048576.0 - 10),
    ("AVERAGEA(A1:A4)", 2.5),
    ("AVERAGEA(A1:A4,C1:C2)", (10.0 + 1.0) / 6),
    ("MAXA(C1:C2)", 1.0),
    ("MINA(A1:A4,C1:C1)", 0.0),
    ("INDEX((A1:A4,B1:B4),3,1,2)", 30.0),
    ("INDEX(B1:B4,2)", 20.0),
]  # fmt: skip


@pytest.mark.parametrize(("formula", "expected"), SINGLE, ids=[formula for formula, _ in SINGLE])
def test_of_single_formulas(value_of, formula, expected):
    assert value_of(CELLS, formula, sheets=("Other", "Third")) == expected


ARRAYS = [
    ("ROW(B2:C4)", [[2.0], [3.0], [4.0]]),
    ("COLUMN(B2:D3)", [[2.0, 3.0, 4.0]]),
    ("ROW(B2)", [[2.0]]),
    ("ROW()+{0,1}", [[9.0, 10.0]]),
    ("N(A1:A3)", [[1.0]]),
    ("INDEX((A1:A4,B1:B4),{2;3},1,2)", [[20.0], [30.0]]),
    ('AVERAGEA(IF({1,0},{1,"x"},TRUE))', [[1.0]]),
]  # fmt: skip


@pytest.mark.parametrize(("formula", "expected"), ARRAYS)
def test_of_arrays(value_of, formula, expected):
    result = value_of(CELLS, formula, array=True)
    assert (result if isinstance(result, list) else [[result]]) == expected


@pytest.mark.parametrize(
    ("at", "expected"), [(Cell("S", 2, 9), 20.0), (Cell("S", 3, 9), 30.0), (Cell("S", 9, 9), VALUE)]
)
def test_a_column_of_a_table_takes_the_cell_beside(value_of, at, expected):
    assert value_of(CELLS, "INDEX(A1:B4,0,2)", at=at) == expected


@pytest.mark.parametrize(
    ("at", "expected"), [(Cell("S", 9, 1), 3.0), (Cell("S", 9, 2), 30.0), (Cell("S", 9, 3), VALUE)]
)
def test_a_row_of_a_table_takes_the_cell_above(value_of, at, expected):
    assert value_of(CELLS, "INDEX(A1:B4,3,0)", at=at) == expected


@pytest.mark.parametrize(
    ("formula", "message"),
    [
        ("ROW(1)", "a reference is needed here"),
        ('CELL("colour",A1)', "CELL\\('colour'\\) is not supported"),
        ("ISREF(IF(A1>1,A2,3))", "what ISREF is asked about depends on a value that varies"),
        ("ISREF(CHOOSE(A1,A2,3))", "what ISREF is asked about depends on a value that varies"),
        ("ISREF(IF(A1>1,4,IF(A1>2,A2,3)))", "what ISREF is asked about depends on a value that varies"),
        ("CELL(A1,A2)", "the first argument of CELL must not vary"),
        ("SHEET(A1&1)", "SHEET needs a reference"),
    ],
)
def test_refusals(lower, formula, message):
    with pytest.raises(XlmcError, match=f"(?i){message}"):
        lower({**CELLS, "H9": f"={formula}"}, ["A1"], ["H9"])


@pytest.mark.parametrize(("formula", "expected"), [("ISREF(IF(A1>1,2,3))", 0.0), ("ISREF(CHOOSE(A1,2,3))", 0.0)])
def test_no_reference_whatever_varies(run, formula, expected):
    assert run({**CELLS, "H9": f"={formula}+0*A1"}, {"A1": [1.0, 2.0]}, ["H9"]).forecasts == [[expected] * 2]


@pytest.mark.parametrize(
    ("formula", "expected"),
    [
        ("INDEX((B1:B4,C1:C2),2,1,A1)", ["#VALUE!", 20.0, 1.0, "#REF!"]),
        ("INDEX((B1:B4,C1:C2),A1,1)", ["#VALUE!", 10.0, 20.0, 30.0]),
        ("INDEX((B1:B4,C1:C2),A1,1,)", ["#VALUE!"] * 4),
        ("INDEX((B1:B4,C1:C2),2,A1,1)", [20.0, 20.0, "#REF!", "#REF!"]),
        ("INDEX((B1:B4,C1:C2),2,1,A1/0)", ["#DIV/0!"] * 4),
        ('SUMIF(A1:A4,">2",B1)+0*A1', [70.0, 70.0, 70.0, 100.0 - 20.0]),
        ('COUNTIF(A:A,"<1")', [1.0, 0.0, 0.0, 0.0]),
        ('COUNTIF(A:A,">2")', [2.0, 2.0, 2.0, 3.0]),
        ('CELL("contents",A1)', [0.5, 1.0, 2.0, 3.0]),
        ("N(A1:B1)", [0.5, 1.0, 2.0, 3.0]),
        ("AVERAGEA(A1:A4,C2)", [2.1, 2.2, 2.4, 2.6]),
    ],
)
def test_of_values_that_vary(run, formula, expected):
    cells = {**CELLS, "H9": f"={formula}"}
    (column,) = run(cells, {"A1": [0.5, 1.0, 2.0, 3.0]}, ["H9"]).forecasts
    assert [item if isinstance(item, str) else round(item, 9) for item in column] == expected
