"""Which arguments of a plain formula are computed cell by cell, and which take the cell of a range beside the formula.

The classes are those of Excel's file format ("OpenOffice.org's documentation of the Microsoft Excel file format", 3.2,
and the table of functions there: reference, value and array classes); what they come to in words is in
`docs/functions.md`. The formulas stand where nothing lies beside a range, so that it gives `#VALUE!`.
"""

from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area
from xlmc.excel.functions.families import REGISTRY
from xlmc.excel.functions.registry import Ranges
from xlmc.excel.workbook.workbook import CellContent, Formula

VALUE, NA, REF = ErrorCode.VALUE, ErrorCode.NA, ErrorCode.REF

CELLS = {
    "A1": "x", "A2": "y", "A3": "x",
    "B1": 3.0, "B2": 3.0, "B3": 5.0,
    "C1": 4.0, "C2": 2.0, "C3": 9.0,
    "D1": 1.0, "D2": 2.0, "D3": 3.0,
    "E1": 0.0, "E2": 1.0, "E3": 2.0,
    "F1": 0.0,
}  # fmt: skip

CELL_BY_CELL = [
    ('MATCH(1,INDEX((A1:A3="x")*(B1:B3=5),0),0)', 3.0),
    ('MATCH(1,INDEX((A1:A3="y")*(B1:B3=3),0,1),0)', 2.0),
    ('MATCH(TRUE,INDEX(A1:A3="y",0),0)', 2.0),
    ('INDEX(C1:C3,MATCH(1,INDEX((A1:A3="x")*(B1:B3=5),0),0))', 9.0),
    ("INDEX(ROW(A1:A3),2)", 2.0),
    ("INDEX(C1:C3*2,3)", 18.0),
    ("INDEX(B1:C3*2,2,2)", 4.0),
    ("SUM(INDEX((C1:C3>3)*C1:C3,0))", 13.0),
    ("SUM(INDEX(C1:C3*D1:D3,F1))", 35.0),
    ("SUM(INDEX(C1:C3*D1:D3,0))", 35.0),
    ("LARGE(INDEX(C1:C3*D1:D3,0),2)", 4.0),
    ("LARGE(INDEX(C1:C3*D1:D3,F1),2)", 4.0),
    ("AND(INDEX(C1:C3>1,0))", True),
    ("AND(INDEX(C1:C3>3,F1))", False),
    ("OR(INDEX(C1:C3>8,0))", True),
    ("MAX(INDEX(ROW(A1:A3)*(A1:A3=\"x\"),0))", 3.0),
    ("COUNT(INDEX(1/(B1:B3=3),0))", 2.0),
    ("SUMPRODUCT((C1:C3>3)*C1:C3)", 13.0),
    ("SUMPRODUCT(SQRT(C1:C3)*ABS(-D1:D3))", 2.0 + 2 * 2.0**0.5 + 9.0),
    ("SUMPRODUCT(LARGE(C1:C3*D1:D3,D1:D2))", 31.0),
    ("SUMPRODUCT(SUM(C1:C3*D1:D3))", 35.0),
    ("LOOKUP(2,1/(B1:B3=3),C1:C3)", 2.0),
    ("LOOKUP(6,C1:C3*D1:D3)", 4.0),
    ("SUM(MMULT(C1:C3*1,TRANSPOSE({1;2;3})))", 90.0),
    ("MDETERM(C1:D2*2)", 24.0),
    ("SUM(MINVERSE(C1:D2*1))", 0.5),
    ("SUM(FREQUENCY(C1:C3*2,D1:D2*4))", 3.0),
    ("MODE(B1:B3*2)", 6.0),
    ("MODE.SNGL(B1:B3+1)", 4.0),
    ("SUMX2MY2(C1:C3*1,D1:D3*1)", 101.0 - 14.0),
    ("SUMX2PY2(C1:C3*1,D1:D3*1)", 115.0),
    ("SUMXMY2(C1:C3*1,D1:D3*1)", 45.0),
    ("CORREL(C1:C3*2,C1:C3*3)", 1.0),
    ("PEARSON(C1:C3*2,C1:C3*-3)", -1.0),
    ("RSQ(C1:C3*2,C1:C3*3)", 1.0),
    ("COVAR(D1:D3*2,D1:D3*3)", 4.0),
    ("COVARIANCE.P(D1:D3*2,D1:D3*3)", 4.0),
    ("COVARIANCE.S(D1:D3*2,D1:D3*3)", 6.0),
    ("SLOPE(D1:D3*2,D1:D3)", 2.0),
    ("INTERCEPT(D1:D3*2+1,D1:D3)", 1.0),
    ("STEYX(D1:D3*2,D1:D3)", 0.0),
    ("FORECAST(5,D1:D3*2,D1:D3*1)", 10.0),
    ("FORECAST.LINEAR(5,D1:D3*2,D1:D3*1)", 10.0),
    ("INDEX(LINEST(D1:D3*2,D1:D3*1),1)", 2.0),
    ("INDEX(LOGEST(2^D1:D3,D1:D3*1),1)", 2.0),
    ("INDEX(TREND(D1:D3*2,D1:D3*1,D1:D3+1),3)", 8.0),
    ("INDEX(GROWTH(2^D1:D3,D1:D3*1,D1:D3+1),3)", 16.0),
    ("IRR(C1:C3*{-1;0;1})", 0.5),
    ("MIRR(C1:C3*{-1;0;1},0.1,0.1)", 0.5),
    ("PROB(D1:D3,D1:D3/6,2)", 2 / 6),
    ("TTEST(C1:C3*1,C1:C3*1,2,1)", ErrorCode.DIV0),
    ("T.TEST(C1:C3*1,C1:C3*2/2,2,2)", 1.0),
    ("FTEST(C1:C3*1,C1:C3*1)", 1.0),
    ("F.TEST(C1:C3*1,C1:C3*1)", 1.0),
    ("CHITEST(C1:C3*1,C1:C3*1)", 1.0),
    ("CHISQ.TEST(C1:C3*1,C1:C3*1)", 1.0),
    ("AGGREGATE(14,6,C1:C3/(B1:B3=3),1)", 4.0),
    ("AGGREGATE(15,6,ROW(C1:C3)/(B1:B3=3),2)", 2.0),
    ("SUM(AGGREGATE(14,6,C1:C3,{1,2}))", 13.0),
    ("SUM(AGGREGATE(14,6,C1:C3,{1,2})*2)", 26.0),
    ("INDEX(AGGREGATE(15,6,C1:C3,{1,2}),1,2)", 4.0),
    ("AGGREGATE(14,6,C1:C3,{2,1})+1", 5.0),
    ("SUM(AGGREGATE(D1*14,6,C1:C3,{1,2}))", 13.0),
    ("AGGREGATE(9,6,C1:C3,D1:D2)", 18.0),
    ('XLOOKUP(1,(A1:A3="x")*(B1:B3=5),C1:C3)', 9.0),
    ('XMATCH(1,(A1:A3="x")*(B1:B3=5))', 3.0),
    ("SUM(FILTER(C1:C3,B1:B3=3))", 6.0),
    ("SUM(TAKE(SORT(C1:C3*-1),1))", -9.0),
    ("SUM(TAKE(SORTBY(C1:C3,B1:B3*-1),1))", 9.0),
    ("SUM(UNIQUE(B1:B3*2))", 16.0),
]  # fmt: skip

