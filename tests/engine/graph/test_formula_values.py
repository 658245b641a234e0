"""What formulas give, as Excel does: ranges, arrays, references worked out on the way, LET and LAMBDA.

Every formula is computed twice: from constants, and with A1 and B2 as assumptions drawn at these same values.
"""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.analysis.studies.verify import verify
from xlmc.errors import ErrorCode, XlmcError
from xlmc.excel.address import Area
from xlmc.excel.workbook.workbook import CellContent, Formula

CELLS = {
    "A1": 1.0,
    "A2": 2.0,
    "A3": 3.0,
    "B1": 10.0,
    "B2": 20.0,
    "B3": 30.0,
    "C1": "x",
    "C2": True,
    "C3": None,
    "D1": "=A1+1",
    "D2": "=B2/A2",
    "D3": "=SUM(A1:A3)",
    "E1": "=1/0",
    "E2": '=""',
    "E3": "B2",
    "Other!A1": 100.0,
    "Other!A2": 200.0,
    "Third!A1": 1000.0,
}
NAMES = {"Rate": "0.5", "Span": "S!$A$1:$A$3", "Twice": "_xlfn.LAMBDA(_xlpm.x,_xlpm.x*2)", "Next": "S!B1"}

PLAIN = [
    ("A1:A3*2", ErrorCode.VALUE),  # in H9 nothing stands beside the range
    ("SUM(A1:A3)", 6.0),
    ("SUM(A:A)", 6.0),
    ("SUM(S:Third!A1)", 1101.0),
    ('SUM(INDIRECT("S:Third!A1"))', ErrorCode.REF),
    ("SUM((A1,B2:B3))", 51.0),
    ("SUM(A1:B2 B1:B3)", 30.0),
    ("A1:B2 C1", ErrorCode.NULL),
    ("SUMPRODUCT(A1:A3,B1:B3)", 140.0),
    ("SUMPRODUCT((A1:A3>1)*B1:B3)", 50.0),
    ("SUMPRODUCT(--(A1:A3=2),B1:B3)", 20.0),
    ("IF(A1>5,1/0,A2)", 2.0),
    ("IFS(A1>5,1/0,A1=1,7)", 7.0),
    ("IFS(A1>5,1)", ErrorCode.NA),
    ('SWITCH(A2,1,"a",2,"b","c")', "b"),
    ('SWITCH(A3,1,"a",2,"b","c")', "c"),
    ("SWITCH(A3,1,10)", ErrorCode.NA),
    ("CHOOSE(A2,10,A3,1/0)", 3.0),
    ("CHOOSE(4,1,2,3)", ErrorCode.VALUE),
    ("SUM(CHOOSE(2,A1:A3,B1:B3))", 60.0),
    ("SUM(IF(A1=1,A1:A3,B1:B3))", 6.0),
    ("IFERROR(E1,A2)", 2.0),
    ("IFERROR(1/(A1-1),-1)", -1.0),
    ("IFNA(E1,1)", ErrorCode.DIV0),
    ("OFFSET(A1,1,1)", 20.0),
    ("SUM(OFFSET(A1,0,0,3,2))", 66.0),
    ("SUM(OFFSET(A3,0,0,-2,1))", 5.0),
    ("SUM(A1:OFFSET(A1,2,0))", 6.0),
    ("OFFSET(A1,-1,0)", ErrorCode.REF),
    ('INDIRECT("B2")', 20.0),
    ("INDIRECT(E3)", 20.0),
    ('SUM(INDIRECT("Other!A1:A2"))', 300.0),
    ('INDIRECT("R2C1",FALSE)', 2.0),
    ('INDIRECT("nonsense!")', ErrorCode.REF),
    ('INDIRECT("Rate")', ErrorCode.REF),
    ('SUM(INDIRECT("Span"))', 6.0),
    ("ROW()", 9.0),
    ("COLUMN(B3)", 2.0),
    ("ROWS(A1:B3)", 3.0),
    ("COLUMNS(A1:B3)", 2.0),
    ("AREAS((A1,B2:B3))", 2.0),
    ("ISREF(A1)", True),
    ("ISREF(1)", False),
    ("ISFORMULA(D1)", True),
    ("ISFORMULA(A1)", False),
    ("FORMULATEXT(D1)", "=A1+1"),
    ("SHEET(Other!A1)", 2.0),
    ("SHEETS()", 3.0),
    ('CELL("row",B3)', 3.0),
    ('CELL("address",B3)', "$B$3"),
    ('CELL("address",Other!B3)', "'[book.xlsx]Other'!$B$3"),
    ('CELL("col",B3)', 2.0),
    ('CELL("filename",Other!B3)', "[book.xlsx]Other"),
    ('MID(CELL("filename",A1),FIND("]",CELL("filename",A1))+1,31)', "S"),
    ('CELL("type",A1)', "v"),
    ('CELL("TYPE",Z99)', "b"),
    ('CELL("type",E3)', "l"),
    ('SHEET("other")', 2.0),
    ('SHEET("Oth"&"er")', 2.0),
    ('SHEET("nowhere")', ErrorCode.NA),
    ("LET(x,A1,y,x+A2,x*y)", 3.0),
    ("LET(r,A1:A3,SUM(r)+ROWS(r))", 9.0),
    ("LET(f,LAMBDA(x,x+1),f(f(A1)))", 3.0),
    ("LAMBDA(x,y,x*y)(A2,A3)", 6.0),
    ("Twice(A3)", 6.0),
    ("SUM(MAP(A1:A3,LAMBDA(x,x^2)))", 14.0),
    ("SUM(MAP(A1:A3,B1:B3,LAMBDA(x,y,x*y)))", 140.0),
    ("REDUCE(0,A1:A3,LAMBDA(a,x,a+x))", 6.0),
    ("REDUCE(1,A1:A3,LAMBDA(a,x,a*x))", 6.0),
    ("SUM(SCAN(0,A1:A3,LAMBDA(a,x,a+x)))", 10.0),
    ("SUM(BYROW(A1:B3,LAMBDA(r,MAX(r))))", 60.0),
    ("SUM(BYCOL(A1:B3,LAMBDA(c,SUM(c)^2)))", 3636.0),
    ("SUM(MAKEARRAY(2,3,LAMBDA(r,c,r*10+c)))", 102.0),
    ("Rate*A2", 1.0),
    ("SUM(Span)", 6.0),
    ("2^3^2", 64.0),
    ("-A2^2", 4.0),
    ("A1&A2", "12"),
    ("C3+1", 1.0),
    ('C3&"y"', "y"),
    ("C2+1", 2.0),
    ("SUM(C1:C3)", 0.0),
    ('IF(C3="",1,2)', 1.0),
    ("E1+C1", ErrorCode.DIV0),
    ("@A1:A3", ErrorCode.VALUE),
    ("SUM(OFFSET(A1,0,0) B5)", ErrorCode.NULL),
    ("OFFSET(A1,1/0,0)", ErrorCode.DIV0),
    ("INDIRECT(E1)", ErrorCode.DIV0),
    ('INDIRECT("A1",E1)', ErrorCode.DIV0),
    ("INDEX(A1:B3,E1,1)", ErrorCode.DIV0),
    ("N(A2:B3)", 2.0),
    ("N(C1:C2)", 0.0),
    ("SUMPRODUCT(N(A1:A3>1))", 2.0),
    ("T(C1:D3)", "x"),
    ("T(A1:C3)", ""),
    ("VALUETOTEXT(A2)", "2"),
    ("VALUETOTEXT(A1:B3)", "#VALUE!"),
    ("ISREF(OFFSET(A1,-1,0))", False),
    ("COUNT(OFFSET(A1,-1,0))", 0.0),
    ('COUNTA(INDIRECT("no such"))', 1.0),
    ("ISERROR(INDEX(A1:B3,9,9))", True),
    ('IFERROR(SUM(INDIRECT("no such")),-1)', -1.0),
    ("IFERROR(SUM(A1:OFFSET(A1,-1,0)),-1)", -1.0),
    ("SUM(CHOOSE(9,A1:A3,B1:B3))", ErrorCode.VALUE),
    ("LET(r,OFFSET(A1,-1,0),IFERROR(SUM(r),7))", 7.0),
]

