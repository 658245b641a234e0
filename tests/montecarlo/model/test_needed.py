from __future__ import annotations

from types import SimpleNamespace

import pytest

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.formula import formula_text
from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.definitions.evidence import Bell
from xlmc.montecarlo.model.needed import MOST_CALLS, _refuse_too_many, accepted_by_chance, filter_condition, find_needed

CELLS = {"A1": 1.0, "A2": 2.0, "A3": 3.0, "A4": 4.0, "B1": "=A1+A2", "B2": "=A3*2", "B3": "=B2+A4", "C1": "=B1>0"}
UNIT = {"low": 0, "high": 1}


@pytest.fixture
def scene(workbook, definitions):
    def make(assumptions, forecasts=None, filters=None, cells=CELLS):
        book = workbook(cells)
        return find_needed(book, definitions(book, assumptions, forecasts or {}, filters or {}, {}))

    return make


def names(assumptions):
    return [assumption.name for assumption in assumptions]


def test_only_assumptions_that_something_needs_are_drawn(scene):
    result = scene({name: {"cell": name, **UNIT} for name in ("A1", "A2", "A3", "A4")}, {"x": "B1"})
    assert list(result.live) == ["A1", "A2"]
    assert names(result.idle) == ["A3", "A4"]
    assert [str(notice) for notice in result.notices()] == [
        "S!A3: No forecast or filter needs the assumption 'A3'",
        "S!A4: No forecast or filter needs the assumption 'A4'",
    ]


def test_filters_need_cells_too(scene):
    assumptions = {name: {"cell": name, **UNIT} for name in ("A1", "A2", "A3")}
    assert list(scene(assumptions, {}, {"f": "C1"}).live) == ["A1", "A2"]
    assert list(scene(assumptions, {}, {"f": {"cell": "A1", "below": "B2"}}).live) == ["A1", "A3"]


def test_frozen_assumptions_are_not_drawn(scene):
    result = scene({"a": {"cell": "A1", "frozen": True, **UNIT}, "b": {"cell": "A2", **UNIT}}, {"x": "B1"})
    assert list(result.live) == ["b"]
    assert result.idle == ()
    assert (
        scene({"a": {"cell": "A9", "frozen": True, **UNIT}, "b": {"cell": "A2", **UNIT}}, {"x": "B1"}).notices() == ()
    )
    assert Cell("S", 1, 1) in result.graph.reached


def test_parameters_need_cells_and_these_need_assumptions(scene):
    assumptions = {
        "last": {"cell": "A1", "low": "B3", "high": 99},
        "first": {"cell": "A3", **UNIT},
        "also": {"cell": "A4", "low": 0, "high": 1, "upper_cutoff": "A2"},
        "idle": {"cell": "A9", "low": "A8", "high": 1},
        "never": {"cell": "A8", **UNIT},
    }
    result = scene(assumptions, {"x": "A1"})
    assert [list(stage) for stage in result.stages] == [["first", "also"], ["last"]]
    assert names(result.idle) == ["idle", "never"]


def test_stages_run_one_after_another(scene):
    assumptions = {
        "c": {"cell": "A3", "low": 0, "high": "A2"},
        "b": {"cell": "A2", "low": 0, "high": "A1"},
        "a": {"cell": "A1", **UNIT},
    }
    assert [list(stage) for stage in scene(assumptions, {"x": "A3"}).stages] == [["a"], ["b"], ["c"]]


def test_a_parameter_of_known_cells_waits_for_nothing(scene):
    assumptions = {"a": {"cell": "A1", "low": 0, "high": "D1"}, "b": {"cell": "A2", **UNIT}}
    result = scene(assumptions, {"x": "B1"}, cells=CELLS | {"D1": "=D2*2", "D2": 5.0})
    assert [list(stage) for stage in result.stages] == [["a", "b"]]


