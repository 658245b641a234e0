"""References that name sheets: several at once, in the order of their tabs; sheets that are not there."""

from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, ir
from xlmc.excel.formula.precedents import references
from xlmc.excel.workbook.workbook import Formula

TABS = ("Mar", "Jan", "It's", "Dec", "Apr")
CELLS = {"Mar!B9": 1.0, "Dec!A4": 2.0, "'It''s'!A2": 3.0}
NAMES = {"Year": "Jan:Dec!$A$1", "Moving": "Jan:Dec!B2"}


@pytest.fixture
def read(workbook):
    """The cells and areas that a formula written for `Mar!B2` reads, one after another."""

    def places(text, row=2, column=2):
        resolver = Resolver(workbook(CELLS, names=NAMES, sheets=TABS))
        return [str(place) for place in references(resolver.formula(Cell("Mar", row, column), Formula(text, 2, 2)))]

    return places


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("SUM(Jan:Dec!A1)", ["Jan!A1", "'It''s'!A1", "Dec!A1"]),  # in the order of the tabs, not of the calendar
        ("SUM(Dec:Jan!A1)", ["Jan!A1", "'It''s'!A1", "Dec!A1"]),
        ("SUM(jan:DEC!$A$1:B2)", ["Jan!A1:B2", "'It''s'!A1:B2", "Dec!A1:B2"]),
        ("SUM('Jan:It''s'!A1)", ["Jan!A1", "'It''s'!A1"]),
        ("SUM(Dec:Dec!A1)", ["Dec!A1"]),
        ("SUM(S:Jan!A1)", ["S!A1", "Mar!A1", "Jan!A1"]),
        ("SUM(Dec:Apr!A1,Mar:Mar!A1)", ["Dec!A1", "Apr!A1", "Mar!A1"]),
        ("SUM('It''s:Apr'!A:A)", ["'It''s'!A1:A2", "Dec!A1:A4", "Apr!A1:A1"]),  # each as far as it is used
        ("SUM(Year)", ["Jan!A1", "'It''s'!A1", "Dec!A1"]),
        ("SUM(Moving)", ["Jan!C3", "'It''s'!C3", "Dec!C3"]),
    ],
)
def test_a_reference_over_several_sheets(read, text, expected):
    assert read(text) == expected


def test_it_moves_with_a_shared_formula(read):
    assert read("SUM(Jan:Dec!A1)", 5, 3) == ["Jan!B4", "'It''s'!B4", "Dec!B4"]
    assert read("SUM(Jan:Dec!$A$1)", 5, 3) == ["Jan!A1", "'It''s'!A1", "Dec!A1"]


def test_off_the_sheet_it_is_an_error_on_each(workbook):
    resolver = Resolver(workbook({}, sheets=TABS))
    tree = resolver.formula(Cell("S", 1, 1), Formula("Jan:Dec!A1", 2, 2))
    first, rest = ir.chain(tree)
    assert [operator for operator, _ in rest] == [",", ","]
    assert {first, *(part for _, part in rest)} == {ir.ErrorLiteral(4)}


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("SUM(Jan:Dez!A1)", "there is no sheet 'Dez'", "did you mean 'Dec'?"),
        ("SUM(Jam:Dec!A1)", "there is no sheet 'Jam'", "did you mean 'Jan'?"),
        ("'Its'!A1", "there is no sheet 'Its'", 'did you mean "It\'s"?'),
        (
            "SUM([1]Jan:Dec!A1)",
            "the formula refers to another workbook",
            "copy the value into this workbook; links are not followed",
        ),
        ("Winter!Rate", "there is no sheet 'Winter'", None),
    ],
)
def test_a_sheet_that_is_not_there(read, text, message, hint):
    with pytest.raises(FormulaError) as caught:
        read(text)
    assert (caught.value.message, caught.value.hint) == (message, hint)
    assert (caught.value.where, caught.value.text) == ("Mar!B2", text)


def test_many_sheets(workbook):
    tabs = [f"T{number}_" for number in range(300)]
    resolver = Resolver(workbook({}, sheets=tabs))
    tree = resolver.formula(Cell("S", 1, 1), Formula("SUM(T0_:T299_!A1)", 1, 1))
    assert list(references(tree)) == [Cell(tab, 1, 1) for tab in tabs]


def test_a_long_list_of_areas(workbook):
    text = "SUM((" + ",".join(f"A{row}" for row in range(1, 151)) + "))"
    tree = Resolver(workbook({})).formula(Cell("S", 1, 2), Formula(text, 1, 2))
    assert list(references(tree)) == [Cell("S", row, 1) for row in range(1, 151)]