LOST = ['INDIRECT("no such")', "OFFSET(A1,-1,0)", "INDEX(A1:B3,9,9)", "A1:OFFSET(A1,-1,0)"]
"""References that lead nowhere."""

OF_RANGES = [
    "SUM({})", "AVERAGE(A1,{})", "MAX({},1)", "PRODUCT({})", "STDEV({})", "AND({})", "OR({})", "XOR({})",
    "COUNTIF({},1)", "COUNTBLANK({})", "SUMIF({},1)", "SUMIF(A1:A3,1,{})", "SUMIFS({},A1:A3,1)",
    "SUMIFS(A1:A3,{},1)", "COUNTIFS({},1)", "AVERAGEIF({},1)", "SUMPRODUCT({},A1:A3)", "SUMPRODUCT(A1:A3,{})",
    "SUMSQ({})", "SUMX2MY2({},A1:A3)", "VLOOKUP(1,{},1)", "VLOOKUP({},A1:B3,1)", "HLOOKUP(1,{},1)",
    "LOOKUP(1,{})", "LOOKUP(1,A1:A3,{})", "MATCH(1,{},0)", "MATCH({},A1:A3,0)", "XLOOKUP(1,{},A1:A3)",
    "XMATCH(1,{})", "INDEX({},1,1)", "ROW({})", "COLUMN({})", "ROWS({})", "COLUMNS({})", "AREAS({})",
    "SHEET({})", "ISFORMULA({})", "FORMULATEXT({})", 'CELL("row",{})', "RANK(1,{})", "PERCENTILE({},0.5)",
    "QUARTILE({},1)", "MEDIAN({})", "LARGE({},1)", "SMALL({},1)", "MODE({})", "CORREL({},A1:A3)",
    "SLOPE(A1:A3,{})", 'TEXTJOIN(",",TRUE,{})', "CONCAT({})", "DSUM({},1,A1:A3)", "DSUM(A1:B3,1,{})",
    "SUM(MMULT({},A1:B2))", "SUM(TRANSPOSE({}))", "MDETERM({})", "SUBTOTAL(9,{})", "AGGREGATE(9,4,{})",
    "NPV(0.1,{})", "IRR({})", "OFFSET({},1,1)", "SUM(MAP({},LAMBDA(x,x)))", "REDUCE(0,{},LAMBDA(a,x,a+x))",
    "N({})", "T({})", "SUM((A1:A3,{}))", "LET(r,{},SUM(r))", "IF(A1=1,SUM({}),2)",
    "SUM(IF(A1=1,{},A1:A3))", "SUM(CHOOSE(1,{},A1:A3))",
]  # fmt: skip