BESIDE = [
    ('MATCH(1,(A1:A3="x")*(B1:B3=5),0)', VALUE),
    ("SUM((C1:C3>3)*C1:C3)", VALUE),
    ("LARGE(C1:C3*D1:D3,2)", VALUE),
    ("AND(C1:C3>1)", VALUE),
    ("SUM(LARGE(C1:C3,D1:D2))", VALUE),
    ("SUM(LARGE(C1:C3,{1,2}))", 13.0),
    ("NPV(0.1,C1:C3*1)", VALUE),
    ("PERCENTILE(C1:C3*1,0.5)", VALUE),
    ("ZTEST(C1:C3*1,4)", VALUE),
    ("VLOOKUP(2,D1:E3*1,2)", VALUE),
    ("SUMPRODUCT(IF(C1:C3>3,C1:C3,0))", VALUE),
    ("SUMPRODUCT(IF(B1>1,C1:C3*2,0))", VALUE),
    ("SUMPRODUCT(IFERROR(C1:C3/B1:B3,0))", 0.0),
    ("SUMPRODUCT(IFERROR(1/F1,C1:C3*2))", VALUE),
    ("SUMPRODUCT(CHOOSE(B1-2,C1:C3*2,C1:C3))", VALUE),
    ("SUMPRODUCT(IFS(C1:C3>3,C1:C3))", VALUE),
    ("SUMPRODUCT(SWITCH(C1:C3,4,1,0))", VALUE),
    ("INDEX(IF(C1:C3>3,C1:C3),1)", VALUE),
    ("MATCH(1,INDEX(IF(B1:B3=5,1),0),0)", VALUE),
    ("SUMPRODUCT(VLOOKUP(D1:D3,D1:E3,2,0))", VALUE),
    ("SUMPRODUCT(INDEX(C1:C3,D1:D3))", VALUE),
    ("SUM(INDEX(C1:C3,{1,3}))", 4.0),
    ("SUMPRODUCT(TRANSPOSE(C1:C3)*{1,2,3})", VALUE),
    ("SUM(MMULT(TRANSPOSE(C1:C3),D1:D3))", VALUE),
]  # fmt: skip

