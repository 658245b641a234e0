"""What a workbook as read says of its cells, names, tables and what-if tables."""

from __future__ import annotations

import pytest

from xlmc.errors import ErrorCode
from xlmc.excel.address import MAX_ROW, Area, Cell
from xlmc.excel.workbook.workbook import (
    CellContent,
    DataTable,
    DefinedName,
    Formula,
    LinkedBook,
    PivotTable,
    Place,
    Sheet,
    Table,
    Workbook,
)

PLAIN = Formula("A1", 1, 1)
ARRAY = Formula("A1:A2", 1, 2, array=Area("S", 1, 2, 2, 2))


@pytest.mark.parametrize(
    ("content", "blank", "uncalculated"),
    [
        (CellContent(), True, False), (CellContent(""), True, False), (CellContent(" \t"), True, False),
        (CellContent("x"), False, False), (CellContent(0.0), False, False), (CellContent(False), False, False),
        (CellContent(None, PLAIN), False, True), (CellContent(1.0, PLAIN), False, False),
        (CellContent("", PLAIN), True, False), (CellContent(None, ARRAY), False, False),
        (CellContent(ErrorCode.NA), False, False),
    ],
)  # fmt: skip
def test_cells(content, blank, uncalculated):
    assert (content.is_blank, content.is_uncalculated) == (blank, uncalculated)


def sheet(name, cells, **more):
    return Sheet(name, f"xl/worksheets/{name}.xml", {at: CellContent(*each) for at, each in cells.items()}, **more)


LINKED = LinkedBook("prices.xlsx", {"[1]Prices": sheet("[1]Prices", {(1, 1): (5.0,)})})
BOOK = Workbook(
    "book.xlsx",
    {
        "Sheet": sheet("Sheet", {(1, 1): (1.0,), (1, 2): (2.0, ARRAY), (2, 2): (3.0,), (3, 1): ("x", PLAIN)}),
        "Käse": sheet("Käse", {(2, 3): (True,), (4, 4): (None, PLAIN)}),
    },
    names=(
        DefinedName("Rate", "Sheet!$A$1"), DefinedName("rate", "Käse!$C$2", "Käse"), DefinedName("Area", "Sheet!A1:B2"),
        DefinedName("Wrong", "1+1"),
    ),
    tables=(Table("Costs", Area("Sheet", 1, 1, 9, 3), ("a", "b", "c"), totals_rows=1),),
    links={"[1]": LINKED},
)  # fmt: skip


@pytest.mark.parametrize(
    ("place", "value"),
    [
        ("Sheet!A1", 1.0), ("sheet!a1", 1.0), (" Sheet!A1 ", 1.0), ("KÄSE!$C$2", True), ("'Käse'!C2", True),
        ("Rate", 1.0), ("RATE", 1.0), ("Sheet!Z9", None), ("Sheet!A3", "x"), ("Käse!D4", None),
    ],
)  # fmt: skip
def test_the_value_of_a_place(place, value):
    assert BOOK[place] == value


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ("Nothing", "is no cell of book.xlsx"), ("A1", "A1"), ("Sheet!A1:B2", "is not one cell, but Sheet!A1:B2"),
        ("Area", "is not one cell"), ("Lost!A1", "there is no sheet 'Lost' in book.xlsx; there are Sheet, Käse"),
        ("Wrong", "is no cell of book.xlsx"),
    ],
)  # fmt: skip
def test_places_that_are_none(place, message):
    with pytest.raises(KeyError, match=message):
        BOOK[place]


def test_names_and_tables_whatever_their_case():
    assert BOOK.defined_name("RATE").text == "Sheet!$A$1"
    assert BOOK.defined_name("Rate", "KÄSE").text == "Käse!$C$2"
    assert BOOK.defined_name("Rate", "Sheet").text == "Sheet!$A$1"
    assert BOOK.defined_name("None", "Sheet") is None
    assert BOOK.table_named("COSTS").name == "Costs"
    assert BOOK.table_named("None") is None
    assert BOOK.sheet_named("käse").name == "Käse"
    assert BOOK.sheet_named("None") is None


def test_formulas_and_arrays():
    assert [*BOOK.formula_cells()] == [Cell("Sheet", 1, 2), Cell("Sheet", 3, 1), Cell("Käse", 4, 4)]
    assert BOOK.sheets["Sheet"].arrays == {Cell("Sheet", 1, 2): ARRAY.array}
    assert BOOK.sheets["Käse"].arrays == {}


def test_cells_of_other_books():
    assert BOOK.content(Cell("[1]Prices", 1, 1)).value == 5.0
    for cell in (Cell("[1]Prices", 2, 1), Cell("[1]Lost", 1, 1), Cell("[2]Prices", 1, 1), Cell("Lost", 1, 1)):
        assert BOOK.content(cell) == CellContent()
    assert BOOK.sheet_of(Cell("[1]Prices", 9, 9)) is LINKED.sheets["[1]Prices"]
    assert BOOK.sheet_of(Cell("[2]Prices", 9, 9)) is None
    assert BOOK.sheet_of(Cell("Käse", 1, 1)) is BOOK.sheets["Käse"]
    assert BOOK.content(Cell("Käse", 2, 3)).value is True


