"""Not strict: a name that is not there is `#NAME?`, as Excel has it; the formula goes on."""

from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver
from xlmc.excel.workbook.workbook import Formula

NAMES = {"Rate": "S!$C$3", "Half": "Gone/2", "Data!Own": "Data!$A$1", "Both": "Half+Rate", "Loop": "Loop"}
ANY_CASE = {
    # formula -> its tree where nothing is missing
    "Rate*2": "(* S!C3 2)",
    "LET(x,1,x)": "LET(x=1 x)",
    "Data!Own": "Data!A1",
}
MISSING = {
    "Gone": "#NAME?",
    "1+Gone*2": "(+ 1 (* #NAME? 2))",
    "IFERROR(Gone,0)": "IFERROR(#NAME? 0)",
    "Gone:B2": "#NAME?",
    "A1 Gone": "#NAME?",
    "S!Gone": "#NAME?",
    "Own": "#NAME?",  # another sheet's own name
    "Half": "(/ #NAME? 2)",
    "Both": "(+ (/ #NAME? 2) S!C3)",
    "LET(x,1,Gone+x)": "LET(x=1 (+ #NAME? x))",
    "LAMBDA(x,x+y)(1)": "[λ(x (+ x #NAME?))](1)",
    "Gone(2)": "GONE(2)",  # a call: which functions there are is not known here
}


@pytest.fixture
def see(workbook, shown):
    """The tree that a formula gives in `S!B2`."""

    def resolve(text, strict):
        resolver = Resolver(workbook({}, names=NAMES, sheets=("Data",)), strict=strict)
        return shown(resolver.formula(Cell("S", 2, 2), Formula(text, 2, 2)))

    return resolve


@pytest.mark.parametrize("text", MISSING)
def test_a_name_that_is_not_there(see, text):
    assert see(text, strict=False) == MISSING[text]
    if text != "Gone(2)":
        with pytest.raises(FormulaError, match="There is no name"):
            see(text, strict=True)


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize("text", ANY_CASE)
def test_what_is_there_is_the_same(see, text, strict):
    assert see(text, strict) == ANY_CASE[text]


@pytest.mark.parametrize("strict", [True, False])
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1+", "The formula cannot be read"),
        ("[1]!Rate", "The formula refers to another workbook"),
        ("Loop", "The name 'Loop' is defined by itself"),
        ("1 2", "needs references on both sides"),
        ("LET(1,2,3)", "LET needs a name"),
    ],
)
def test_what_nobody_can_compute_is_told(see, text, message, strict):
    with pytest.raises(FormulaError, match=message) as caught:
        see(text, strict)
    assert caught.value.where == "S!B2"
