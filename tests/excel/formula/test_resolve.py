from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, ir
from xlmc.excel.workbook.workbook import Formula

NAMES = {
    "Rate": "S!$C$3",
    "Data!Rate": "Data!$D$4",
    "Nested": "Rate*2",
    "Data!Own": "Rate*3",
    "Data!Twice": "_xlfn.LAMBDA(_xlpm.x,3*_xlpm.x)",
    "Called": "Twice(1)",
    "Deep": "Nested+S!$A$1",
    "Left": "S!XFD1",
    "Above": "S!A1048576",
    "Here": "!A1",
    "Loop": "Pool+1",
    "Pool": "-Loop",
    "Area": "S!$A$1:$B$2",
    "Number": "32.174",
    "Lost": "#REF!$A$1",
    "Column": "S!$A:$A",
    "Twice": "_xlfn.LAMBDA(_xlpm.x,2*_xlpm.x)",
}
CELLS = {"A1": 1.0, "D5": 2.0, "Data!B2": 3.0, "'My sheet'!A1": 4.0}


@pytest.fixture
def see(resolved):
    """The tree that a formula gives in `S!B2`."""
    return lambda text, at="S!B2", **given: resolved(text, at=at, cells=CELLS, names=NAMES, sheets=("Empty",), **given)


PLAIN = {
    "A1": "S!A1",
    "A1:B2": "S!A1:B2",
    "B2:A1": "S!A1:B2",
    "A1:A1": "S!A1",
    "data!$A$1": "Data!A1",
    "'MY SHEET'!A1": "'My sheet'!A1",
    "Data!A1:Data!B2": "Data!A1:B2",
    "(A1):B2": "S!A1:B2",
    "A1:B2:D1": "S!A1:D2",
    "A1:B2 B1:C3": "S!B1:B2",
    "A1:B2 B2:C3": "S!B2",
    "A1:A3 B1:B3": "#NULL!",
    "A1 Data!A1": "#VALUE!",
    "Data!A1:S!B2": "#VALUE!",
    "#REF!:B2": "#REF!",
    "(A1,B2)": "(∪ S!A1 S!B2)",
    "SUM(A1,,-2%)": "SUM(S!A1 _ (% (- 2)))",
    "SUM(Data:S!A1)": "SUM((∪ (∪ S!A1 Empty!A1) Data!A1))",  # from tab to tab
    "SUM(S:Empty!A1:A2)": "SUM((∪ S!A1:A2 Empty!A1:A2))",
    "OFFSET(A1,1,1):C3": "(: OFFSET(S!A1 1 1) S!C3)",
    "LET(x,A1,y,x+1,x*y)": "LET(x=S!A1 y=(+ x 1) (* x y))",
    "_xlfn.LET(_xlpm.x,A1,_xlpm.x)": "LET(x=S!A1 x)",
    "LET(rate,1,rate)+Rate": "(+ LET(rate=1 rate) S!C3)",
    "LAMBDA(x,x+A1)(2)": "[λ(x (+ x S!A1))](2)",
    "LET(f,LAMBDA(x,-x),f(1))": "LET(f=λ(x (- x)) [f](1))",
    "Twice(A1)": "[λ(x (* 2 x))](S!A1)",
    '{1,"a"}': '{1 "a"}',
    "@A1:A3": "SINGLE(S!A1:A3)",
    # whole columns and rows end with what the sheet holds: S reaches to D5
    "A:A": "S!A1:A5",
    "B:A": "S!A1:B5",
    "3:3": "S!A3:D3",
    "Data!A:C": "Data!A1:C2",
    "Empty!A:A": "Empty!A1:A1",
    "F:F": "S!F1:F5",
    # names
    "Rate": "S!C3",
    "rate": "S!C3",
    "Data!Rate": "Data!D4",
    "Nested": "(* S!C3 2)",
    "Deep*Number": "(* (+ (* S!C3 2) S!A1) 32.174)",
    "Area": "S!A1:B2",
    "Area B:B": "S!B1:B2",
    "Rate:A1": "S!A1:C3",
    "Lost+1": "(+ #REF! 1)",
    "Column": "S!A1:A5",
    "Left": "S!A2",
    "Above": "S!B1",
    "Here": "S!B2",
    "[0]!Rate": "S!C3",
}


@pytest.mark.parametrize("text", PLAIN)
def test_what_a_formula_names(see, text):
    assert see(text) == PLAIN[text]


