"""Tornado and spider: exact, for the model is evaluated and nothing is drawn."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.analysis.studies.sensitivity import PERCENTS
from xlmc.analysis.studies.sensitivity.one_at_a_time import one_at_a_time


def bars_of(model, forecast=0):
    return {bar.assumption: bar for bar in one_at_a_time(model, [*model.draws]).bars[forecast]}


@pytest.fixture(scope="module")
def model(book):
    return book(
        {"A1": 2.0, "A2": 1.0, "A3": 0.0, "B1": "=3*A1+A2*A2+A3^2", "C1": "=A1"},
        {
            "a": {"cell": "A1", "low": 0.0, "high": 10.0},
            "b": {"cell": "A2", "low": 1.0, "high": 2.0},
            "c": {"cell": "A3", "low": -1.0, "high": 1.0},
        },
        {"y": "B1"},
        {"f": {"cell": "C1", "at_most": 6.0}},
    )


def test_each_moves_alone_from_the_base_case(model):
    result = one_at_a_time(model, [*model.draws])
    assert result.base == (7.0,)
    bars = bars_of(model)
    share = np.array(PERCENTS) / 100.0
    assert bars["a"].inputs == pytest.approx(10.0 * share)
    assert bars["a"].answers == pytest.approx(30.0 * share + 1.0)
    assert bars["b"].answers == pytest.approx(6.0 + (1.0 + share) ** 2)
    assert (bars["a"].low, bars["a"].high) == (bars["a"].answers[0], bars["a"].answers[-1])


def test_the_widest_comes_first(model):
    bars = one_at_a_time(model, [*model.draws]).bars[0]
    assert [bar.assumption for bar in bars] == ["a", "b", "c"]
    assert bars[0].span == pytest.approx(24.0)


def test_what_rises_and_falls_is_marked(model):
    bars = bars_of(model)
    assert (bars["a"].monotonic, bars["b"].monotonic, bars["c"].monotonic) == (True, True, False)
    assert bars["c"].low == pytest.approx(bars["c"].high)  # the bar would hide it
    assert bars["c"].span == pytest.approx(0.64)


def test_cases_that_the_filters_would_reject_are_marked(model):
    bars = bars_of(model)
    assert bars["a"].rejected == (False, False, False, True, True)
    assert bars["b"].rejected == (False,) * 5


def test_a_cell_without_a_value_is_held_at_its_median(book):
    model = book(
        {"A1": None, "A2": 1.0, "B1": "=A1*A2"},
        {"a": {"cell": "A1", "low": 0.0, "high": 10.0}, "b": {"cell": "A2", "low": 1.0, "high": 3.0}},
        {"y": "B1"},
    )
    result = one_at_a_time(model, [*model.draws])
    assert result.medians == ("a",)
    assert result.base == (5.0,)
    assert bars_of(model)["b"].high == pytest.approx(5.0 * 2.8)


def test_varying_parameters_are_those_of_the_base_case(book):
    model = book(
        {"A1": 4.0, "A2": 1.0, "B1": "=A2", "C1": "=A1*10"},
        {"a": {"cell": "A1", "low": 1.0, "high": 2.0}, "b": {"cell": "A2", "low": 0.0, "high": "C1"}},
        {"y": "B1"},
    )
    assert bars_of(model)["b"].inputs == pytest.approx(40.0 * np.array(PERCENTS) / 100.0)


def test_an_error_in_a_cell_is_no_number(book):
    model = book({"A1": 4.0, "B1": "=SQRT(A1-2)"}, {"a": {"cell": "A1", "low": 0.0, "high": 10.0}}, {"y": "B1"})
    bar = bars_of(model)["a"]
    assert bar.answers[0] is None
    assert bar.monotonic is None
    assert bar.answers[2] == pytest.approx(3.0**0.5)


def test_many_assumptions_go_through_in_blocks(book, monkeypatch):
    n = 60
    cells = {f"A{i}": 1.0 for i in range(1, n + 1)} | {"B1": "=" + "+".join(f"{i}*A{i}" for i in range(1, n + 1))}
    model = book(cells, {f"a{i}": {"cell": f"A{i}", "low": 0.0, "high": 2.0} for i in range(1, n + 1)}, {"y": "B1"})
    whole = one_at_a_time(model, [*model.draws])
    monkeypatch.setattr(model.program("numpy"), "largest_block", 7)
    assert one_at_a_time(model, [*model.draws]) == whole
    assert whole.bars[0][0].span == pytest.approx(60 * 1.6)
