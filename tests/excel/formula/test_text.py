from __future__ import annotations

import pytest

from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, formula_text, parse
from xlmc.excel.workbook.workbook import Formula

TEXTS = {
    "A1+B1*2": "(S!A1+(S!B1*2.0))",
    "-A1": "(-(S!A1))",
    "--A1%": "((-((-(S!A1))))%)",
    "A1-B1-C1": "((S!A1-S!B1)-S!C1)",
    "A1-(B1-C1)": "(S!A1-(S!B1-S!C1))",
    'IF(A1>0,"a""b",)': 'IF((S!A1>0.0),"a""b",)',
    "SUM(A1:B2,TRUE,#N/A)": "SUM(S!A1:B2,TRUE,#N/A)",
    "SUM({1,2;3,-4})": "SUM({1.0,2.0;3.0,(-(4.0))})",
    "1E20": "1e+20",
}


@pytest.fixture
def written(workbook):
    resolver = Resolver(workbook({}))

    def write(text, name=str):
        return formula_text(resolver.formula(Cell("S", 1, 9), Formula(text, 1, 9)), name)

    return write


@pytest.mark.parametrize("text", TEXTS)
def test_a_tree_as_a_formula(written, text):
    assert written(text) == TEXTS[text]


@pytest.mark.parametrize("text", TEXTS)
def test_it_reads_back_as_the_same_tree(written, text):
    again = written(text)
    assert written(again) == again


def test_references_under_other_names(written):
    assert written("A1+A2", lambda place: f"R{place.row}") == "(R1+R2)"


def test_a_tree_that_is_not_resolved_is_refused():
    with pytest.raises(TypeError, match="not resolved"):
        formula_text(parse("A1"))


def test_a_long_sum(written):
    assert written("A1" + "+A1" * 4000) == "(" * 4000 + "S!A1" + "+S!A1)" * 4000