BRANCHES_THAT_ARE_RANGES = [
    ("VLOOKUP(5,CHOOSE({1,2},B1:B3,C1:C3),2,0)", 9.0),
    ("VLOOKUP(5,IF({1,0},B1:B3,C1:C3),2,0)", 9.0),
    ("VLOOKUP(5,IF({1,0},B1:B3*1,C1:C3),2,0)", NA),
    ("SUMPRODUCT(IF(B1>1,C1:C3,D1:D3)*D1:D3)", 35.0),
    ("SUMPRODUCT(CHOOSE(B1-1,C1:C3,D1:D3)*D1:D3)", 14.0),
    ("SUMPRODUCT(CHOOSE(2,C1:C3,D1:D3)*D1:D3)", 14.0),
    ("SUM(IF(B1>1,C1:C3,D1:D3))", 15.0),
    ("SUM(IF(B1>1,IF(B1>2,C1:C3,B1:B3),D1:D3))", 15.0),
    ("IF(B1>1,C1:C3,D1:D3)", VALUE),
    ("SUM(IF(B1>1,C1:C3,D1:D3)*2)", VALUE),
    ("SUMPRODUCT(VLOOKUP(N(IF({1},D1:D2)),D1:E3,2,0))", 1.0),
    ("SUM(INDEX(C1:C3,N(IF(1,{1,3}))))", 13.0),
]

ZERO = [
    ("SUM(INDEX(C1:D3,{},1))", 15.0),
    ("SUM(INDEX(C1:D3,2,{}))", 4.0),
    ("SUM(INDEX(C1:D3,{},{}))", 21.0),
    ("INDEX(C1:D3,{},1)", VALUE),
    ("INDEX(C1:C3,{})", VALUE),
    ("INDEX(C1:C3,{})*2", VALUE),
    ("SUM(INDEX(C1:C3,{})*2)", VALUE),
    ("SUM(C1,INDEX(C1:C3,{}))", 19.0),
    ("MATCH(9,INDEX(C1:D3,{},1),0)", 3.0),
    ("SUMPRODUCT(INDEX(C1:D3,{},1)*D1:D3)", 35.0),
    ("COUNT(INDEX(A1:D3,2,{}))", 3.0),
    ("MAX(INDEX(B1:C3*2,{},2))", 18.0),
    ("ISNUMBER(INDEX(C1:C3,{}))", False),
    ("IFERROR(INDEX(C1:C3,{}),7)", 7.0),
    ("IF(TRUE,INDEX(C1:C3,{}),7)", VALUE),
]
"""With a 0 instead of `{}`, or a cell that holds 0."""

