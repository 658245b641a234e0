from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.reference.formulas_engine import FormulasProgram
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area
from xlmc.excel.workbook.workbook import CellContent, Formula


def test_a_draw_that_is_an_error(lower):
    lowering, (target,) = lower({"C1": "=IFERROR(A1,-1)"}, ["A1"], ["C1"])
    evaluator = FormulasProgram(lowering, [target], [], frozenset({"A1"})).evaluator(2)
    (column,) = evaluator.filters({"A1": np.array([np.nan, 3.0])}, 2)
    assert column.as_floats().tolist() == [-1.0, 3.0]


def test_saved_and_held_values_stand_in_here_too(lower):
    cells = {"B1": ("=MYFUNC(2)", 42.0), "C1": "=B1+A1+A2"}
    lowering, (target,) = lower(cells, ["A1"], ["C1"], held={"A2": 0.5})
    (column,) = FormulasProgram(lowering, [target], [], frozenset()).evaluator(1).filters({"A1": np.array([1.0])}, 1)
    assert column.as_floats().tolist() == [43.5]


def test_what_formulas_cannot_compute_is_told_of_its_cell(lower):
    lowering, (target,) = lower({"C1": "=SUM((A1,A2))"}, ["A1", "A2"], ["C1"])
    draws = {"A1": np.array([2.0]), "A2": np.array([3.0])}
    with pytest.raises(FormulaError, match="The engine `formulas` cannot compute this") as caught:
        FormulasProgram(lowering, [target], [], frozenset()).evaluator(1).filters(draws, 1)
    assert caught.value.where == "S!C1"
    assert caught.value.text == "SUM((S!A1,S!A2))"


def test_a_function_that_formulas_lacks_is_shown_with_its_own_references(lower):
    lowering, (target,) = lower({"C1": "=SIN(B7)+ENCODEURL(B7)"}, ["B7"], ["C1"])
    with pytest.raises(FormulaError, match="The engine `formulas` cannot compute this") as caught:
        FormulasProgram(lowering, [target], [], frozenset()).evaluator(1).filters({"B7": np.array([2.0])}, 1)
    assert caught.value.text == "(SIN(S!B7)+ENCODEURL(S!B7))"


@pytest.mark.parametrize(
    "formula",
    ["ROW(D5)", "COLUMNS(A1:D5)", 'CELL("row",D5)', "FORMULATEXT(B7)", "ISFORMULA(B7)", "SHEET(D5)", "AREAS(D5)"],
)
def test_where_a_cell_stands_is_told_apart_from_what_it_holds(lower, formula):
    lowering, (target,) = lower({"B7": "=A1*2", "C1": f"={formula}+A1"}, ["A1"], ["C1"])
    with pytest.raises(FormulaError, match="cannot tell where a cell stands") as caught:
        FormulasProgram(lowering, [target], [], frozenset())
    assert caught.value.where == "S!C1"


def test_array_formulas_are_refused(lower):
    anchor = CellContent(None, Formula("A1*{1;2}", 1, 3, Area("S", 1, 3, 2, 3)))
    lowering, (target,) = lower({"C1": anchor, "C2": 4.0, "D1": "=C2+1"}, ["A1"], ["D1"])
    with pytest.raises(FormulaError, match="no array formulas") as caught:
        FormulasProgram(lowering, [target], [], frozenset())
    assert caught.value.where == "S!C1"


def test_a_power_that_python_makes_complex_is_an_error_as_in_excel(lower):
    lowering, (target,) = lower({"C1": "=(A1-1)^0.5"}, ["A1"], ["C1"])
    draws = {"A1": np.array([0.5, 5.0])}
    (column,) = FormulasProgram(lowering, [target], [], frozenset()).evaluator(2).filters(draws, 2)
    assert column.codes is not None
    assert column.codes.tolist() == [ErrorCode.NUM.value, 0]
    assert column.as_floats()[1] == 2.0
