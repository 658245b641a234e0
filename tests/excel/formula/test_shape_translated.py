"""Shapes against openpyxl's translation of a formula from one cell to another, and against the parser itself."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openpyxl.formula.translate import Translator

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, parse
from xlmc.excel.formula import shape as module
from xlmc.excel.formula.shape import Shapes, shape_of
from xlmc.excel.workbook.workbook import Formula

ROWS, COLUMNS = 40, 20  # far enough from the edges: a shift of this much stays on the sheet

corners = st.builds(
    "{}{}{}{}".format,
    st.sampled_from(["", "$"]),
    st.sampled_from(["Z", "AB", "aa", "XAA", "TAX"]),
    st.sampled_from(["", "$"]),
    st.sampled_from(["50", "61", "2024"]),
)
dollars = st.sampled_from(["", "$"])
ranges = st.one_of(
    corners,
    st.tuples(corners, corners).map(":".join),
    st.builds("{}Z:{}AC".format, dollars, dollars),
    st.builds("{}50:{}77".format, dollars, dollars),
)
prefixes = st.sampled_from(["", "Data!", "'a b'!", "'It''s A50'!", "'Z50 60'!"])
leaves = st.one_of(
    st.tuples(prefixes, ranges).map("".join),
    st.sampled_from(
        ["1E5", "5%", '"A50"', '"say ""Z50"" A$50"', "TRUE", "#N/A", "Rate", "a.b", '"it\'s"', "{1,2;3,-4}"]
    ),
)
formulas = st.recursive(
    leaves,
    lambda parts: st.one_of(
        st.builds("{}{}{}".format, parts, st.sampled_from(["+", "-", "*", "^", "&", ">=", " , "]), parts),
        st.builds("{}({},{})".format, st.sampled_from(["SUM", "LOG10", "ATAN2", "_xlfn.F.DIST"]), parts, parts),
        st.builds("({})".format, parts),
        st.builds("-{}%".format, parts),
    ),
    max_leaves=6,
)
places = st.tuples(st.integers(50, 60), st.integers(26, 30))
shifts = st.tuples(st.integers(-ROWS, ROWS), st.integers(-COLUMNS, COLUMNS))


def translated(text, here, there):
    origin, target = (Cell("S", *place).a1 for place in (here, there))
    return Translator(f"={text}", origin=origin).translate_formula(target).removeprefix("=")


@settings(max_examples=250, deadline=None)
@given(formulas, places, shifts)
def test_a_formula_and_its_translation_have_one_shape(text, here, shift):
    there = (here[0] + shift[0], here[1] + shift[1])
    assert shape_of(translated(text, here, there), *there) == shape_of(text, *here)


@settings(max_examples=250, deadline=None)
@given(formulas, places, shifts)
def test_the_same_text_elsewhere_has_its_shape_only_if_nothing_in_it_moves(text, here, shift):
    there = (here[0] + shift[0], here[1] + shift[1])
    moves = translated(text, here, there).upper() != text.upper()
    assert (shape_of(text, *there) != shape_of(text, *here)) is moves


@settings(max_examples=200, deadline=None)
@given(st.lists(formulas, min_size=2, max_size=4), places, shifts)
def test_what_was_parsed_for_another_cell_means_the_same_here(workbook, texts, here, shift):
    there = (here[0] + shift[0], here[1] + shift[1])
    book = workbook(
        {"Data!A1": 1.0, "'a b'!A1": 1.0, "'It''s A50'!A1": 1.0, "'Z50 60'!A1": 1.0}, {"Rate": "7", "a.b": "8"}
    )
    shared = Resolver(book)
    for text in texts:
        shared.formula(Cell("S", *here), Formula(text, *here))
        moved = Formula(translated(text, here, there), *there)
        host = Cell("S", *there)
        assert shared.formula(host, moved) == Resolver(book).formula(host, moved)


UNTOUCHED = [
    # no cell in any of these moves, so two cells that hold the same text share its shape
    "YAW1",
    "XFE1",
    "A1048577",
    "A0",
    "Yaw_A1",
    "A1.B1",
    "A1_",
    "a?A1",
    "\\A1",
    "Größe1",
    "R1C1",
    "$A$1",
    "'A1'!$B$2",
    "A1!$B$2",
    "[1]A1!$B$2",
    "'[A1.xlsx]B2'!$C$3",
    "Jan1:Dec1!$A$1",
    "'Jan1:Dec1'!$A$1",
    "T[A1]",
    "T[[A1]:[B1]]",
    "T[[#This Row],[A1]]",
    "[@A1]",
    "T['[]&\"A1\"&T['[A1']]",
    "T['']&'A1'!$A$1",
    "A1[A1]",
    "LOG10(1)+ATAN2(1,2)",
    "_xlfn.DEC2HEX(1)",
    '"A1"&"say ""A1"""',
    "\"it's A1\"&'A1 it''s'!$A$1",
    "1E5+2E10",
    "#REF!$A$1",
    "$A:$B+$1:$2",
    "{1,2}",
    "TRUE1",
]


