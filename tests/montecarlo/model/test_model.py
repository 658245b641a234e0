from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.engines import ENGINES
from xlmc.errors import DefinitionError, FormulaError, SimulationError
from xlmc.excel.address import parse_address
from xlmc.excel.workbook.lazy_sheets import with_values
from xlmc.montecarlo.definitions.definitions import Settings
from xlmc.montecarlo.model.loading import load
from xlmc.montecarlo.model.model import CompiledModel

CELLS = {"A1": 1.0, "A2": 2.0, "A3": 3.0, "B1": "=A1+A2", "B2": "=SQRT(A1)", "B3": '=IF(A1>0,"x",A1)', "C1": "=B1>0"}
GIVEN = {"Mass": {"cell": "A1", "low": 0, "high": 1}, "speed": {"cell": "A2", "low": 0, "high": 1}}
FORECASTS = {"Sum": "B1", "Root": "B2", "Text": "B3"}


@pytest.fixture
def model(book):
    return book(CELLS, GIVEN | {"idle": {"cell": "A3", "low": 0, "high": 1}}, FORECASTS, {"f": "C1"})


def test_what_a_model_shows(model):
    assert [a.name for a in model.assumptions] == ["Mass", "speed", "idle"]
    assert [a.name for a in model.live] == ["Mass", "speed"]
    assert [f.name for f in model.forecasts] == ["Sum", "Root", "Text"]
    assert [f.name for f in model.filters] == ["f"]
    assert [str(notice) for notice in model.notices] == ["S!A3: No forecast or filter needs the assumption 'idle'"]
    assert model.definitions.settings == Settings(trials=200_000, seed=999, sampling="mc", engine="numpy")


def test_what_offset_leads_to_keeps_the_order_of_the_first_stages(book):
    """Correlated draws depend on the order: a run gives the numbers that earlier versions gave."""
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=SUM(A1:A3)", "C1": "=A3-5", "C2": "=OFFSET(D1,2,-3)-5"}
    low = {"named": ("A1", "C1"), "by offset": ("A2", "C2"), "needed": ("A3", 0)}
    model = book(cells, {name: {"cell": cell, "low": at, "high": 9} for name, (cell, at) in low.items()}, {"x": "B1"})
    assert [list(stage) for stage in model.needed.stages] == [["needed"], ["by offset", "named"]]
    assert [a.name for a in model.live] == ["needed", "by offset", "named"]


def test_the_workbook_as_a_function(model):
    result = model.function({"mass": [4.0, 9.0, -1.0], "Speed ": 0.5})
    assert {name: values.shape for name, values in result.items()} == dict.fromkeys(FORECASTS, (3,))
    assert result["Sum"].tolist() == [4.5, 9.5, -0.5]
    assert result["Root"][:2].tolist() == [2.0, 3.0]
    assert np.isnan(result["Root"][2])
    assert np.isnan(result["Text"][:2]).all()
    assert result["Text"][2] == -1.0


def test_filters_are_not_asked(model):
    assert model.function({"mass": -5.0, "speed": 1.0})["Sum"].tolist() == [-4.0]


@pytest.mark.parametrize(
    ("mass", "speed", "n"),
    [
        (1.0, 2.0, 1),
        ([1.0], 2.0, 1),
        ([1.0, 2.0], 2.0, 2),
        (1.0, [2.0, 3.0, 4.0], 3),
        ([1, 2], [3, 4], 2),
        ([], 1.0, 0),
    ],
)
def test_shapes_of_the_function(model, mass, speed, n):
    result = model.function({"mass": mass, "speed": speed})
    assert {values.shape for values in result.values()} == {(n,)}
    assert np.array_equal(result["Sum"], np.broadcast_to(np.add(mass, speed), (n,)))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_inputs_that_are_no_numbers_are_errors(model, bad):
    result = model.function({"mass": [bad, 4.0], "speed": 1.0})
    assert np.isnan(result["Sum"][0])
    assert result["Sum"][1] == 5.0


def test_results_are_the_callers_own(model):
    given = np.array([4.0, 9.0])
    first = model.function({"mass": given, "speed": 0.0})
    first["Sum"][:] = 0.0
    assert model.function({"mass": given, "speed": 0.0})["Sum"].tolist() == [4.0, 9.0]
    assert given.tolist() == [4.0, 9.0]


def test_a_missing_assumption(model):
    with pytest.raises(SimulationError) as caught:
        model.function({"mass": 1.0})
    assert (caught.value.message, caught.value.hint) == (
        "no values for the assumption 'speed'",
        "give every live assumption",
    )


def test_an_assumption_that_nothing_needs_may_be_given(model):
    assert model.function({"mass": 1.0, "speed": 1.0, "idle": [3.0]})["Sum"].tolist() == [2.0]


def test_a_name_that_is_no_assumption(model):
    with pytest.raises(SimulationError, match="There is no assumption 'sped'"):
        model.function({"mass": 1.0, "speed": 1.0, "sped": 2.0})