ARRAYS = [
    ("A1:A3*B1:B3", [[10.0], [40.0], [90.0]]),
    ("A1:A3+{1,2}", [[2.0, 3.0], [3.0, 4.0], [4.0, 5.0]]),
    ("SUM(A1:A3*B1:B3)", [[140.0]]),
    ("IF(A1:A3>1,B1:B3,0)", [[0.0], [20.0], [30.0]]),
    ("IFERROR(1/(A1:A3-1),-1)", [[-1.0], [1.0], [0.5]]),
    ("ROW(A1:A3)", [[1.0], [2.0], [3.0]]),
    ("MAP(A1:A3,LAMBDA(x,x*2))", [[2.0], [4.0], [6.0]]),
    ("{1,2;3,4}", [[1.0, 2.0], [3.0, 4.0]]),
    ("A1:A3+{1;2}", [[2.0], [4.0], [ErrorCode.NA]]),
    ("CHOOSE({1,2},A1:A3,B1:B3)", [[1.0, 10.0], [2.0, 20.0], [3.0, 30.0]]),
]


def _same(got, expected):
    if isinstance(expected, float):
        return isinstance(got, float) and got == pytest.approx(expected, rel=1e-15)
    return type(got) is type(expected) and got == expected


@pytest.fixture
def computed(workbook):
    """`computed({"H9": "=…"})`: what each of these cells gives."""

    def compute(formulas, cells=CELLS, **more):
        book = workbook({**cells, **formulas}, names=NAMES, sheets=("Other", "Third"), **more)
        return {str(check.cell).removeprefix("S!"): check for check in verify(book).cells}

    return compute


