"""Distances at given uniforms, from books whose draws and filters are worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.rare import limit_state_function as module
from xlmc.montecarlo.rare.limit_state_function import (
    OUTSIDE,
    Drawing,
    GivenUniforms,
    LimitStateFunction,
    points_of,
    uniforms_of,
)

CELLS = {"A1": 1.0, "A2": 1.0, "B1": "=A1+A2", "B2": "=LN(A1-0.5)", "B3": "=A1>A2"}
GIVEN = {"a": {"cell": "A1", "low": 0, "high": 2}, "b": {"cell": "A2", "low": 10, "high": 14}}


def test_uniforms_and_normals():
    points = np.array([-40.0, -1.0, 0.0, 2.0, 40.0])
    uniforms = uniforms_of(points)
    assert uniforms == pytest.approx(stats.norm.cdf(points))
    assert uniforms[-1] == 1.0 - 2.0**-53
    assert points_of(uniforms)[1:4] == pytest.approx(points[1:4])
    assert points_of(np.zeros(1))[0] == pytest.approx(stats.norm.ppf(2.0**-54))
    assert np.isfinite(points_of(np.array([0.0, 1.0 - 2.0**-53]))).all()


def test_given_uniforms_fill_the_rows_of_a_block():
    """Row by row with an offset and a factor; what is beyond them is drawn at one half."""
    given, rows = GivenUniforms(), np.zeros((2, 4))
    fill = given.filler([], [(0.0, 1.0), (1.0, -1.0)], rows)
    given.uniforms = np.array([[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]])
    fill(0)
    assert rows == pytest.approx(np.array([[0.1, 0.3, 0.5, 0.5], [0.8, 0.6, 0.4, 0.5]]))
    fill(2)
    assert rows == pytest.approx(np.array([[0.5, 0.5, 0.5, 0.5], [0.4, 0.5, 0.5, 0.5]]))


def test_draws_at_uniforms(book):
    drawing = Drawing(book(CELLS, GIVEN, {"x": "B1"}))
    uniforms = np.empty((3, 2))
    uniforms[:, drawing.row_of["a"]] = [0.0, 0.25, 0.5]
    uniforms[:, drawing.row_of["b"]] = [0.5, 0.75, 0.0]
    draws, n = drawing.draw_at(uniforms)
    assert n == 3
    assert draws["a"].tolist() == [0.0, 0.5, 1.0]
    assert draws["b"].tolist() == [12.0, 13.0, 10.0]


@pytest.fixture
def function(book, random, monkeypatch):
    """`function(filters, block)`: with points of a and b in this order, in blocks of so many."""

    def make(filters, block=None, given=GIVEN):
        model = book(CELLS, given, {"x": "B1"}, filters)
        if block is not None:
            original = Drawing.__init__

            def small(self, of):
                original(self, of)
                self.block = block

            monkeypatch.setattr(Drawing, "__init__", small)
        made = LimitStateFunction(model, random)
        order = [model.sampler(0, 1).row_of[name] for name in "ab"]
        return made, order

    return make


def uniforms(order, a, b):
    result = np.empty((len(a), 2))
    result[:, order[0]], result[:, order[1]] = a, b
    return result


@pytest.mark.parametrize("block", [None, 2, 1])
def test_distances_and_acceptance(function, block):
    """a + b at least 13, and a at most 1: the farther, the farther; the last is a median failure away."""
    made, order = function({"sum": {"cell": "B1", "at_least": 13}, "a": {"cell": "A1", "at_most": 1.0}}, block)
    given = uniforms(order, [0.5, 0.25, 0.0, 0.0, 0.75], [0.5, 0.5, 0.5, 0.0, 0.9])
    assert made.dimensions == 2
    before = made.evaluations
    by_sum, by_a = made.by_filter_at(given)  # sums 13, 12.5, 12, 10, 15.1
    assert by_sum[[0, 4]].tolist() == [0.0, 0.0]
    assert by_sum[1:4] / by_sum[1] == pytest.approx([1.0, 2.0, 6.0])
    assert by_a[:4].tolist() == [0.0] * 4
    assert by_a[4] == pytest.approx(1.0, rel=0.05)  # a is 1.5, half above; the median of those that fail
    assert made.evaluations - before == 5
    assert made.distance_at(given) == pytest.approx(np.maximum(by_sum, by_a))
    assert made.accepts_at(given).tolist() == [True, False, False, False, False]
    assert made.lost == 0
    points = points_of(np.clip(given, 0.01, 0.99))
    assert made.uniforms(points) == pytest.approx(np.clip(given, 0.01, 0.99))
    assert made.distance(points) == pytest.approx(made.distance_at(made.uniforms(points)))
    assert made.accepts(points).tolist() == made.accepts_at(made.uniforms(points)).tolist()
    assert [each.tolist() for each in made.by_filter(points)] == [
        each.tolist() for each in made.by_filter_at(made.uniforms(points))
    ]
    assert len(made.asked) == 2


def test_no_points(function):
    made, _ = function({"sum": {"cell": "B1", "at_least": 13}})
    assert made.distance_at(np.empty((0, 2))).tolist() == []
    assert made.accepts_at(np.empty((0, 2))).tolist() == []


@pytest.mark.parametrize("block", [None, 2])
def test_errors_are_counted_and_infinitely_far(function, block):
    """LN(a - 0.5) is an error up to a = 0.5; at a = 1.75 it is ln 1.25."""
    made, order = function({"log": {"cell": "B2", "at_least": 0.0}}, block, {"a": GIVEN["a"], "b": GIVEN["b"]})
    given = uniforms(order, [0.1, 0.25, 0.5, 0.875], [0.5] * 4)
    lost = made.lost
    assert made.lost == pytest.approx(module.SCALING_TRIALS * 0.25, rel=0.1)
    distance = made.distance_at(given)
    assert distance[:2].tolist() == [np.inf, np.inf]
    assert 0.0 < distance[2] < np.inf
    assert distance[3] == 0.0
    assert made.lost - lost == 2
    assert made.accepts_at(given).tolist() == [False, False, False, True]
    assert made.lost - lost == 4


def test_one_stratum_is_the_distance_itself(function):
    made, order = function({"sum": {"cell": "B1", "at_least": 13}})
    (only,) = made.strata_at
    given = uniforms(order, [0.5, 0.25], [0.5, 0.5])
    assert only(given).tolist() == made.distance_at(given).tolist()
    (of_points,) = made.strata
    assert of_points(points_of(given)) == pytest.approx(made.distance_at(given))


def test_strata_of_a_choice(book, random):
    """Two branches of an IF: each trial is in one, and outside of it farther than any within."""
    cells = {"A1": 1.0, "A2": 1.0, "B1": "=IF(A1<0.5,A2*1000,A2)"}
    unit = {"low": 0, "high": 1}
    model = book(
        cells, {"a": {"cell": "A1", **unit}, "b": {"cell": "A2", **unit}}, {"x": "B1"},
        {"f": {"cell": "B1", "at_least": 0.9, "at_most": 0.901}},
    )  # fmt: skip
    made = LimitStateFunction(model, random)
    rows = model.sampler(0, 1).row_of
    given = np.empty((4, 2))
    given[:, rows["a"]] = [0.2, 0.2, 0.8, 0.8]
    given[:, rows["b"]] = [0.0009005, 0.5, 0.9005, 0.5]
    strata = [stratum(given) for stratum in made.strata_at]
    assert len(strata) == 2
    own = sorted(strata, key=lambda each: each[0])
    assert own[0][0] == own[1][2] == 0.0
    assert (own[0][2:] > OUTSIDE).all()
    assert (own[1][:2] > OUTSIDE).all()
    assert 0.0 < own[0][1] < OUTSIDE
    assert np.expm1(own[0][1]) == pytest.approx(made.distance_at(given)[1])