@pytest.mark.parametrize(
    ("table", "body"),
    [
        (Table("t", Area("S", 1, 2, 9, 4), ()), Area("S", 2, 2, 9, 4)),
        (Table("t", Area("S", 1, 2, 9, 4), (), totals_rows=1), Area("S", 2, 2, 8, 4)),
        (Table("t", Area("S", 1, 2, 9, 4), (), header_rows=0), Area("S", 1, 2, 9, 4)),
    ],
)
def test_the_body_of_a_table(table, body):
    assert table.body == body


def test_hidden_rows_count_where_a_filter_leaves_rows_out():
    hidden = frozenset({3, 4})
    plain, filtered = (sheet(name, {}, hidden_rows=hidden) for name in ("S", "T"))
    by_filter = sheet("U", {}, hidden_rows=hidden, filtered=(Area("U", 1, 1, 9, 1),))
    table = Table("t", Area("T", 1, 1, 9, 1), ("a",), filtered=Area("T", 1, 1, 9, 1))
    book = Workbook("b", {each.name: each for each in (plain, filtered, by_filter)}, tables=(table,))
    assert [book.filtered_rows(each) for each in (plain, filtered, by_filter)] == [frozenset(), hidden, hidden]
    without = Workbook("b", {"T": filtered}, tables=(Table("t", Area("T", 1, 1, 9, 1), ("a",)),))
    assert without.filtered_rows(filtered) == frozenset()


AREA = Area("S", 5, 3, 7, 6)
"""C5:F7; its corner is B4."""


@pytest.mark.parametrize(
    ("table", "formula", "values"),
    [
        (DataTable(AREA, two_inputs=True), Cell("S", 4, 2), (Cell("S", 4, 5), Cell("S", 6, 2))),
        (DataTable(AREA, by_row=True), Cell("S", 6, 2), (Cell("S", 4, 5),)),
        (DataTable(AREA), Cell("S", 4, 5), (Cell("S", 6, 2),)),
    ],
)
def test_what_if_tables(table, formula, values):
    """For E6: in the corner, or in the column on its left, or in the row above it."""
    assert table.formula_of(Cell("S", 6, 5)) == formula
    assert table.values_of(Cell("S", 6, 5)) == values


@pytest.mark.parametrize(
    ("table", "margins"),
    [
        (DataTable(Area("S", 2, 2, 3, 3)), ["B1", "C1", "A2", "A3"]),
        (DataTable(Area("S", 2, 2, 3, 3), two_inputs=True), ["A1", "B1", "C1", "A2", "A3"]),
        (DataTable(Area("S", 1, 2, 2, 3), two_inputs=True), ["A1", "A2"]),
        (DataTable(Area("S", 2, 1, 2, 2), two_inputs=True), ["A1", "B1"]),
        (DataTable(Area("S", 1, 1, 2, 2), two_inputs=True), []),
        (DataTable(Area("S", MAX_ROW, 2, MAX_ROW, 2)), [f"B{MAX_ROW - 1}", f"A{MAX_ROW}"]),
    ],
)
def test_the_cells_beside_a_what_if_table(table, margins):
    assert [cell.a1 for cell in table.margins()] == margins


def pivot():
    """Two rows of items and their total, by two columns; the second column shows data field 1."""
    rows = Place(frozenset({(0, 0)})), Place(frozenset({(0, 1)})), None, Place(frozenset())
    columns = Place(frozenset(), 0), Place(frozenset(), 1), Place(frozenset({(1, 4)}))
    return PivotTable(Area("S", 1, 1, 9, 9), Cell("S", 3, 2), (), (), rows, columns, {}, None)


def test_the_cells_of_a_pivot_table():
    cells = pivot().cells
    assert cells[0, frozenset({(0, 0)})] == (Cell("S", 3, 2),)
    assert cells[1, frozenset({(0, 1)})] == (Cell("S", 4, 3),)
    assert cells[0, frozenset()] == (Cell("S", 6, 2),)
    assert cells[0, frozenset({(0, 1), (1, 4)})] == (Cell("S", 4, 4),)
    assert len(cells) == 9
    both, one = (Place(frozenset()),) * 2, (Place(frozenset()),)
    two = PivotTable(Area("S", 1, 1, 9, 9), Cell("S", 3, 2), (), (), both, one, {}, None)
    assert two.cells == {(0, frozenset()): (Cell("S", 3, 2), Cell("S", 4, 2))}


@pytest.mark.parametrize(
    ("data", "items", "expected"),
    [
        (0, {(0, 0)}, {"D3"}), (0, {(0, 1)}, {"D4"}), (0, {(1, 4)}, {"D3", "D4"}), (1, set(), {"C3", "C4"}),
        (0, {(9, 9)}, set()), (0, {(0, 0), (1, 4)}, set()), (0, set(), {"B3", "B4", "D3", "D4", "D6"}),
    ],
)  # fmt: skip
def test_cells_with_further_items(data, items, expected):
    found = pivot().cells_with(data, frozenset(items))
    assert {cell.a1 for cells in found for cell in cells} == expected


def test_what_is_usual():
    plain = Workbook("b", {})
    flags = plain.date1904, plain.libreoffice, plain.macintosh, plain.may_be_stale
    assert flags == (False,) * 4
    shown = repr(Workbook("b", {}, parts={"a": b"bytes"}, origin={"a": b"bytes"}, data=b"bytes"))
    assert "bytes" not in shown
    assert (Sheet("S", "p", {}).visible, DataTable(AREA).two_inputs, DataTable(AREA).by_row) == (True, False, False)
    assert not Formula("A1", 1, 1).dynamic