@pytest.mark.parametrize(
    ("text", "at", "expected"),
    [
        ("Rate", "Data!A1", "Data!D4"),  # a sheet's own name comes first
        ("S!Rate", "Data!A1", "S!C3"),
        ("Nested", "Data!A1", "(* S!C3 2)"),  # but not in a name of the whole workbook
        ("Own", "Data!A1", "(* Data!D4 3)"),
        ("Data!Own", "S!A1", "(* Data!D4 3)"),
        ("Twice(1)", "Data!A1", "[λ(x (* 3 x))](1)"),
        ("Called", "Data!A1", "[λ(x (* 2 x))](1)"),
        ("A1", "Data!A9", "Data!A1"),
        ("Left", "S!A1", "S!XFD1"),  # in names, relative references go around the edge
        ("Here", "Data!C7", "Data!C7"),
        ("A:A", "Data!A9", "Data!A1:A2"),
    ],
)
def test_what_it_means_elsewhere(see, text, at, expected):
    assert see(text, at=at) == expected


@pytest.mark.parametrize(
    ("text", "written_for", "at", "expected"),
    [
        ("A1", "S!B1", "S!B4", "S!A4"),
        ("$A1+A$1+$A$1", "S!B1", "S!D3", "(+ (+ S!A3 S!C1) S!A1)"),
        ("A1:B2", "S!C3", "S!C2", "#REF!"),
        ("A2:$B$2", "S!C3", "S!C2", "S!A1:B2"),
        ("A1", "S!B1", "S!A1", "#REF!"),
        ("XFD1", "S!A1", "S!B1", "#REF!"),
        ("A1048576", "S!A1", "S!A2", "#REF!"),
        ("A:A", "S!B1", "S!C1", "S!B1:B5"),
        ("1:1", "S!B1", "S!B3", "S!A3:D3"),
        ("SUM(Data!A1:A2)", "S!B1", "S!B2", "SUM(Data!A2:A3)"),
        ("Rate+A1", "S!B1", "S!B2", "(+ S!C3 S!A2)"),
    ],
)
def test_a_shared_formula_means_its_own_neighbours(see, text, written_for, at, expected):
    assert see(text, at=at, written_for=written_for) == expected


TABLE = {
    # the table stands in S!A1:C5, with a header and a totals row
    "T[Low]": "S!A2:A4",
    "T[low]": "S!A2:A4",
    "T[[Low]:[High]]": "S!A2:B4",
    "T[[High]:[Low]]": "S!A2:B4",
    "T": None,
    "T[]": "S!A2:C4",
    "T[#All]": "S!A1:C5",
    "T[#Data]": "S!A2:C4",
    "T[#Headers]": "S!A1:C1",
    "T[#Totals]": "S!A5:C5",
    "T[[#Headers],[Low]]": "S!A1",
    "T[[#Headers],[#Data],[Low]]": "S!A1:A4",
    "T[[#Data],[#Totals],[Low]:[High]]": "S!A2:B5",
    "T[[#Totals],[Std dev]]": "S!C5",
    "T[@Low]": "S!A3",
    "T[[#This Row],[Low]:[High]]": "S!A3:B3",
    "T[@]": "S!A3:C3",
    "SUM(T[Low])": "SUM(S!A2:A4)",
}


@pytest.mark.parametrize("text", TABLE)
def test_tables(resolved, table, text):
    tables = [table("T", "S!A1:C5", "Low", "High", "Std dev", totals_rows=1)]
    if TABLE[text] is None:
        with pytest.raises(FormulaError, match="There is no name 'T'"):
            resolved(text, at="S!E3", tables=tables)
    else:
        assert resolved(text, at="S!E3", tables=tables) == TABLE[text]


@pytest.mark.parametrize(
    ("text", "at", "expected"),
    [
        ("[@Low]", "S!C3", "S!A3"),
        ("[Low]", "S!C3", "S!A2:A5"),
        ("[@Low]", "S!C1", "#VALUE!"),  # in the header row there is no row of data
        ("T[@Low]", "S!E9", "#VALUE!"),
        ("T[@Low]", "Data!A3", "#VALUE!"),
        ("T[#Totals]", "S!E3", "#REF!"),
        ("U[#Headers]", "S!E3", "#REF!"),
        ("U[x]", "S!E3", "S!H1:H2"),
    ],
)
def test_tables_and_where_the_formula_stands(resolved, table, text, at, expected):
    tables = [table("T", "S!A1:C5", "Low", "High", "Std dev"), table("U", "S!H1:I2", "x", "y", header_rows=0)]
    assert resolved(text, at=at, tables=tables, sheets=("Data",)) == expected