@pytest.mark.parametrize("text", UNTOUCHED)
def test_what_looks_like_a_cell_and_is_none(text):
    assert shape_of(text, 1, 1) == shape_of(text, 8, 9)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("YAW1", "YAW2"),
        ("a?A1", "a?A2"),
        ("Jan1:Dec!A1", "Jan2:Dec!A2"),
        ("[1]A1!B1", "[1]A2!B2"),
        ("T['[]&A1&T['[]", "T['[]&A1&T['[]"),
        ("T[x'[]*A1+'b c'!D1", "T[x'[]*A1+'b c'!D2"),
        ("T[']]&A1&T[']]", "T[']]&A1&T[']]"),
        ("A1048576", "A1048577"),
        ("SUM(A1,1)", "SUM(A2,2)"),
        ('A1&"A1"', 'A2&"A2"'),
        ("A1:A2", "A2:A2"),
        ("1:1", "$1:1"),
    ],
)
def test_what_differs_by_more_than_a_row(one, other):
    assert shape_of(one, 1, 1) != shape_of(other, 2, 1)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Data!A1:Data!A3", "Data!A2:Data!A4"),
        ("'b c'!A1:D!A3", "'b c'!A2:D!A4"),
        ("TAX2024*2", "TAX2025*2"),  # column TAX is on the sheet
        ("T['[]&A1&T[']]", "T['[]&A2&T[']]"),
        ("Jan1:Dec1!A1", "Jan1:Dec1!A2"),
        ("A1#+@B1", "A2#+@B2"),
        ("A1:INDEX(B:B,2)", "A2:INDEX(B:B,2)"),
        ("SUM(A1 ,\nA2)", "SUM(A2 ,\nA3)"),
        ("LET(x,A1,x*B$1)", "LET(x,A2,x*B$1)"),
        ("1:2", "2:3"),
        ("-A1%", "-A2%"),
        ("{1}*A1", "{1}*A2"),
    ],
)
def test_what_differs_by_a_row(one, other):
    assert shape_of(one, 1, 1) == shape_of(other, 2, 1)
    assert parse(one) != parse(other)


@pytest.fixture
def parses(monkeypatch):
    """The texts that were parsed."""
    texts = []

    def listening(text):
        texts.append(text)
        return parse(text)

    monkeypatch.setattr(module, "parse_cell", listening)
    return texts


def test_a_thousand_filled_down_cells_are_parsed_once(parses, workbook):
    resolver = Resolver(workbook({}, names={"Rate": "S!$Z$1"}))
    for row in range(1, 1001):
        text = f"IF(A{row}>0,B{row}*Rate,$C$1)"
        tree = resolver.formula(Cell("S", row, 4), Formula(text, row, 4))
        assert tree.arguments[1].left == Cell("S", row, 2)
    assert parses == ["IF(A1>0,B1*Rate,$C$1)"]


def test_a_thousand_cells_of_a_shared_formula_are_parsed_once(parses, workbook):
    resolver = Resolver(workbook({}))
    trees = [resolver.formula(Cell("S", row, 2), Formula("A5*2", 5, 2)) for row in range(5, 1005)]
    assert [tree.left.row for tree in trees] == list(range(5, 1005))
    assert parses == ["A5*2"]


def test_two_hundred_shapes_are_two_hundred_parses(parses, workbook):
    resolver = Resolver(workbook({}))
    for row in range(1, 51):
        for column in range(2, 202):
            resolver.formula(Cell("S", row, column), Formula(f"$A{row}*{column}", row, column))
    assert len(parses) == 200


def test_what_is_no_formula_is_told_of_each_text():
    shapes = Shapes()
    for row in (1, 2):
        with pytest.raises(FormulaError, match="cannot be read") as caught:
            shapes.parse(f"A{row}+", row, 1)
        assert caught.value.text == f"A{row}+"
