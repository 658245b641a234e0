"""Whole columns and rows end with the last filled cell, but keep their size: Excel's answers, on both engines."""

from __future__ import annotations

import pytest

from xlmc.engine.tracking import TrackingEvaluator
from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, column_letters
from xlmc.excel.workbook.workbook import CellContent, Formula

ROWS, COLUMNS = 1048576.0, 16384.0

CELLS = {"C1": 5.0, "C2": "x", "C4": -2.0, "C5": 0.0, "D1": 1.0, "D2": 10.0, "D3": 100.0, "D5": 1000.0, "E1": "a"}
"""C3 and C6 on are empty; A1 is drawn, and A2 on are empty. Z9 holds the formula: the sheet ends there."""

SIZES = {
    "ROWS(C:C)": ROWS,
    "COLUMNS(1:1)": COLUMNS,
    "COLUMNS(C:E)": 3.0,
    "ROWS(A2:A1048576)": ROWS - 1,
    "ROWS(C:C)*COLUMNS(2:2)": ROWS * COLUMNS,
    "ROWS(OFFSET(A1,0,0,1048576,1))": ROWS,
    "ROWS(OFFSET(A1,0,0,900000,1))": 900000.0,
    "ROWS(OFFSET(C:C,0,1))": ROWS,
    "SUM(OFFSET(C:C,0,1))": 1111.0,
    "ROWS(INDEX(C:C,5):INDEX(C:C,900000))": 899996.0,
    "SUM(INDEX(C:C,4):INDEX(C:C,900000))": -2.0,
    "ROWS(C2:C1048576 C:C)": ROWS - 1,
    'ROWS(INDIRECT("C:C"))': ROWS,
    "ROWS(INDEX(C:C,0))": ROWS,
}

COUNTS = {
    "COUNTBLANK(C:C)": ROWS - 4,
    "COUNTBLANK(A:A)": ROWS - 1,
    "COUNTBLANK(C2:E1048576)": 3 * (ROWS - 1) - 6 + 0,
    "COUNTBLANK(11:1048576)": (ROWS - 10) * COLUMNS,
    'COUNTIF(C:C,"")': ROWS - 4,
    'COUNTIF(C:C,"=")': ROWS - 4,
    'COUNTIF(C:C,"<>")': 4.0,
    'COUNTIF(C:C,"<>5")': ROWS - 1,
    'COUNTIF(A:A,"<>"&A1)': ROWS - 1,
    'COUNTIF(1:1,"<>23")': COLUMNS,
    'COUNTIF(1:1,"<>5")': COLUMNS - 1,
    "COUNTIF(C:C,0)": 1.0,
    'COUNTIFS(C:C,"",D:D,"")': ROWS - 5,
    'COUNTIF(Other!A:XFD,"")': ROWS * COLUMNS - 20,
    "COUNTA(C:E)": 9.0,
    "COUNTBLANK(Other!A:XFD)": ROWS * COLUMNS - 20,
    "ROWS(A:XFD)*COLUMNS(A:XFD)": ROWS * COLUMNS,
    'COUNTIFS(C:C,"<>x",D:D,">5")': 2.0,
    'COUNTIFS(C:C,"",A:A,"")': ROWS - 4,
    'COUNTIFS(C:C,"",Other!A:A,"")': ROWS - 4 - 16,
    "COUNTA(C:C)": 4.0,
    "COUNT(A:C)": 4.0,
}

CONDITIONS = {
    'SUMIF(C:C,"<>x",D:D)': 1101.0,
    'SUMIF(C:C,"",D:D)': 100.0,
    'SUMIF(C:C,"",Other!A:A)': 3.0 + sum(range(6, 21)),
    'AVERAGEIF(C:C,"",D:D)': 100.0,
    'AVERAGEIF(C:C,"",Other!A:A)': (3.0 + sum(range(6, 21))) / 16,
    'SUMIFS(D:D,C:C,"")': 100.0,
    'SUMIFS(Other!A:A,C:C,"")': 3.0 + sum(range(6, 21)),
    'SUMIFS(D1:D9,C:C,"")': "#VALUE!",
    'SUMIFS(D2:D1048576,C:C,"")': "#VALUE!",
    'MAXIFS(D:D,C:C,"<>5")': 1000.0,
}

