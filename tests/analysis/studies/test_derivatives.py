"""Derivatives of cells against calculus, in trials of any number at once; by how much cells move."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.analysis.studies import derivatives as module
from xlmc.analysis.studies.derivatives import Movements, _portion, derivatives
from xlmc.errors import SimulationError
from xlmc.excel.address import parse_address

INPUTS = {"u": {"cell": "A1", "low": 0.5, "high": 2.0}, "v": {"cell": "A2", "low": -1.0, "high": 1.0}}
CELLS = {
    "A1": 1.0,
    "A2": 0.5,
    "B1": "=A1^2*A2+3*A1",
    "B2": "=SIN(A1)*EXP(A2)",
    "B3": "=SQRT(A2)",
    "B4": '=IF(A2>0,"text",A1)',
    "C1": "=B1+B2",
    "D1": 7.0,
    "D2": "=D1*2",
}
U, V = np.array([0.6, 1.0, 1.9, 1.2]), np.array([0.3, -0.7, 0.9, -0.2])


@pytest.fixture(scope="module")
def model(model_of):
    return model_of(CELLS, INPUTS, {"sum": "C1", "root": "B3", "text": "B4"}, {"f": {"cell": "B1", "at_least": -9.0}})


def at(address):
    return parse_address(address, "S")


def first(name):
    one = np.ones(U.size)
    b1 = np.column_stack([2 * U * V + 3, U**2])
    b2 = np.column_stack([np.cos(U) * np.exp(V), np.sin(U) * np.exp(V)])
    return {"B1": b1, "B2": b2, "C1": b1 + b2, "A1": np.column_stack([one, 0 * one])}[name]


def second():
    """Of B1 + B2, `(n, 2, 2)`."""
    uu, uv = 2 * V - np.sin(U) * np.exp(V), 2 * U + np.cos(U) * np.exp(V)
    return np.array([[uu, uv], [uv, np.sin(U) * np.exp(V)]]).transpose(2, 0, 1)


@pytest.mark.parametrize("portion", [1 << 21, 6, 1])
@pytest.mark.parametrize("order", [1, 2])
def test_derivatives_are_those_of_calculus(model, monkeypatch, portion, order):
    """Whether all trials are looked at at once, some, or one after the other."""
    monkeypatch.setattr(module, "_PORTION", portion)
    result = derivatives(model, {"u": U, "v": V}, order=order, cells=[at("B2"), at("A1"), at("B2")])
    assert result.names == ("u", "v")
    np.testing.assert_array_equal(result.points, np.column_stack([U, V]))
    assert [*result.forecasts] == ["sum", "root", "text"]
    assert [*result.filters] == ["f"]
    assert [*result.cells] == [at("B2"), at("A1")]
    whole = result.forecasts["sum"]
    np.testing.assert_allclose(whole.value, U**2 * V + 3 * U + np.sin(U) * np.exp(V), rtol=1e-14)
    for made, name in ((whole, "C1"), (result.filters["f"], "B1"), (result.cells[at("B2")], "B2")):
        np.testing.assert_allclose(made.gradient, first(name), rtol=1e-12)
    np.testing.assert_array_equal(result.cells[at("A1")].gradient, first("A1"))
    if order == 2:
        np.testing.assert_allclose(whole.hessian, second(), rtol=1e-12)
        np.testing.assert_array_equal(result.cells[at("A1")].hessian, np.zeros((4, 2, 2)))
    else:
        assert whole.hessian is None


def test_what_is_no_number_has_no_derivative(model):
    result = derivatives(model, {"u": U, "v": V}, order=2)
    lost = V < 0
    root = result.forecasts["root"]
    np.testing.assert_allclose(
        root.gradient[~lost], np.column_stack([0 * V, 0.5 / np.sqrt(np.abs(V))])[~lost], rtol=1e-12
    )
    assert np.isnan(root.value[lost]).all()
    assert np.isnan(root.gradient[lost]).all()
    text = result.forecasts["text"]
    assert np.isnan(text.value[~lost]).all()
    assert np.isnan(text.gradient[~lost]).all()
    np.testing.assert_array_equal(text.gradient[lost], first("A1")[lost])


def test_one_number_stands_for_an_assumption_in_all_trials(model):
    made = derivatives(model, {"u": U, "v": 0.5}).filters["f"]
    np.testing.assert_allclose(made.gradient, np.column_stack([U + 3, U**2]), rtol=1e-13)


@pytest.mark.parametrize("order", [0, 3])
def test_no_other_order(model, order):
    with pytest.raises(SimulationError, match=f"order {order}"):
        derivatives(model, {"u": U, "v": V}, order=order)


@pytest.mark.parametrize("address", ["D1", "D2", "Z9"])
def test_a_cell_that_nothing_needs(model, address):
    with pytest.raises(SimulationError, match="No forecast or filter needs"):
        derivatives(model, {"u": U, "v": V}, cells=[at(address)])


def test_cells_move_by_their_derivatives_times_the_assumptions(model, monkeypatch):
    lowering = model.lowering
    nodes = {at(address): lowering.cell(at(address)) for address in ("B1", "B2", "B3")}
    for portion in (1 << 21, 2):
        monkeypatch.setattr(module, "_PORTION", portion)
        movements = Movements(nodes)
        derivatives(model, {"u": U, "v": V}, movements=movements)
        for address in ("B1", "B2"):
            moved = np.abs(first(address) * np.column_stack([U, V]))
            node = nodes[at(address)]
            np.testing.assert_allclose(movements.of_trials[node], moved.sum(axis=1), rtol=1e-12)
            np.testing.assert_allclose(movements.of_assumptions[node], moved.sum(axis=0), rtol=1e-12)
        root = movements.of_trials[nodes[at("B3")]]
        np.testing.assert_allclose(root, np.where(V > 0, np.sqrt(np.abs(V)) / 2, 0.0), rtol=1e-12)


@pytest.mark.parametrize(
    ("k", "order", "trials"), [(0, 1, 1 << 21), (1, 1, 1 << 21), (4, 1, 1 << 19), (4, 2, 1 << 17), (1 << 12, 2, 1)]
)
def test_how_many_trials_at_once(model, k, order, trials):
    assert _portion(model.lowering, k, order) == trials


def test_fewer_trials_at_once_where_a_range_is_large(model_of):
    cells = {"A1": 1.0, "A2": 0.5, "B1": "=SUM(A1:C8)"} | {f"C{row}": f"=A1*{row}" for row in range(1, 9)}
    model = model_of({**cells, "B1": "=SUM(C1:D8)"}, INPUTS, {"x": "B1"})
    assert _portion(model.lowering, 2, 1) == (1 << 21) // (16 * 2)
    made = derivatives(model, {"u": U}).forecasts["x"]
    np.testing.assert_allclose(made.gradient, [[36]] * 4)
