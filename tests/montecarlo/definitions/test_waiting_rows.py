"""Rows that are ready and not used: frozen assumptions without a value, forecasts that are a dash."""

from __future__ import annotations

import pytest
from simulated import simulated
from workbook_files import workbook_of

from xlmc.errors import DefinitionError
from xlmc.montecarlo.model.loading import load

HEAD = ["Name", "Value", "Distribution", "Low", "High", "Frozen"]


@pytest.fixture
def saved(tmp_path):
    """`saved(row, answer)`: the path of a book with the assumption `a`, this second row, and the forecasts y and z."""

    def save(row, answer):
        path = tmp_path / "book.xlsx"
        rows = {"In": [HEAD, ["a", 0.5, "Uniform", 0, 1, None], row]}
        rows["Out"] = [["Name", "Value"], ["y", "=In!B2+N(In!B3)"], ["z", answer]]
        workbook_of(rows, {"xlmc_assumptions": "In!A1:F3", "xlmc_forecasts": "Out!A1:B3"}).save(path)
        return path

    return save


WAITING = '=IF(In!B3>0,In!B2*In!B3,"–")'


def test_a_frozen_row_without_a_value_and_a_dash_are_not_used(saved):
    model = load(saved(["b", None, None, None, None, True], WAITING))
    assert [a.name for a in model.assumptions] == ["a"]
    assert [f.name for f in model.forecasts] == ["y"]
    assert any("which wait for inputs: 'z'" in str(each) for each in model.notices)
    assert simulated(model, 1_000).error_trials == 0


def test_with_a_value_both_are(saved):
    model = load(saved(["b", 2, None, None, None, True], WAITING))
    held = model.assumptions[1]
    assert (held.name, held.frozen, held.base) == ("b", True, 2.0)
    run = simulated(model, 1_000)
    assert run.forecasts["z"].max() <= 2


def test_a_range_without_a_value_is_still_a_mistake(saved):
    with pytest.raises(DefinitionError, match="frozen, and its cell is blank"):
        load(saved(["b", None, None, 1, 3, True], WAITING))


def test_a_dash_in_some_trials_is_no_dash(saved):
    model = load(saved(["b", 2, None, None, None, True], '=IF(In!B2>0.5,In!B2,"–")'))
    assert [f.name for f in model.forecasts] == ["y", "z"]