OUTSIDE = [
    ("INDEX(C1:C3,-1)", VALUE),
    ("INDEX(C1:C3,4)", REF),
    ("INDEX(C1:D3,2)", REF),  # a reference of rows and columns wants both numbers, an array does not
    ("SUM(INDEX(C1:D3,2))", REF),
    ("SUM(INDEX(C1:D3,E2))", REF),
    ("SUM(INDEX(C1:D3,2,))", 4.0),
    ("SUM(INDEX(C1:D3+0,2))", 4.0),
    ("SUM(INDEX(INDEX(C1:D3,0,0),2))", REF),
    ("INDEX(C1:D3,1,-1)", VALUE),
    ("INDEX(C1:D3,1,3)", REF),
    ("INDEX(C1:C3,0-D1)", VALUE),
    ("INDEX(C1:C3,D1+3)", REF),
    ("SUM(INDEX(C1:C3,-1))", VALUE),
    ("INDEX((C1:C3,D1:D3),1,1,2)", 1.0),
    ("INDEX((C1:C3,D1:D3),1,1,0)", VALUE),
    ("INDEX((C1:C3,D1:D3),1,1,3)", REF),
    ("INDEX((C1:C3,D1:D3),D2,1,2)", 2.0),
    ("SUMPRODUCT(INDEX((C1:C3,D1:D3),0,1,2)*C1:C3)", 35.0),
]

ONE_CELL = [
    ("EDATE(D1:D3,1)", VALUE),
    ("EDATE(D1,1)", 32.0),
    ("EDATE(D1:D1,1)", 32.0),
    ("EDATE(D1,C1:C3)", VALUE),
    ("SUMPRODUCT(EDATE(D1:D3,1))", VALUE),
    ("SUMPRODUCT(EDATE(+D1:D3,1))", 32.0 + 33 + 34),
    ("SUMPRODUCT(EDATE(D1:D3*1,1))", 32.0 + 33 + 34),
    ("SUM(EDATE({1,2,3},1))", 32.0 + 33 + 34),
    ("EDATE(D1:D3*1,1)", VALUE),
    ("SUMPRODUCT(EDATE(INDEX(D1:D3,0),1))", VALUE),
    ("SUMPRODUCT(EDATE(INDEX(D1:D3,2),1))", 33.0),
    ("SUMPRODUCT(EDATE(INDEX(D1:D3,D2),1))", 33.0),
    ("EDATE(OFFSET(D1,0,0,3),1)", VALUE),
    ("SUMPRODUCT(EDATE(IF(B1>1,D1:D3,C1),1))", VALUE),
    ("SUMPRODUCT(EDATE(IF(B1>9,D1:D3,D1),1))", 32.0),
    ("EDATE(CHOOSE(D2,D1:D3,D1),1)", 32.0),
    ("EDATE(CHOOSE(D1,D1:D3,D1),1)", VALUE),
    ("EDATE((D1:D2 D2:D3),1)", 33.0),
    ("LET(x,D1:D3,SUMPRODUCT(EDATE(x,1)))", VALUE),
    ("LET(x,D1:D3,SUMPRODUCT(EDATE(+x,1)))", 32.0 + 33 + 34),
    ("SUM(MAP(D1:D3,LAMBDA(x,EDATE(x,1))))", 32.0 + 33 + 34),
    ("SUMPRODUCT(--(WEEKNUM(D:D)=1))", VALUE),
    ("SUMPRODUCT(--(WEEKNUM(D1:D3)=1))", VALUE),
    ("SUMPRODUCT(--(WEEKNUM(D1:D3+0)=1))", 3.0),
    ("SUMPRODUCT(--ISODD(D1:D3))", VALUE),
    ("SUMPRODUCT(--ISODD(D1:D3+0))", 2.0),
    ("IFERROR(MROUND(D1:D3,2),7)", 7.0),
    ("SUMPRODUCT(QUOTIENT(C1:C3,2))", VALUE),
    ("SUMPRODUCT(QUOTIENT(+C1:C3,2))", 7.0),
    ("SUMPRODUCT(--DEC2BIN(D1:D3))", VALUE),
    ("SUMPRODUCT(--DEC2BIN(-D1:D3*-1))", 22.0),
    ("SUMPRODUCT(DELTA(D1:D3,2))", VALUE),
    ("SUMPRODUCT(NETWORKDAYS(D1:D3,C1:C3))", VALUE),
    ("NETWORKDAYS(D2,C3)", 6.0),
    ("NETWORKDAYS(D2,C3,C1:C3)", 3.0),
    ("SUMPRODUCT(NETWORKDAYS(+D1:D3,C3+0,C1:C3))", 3.0 + 3 + 3),
    ("GCD(C1:C3)", 1.0),
    ("LCM(C1:C3)", 36.0),
    ("MULTINOMIAL(D1:D3)", 60.0),
    ("SERIESSUM(2,0,1,D1:D3)", 17.0),
    ("SERIESSUM(D1:D3,0,1,D1:D3)", VALUE),
    ('IMSUM(D1:D3)', "6"),
    ("SUMPRODUCT(ISOWEEKNUM(D2:D3))", 2.0),
    ("SUMPRODUCT(WEEKDAY(D1:D3))", 6.0),
]  # fmt: skip
"""The arguments of the former Analysis ToolPak: `#VALUE!` for a range of several cells, arrays element by element."""


