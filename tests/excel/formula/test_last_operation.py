"""Which operation a formula ends with, outside of brackets: Excel makes 0 of it where it is a sum that cancels."""

from __future__ import annotations

import pytest

from xlmc.excel.formula import ir
from xlmc.excel.formula.parse import parse, parse_cell


@pytest.mark.parametrize(
    ("text", "last"),
    [
        ("A1-B1", True),
        ("A1+B1", True),
        (" +A1-B1 ", True),
        ("(A1)-(B1)", True),
        ("(A1-B1)-(A1-C1)", True),
        ("A1*(2+3)-(B1)", True),
        ('("a)"&A1)-(B1)', True),
        ("('a sheet)'!A1)-(B1)", True),
        ("(Table1[[a)]])-(B1)", True),
        ("A1-\n(B1)", True),
        ("(A1-B1)", False),
        ("((A1)-(B1))", False),
        (' ("a("-"b)") ', False),
        ("(A1-\nB1)", False),
        ("-(A1-B1)", False),
        ("(A1-B1)%", False),
        ("A1-B1=0", False),
        ("A1-B1&1", False),
        ("A1*B1", False),
        ("SUM(A1-B1)", False),
    ],
)
def test_the_last_operation(text, last):
    tree = parse_cell(text)
    assert (isinstance(tree, ir.Binary) and tree.last) is last
    inner = parse(text)
    assert not (isinstance(inner, ir.Binary) and inner.last)
