from __future__ import annotations

from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.workbook import Formula
from xlmc.montecarlo.definitions.computed import Computed


def test_formulas_arrays_and_draws(make_book):
    spilled = Formula("A1:A3*2", row=1, column=2, array=Area("S", 1, 2, 3, 2))
    book = make_book({"S!A1": 1, "S!B1": (spilled, 2.0), "S!B2": 4, "S!D1": "=A1", "T!B2": 5})
    computed = Computed(book, drawn={Cell("S", 1, 1)})
    assert [computed.by_formula(Cell("S", row, 2)) for row in (1, 2, 3, 4)] == [True, True, True, False]
    assert computed.by_formula(Cell("S", 1, 4))
    assert not computed.by_formula(Cell("T", 2, 2))
    assert not computed.by_formula(Cell("S", 1, 1))
    assert computed.at_all(Cell("S", 1, 1))
    assert computed.at_all(Cell("S", 2, 2))
    assert not computed.at_all(Cell("S", 2, 1))


def test_drawn_cells_may_be_added_later(make_book):
    drawn = {}
    computed = Computed(make_book({"S!A1": 1}), drawn)
    assert not computed.at_all(Cell("S", 1, 1))
    drawn[Cell("S", 1, 1)] = Cell("S", 9, 9)
    assert computed.at_all(Cell("S", 1, 1))