PLACES = {
    "INDEX(C:C,4)": -2.0,
    "INDEX(C:C,20)": 0.0,
    "INDEX(C:C,1048576)": 0.0,
    "INDEX(C:C,1048577)": "#REF!",
    "INDEX(C:C,A1+19)": 0.0,
    "INDEX(C:C,A1+3)": -2.0,
    "INDEX(C:C,A1+1048575)": 0.0,
    "INDEX(C:C,A1+1048576)": "#REF!",
    "INDEX(C:D,A1+19,A1+1)": 0.0,
    "INDEX(1:1,A1+2)": 5.0,
    "INDEX(1:1,A1+200)": 0.0,
    "INDEX(1:1,A1+16384)": "#REF!",
    'MATCH("",C:C,0)': "#N/A",
    "MATCH(-2,C:C,0)": 4.0,
    'MATCH("x",C:C,0)': 2.0,
    "MATCH(9E+99,C:C)": 5.0,
    "MATCH(6,Other!A:A)": 6.0,
    "LOOKUP(9E+99,C:C)": 0.0,
    "LOOKUP(9E+99,C:C,D:D)": 1000.0,
    'LOOKUP(2,1/(C:C<>""),C:C)': 0.0,
    'LOOKUP(2,1/(C:C="x"),D:D)': 10.0,
    "LOOKUP(2,1/(C:C=5*A1),Other!A:A)": 1.0,
    "LOOKUP(2,1/(C:C=A1-1),Other!A:A)": 0.0,
    "LOOKUP(2,1/(C:C=A1-3),Other!A:A)": 4.0,
    "LOOKUP(2,1/(C:C=A1*77),Other!A:A)": "#N/A",
    "VLOOKUP(-2,C:D,2,FALSE)": 0.0,
    "VLOOKUP(5*A1,C:D,2,FALSE)": 1.0,
    "VLOOKUP(6,Other!A:A,1)": 6.0,
    'HLOOKUP("a",1:8,2,FALSE)': 0.0,
    "HLOOKUP(5,C:C,20,FALSE)": 0.0,
    "HLOOKUP(5,C:C,1048577,FALSE)": "#REF!",
    "XLOOKUP(5,C:C,D:D)": 1.0,
    "XLOOKUP(7,C:C,D:D,A1)": 1.0,
    "XLOOKUP(5,C:C,D1:D10)": "#VALUE!",
    "XLOOKUP(5,C:C,D1:D9)": "#VALUE!",
    "XLOOKUP(5,C:C,D2:D1048576)": "#VALUE!",
    "XLOOKUP(5,C:C,Other!A:A)": 1.0,
    "XMATCH(A2,C:C)": 3.0,
    "XMATCH(A2,Other!A:A)": 21.0,
    "XMATCH(5,C:C,0,-1)": 1.0,
    "XMATCH(5*A1,C:C,0,-1)": 1.0,
    "XMATCH(A2,C:C,0,-1)": ROWS,
    "XMATCH(77,C:C,0,-1)": "#N/A",
    "XMATCH(A1+4,1:1,0,-1)": 3.0,
    "XLOOKUP(5,C:C,D:D,,0,-1)": 1.0,
    "XLOOKUP(5*A1,C:C,D:D,7,0,-1)": 1.0,
    "XLOOKUP(5,C:C,D1:D9,,0,-1)": "#VALUE!",
    'XLOOKUP("*",C:C,D:D,,2,-1)': 10.0,
    "XLOOKUP(9E+99,C:C,C:C,,-1,-1)": 5.0,
}