@pytest.mark.parametrize(
    ("assumptions", "circle", "where"),
    [
        (
            {"a": {"cell": "A1", "low": 0, "high": "A2"}, "b": {"cell": "A2", "low": 0, "high": "A1"}},
            "'a' → 'b' → 'a'",
            "S!A1",
        ),
        (
            {
                "x": {"cell": "A4", "low": "A3", "high": 9},
                "a": {"cell": "A1", "low": 0, "high": "D1"},
                "b": {"cell": "A2", "low": 0, "high": "A1"},
                "c": {"cell": "A3", "low": 0, "high": "A2"},
            },
            "'c' → 'b' → 'a' → 'c'",
            "S!A3",
        ),
    ],
)
def test_assumptions_that_need_each_other(scene, assumptions, circle, where):
    with pytest.raises(DefinitionError) as caught:
        scene(assumptions, {"x": "B3", "y": "B1"}, cells=CELLS | {"D1": "=A3+1"})
    error = caught.value
    assert error.message == f"parameters of assumptions need each other in a circle: {circle}"
    assert (error.where, error.hint) == (where, "give one of them parameters that are numbers")


def test_an_assumption_that_needs_itself(scene):
    """A model takes the base value in place of its own cell; what is left has the cell found while it is computed."""
    with pytest.raises(DefinitionError) as caught:
        scene({"a": {"cell": "A1", "low": 0, "high": "A1"}}, {"x": "B1"})
    error = caught.value
    assert error.message == "parameters of assumptions need each other in a circle: 'a' → 'a'"
    hint = "refer to S!A1 in its parameters without OFFSET and INDIRECT, or type them as numbers"
    assert (error.where, error.hint) == ("S!A1", hint)


def test_a_needed_circle_of_cells_is_listed(scene):
    needed = scene({"a": {"cell": "A1", **UNIT}}, {"x": "D1"}, cells={"A1": 1.0, "D1": "=D2", "D2": "=D1+A1"})
    assert {str(cell) for cell in needed.graph.circles} == {"S!D1", "S!D2"}


@pytest.mark.parametrize(
    ("limits", "asked"),
    [
        ({}, "((S!B1+0.0)<>0.0)"),
        ({"at_least": 0.0}, "((S!B1+0.0)>=0.0)"),
        ({"at_least": 0.0, "below": 1.0}, "AND(((S!B1+0.0)>=0.0),((S!B1+0.0)<1.0))"),
        ({"above": -1.0, "at_most": 1.0}, "AND(((S!B1+0.0)<=1.0),((S!B1+0.0)>(-1.0)))"),
        ({"at_most": Cell("S", 9, 3)}, "((S!B1+0.0)<=(S!C9+0.0))"),
    ],
)
def test_what_a_filter_asks(limits, asked):
    cell = Cell("S", 1, 2)
    assert formula_text(filter_condition(Filter("f", cell, cell, **limits))) == asked


@pytest.mark.parametrize(
    ("bell", "chance", "asked"),
    [
        (Bell(1.0, 2.0), None, "(CHANCE>0.0)"),
        (Bell(1.0, 2.0), Cell("S", 9, 9), "(S!I9<=CHANCE)"),
        (Bell(1.0, 2.0, sides=(True, False)), Cell("S", 9, 9), "(S!I9<=CHANCE)"),
        (Bell(1.0, 2.0, logarithmic=True), None, "IF(((S!B1+0.0)>0.0),(CHANCE>0.0),FALSE)"),
        (Bell(1.0, 2.0, logarithmic=True), Cell("S", 9, 9), "IF(((S!B1+0.0)>0.0),(S!I9<=CHANCE),FALSE)"),
    ],
)
def test_trials_are_kept_by_chance(bell, chance, asked):
    cell = Cell("S", 1, 2)
    result = formula_text(accepted_by_chance(bell, cell, chance))
    assert result.replace(formula_text(bell.tree_of_chance(cell)), "CHANCE") == asked


def test_a_run_draws_as_many_calls_in_cells_as_a_report_can_take():
    call = SimpleNamespace(row=Cell("S", 1, 1))
    _refuse_too_many([call] * MOST_CALLS)
    with pytest.raises(DefinitionError, match="need 10,001 draws in cells; a run takes at most 10,000") as caught:
        _refuse_too_many([call] * (MOST_CALLS + 1))
    assert caught.value.hint
