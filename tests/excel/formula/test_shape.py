"""Shapes of formulas; and formulas as Excel shows them: without what only the file has, and that of the cell itself."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.formula import Resolver
from xlmc.excel.formula.shape import Shapes, shape_of, shown_formula
from xlmc.excel.workbook.workbook import CellContent, Formula


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


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("A1+1", "=A1+1"),
        ("_xlfn.CONCAT(A1:A3)", "=CONCAT(A1:A3)"),
        ("_xlfn._xlws.SORT(A1:A3)", "=SORT(A1:A3)"),
        ("_xlfn.LET(_xlpm.x,A1,_xlpm.x*2)", "=LET(x,A1,x*2)"),
        ("_xlfn.LAMBDA(_xlpm.x,_xlop.y,_xlpm.x+_xlop.y)(1)", "=LAMBDA(x,[y],x+y)(1)"),
        ("_xlfn.BYROW(A1:B2,_xleta.SUM)", "=BYROW(A1:B2,SUM)"),
        ("SUM(_xlfn.ANCHORARRAY('My Sheet'!A1))", "=SUM('My Sheet'!A1#)"),
        ("_xlfn.LET(_xlpm.x,A1,_xlfn.SINGLE(_xlpm.x))", "=LET(x,A1,@x)"),
        ("_xlfn.SINGLE(A1:A9)*2", "=@A1:A9*2"),
        ('"_xlfn.IFS(" & A1', '="_xlfn.IFS(" & A1'),
        ("'_xlfn.old'!A1+_xlfn.DAYS(A1,A2)", "='_xlfn.old'!A1+DAYS(A1,A2)"),
        ("my_xlfn.name+1", "=my_xlfn.name+1"),
        ("_xll.RiskNormal(A1,2)+1", "=RiskNormal(A1,2)+1"),
    ],
)
def test_without_the_prefixes_of_the_file(text, shown):
    assert shown_formula(Formula(text, 1, 1), parse_address("A1", "S")) == shown


def test_a_shared_formula_is_that_of_the_cell():
    assert shown_formula(Formula("A1*$B$2+_xlfn.DAYS(A1,C$1)", 1, 4), parse_address("E3", "S")) == (
        "=B3*$B$2+DAYS(B3,D$1)"
    )


def test_braces_are_those_of_ctrl_shift_enter():
    area, cell = Area("S", 1, 1, 3, 1), parse_address("A1", "S")
    assert shown_formula(Formula("B1:B3*2", 1, 1, area), cell) == "{=B1:B3*2}"
    assert shown_formula(Formula("B1:B3*2", 1, 1, area, dynamic=True), cell) == "=B1:B3*2"


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        (Formula("A1*2", 1, 2), "=A3*2"),
        (Formula("_xlfn.DAYS(A1,2)", 1, 2), "=DAYS(A3,2)"),
        (Formula("A1*2", 3, 2, Area("S", 3, 2, 4, 2)), "{=A1*2}"),
    ],
)
def test_formulatext_and_verify_show_it(workbook, formula, text):
    from xlmc.analysis.studies.verify import verify

    book = workbook({"A3": 5.0, "B3": CellContent(1.0, formula), "C1": ("=FORMULATEXT(B3)", text)})
    result = {str(check.cell): check for check in verify(book).cells}
    assert result["S!C1"].got == text
    assert result["S!B3"].formula == text
