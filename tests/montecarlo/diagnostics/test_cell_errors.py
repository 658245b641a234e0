"""Where errors come from: of the base case, and of trials."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.errors import ErrorCode
from xlmc.montecarlo.diagnostics.cell_errors import error_roots, errors_at_base

DIV0, NUM, NA = ErrorCode.DIV0, ErrorCode.NUM, ErrorCode.NA
CELLS = {
    "A1": 1.0,
    "A2": 4.0,
    "B1": "=1/(A1-1)",
    "B2": "=B1+A2",
    "B3": "=SQRT(A2-5)",
    "B4": "=IFERROR(B1,0)+A2",
    "B5": "=B2+B3",
    "B6": "=A1+A2",
}
GIVEN = {"a": {"cell": "A1", "low": 0, "high": 2}, "b": {"cell": "A2", "low": 0, "high": 9}}


def told(cells):
    return {str(cell)[2:]: code for cell, code in cells.items()}


@pytest.mark.parametrize(
    ("forecasts", "filters", "roots", "others", "answers"),
    [
        ({"x": "B6"}, {}, {}, {}, False),
        ({"x": "B2"}, {}, {"B1": DIV0}, {"B2": DIV0}, True),
        ({"x": "B5"}, {}, {"B1": DIV0, "B3": NUM}, {"B2": DIV0, "B5": DIV0}, True),
        ({"x": "B4"}, {}, {"B1": DIV0}, {}, False),  # which IFERROR keeps from the forecast
        ({"x": "B6"}, {"f": {"cell": "B3", "above": 0}}, {"B3": NUM}, {}, True),
    ],
)
def test_errors_of_the_base_case(book, forecasts, filters, roots, others, answers):
    result = errors_at_base(book(CELLS, GIVEN, forecasts, filters))
    assert (told(result.roots), told(result.others), result.answers) == (roots, others, answers)


def test_parameters_are_looked_at_too(book):
    cells = {**CELLS, "C1": "=1/(A2-4)"}
    given = {"a": {"cell": "A1", "low": 0, "high": "C1"}, "b": GIVEN["b"]}
    result = errors_at_base(book(cells, given, {"x": "B6"}))
    assert told(result.roots) == {"C1": DIV0}


def test_cells_of_a_circle_are_roots_together(book):
    cells = {"A1": 1.0, "B1": "=IF(A1>0.5,B2,1)+0*A1", "B2": "=IF(A1>0.5,B1,2)", "B3": "=B2+1"}
    result = errors_at_base(book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B3"}))
    assert set(told(result.roots)) == {"B1", "B2"}
    assert set(told(result.others)) == {"B3"}


def roots(model, names, *drawn):
    cells = {f.name: f.cell for f in model.forecasts}
    result = error_roots(model, [cells[name] for name in names], drawn)
    return {str(cell)[2:]: (str(root)[2:], code) for cell, (root, code) in result.items()}


def draws(a, b):
    return {"a": np.array(a, float), "b": np.array(b, float)}


@pytest.fixture
def model(book):
    return book(CELLS, GIVEN, {"x": "B2", "y": "B5", "z": "B6", "w": "B3"})


def test_errors_of_trials_come_from_the_first_cell_upstream(model):
    assert roots(model, ["x"], draws([2, 1], [9, 9])) == {"B2": ("B1", DIV0)}
    assert roots(model, ["y", "w"], draws([2, 2], [9, 1])) == {"B5": ("B3", NUM), "B3": ("B3", NUM)}
    assert roots(model, ["y"], draws([2, 1], [9, 1])) == {"B5": ("B1", DIV0)}  # both: the first that it needs
    assert roots(model, ["z", "x"], draws([2, 3], [9, 9])) == {}


def test_the_first_trial_that_shows_an_error_is_looked_at_in_any_of_the_sets(model):
    many = draws([2] * 5_000 + [1], [9] * 5_001)
    assert roots(model, ["x"], draws([2], [9]), many) == {"B2": ("B1", DIV0)}
    first = draws([2, 1, 2], [1, 9, 1])
    assert roots(model, ["y"], first) == {"B5": ("B3", NUM)}  # of the first trial, not of the second


def test_a_draw_that_is_no_number_is_no_error_of_a_cell(model):
    assert roots(model, ["x"], draws([np.nan, 2], [9, 9])) == {}
    assert roots(model, ["x"], draws([np.nan, 1], [9, 9])) == {"B2": ("B1", DIV0)}


def test_a_large_model_is_not_looked_through(model, monkeypatch):
    most = "xlmc.montecarlo.diagnostics.cell_errors._MOST_CELLS"
    monkeypatch.setattr(most, len(model.needed.graph.formulas))
    assert roots(model, ["x"], draws([1], [9])) == {"B2": ("B1", DIV0)}
    monkeypatch.setattr(most, len(model.needed.graph.formulas) - 1)
    assert roots(model, ["x"], draws([1], [9])) == {}
