from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.address import Cell
from xlmc.errors import FormulaError
from xlmc.formula import Resolver
from xlmc.formula.shape import Shapes, shape_of
from xlmc.workbook.model import Formula


@pytest.mark.parametrize(
    ("one", "at", "other", "there"),
    [
        ("A1+1", (1, 2), "A7+1", (7, 2)),
        ("A1+1", (1, 2), "C1+1", (1, 4)),
        ("$A1+B$1+$C$3", (1, 2), "$A2+C$1+$C$3", (2, 3)),
        ("SUM(Data!A1:B2)", (1, 1), "SUM(Data!B3:C4)", (3, 2)),
        ("A:A+1:1", (1, 1), "B:B+2:2", (2, 2)),
        ("$A:$A", (1, 1), "$A:$A", (9, 9)),
        ('A1&"A1"', (1, 1), 'A2&"A1"', (2, 1)),
    ],
)
def test_filled_formulas_have_one_shape(one, at, other, there):
    assert shape_of(one, *at) == shape_of(other, *there)


@pytest.mark.parametrize(
    ("one", "at", "other", "there"),
    [
        ("A1+1", (1, 2), "A1+1", (2, 2)),
        ("A1+1", (1, 2), "A1+2", (1, 2)),
        ("$A$1", (1, 1), "$A$2", (2, 1)),
        ("A$1", (1, 1), "A$2", (2, 1)),
        ('"A1"', (1, 1), '"A2"', (2, 1)),
        ("YAW1", (1, 1), "YAW2", (2, 1)),  # names: no cell lies there
        ("T[A1]", (1, 1), "T[A2]", (2, 1)),
        ("'A1'!B$1", (1, 1), "'A2'!B$1", (2, 1)),
        ("A:A", (1, 1), "A:A", (1, 2)),
        ("1:1", (1, 1), "1:1", (2, 1)),
        ("Rate1x", (1, 1), "Rate2x", (2, 1)),
        ("LOG10(A$1)", (1, 1), "LOG11(A$1)", (2, 1)),
        ("\\A1", (1, 1), "\\A2", (2, 1)),
        ("A1.x", (1, 1), "A2.x", (2, 1)),
    ],
)
def test_what_differs_in_more_than_a_shift_has_another(one, at, other, there):
    assert shape_of(one, *at) != shape_of(other, *there)


def test_a_shape_is_parsed_once():
    shapes = Shapes()
    first = shapes.parse("A1+$B$1", 1, 3)
    again = shapes.parse("A500+$B$1", 500, 3)
    assert again is first
    assert again.origin == (1, 3)


PIECES = ["A1", "B$2", "$C3", "$D$4", "A1:B3", "A:A", "$A:B", "2:3", "1:$2", "Data!A2", "YAW1", '"A1"', "T[A1]", "10"]
PIECES += ["LOG10(A1)", "A2 A:A", "-B1%", "{1,2}", "IF(A1,$A2,)"]


@given(
    st.lists(st.sampled_from(PIECES), min_size=1, max_size=4),
    st.lists(st.tuples(st.integers(1, 6), st.integers(1, 6)), min_size=2, max_size=5),
)
def test_what_a_shape_means_does_not_depend_on_where_it_was_first_met(workbook, table, shown, pieces, hosts):
    cells = {"Z9": 1.0, "Data!Z9": 1.0}
    book = workbook(cells, names={"YAW1": "S!$Z$9"}, tables=[table("T", "S!M1:N3", "A1", "B1")])
    one_for_all = Resolver(book)
    text = "+".join(pieces)
    for row, column in hosts:
        host, formula = Cell("S", row, column), Formula(text, row, column)
        assert shown(one_for_all.formula(host, formula)) == shown(Resolver(book).formula(host, formula))


SUFFIXES = [
    "A1",
    "A2",
    "$A1",
    "A$2",
    "-1",
    "A10",
    "B2*3",
    "%",
    "%d",
    "LOG10(A1)",
    "Data!A3",
    "1:2",
    "YAW1",
    '"A1"',
    "A1048576",
]


@given(
    st.lists(st.sampled_from(SUFFIXES), min_size=1, max_size=4),
    st.lists(st.sampled_from(SUFFIXES), min_size=1, max_size=4),
    st.integers(1, 12),
    st.integers(1, 12),
)
def test_what_a_column_is_filled_with_is_of_one_shape(pieces, others, row, other_row):
    shapes, text = Shapes(), "+".join(pieces)
    shifted = text.replace("A1", f"A{1 + other_row - row}").replace("A2", f"A{2 + other_row - row}")
    for other in (text, shifted, "+".join(others)):
        try:
            same = shapes.parse(text, row, 3) is shapes.parse(other, other_row, 3)
        except FormulaError:
            continue
        assert same == (shape_of(text, row, 3) == shape_of(other, other_row, 3))