@pytest.mark.parametrize(("formula", "expected"), PLAIN, ids=[case[0] for case in PLAIN])
def test_plain_formulas(computed, formula, expected):
    check = computed({"H9": f"={formula}"})["H9"]
    assert check.reason == ""
    assert _same(check.got, expected), check.got


NUMERIC = [case for case in PLAIN if isinstance(case[1], float)]


@pytest.mark.parametrize(("formula", "expected"), NUMERIC, ids=[case[0] for case in NUMERIC])
def test_plain_formulas_of_assumptions(book, formula, expected):
    model = book(
        {**CELLS, "H9": f"={formula}+0*(A1+B2)"},
        {"a": {"cell": "A1", "low": 0, "high": 2}, "b": {"cell": "B2", "low": 0, "high": 40}},
        {"answer": "H9"},
        names=NAMES,
        sheets=("Other", "Third"),
    )
    got = model.function({"a": [1.0, 1.0, 1.0], "b": 20.0})["answer"]
    assert got == pytest.approx([expected] * 3, rel=1e-15)


@pytest.mark.parametrize(("formula", "expected"), ARRAYS, ids=[case[0] for case in ARRAYS])
def test_array_formulas(computed, formula, expected):
    rows, columns = len(expected), len(expected[0])
    area = Area("S", 9, 8, 8 + rows, 7 + columns)
    filled = {str(cell): CellContent(None) for cell in area.cells()}
    anchor = CellContent(None, Formula(formula, 9, 8, array=area))
    readers = {f"P{20 + i}": f"={str(cell).removeprefix('S!')}" for i, cell in enumerate(area.cells())}
    result = computed({**filled, "S!H9": anchor, **readers})
    wanted = [item for row in expected for item in row]
    got = [result[f"P{20 + i}"].got for i in range(len(wanted))]
    assert all(_same(g, w) for g, w in zip(got, wanted, strict=True)), got


@pytest.mark.parametrize("lost", LOST)
def test_a_reference_that_leads_nowhere_is_a_value_in_every_function_of_ranges(computed, lost):
    cells = {f"H{9 + 2 * i}": f"={formula.replace('{}', lost)}" for i, formula in enumerate(OF_RANGES)}
    result = computed(cells)
    got = {formula: result[cell].got for cell, formula in zip(cells, OF_RANGES, strict=True)}
    assert [f"{formula}: {value}" for formula, value in got.items() if value is not ErrorCode.REF] == []
    rescued = computed({cell: f"=IFERROR({formula[1:]},-1)" for cell, formula in cells.items()})
    assert [cells[cell] for cell in cells if rescued[cell].got != -1.0] == []


def test_a_reference_that_leads_nowhere_in_some_trials_is_an_error_in_these(book):
    cells = {**CELLS, "H9": "=SUM(A1,INDEX(B1:B3,A1))", "H10": "=IFERROR(SUM(CHOOSE(A1,B1:B2,B3)),-1)"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"sum": "H9", "rescued": "H10"})
    result = model.function({"a": [1.0, 3.0, 7.0]})
    assert result["sum"][:2].tolist() == [11.0, 33.0]
    assert np.isnan(result["sum"][2])
    assert result["rescued"].tolist() == [30.0, -1.0, -1.0]


def test_array_formulas_of_assumptions_stay_on_the_fast_path(book, monkeypatch):
    area = Area("S", 9, 8, 11, 8)
    cells = {**CELLS, "H9": CellContent(None, Formula("A1:A3*B1:B3", 9, 8, array=area)), "J1": "=SUM(H9:H11)"}
    cells |= {"H10": 0.0, "H11": 0.0}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 2}}, {"answer": "J1"})

    def careful(*_):
        raise AssertionError("the careful path was taken")

    monkeypatch.setattr("xlmc.engine.tracking.TrackingEvaluator.filters", careful)
    assert model.function({"a": [1.0, 2.0]})["answer"].tolist() == [140.0, 150.0]


def test_a_spill_is_read_whole(computed):
    anchor = CellContent(None, Formula("A1:A3*2", 9, 8, array=Area("S", 9, 8, 11, 8), dynamic=True))
    result = computed({"H9": anchor, "J1": "=SUM(_xlfn.ANCHORARRAY(H9))"})
    assert result["J1"].got == 12.0