def test_a_frozen_assumption_cannot_be_given(book):
    given = {"a": {"cell": "A1", "low": 0, "high": 1, "frozen": True}, "b": {"cell": "A2", "low": 0, "high": 1}}
    model = book({"A1": 5.0, "A2": 1.0, "B1": "=A1+A2"}, given, {"x": "B1"})
    assert model.function({"b": 1.0})["x"].tolist() == [6.0]
    with pytest.raises(SimulationError, match="The assumption 'a' is frozen"):
        model.function({"a": 2.0, "b": 1.0})


@pytest.mark.parametrize(("mass", "speed"), [([1.0, 2.0], [1.0, 2.0, 3.0]), ([[1.0, 2.0]], 1.0)])
def test_shapes_that_do_not_go_together(model, mass, speed):
    with pytest.raises(SimulationError, match="one number or one list of numbers"):
        model.function({"mass": mass, "speed": speed})


def test_dynamic_parameters_do_not_matter_to_the_function(book):
    given = {"a": {"cell": "A1", "low": 0, "high": 1}, "b": {"cell": "A2", "low": 0, "high": "A1"}}
    model = book({"A1": 1.0, "A2": 1.0, "B1": "=A1*A2"}, given, {"x": "B1"})
    assert model.function({"a": 2.0, "b": 50.0})["x"].tolist() == [100.0]


@pytest.mark.parametrize(
    ("formula", "message"), [("=NOSUCH(A1)", "The function NOSUCH is not known"), ("=Nothing!A1", "There is no sheet")]
)
def test_a_faulty_cell_is_told_of_when_the_model_is_made(book, formula, message):
    with pytest.raises(FormulaError, match=message) as caught:
        book({"A1": 1.0, "B1": formula}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B1"})
    assert caught.value.where == "S!B1"


def test_a_faulty_cell_that_nothing_needs_is_no_matter(book):
    book({"A1": 1.0, "B1": "=1+*", "B2": "=A1"}, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B2"})


def test_an_unknown_engine(model):
    with pytest.raises(SimulationError) as caught:
        model.program("jax")
    assert (caught.value.message, caught.value.hint) == (
        "there is no engine 'jax'",
        f"choose one of {', '.join(ENGINES)}",
    )


def test_the_saved_value_of_a_known_part_is_noticed(book):
    cells = {"A1": 1.0, "B1": ("=MYFUNC(1)", 3.0), "B2": "=A1+B1"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B2"})
    assert model.function({"a": 1.0})["x"].tolist() == [4.0]
    assert "Excel's saved value is used" in str(model.notices[0])


@pytest.mark.parametrize("formula", ["=MYFUNC(A2)", "=MYFUNC(C1)"])
def test_a_saved_value_of_other_inputs_is_not_used(book, formula):
    cells = {"A1": 1.0, "A2": 2.0, "A3": 5.0, "C1": "=A2*2", "B1": (formula, 3.0), "B2": "=A1+B1+A3"}
    model = book(cells, {"a": {"cell": "A1", "low": 0, "high": 1}}, {"x": "B2"})

    def typed(**values):
        cells = {parse_address(f"S!{address}"): value for address, value in values.items()}
        return CompiledModel(with_values(model.workbook, cells), model.definitions, model.path)

    assert typed(A2=2.0, A3=7.0).function({"a": 1.0})["x"].tolist() == [11.0]  # A2 as it was
    with pytest.raises(FormulaError, match="what Excel saved in it belongs to another content of S!A2") as caught:
        typed(A2=9.0)
    assert caught.value.where == "S!B1"


def test_a_book_with_mistakes_is_not_loaded(tmp_path, monkeypatch):
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.definitions import Definitions
    from xlmc.montecarlo.model import loading as module

    problems = (DefinitionError("Low is blank", where="S!B2"), DefinitionError("Name is blank", where="S!A3"))
    monkeypatch.setattr(module, "read_workbook", lambda path, functions: Workbook("b", {}))
    monkeypatch.setattr(module, "read_definitions", lambda *_: Definitions(problems=problems))
    with pytest.raises(DefinitionError) as caught:
        load(tmp_path / "book.xlsx")
    assert str(caught.value) == "S!B2: Low is blank.\nS!A3: Name is blank."


def test_forecasts_that_do_not_vary_are_named_together(book):
    """Four of them; of more, how many."""
    cells = {"A1": 1, "B1": "=A1+1", "C1": 5} | {f"D{row}": f"=C1*{row}" for row in range(1, 7)}
    forecasts = {"moves": "B1"} | {f"f{row}": f"D{row}" for row in range(1, 7)}
    (notice,) = book(cells, {"a": {"cell": "A1", "low": 0, "high": 2}}, forecasts).notices
    assert notice.message == (
        "The forecasts 'f1', 'f2', 'f3', 'f4' and 2 more do not vary: no assumption with a range reaches them"
    )