PRODUCTS = {
    'SUMPRODUCT(--(C:C=""))': ROWS - 4,
    "SUMPRODUCT(--ISBLANK(C:C))": ROWS - 4,
    "SUMPRODUCT(--(C:C=D:D))": ROWS - 5,
    "SUMPRODUCT((D:D>5)*D:D)": 1110.0,
    "SUMPRODUCT((D:D>5*A1)*D:D)": 1110.0,
    "SUMPRODUCT(--(A:A<>A1))": ROWS - 1,
    "SUMPRODUCT(--(A:A<5))": ROWS,
    "SUMPRODUCT(--(1:1=5))": 1.0,
    'SUMPRODUCT(--(1:1=""))': COLUMNS - 4,
    "SUMPRODUCT(D:D,Other!A:A)": 1 + 20 + 300 + 5000.0,
    "SUMPRODUCT((D:D>5)*Other!A:A)": 10.0,
    'SUMPRODUCT((C:C="")*(Other!A:A=""))': ROWS - 20,
    "SUMPRODUCT(D:D,Other!A1:A20)": "#VALUE!",
    "SUMPRODUCT(D:D,Other!A1:A9)": "#VALUE!",
    "SUMPRODUCT(D:D,Other!A2:A1048576)": "#VALUE!",
    'SUMPRODUCT(--(OFFSET(C:C,0,1)=""))': ROWS - 4,
    "SUMPRODUCT(1/COUNTIF(Other!A1:A20,Other!A1:A20))": 20.0,
    "SUMX2MY2(D:D,D:D)": 0.0,
    'SUMPRODUCT((C:C="x")*ROW(C:C))': 2.0,
    'SUMPRODUCT((C:C="x")*1,ROW(C:C)*1)': 2.0,
    "SUMPRODUCT((C:C=5*A1)*ROW(C:C))": 1.0,
    'SUMPRODUCT((C:C="")*ROW(C:C))': ROWS * (ROWS + 1) / 2 - 1 - 2 - 4 - 5,
    "SUMPRODUCT((C:C=A1-1)*ROW(C:C))": ROWS * (ROWS + 1) / 2 - 1 - 2 - 4,
    'SUMPRODUCT(MAX((C:C<>"")*ROW(C:C)))': 5.0,
    "SUMPRODUCT(MAX((C:C=5*A1)*ROW(C:C)))": 1.0,
    "SUMPRODUCT(MAX((C:C=A1-1)*ROW(C:C)))": ROWS,
    'SUMPRODUCT(MAX((1:1<>"")*COLUMN(1:1)))': 5.0,
    'LOOKUP(2,1/(C:C<>""),ROW(C:C))': 5.0,
    "LOOKUP(2,1/(C:C=A1-3),ROW(C:C))": 4.0,
    "SUMX2MY2(D:D,D1:D9)": "#N/A",
    "SUM(C:C)": 3.0,
    "AVERAGE(C:C)": 1.0,
    "MIN(C:C)": -2.0,
    "MEDIAN(Other!A:A)": 10.5,
    'MATCH(TRUE,INDEX(C:C="",0),0)': 3.0,
    "MATCH(1,INDEX((C:C=A1-1)*1,0),0)": 3.0,
    "LARGE(D:D,2)": 100.0,
    "SUBTOTAL(9,D:D)": 1111.0,
    'TEXTJOIN(",",TRUE,C:C)="5,x,-2,0"': 1.0,
    "SUM(AND(1=1),C2:C1048576)": -1.0,
}

REFUSED = {
    "SUMPRODUCT(TRANSPOSE(C:C))": "TRANSPOSE",
    "SUM(MMULT(TRANSPOSE(D:D),D:D))": "MMULT",
    "SUM(SORT(D:D))": "SORT",
    "ROWS(TOCOL(C:C))": "TOCOL",
    "SUMPRODUCT(C:C*1:1)": "SUMPRODUCT",
    "SUMPRODUCT((D:D>5)*D1:D9)": "SUMPRODUCT",
    "SUMPRODUCT((D:D>5)*(D2:D1048576))": "SUMPRODUCT",
    "SUMPRODUCT(--(ROW(D:D)=700000))": "SUMPRODUCT",
    "SUMPRODUCT((D:D>5)*ROW(D:D)^2)": "SUMPRODUCT",
    "SUMPRODUCT((D:D>5)*ROW(D:D),ROW(D:D)*1)": "SUMPRODUCT",
    "SUMPRODUCT(LOOKUP(7,D:D*ROW(D:D)))": "LOOKUP",
    'SUMPRODUCT(--(INDEX(C:C,A1-A1)=""))': "INDEX",
    'LEN(TEXTJOIN(",",FALSE,C:C))': "TEXTJOIN",
    "XMATCH(5,C:C,0,2)": "XMATCH",
    "SUM(MAP(D:D,LAMBDA(p,p+1)))": "all cells",
}

