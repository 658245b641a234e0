"""What formulas read, by their trees and by their texts."""

from __future__ import annotations

import pytest

from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell, parse_address
from xlmc.excel.formula import ir
from xlmc.excel.formula.indirect_text import read_a1, read_r1c1
from xlmc.excel.formula.pivot_items import items_named, names_of, position_of
from xlmc.excel.formula.precedents import mentioned, mentioned_cells, references
from xlmc.excel.workbook.workbook import Formula, PivotField

HOST = Cell("S", 5, 3)


@pytest.fixture
def book(workbook, table):
    names = {
        "Rate": "S!$C$3",
        "Other!Rate": "Other!$D$4",
        "Twice": "Rate*2",
        "Loop": "Loop+S!$E$1",
        "Below": "S!A2",
        "Own": "$B$7",
    }
    made = workbook({"A1": 1.0, "My sheet!A1": 1.0}, names=names, sheets=("Other", "My sheet", "Ann's"))
    return type(made)(made.name, made.sheets, made.names, (table("Costs", "S!H1:I9", "a", "b"),))


def said(areas):
    return [str(area) for area in areas]


@pytest.mark.parametrize(
    ("text", "areas"),
    [
        ("A1+B2", ["S!A1", "S!B2"]),
        ("$a$1:b2", ["S!A1:B2"]),
        ("B2:A1", ["S!A1:B2"]),
        ("Other!A1+'My sheet'!B2:C3", ["Other!A1", "My sheet!B2:C3"]),
        ("'Ann''s'!A1", ["Ann's!A1"]),
        ("Gone!A1", []),
        ('"A1"&B2', ["S!B2"]),
        ('"say ""A1"""&B2', ["S!B2"]),
        ("LOG10(A1)+AB12(1)+A1.b", ["S!A1"]),
        ("SUM(A:C)", [f"S!A1:C{MAX_ROW}"]),
        ("SUM(Other!$C:$A)", [f"Other!A1:C{MAX_ROW}"]),
        ("Rate", ["S!C3"]),
        ("twice", ["S!C3"]),
        ("Loop", ["S!E1"]),
        ("Own", ["S!B7"]),
        ("Below", ["S!C6"]),  # as seen from A1: a row further down than the host
        ("SUM(Costs[a])", ["S!H1:I9"]),
        ("1+2", []),
    ],
)
def test_areas_that_a_text_mentions(book, text, areas):
    result = [Area(a.sheet, a.top, a.left, a.bottom, a.right) for a in mentioned(Formula(text, 5, 3), HOST, book)]
    wanted = [parse_address(each.replace("My sheet", "'My sheet'").replace("Ann's", "'Ann''s'")) for each in areas]
    assert result == [
        Area(each.sheet, each.row, each.column, each.row, each.column) if isinstance(each, Cell) else each
        for each in wanted
    ]


def test_a_name_of_the_sheet_goes_before_the_others_and_both_count(book):
    result = said(mentioned(Formula("Rate", 1, 1), Cell("Other", 1, 1), book))
    assert result == ["Other!D4:D4", "S!C3:C3"]


@pytest.mark.parametrize(
    ("text", "host", "area"),
    [
        ("A1", Cell("S", 6, 5), Cell("S", 2, 3)),  # a row and two columns on
        ("$A1", Cell("S", 6, 5), Cell("S", 2, 1)),
        ("A$1", Cell("S", 6, 5), Cell("S", 1, 3)),
        ("A1", Cell("S", 4, 3), Cell("S", MAX_ROW, 1)),  # round the end of the sheet
        ("A1", Cell("S", 5, 2), Cell("S", 1, MAX_COLUMN)),
    ],
)
def test_a_shared_formula_is_moved_to_its_cell(book, text, host, area):
    (result,) = mentioned(Formula(text, 5, 3), host, book)
    assert (result.top, result.left, result.bottom, result.right) == (area.row, area.column, area.row, area.column)


def test_of_large_areas_only_the_cells_that_are_asked_for(workbook):
    book = workbook({"C5": "=SUM(A1:B3)+D1"})
    cells = {Cell("S", 2, 1), Cell("S", 9, 9), Cell("S", 1, 4)}
    assert said(mentioned_cells(book, Cell("S", 5, 3), cells)) == ["S!A2", "S!D1"]
    many = {Cell("S", 20, n) for n in range(1, 7)}
    assert len(list(mentioned_cells(book, Cell("S", 5, 3), many))) == 7
    assert list(mentioned_cells(book, Cell("S", 1, 1), many)) == []


A, B, R = Cell("S", 1, 1), Cell("S", 2, 2), Area("S", 1, 3, 4, 3)
ONE = ir.Number(1.0)