def test_arrays_whose_size_varies_by_trial(book):
    model = book(
        {"A1": 1.0, "B1": "=SUM(_xlfn._xlws.FILTER({1,2,3,4},{1,2,3,4}>A1))"},
        {"a": {"cell": "A1", "low": 0, "high": 4}},
        {"answer": "B1"},
    )
    got = model.function({"a": [0.0, 1.5, 3.5]})["answer"]
    assert got.tolist() == [10.0, 9.0, 4.0]


REFUSED = [
    ("OFFSET(B1,A1,0)", "depends on a value that varies"),
    ('INDIRECT("A"&A1)', "depends on a value that varies"),
    ("LAMBDA(x,x+1)", "Nothing calls"),
    ("LET(x,1)", "pairs of a name and a value"),
    ("NOSUCH(A1)", "not known"),
    ('INDIRECT("A1",A1>0)', "Whether INDIRECT reads A1 or R1C1 must not vary"),
    ("SUM(INDIRECT())", "INDIRECT has 0 arguments; it takes 1 to 2"),
    ("SUM(INDEX(A1:A3))", "INDEX has 1 argument; it takes 2 to 4"),
    ("ISREF()", "ISREF has 0 arguments; it takes 1"),
    ('CELL("color",A2)', "CELL('color') is not supported"),
    ("CELL(A1,A2)", "The first argument of CELL must not vary"),
    ("SHEET(A1&0)", "SHEET needs a reference, or the name of a sheet that does not vary"),
    ("CELL()", "CELL has 0 arguments; it takes 1 to 2"),
    ("MAP()", "MAP has 0 arguments; it takes 2 or more"),
]


@pytest.mark.parametrize(("formula", "message"), REFUSED)
def test_what_cannot_be_computed_is_refused_with_its_cell(book, formula, message):
    with pytest.raises(XlmcError, match="S!H9") as refused:
        book({**CELLS, "H9": f"=A1+{formula}"}, {"a": {"cell": "A1", "low": 0, "high": 2}}, {"answer": "H9"})
    assert message in str(refused.value)


def test_offset_reaches_assumptions_that_no_formula_names(book):
    model = book(
        {"A1": 5.0, "A2": 7.0, "B1": "=OFFSET(A1,1,0)*2"},
        {"near": {"cell": "A1", "low": 0, "high": 1}, "far": {"cell": "A2", "low": 0, "high": 1}},
        {"answer": "B1"},
    )
    assert [assumption.name for assumption in model.live if assumption.name == "far"] == ["far"]
    got = model.function({"near": 0.0, "far": np.array([0.25, 0.5])})["answer"]
    assert got.tolist() == [0.5, 1.0]


def test_offset_through_cells_that_need_others(book):
    model = book(
        {"A1": 1.0, "A2": "=A1*3", "A3": "=A2+1", "B1": "=SUM(OFFSET(A1,1,0,2,1))"},
        {"a": {"cell": "A1", "low": 0, "high": 1}},
        {"answer": "B1"},
    )
    assert model.function({"a": [1.0, 2.0]})["answer"].tolist() == [7.0, 13.0]


def test_indirect_reference_to_itself_is_a_circle(book):
    with pytest.raises(XlmcError, match="circle"):
        book({"A1": 1.0, "B1": '=A1+INDIRECT("B1")'}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"answer": "B1"})


def test_implicit_intersection_picks_the_cell_beside(computed):
    result = computed({"H2": "=A1:A3*2", "B9": "=A1:B1*2", "H3": "=@A1:A3"})
    assert [result[cell].got for cell in ("H2", "B9", "H3")] == [4.0, 20.0, 3.0]


def test_the_clock_is_held_at_what_excel_saved(book):
    cells = {"A1": 1.0, "C1": ("=TODAY()", 45000.0), "B1": "=A1+C1"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"answer": "B1"})
    assert model.function({"a": 0.5})["answer"].tolist() == [45000.5]
    assert "TODAY gives another value each time; Excel's saved value is used" in model.notices[0].message
    with pytest.raises(XlmcError, match="a cell of its own"):
        book({"A1": 1.0, "B1": "=A1+TODAY()"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"answer": "B1"})