ARRAYS = {
    'SUM(--(C:C=""))': ROWS - 4,
    "SUM(IF(D:D>5,D:D))": 1110.0,
    "AVERAGE(IF(D:D>5,D:D))": 370.0,
    'COUNT(IF(C:C="",1))': ROWS - 4,
    "MAX(IF(D:D<500,D:D))": 100.0,
    "MIN(IF(D:D<500,D:D))": 0.0,
    "MIN(IF(D:D>5*A1,D:D))": 10.0,
    "AND(C:C=D:D)": 0.0,
    'MAX((C:C<>"")*ROW(C:C))': 5.0,
    'MAX(IF(C:C<>"",ROW(C:C)))': 5.0,
    "MAX(IF(C:C=5*A1,ROW(C:C)))": 1.0,
    'MIN(IF(C:C="",ROW(C:C)))': 3.0,
    'LARGE(IF(C:C<>"",ROW(C:C)),2)': 4.0,
    'SMALL(IF(C:C<>"",ROW(C:C)),3)': 4.0,
    'SUM((C:C="x")*ROW(C:C))': 2.0,
    'MAX(FILTER(ROW(C:C),C:C<>""))': 5.0,
    'XLOOKUP(TRUE,C:C<>"",ROW(C:C),,0,-1)': 5.0,
    'XMATCH(TRUE,C:C<>"",0,-1)': 5.0,
    'MATCH(2,1/(C:C<>""))': 5.0,
    'MATCH(TRUE,INDEX(C:C="",0),0)': 3.0,
    'MATCH(TRUE,C:C="",0)': 3.0,
    'MATCH(TRUE,Other!A:A="",0)': 21.0,
    'SUM(FILTER(D:D,C:C="x"))': 10.0,
    "INDEX(C:C,20)": 0.0,
    "ROWS(UNIQUE(Other!A:A))": 21.0,
    "XLOOKUP(TRUE,C:C=5,D:D)": 1.0,
    "SUM(LEN(C:C))": 5.0,
}

OTHER = {f"Other!A{row}": float(row) for row in range(1, 21)}


def differing(run, table, array=False):
    """The formulas of a table that give something else, with what they give: some at a time, in the ninth row.

    Where such a block leaves the fast path each is asked for alone, to see what it gives there by itself.
    """
    result, left = {}, [[*table][start : start + 12] for start in range(0, len(table), 12)]
    while left:
        some = left.pop()
        cells = [Cell("S", 9, 26 + at) for at in range(len(some))]
        areas = [Area("S", 9, cell.column, 9, cell.column) if array else None for cell in cells]
        placed = {
            f"{column_letters(cell.column)}9": CellContent(None, Formula(formula, 9, cell.column, area))
            for cell, formula, area in zip(cells, some, areas, strict=True)
        }
        outcome = run({"A1": 0.0, **CELLS, **OTHER, **placed}, {"A1": [1.0, 1.0]}, [*placed])
        if outcome.careful and len(some) > 1:
            left += [[formula] for formula in some]
        else:
            result |= {formula: gives[0] for formula, gives in zip(some, outcome.forecasts, strict=True)}
    return {formula: gives for formula, gives in result.items() if gives != table[formula]}


def test_a_whole_column_keeps_its_size(run):
    assert differing(run, {**SIZES, **COUNTS, **CONDITIONS, **PLACES, **PRODUCTS}) == {}


def test_so_it_does_in_array_formulas(run):
    assert differing(run, ARRAYS, array=True) == {}


@pytest.mark.parametrize("formula", REFUSED)
def test_what_needs_all_its_cells_is_refused_by_name(run, formula):
    with pytest.raises(FormulaError, match=REFUSED[formula]):
        run({"A1": 0.0, **CELLS, **OTHER, "Z9": f"={formula}"}, {"A1": [1.0, 1.0]}, ["Z9"])


def test_a_range_that_moves_with_its_formula_ends_with_the_last_filled_cell(run):
    cells = {"A1": 0.0, "C1": 1.0, "C5": 2.0, "C6": 4.0} | {f"B{r}": f"=SUM(C{r + 2}:C1048576)" for r in (3, 2, 1, 4)}
    got = run(cells, {"A1": [1.0]}, ["B4", "B3", "B2", "B1"])
    assert [column[0] for column in got.forecasts] == [4.0, 6.0, 6.0, 6.0]


def test_a_position_that_is_an_error_in_some_trials_is_no_row_0_of_a_whole_column(run, monkeypatch):
    """Such a block was once taken trial by trial."""
    monkeypatch.setattr(TrackingEvaluator, "_shrink", None)
    cells = {f"N{row}": float(row) for row in range(1, 9)}
    cells |= {f"B{row}": f"=ROUND(A$1*{row},0)" for row in range(1, 9)} | {"C1": "=INDEX(B:B,MATCH(A$1,N$1:N$8,1))"}
    assert run(cells, {"A1": [0.5, 2.2, 9.0]}, ["C1"]).forecasts == [["#N/A", 4.0, 72.0]]
