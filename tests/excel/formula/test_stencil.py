from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell
from xlmc.excel.formula import Resolver, Stencil
from xlmc.excel.formula.precedents import references
from xlmc.excel.workbook.workbook import Formula

HOME = Cell("S", 5, 5)


@pytest.fixture(scope="session")
def stencil(workbook):
    """`stencil(text)`: what the formula of S!E5 has in common with the cells it is filled into; None without."""

    def make(text, at=HOME):
        resolver = Resolver(workbook({"Z9": 1.0, "Data!Z9": 1.0}, names={"Rate": "S!$Z$9"}))
        formula = Formula(text, at.row, at.column)
        resolver.tree_or_stencil(at, formula)
        result = resolver.tree_or_stencil(at, formula)
        return result if isinstance(result, Stencil) else None

    return make


MOVES = ["A1+$B$2", "SUM(D4:F6)", "IF(E4>0,Data!E4,$A5)", "-E$4%", 'D5&"a"', "SUM($A$1:$B$2,D5)"]


@pytest.mark.parametrize("text", MOVES)
@pytest.mark.parametrize("host", [HOME, Cell("S", 9, 5), Cell("S", 5, 9), Cell("S", 7, 6)])
def test_it_is_the_tree_of_each_cell(stencil, workbook, text, host):
    result = stencil(text)
    alone = Resolver(workbook({"Z9": 1.0, "Data!Z9": 1.0})).formula(host, Formula(text, HOME.row, HOME.column))
    assert result.fits(host)
    assert result.at(host) == alone


@given(
    st.sampled_from(["D4*F6", "SUM(D4:F6)+$A$1", "E$1-$A5+D4", "IF(D4,D4,C3)"]), st.integers(-3, 9), st.integers(-3, 9)
)
def test_its_cells_are_what_the_tree_refers_to(stencil, text, down, right):
    result, host = stencil(text), Cell("S", 5 + down, 5 + right)
    if not result.fits(host):
        return
    read = (place for place in references(result.at(host)))
    cells = [cell for place in read for cell in (place.cells() if isinstance(place, Area) else (place,))]
    assert list(dict.fromkeys(result.cells(host))) == list(dict.fromkeys(cells))


@pytest.mark.parametrize(
    "text",
    ["Rate*2", "SUM(A:A)", "SUM(A$1:A5)", "ROW(A1)", "LET(x,A1,x)", "A1:B2 B1:C3", "SUM(A1:Z99)", "S:Data!A1"],
)
def test_what_does_not_simply_move_has_none(stencil, text):
    assert stencil(text) is None


def test_what_would_leave_the_sheet_does_not_fit(stencil):
    assert stencil("D4").fits(Cell("S", 2, 2))
    assert not stencil("D4").fits(Cell("S", 1, 5))
    assert not stencil("D4").fits(Cell("S", 5, 1))
    assert not stencil("E6").fits(Cell("S", MAX_ROW, 5))
    assert not stencil("F5").fits(Cell("S", 5, MAX_COLUMN))
    assert stencil("$D$4").fits(Cell("S", 1, 1))


def test_another_sheet_has_its_own(workbook):
    resolver = Resolver(workbook({"Z9": 1.0, "Data!Z9": 1.0}))
    for sheet in ("S", "Data", "S", "Data"):
        place = Cell(sheet, 2, 2)
        assert resolver.formula(place, Formula("A1", 2, 2)) == Cell(sheet, 1, 1)
