from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.model.needed import filter_condition
from xlmc.montecarlo.rare.limit_state import Leaf, Together, leaves, limit_state
from xlmc.montecarlo.rare.limit_state_function import LimitStateFunction

UNIT = {"low": 0, "high": 1}
GIVEN = {"a": {"cell": "A1", **UNIT}, "b": {"cell": "A2", **UNIT}}


def asked(model):
    return [limit_state(filter_condition(f), f.cell, model.needed.graph.formulas) for f in model.filters]


def shape(of):
    if isinstance(of, Leaf):
        return "gap" if of.gap is not None else "only whether"
    return ("all" if of.every else "any", *map(shape, of.parts))


LIMITS = [
    ({"at_least": 0.5}, "gap"),
    ({"at_least": 0.5, "below": 0.7}, ("all", "gap", "gap")),
    ({"above": "A2"}, "gap"),
]


@pytest.mark.parametrize(("limits", "expected"), LIMITS)
def test_limits_are_comparisons(book, limits, expected):
    model = book({"A1": 1.0, "A2": 1.0, "B1": "=A1"}, GIVEN, {"x": "B1"}, {"f": {"cell": "B1", **limits}})
    assert [shape(each) for each in asked(model)] == [expected]


FORMULAS = [
    ("=A1>A2", "gap"),
    ("=AND(A1>A2,A2>=0.5)", ("all", "gap", "gap")),
    ("=NOT(OR(A1>A2,A2>=0.5))", ("all", "gap", "gap")),
    ("=OR(A1<0.1,NOT(A2>0.2))", ("any", "gap", "gap")),
    ("=ABS(A1-A2)=0", "gap"),
    ("=A1<>A2", "only whether"),
    (
        "=IF(A1>A2,A2>0.5,A1>0.9)",
        ("any", ("all", "gap", "gap"), ("all", "gap", "gap")),
    ),
    ("=IF(A1>A2,TRUE)", "only whether"),
    ("=AND(B2:B3)", "only whether"),
    ("=AND(B2,A1>0.5)", ("all", "gap", "gap")),
    ("=A1", "only whether"),
]


@pytest.mark.parametrize(("formula", "expected"), FORMULAS)
def test_a_logical_filter_is_followed_into_its_formula(book, formula, expected):
    cells = {"A1": 1.0, "A2": 1.0, "B1": formula, "B2": "=A2>0.25", "B3": "=A2>0.5"}
    model = book(cells, GIVEN, {"x": "A1"}, {"f": "B1"})
    assert [shape(each) for each in asked(model)] == [expected]


@pytest.mark.parametrize("formula", [formula for formula, _ in FORMULAS])
def test_what_is_0_away_is_accepted_and_nothing_else(book, random, formula):
    cells = {"A1": 1.0, "A2": 1.0, "B1": formula, "B2": "=A2>0.25", "B3": "=A2>0.5"}
    model = book(cells, GIVEN, {"x": "A1"}, {"f": "B1", "g": {"cell": "A2", "at_most": 0.9}})
    function = LimitStateFunction(model, random)
    points = random.normal(size=(3000, 2))
    distance = function.distance(points)
    assert np.array_equal(distance == 0.0, function.accepts(points))
    assert np.all(distance >= 0.0)


def test_a_farther_trial_is_farther(book, random):
    model = book({"A1": 1.0}, {"a": GIVEN["a"]}, {"x": "A1"}, {"f": {"cell": "A1", "at_least": 0.999}})
    function = LimitStateFunction(model, random)
    points = np.array([[-2.0], [-1.0], [0.0], [2.0], [4.0]])
    result = function.distance(points)
    assert list(result) == sorted(result, reverse=True)
    assert result[-1] == 0.0
    assert result[2] == pytest.approx(1.0, rel=0.05)  # the median shortfall is the unit


def test_an_error_is_infinitely_far(book, random):
    cells = {"A1": 1.0, "B1": "=SQRT(A1-0.5)"}
    model = book(cells, {"a": GIVEN["a"]}, {"x": "A1"}, {"f": {"cell": "B1", "at_least": 0.5}})
    function = LimitStateFunction(model, random)
    result = function.distance(np.array([[-1.0], [0.5], [2.0]]))
    assert result[0] == np.inf
    assert 0.0 < result[1] < np.inf
    assert result[2] == 0.0
    assert function.lost > 0


def test_leaves_come_in_order(book):
    model = book({"A1": 1.0, "A2": 1.0}, GIVEN, {"x": "A1"}, {"f": {"cell": "A1", "at_least": 0.1, "at_most": 0.2}})
    (result,) = asked(model)
    assert isinstance(result, Together)
    assert leaves(result) == list(result.parts)


def test_points_are_drawn_as_the_sampler_draws(book, random):
    """Normals 0 are medians, whatever the distribution, its cutoffs and the parameters that vary."""
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1+A2+A3"}
    given = {
        "a": {"cell": "A1", "low": 2, "high": 4},
        "b": {"cell": "A2", "distribution": "Normal", "mean": "A1", "std_dev": 0.1},
        "c": {"cell": "A3", "distribution": "Normal", "mean": 0, "std_dev": 1, "lower_cutoff": 0},
    }
    model = book(cells, given, {"x": "B1"}, {"f": {"cell": "B1", "at_least": 6.674, "at_most": 6.675}})
    assert LimitStateFunction(model, random).accepts(np.zeros((1, 3))).tolist() == [True]  # 3 + 3 + 0.67449


def test_trials_that_do_not_use_a_draw_without_a_distribution_are_accepted(book):
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0, "B1": "=A1+A2", "B2": "=A1-0.5", "C1": "=IF(A1>0.5,A3,0)"}
    given = {name: {"cell": f"A{n}", "low": 0, "high": 1} for n, name in enumerate("ab", 1)}
    given["c"] = {"cell": "A3", "low": 0, "high": "B2"}
    model = book(cells, given, {"y": "C1"}, {"f": {"cell": "B1", "above": 0.7}})
    rows, random = model.sampler(0, 1).row_of, np.random.default_rng(5)
    uniforms = random.random((500, 3))
    a, b = uniforms[:, rows["a"]], uniforms[:, rows["b"]]
    function = LimitStateFunction(model, random)
    assert function.accepts_at(uniforms).tolist() == (a + b > 0.7).tolist()
    assert (function.distance_at(uniforms) == 0).tolist() == (a + b > 0.7).tolist()
    assert function.lost == 0
