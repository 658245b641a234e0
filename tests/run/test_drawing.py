from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from xlmc.address import Cell
from xlmc.api import Model
from xlmc.definitions.model import Assumption
from xlmc.distributions import FAMILIES, ByPercentiles
from xlmc.errors import DefinitionError

UNIT = {"low": 0, "high": 1}


def drawn(model, name, n=64, seed=1):
    return model.sampler(seed, n).draw(0)[name]


def test_parameters_that_no_assumption_reaches_become_numbers(book):
    cells = {"A1": 1.0, "B1": "=B2*2", "B2": 5.0, "B3": "=B1+1"}
    model = book(cells, {"a": {"cell": "A1", "low": "B1", "high": "B3"}}, {"x": "A1"})
    assert model.fallible == frozenset()
    values = drawn(model, "a")
    assert 10 <= values.min() < values.max() <= 11


def test_cutoffs(book):
    given = {"cell": "A1", "distribution": "Normal", "mean": 0, "std_dev": 1, "lower_cutoff": "B1"}
    model = book({"A1": 1.0, "B1": "=1/2"}, {"a": given}, {"x": "A1"})
    assert drawn(model, "a").min() >= 0.5


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"low": 2, "high": 1}, "a: Low (2) is above High (1)"),
        ({"low": 2, "high": "B1"}, "a: Low (2) is above High (1)"),
        ({**UNIT, "lower_cutoff": 0.9, "upper_cutoff": 0.1}, "a: Lower cutoff (0.9) is not below Upper cutoff (0.1)"),
        ({**UNIT, "lower_cutoff": 5}, "a: Lower cutoff (5) leaves nothing of the distribution"),
    ],
)
def test_numbers_that_are_no_distribution(book, given, message):
    with pytest.raises(DefinitionError) as caught:
        book({"A1": 1.0, "B1": "=2-1"}, {"a": {"cell": "A1", **given}}, {"x": "A1"})
    assert (caught.value.message, caught.value.where) == (message, "S!A1")
    assert caught.value.hint


def by_percentiles(book, p10, **more):
    """A model with one assumption `a` in A1, normal by its percentiles 10 and 90; `b` is uniform in A2."""
    model = book(
        {"A1": 1.0, "A2": 1.0, "B1": "=2/2", "B2": "=A2+1"}, {"b": {"cell": "A2", **UNIT}}, {"x": "A1", "y": "A2"}
    )
    given = {"p10": p10, "p90": 9.0}
    family = ByPercentiles(FAMILIES["Normal"], (), (10.0, 90.0))
    a = Assumption("a", Cell("S", 1, 1), "Normal", given, Cell("S", 1, 1), base=1.0, own_family=family, **more)
    definitions = replace(model.definitions, assumptions=(a, *model.definitions.assumptions))
    return Model(model.workbook, definitions, model.path)


@pytest.mark.parametrize("p10", [1.0, Cell("S", 1, 2)])
def test_percentiles_in_place_of_parameters(book, p10):
    """Of 100,000 draws a tenth lies below each, give or take four standard errors."""
    values = drawn(by_percentiles(book, p10), "a", n=100_000)
    error = 4 * np.sqrt(0.1 * 0.9 / 100_000)
    assert abs((values < 1).mean() - 0.1) < error
    assert abs((values > 9).mean() - 0.1) < error


def test_percentiles_of_a_truncated_distribution(book):
    values = drawn(by_percentiles(book, 1.0, lower_cutoff=5.0), "a")
    assert values.min() >= 5


def test_percentiles_that_no_member_has(book):
    with pytest.raises(DefinitionError) as caught:
        by_percentiles(book, 10.0)
    assert caught.value.message == "a: P10 (10) is not below P90 (9)"


def test_percentiles_cannot_vary(book):
    with pytest.raises(DefinitionError) as caught:
        by_percentiles(book, Cell("S", 2, 2))
    assert caught.value.message == "a: a distribution given by percentiles cannot depend on another assumption"
    assert (caught.value.where, caught.value.hint) == ("S!B2", "give it by its parameters, or by numbers")


@pytest.mark.parametrize("formula", ["=1/0", '="x"'])
def test_a_parameter_that_is_no_number(book, formula):
    with pytest.raises(DefinitionError, match="the parameter is an error") as caught:
        book({"A1": 1.0, "B1": formula}, {"a": {"cell": "A1", "low": 0, "high": "B1"}}, {"x": "A1"})
    assert caught.value.where == "S!B1"


def test_parameters_that_vary(book):
    cells = {"A1": 1.0, "A2": 2.0, "B1": "=A1+1"}
    given = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", "low": "A1", "high": "B1"}}
    model = book(cells, given, {"x": "A2"})
    assert model.fallible == {"b"}
    draws = model.sampler(1, 256).draw(0)
    assert ((draws["a"] <= draws["b"]) & (draws["b"] <= draws["a"] + 1)).all()


def test_a_varying_cutoff(book):
    given = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", "upper_cutoff": "A1", **UNIT}}
    draws = book({"A1": 1.0, "A2": 2.0}, given, {"x": "A2"}).sampler(1, 256).draw(0)
    assert (draws["b"] <= draws["a"]).all()


def test_a_chain_of_parameters(book):
    given = {
        "c": {"cell": "A3", "low": "A2", "high": "B2"},
        "b": {"cell": "A2", "low": "A1", "high": "B1"},
        "a": {"cell": "A1", **UNIT},
    }
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1+1", "B2": "=A2+1"}
    draws = book(cells, given, {"x": "A3"}).sampler(1, 256).draw(0)
    assert ((draws["a"] <= draws["b"]) & (draws["b"] <= draws["c"]) & (draws["c"] <= draws["a"] + 2)).all()


def test_trials_whose_parameters_are_errors_are_nan(book):
    given = {"a": {"cell": "A1", "low": -1, "high": 1}, "b": {"cell": "A2", "low": 0, "high": "B1"}}
    draws = book({"A1": 1.0, "A2": 2.0, "B1": "=SQRT(A1)"}, given, {"x": "A2"}).sampler(1, 256).draw(0)
    assert np.array_equal(np.isnan(draws["b"]), draws["a"] < 0)
    assert (draws["a"] < 0).any()


def test_a_parameter_may_come_to_terms_with_an_error(book):
    given = {
        "a": {"cell": "A1", "low": -1, "high": 1},
        "b": {"cell": "A2", "low": 0, "high": "B1"},
        "c": {"cell": "A3", "low": 5, "high": "B2"},
    }
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=SQRT(A1)", "B2": "=IFERROR(A2+6,5)"}
    draws = book(cells, given, {"x": "A3"}).sampler(1, 256).draw(0)
    assert (draws["a"] < 0).any()
    assert (draws["c"][draws["a"] < 0] == 5).all()
    assert (draws["c"][draws["a"] > 0] > 5).all()