@pytest.mark.parametrize(
    "table",
    [CELL_BY_CELL, BESIDE, BRANCHES_THAT_ARE_RANGES, OUTSIDE, ONE_CELL],
    ids=["cell by cell", "beside", "branches", "outside", "one cell"],
)
def test_arguments_of_plain_formulas(gives, table):
    assert gives(CELLS, table, held=("E1", "E2", "E3")) == []


@pytest.mark.parametrize("dynamic", [False, True])
@pytest.mark.parametrize(("formula", "expected"), [("EDATE(D1:D3,1)", VALUE), ("EDATE(+D1:D3,1)", 32.0)])
def test_an_array_formula_refuses_a_range_where_one_cell_is_wanted(ways, formula, expected, dynamic):
    anchor = CellContent(None, Formula(formula, 1, 8, array=Area("S", 1, 8, 3, 8), dynamic=dynamic))
    answers = ways(CELLS | {"H1": anchor}, ["H1"])
    assert {way: result[0] for way, result in answers.items()} == dict.fromkeys(
        answers, expected.text if isinstance(expected, ErrorCode) else expected
    )


@pytest.mark.parametrize("zero", ["0", "F1", "F1*1"])
def test_a_drawn_index_of_0_gives_what_a_constant_0_gives(gives, zero):
    table = [(formula.replace("{}", zero), expected) for formula, expected in ZERO]
    assert gives(CELLS, table, held=("E1", "E2", "E3")) == []


BESIDE_A_ROW = [
    (("H2", "INDEX(C1:C3,{})"), 2.0),
    (("H3", "INDEX(C1:C3,{})*2"), 18.0),
    (("H2", "INDEX(C1:D3,{},2)"), 2.0),
    (("C9", "INDEX(B1:D3,2,{})"), 2.0),
    (("E9", "INDEX(B1:D3,2,{})"), VALUE),
    (("H2", "INDEX(B1:D3,{},{})"), VALUE),
]


@pytest.mark.parametrize("zero", ["0", "F1"])
@pytest.mark.parametrize(("placed", "expected"), BESIDE_A_ROW, ids=[f"{at} {text}" for (at, text), _ in BESIDE_A_ROW])
def test_a_whole_column_by_index_0_gives_the_cell_beside_the_formula(gives, placed, expected, zero):
    at, text = placed
    assert gives(CELLS, [((at, text.replace("{}", zero)), expected)]) == []


def test_every_class_of_arguments_is_in_a_row_of_the_registry():
    rows = set(REGISTRY.values())
    result = {row.parameter(i).ranges for row in rows for i in range(len(row.parameters))}
    assert result == set(Ranges)
    values = [row.name for row in rows if any(p.ranges is Ranges.CELLS and not p.ranged for p in row.parameters)]
    assert values == []


def test_offset_to_several_places_at_once_is_refused(lower):
    cells = CELLS | {"H9": "=D1+SUMPRODUCT(SUBTOTAL(9,OFFSET(C1,ROW(C1:C3)-1,0)))"}
    with pytest.raises(FormulaError, match="several ranges at once"):
        lower(cells, {"D1": [1.0]}, ["H9"])
