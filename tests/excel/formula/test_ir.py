from __future__ import annotations

import pytest

from xlmc.errors import FormulaError
from xlmc.excel.formula import ir, parse


@pytest.mark.parametrize(
    ("text", "first", "rest"),
    [
        ("A1", "A1", []),
        ("SUM(1+2)", "SUM(1+2)", []),
        ("1+2-3", "1", [("+", "2"), ("-", "3")]),
        ("1+2*3-4", "1", [("+", "2*3"), ("-", "4")]),
        ("1*2+3", "1", [("*", "2"), ("+", "3")]),
        ("1-(2-3)", "1", [("-", "2-3")]),
        ("A1:A2:A3", "A1:A2", [(":", "A3")]),
        ("(A1,A2)", "A1", [(",", "A2")]),
        ("(A1,A2)+1-2", "(A1,A2)", [("+", "1"), ("-", "2")]),
    ],
)
def test_a_chain_is_what_leans_to_the_left(text, first, rest):
    assert ir.chain(parse(text)) == (parse(first), [(operator, parse(part)) for operator, part in rest])


def test_nodes_are_frozen():
    with pytest.raises(AttributeError):
        parse("1").value = 2.0


def test_an_error_knows_its_cell():
    error = FormulaError("wrong", text="A1+", span=(3, 4)).at("S!B7")
    assert str(error) == "S!B7: Wrong.\n    =A1+\n        ^"