LINKS = "copy the value into this workbook; links are not followed"


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("Dta!A1", "there is no sheet 'Dta'", "did you mean 'Data'?"),
        ("Nowhere!A1", "there is no sheet 'Nowhere'", None),
        ("Rat*2", "there is no name 'Rat'", "did you mean 'Rate'?"),
        ("Quux", "there is no name 'Quux'", None),
        ("Tabel[Low]", "there is no table 'Tabel'", "did you mean 'Table'?"),
        ("Table[Hihg]", "the table 'Table' has no column 'Hihg'", "did you mean 'High'?"),
        ("Table[[#Foo],[Low]]", "a table has no part '#foo'", "use #All, #Data, #Headers, #Totals or #This Row"),
        ("[@Low]", "a table's column is named without its table, outside any table", "write the table before it"),
        ("Loop", "the name 'Loop' is defined by itself", "correct it under Formulas ▸ Name Manager"),
        ("[1]Other!A1", "the formula refers to another workbook", LINKS),
        ("'[Other.xlsx]S'!A1", "the formula refers to another workbook", LINKS),
        ("[2]!Rate", "the formula refers to another workbook", LINKS),
        ("LET(1,2,3)", "LET needs a name where it has something else", "a name that looks like no cell"),
        ("LET(x,2)", "LET takes pairs of a name and a value, and then a calculation", None),
        ("A1:2", "the range (:) operator needs references on both sides", "is an operator missing?"),
        ("A1 2", "the intersection (a blank) operator needs references on both sides", "is an operator missing?"),
    ],
)
def test_what_is_not_there(resolved, table, text, message, hint):
    tables = [table("Table", "S!J1:K3", "Low", "High")]
    with pytest.raises(FormulaError) as caught:
        resolved(text, at="S!B2", cells=CELLS, names=NAMES, tables=tables)
    error = caught.value
    assert (error.message, error.hint) == (message, hint)
    assert (error.where, error.text) == ("S!B2", text)


def test_a_missing_name_may_be_an_error_value_instead(workbook, shown):
    resolver = Resolver(workbook({}), strict=False)
    assert shown(resolver.formula(Cell("S", 1, 2), Formula("Quux+1", 1, 2))) == "(+ #NAME? 1)"


def test_a_fault_in_a_formula_is_told_of_its_cell(resolved):
    with pytest.raises(FormulaError) as caught:
        resolved("1+*2", at="S!B2")
    assert (caught.value.where, caught.value.span) == ("S!B2", (2, 3))


def test_a_fault_in_a_name_shows_what_the_name_holds(resolved):
    with pytest.raises(FormulaError) as caught:
        resolved("1+Bad", at="S!B2", names={"Bad": "2**3"})
    assert (caught.value.where, caught.value.text) == ("S!B2", "2**3")


def test_assumption_cells_count_as_used(workbook, shown):
    resolver = Resolver(workbook({"A1": 1.0}), [Cell("S", 9, 1)])
    assert shown(resolver.formula(Cell("S", 1, 3), Formula("SUM(A:A)", 1, 3))) == "SUM(S!A1:A9)"


@pytest.mark.parametrize("nested", [60, 150])
def test_nesting_as_deep_as_excel_allows(see, nested):
    assert see("ABS(" * nested + "A1" + ")" * nested).startswith("ABS(" * nested)


@pytest.mark.parametrize(
    "text",
    ["ABS(" * 1000 + "A1" + ")" * 1000, "-" * 1000 + "A1", "1+(" * 1000 + "A1" + ")" * 1000, "A1" + "%" * 1000],
)
def test_deeper_nesting_is_refused(see, text):
    with pytest.raises(FormulaError, match="nested deeper than"):
        see(text)


def test_a_long_sum_is_no_nesting(workbook):
    tree = Resolver(workbook({})).formula(Cell("S", 1, 2), Formula("A1" + "+A1" * 1200, 1, 2))
    first, rest = ir.chain(tree)
    assert {first, *rest} == {Cell("S", 1, 1), ("+", Cell("S", 1, 1))}
    assert len(rest) == 1200


def test_names_of_names_cannot_grow_beyond_measure(resolved):
    names = {f"N{i}_": f"N{i - 1}_+N{i - 1}_" for i in range(1, 60)} | {"N0_": "1"}
    with pytest.raises(FormulaError, match=r"too long|nested deeper"):
        resolved("N50_", names=names)


def test_a_long_ladder_of_names_is_refused(resolved):
    names = {f"N{i}_": f"1+N{i - 1}_" for i in range(1, 2000)} | {"N0_": "1"}
    with pytest.raises(FormulaError, match="nested deeper"):
        resolved("N1999_", names=names)