@pytest.mark.parametrize(
    ("tree", "read"),
    [
        (A, [A]),
        (ir.Unary("-", R), [R]),
        (ir.Binary("+", ir.Binary("*", A, ONE), B), [A, B]),
        (ir.Call("SUM", (A, R, ONE)), [A, R]),
        (ir.Call("ROW", (A,)), []),
        (ir.Call("ROW", (ir.Binary("+", A, B),)), [A, B]),
        (ir.Let((("x", A),), ir.Binary("+", ir.Variable("x"), B)), [A, B]),
        (ir.Array(((A, ONE), (ONE, B))), [A, B]),
        (ir.Invoke(ir.Lambda(("x",), B), (A,)), [B, A]),
        (ir.Text("A1"), []),
    ],
)
def test_cells_of_a_tree_from_left_to_right(tree, read):
    assert list(references(tree)) == read


@pytest.mark.parametrize("name", ["ROW", "COLUMN", "ROWS", "COLUMNS", "AREAS", "SHEET", "SHEETS", "ISREF", "CELL"])
def test_functions_that_ask_where_a_cell_is_do_not_read_it(name):
    assert list(references(ir.Call(name, (A,)))) == []


def corner(row, column, fixed=True):
    return ir.Corner(row, column, fixed, fixed)


@pytest.mark.parametrize(
    ("text", "first", "last", "sheet"),
    [
        ("R1C1", (1, 1), (1, 1), None),
        ("r2c3", (2, 3), (2, 3), None),
        ("RC", (5, 3), (5, 3), None),
        ("R[1]C[-2]", (6, 1), (6, 1), None),
        ("R1C1:R[-1]C", (1, 1), (4, 3), None),
        ("R2", (2, None), (2, None), None),
        ("C", (None, 3), (None, 3), None),
        ("C1:C[1]", (None, 1), (None, 4), None),
        (" Data!R1C1 ", (1, 1), (1, 1), "Data"),
        ("'Ann''s data'!R1C1", (1, 1), (1, 1), "Ann's data"),
    ],
)
def test_texts_in_rows_and_columns(text, first, last, sheet):
    assert read_r1c1(text, HOST) == ir.Reference(corner(*first), corner(*last), sheet=sheet)


@pytest.mark.parametrize("text", ["", "A1", "R1C1:R2", "R1:C1", "R1C1:R2C2:R3C3", "R[99999999]C1", "1+1"])
def test_texts_that_are_none(text):
    assert read_r1c1(text, HOST) is None


def test_names_are_read_in_either_style():
    assert read_r1c1("Rate", HOST) == read_a1("Rate")
    assert isinstance(read_a1("Rate"), ir.Name)


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("A02", "A2"),
        ("$A$002:b010", "$A$2:B10"),
        ("Data!A01", "Data!A1"),
        ("XFD01", "XFD1"),
        ("A10", "A10"),
        ("A100", "A100"),
    ],
)
def test_zeros_before_a_row(text, same):
    assert read_a1(text) == read_a1(same) is not None


@pytest.mark.parametrize("text", ["A1+", "XFE01", "A0"])
def test_texts_that_are_no_reference(text):
    assert not isinstance(read_a1(text), ir.Reference)


@pytest.mark.parametrize(
    ("names", "wanted", "position"),
    [
        ([["Sum of x", "x"], ["x", "y"]], "X ", 1),  # the first kind of name goes before the second
        ([["a", "x"], ["b", "x"]], "x", 0),
        ([["a"], [], ["c"]], "C", 2),
        ([["a"]], "b", None),
    ],
)
def test_positions(names, wanted, position):
    assert position_of(names, wanted) == position


FIELD = PivotField("f", ((0, "North"), (1, 3.0), (2, "7"), (3, True), (4, None), (5, "north")))


@pytest.mark.parametrize(
    ("asked", "items"),
    [
        ("NORTH", [0, 5]),
        (3.0, [1]),
        ("3", [1]),
        (7.0, [2, 2]),
        ("7", [2, 2]),
        ("", [4]),
        (None, [4]),
        ("(Blank)", [4]),
        ("x", []),
    ],
)
def test_items_of_a_pivot_table(asked, items):
    assert list(items_named(FIELD, asked)) == items


def test_what_items_may_be_called():
    assert list(names_of(FIELD, 3)) == [ir.Logical(value=True)]
    assert list(names_of(FIELD, 2)) == [ir.Text("7"), ir.Number(7.0)]
    assert list(names_of(FIELD, 4)) == [ir.Text(""), ir.Text("(blank)")]
