"""A function without a body of xlmc's own is refused by its name and cell: no other package computes it."""

from __future__ import annotations

import pytest

from xlmc.compile.choices import CHOICES
from xlmc.compile.lambdas import LAMBDAS
from xlmc.compile.not_computed import LEFT_OUT
from xlmc.compile.places import PLACES
from xlmc.compile.written_out import WRITTEN_OUT
from xlmc.errors import FormulaError
from xlmc.functions.families import REGISTRY


def _of(book, formula):
    cells = {"A1": 1.0, "A2": 2.0, "A3": 4.0, "B1": f"={formula}"}
    return book(cells, {"a": {"cell": "A1", "low": 0, "high": 9}}, {"answer": "B1"})


@pytest.mark.parametrize("name", sorted(LEFT_OUT))
def test_a_function_of_excel_without_a_body_is_refused_by_name_with_its_cell(book, name):
    with pytest.raises(FormulaError, match=f"xlmc does not compute the function {name} of Excel") as caught:
        _of(book, f"_xlfn.{name}(A1:A3,A1:A3,A1:A3)")
    assert str(caught.value.where) == "S!B1"
    assert "docs/functions.md" in str(caught.value)


@pytest.mark.parametrize("name", ["DUMMYFUNCTION", "ARRAYROW", "SUMM"])
def test_what_nobody_knows_is_refused_as_unknown(book, name):
    with pytest.raises(FormulaError, match=f"the function {name} is not known to xlmc") as caught:
        _of(book, f"{name}(A1)")
    assert str(caught.value.where) == "S!B1"


def test_nothing_that_has_a_body_is_said_to_have_none():
    assert not LEFT_OUT & {*REGISTRY, *CHOICES, *LAMBDAS, *PLACES, *WRITTEN_OUT, "LET", "LAMBDA"}
