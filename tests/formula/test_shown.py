"""Formulas as Excel shows them: without what only the file has, and that of the cell itself."""

from __future__ import annotations

import pytest

from xlmc.address import Area, parse_address
from xlmc.formula.shape import shown_formula
from xlmc.workbook.model import CellContent, Formula


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
    from xlmc.studies.verify import verify

    book = workbook({"A3": 5.0, "B3": CellContent(1.0, formula), "C1": ("=FORMULATEXT(B3)", text)})
    found = {str(check.cell): check for check in verify(book).cells}
    assert found["S!C1"].got == text
    assert found["S!B3"].formula == text
