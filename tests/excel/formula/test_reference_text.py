from __future__ import annotations

import pytest

from xlmc.excel.formula.ir import TableReference
from xlmc.excel.formula.reference_text import parse_table_reference


@pytest.mark.parametrize(
    ("inner", "items", "first", "last"),
    [
        ("", (), None, None),
        ("Low", (), "Low", None),
        (" Low ", (), "Low", None),
        ("Std dev", (), "Std dev", None),
        ("#All", ("#all",), None, None),
        ("#Totals", ("#totals",), None, None),
        ("@Low", ("#this row",), "Low", None),
        ("@", ("#this row",), None, None),
        ("@[Low]:[High]", ("#this row",), "Low", "High"),
        ("[#This Row],[Low]", ("#this row",), "Low", None),
        ("[#Headers],[#Data],[Low]:[High]", ("#headers", "#data"), "Low", "High"),
        (" [#All] , [Low] ", ("#all",), "Low", None),
        ("[Low]:[High]", (), "Low", "High"),
        ("[a,b:c]", (), "a,b:c", None),
        ("'[x']", (), "[x]", None),
        ("'#x", (), "#x", None),
        ("['@x]", (), "@x", None),
        ("['#x'']", (), "#x'", None),
        ("two\nlines", (), "two\nlines", None),
    ],
)
def test_what_stands_in_the_brackets(inner, items, first, last):
    assert parse_table_reference("T", inner) == TableReference("T", items, first, last)


@pytest.mark.parametrize(
    "inner",
    ["[a],[b]", "[a]b", "[a][b]", "[a]:", ":[a]", "[a]:[b]:[c]", "[a],[#All]", "[#All]:[a]", "[]", "@@[a]", "@[#All]"],
)
def test_nothing_else_may(inner):
    with pytest.raises(ValueError, match="brackets"):
        parse_table_reference("T", inner)
