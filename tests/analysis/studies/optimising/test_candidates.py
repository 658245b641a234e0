"""The values of decisions, equalities that compute some of them, and what is known of a candidate."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from xlmc.analysis.studies.optimising.candidates import MARGIN, SURE, Axis, Equalities, Space, Standing
from xlmc.analysis.studies.optimising.goal_text import Reader
from xlmc.analysis.studies.optimising.measures import Measured
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import Decision

AT = Cell("S", 1, 1)


def between(name, low, high):
    return Decision(name, AT, (low, high), AT, between=(low, high))


def listed(name, *values, ordered=False):
    return Decision(name, AT, values, AT, listed=not ordered)


def required(decisions, *texts):
    model = SimpleNamespace(forecasts=(), definitions=SimpleNamespace(decisions=decisions))
    return tuple(Reader(model, decisions).requirement(text) for text in texts)


@pytest.mark.parametrize(
    ("low", "high", "step", "count"),
    [
        (0.0, 100.0, 0.1, 1001),
        (0.0, 1.0, 0.001, 1001),
        (0.0, 9.99, 0.001, 9991),
        (-5.0, 5.0, 0.01, 1001),
        (0.0, 2.55e-3, 1e-6, 2551),
    ],
)
def test_any_value_of_a_range_is_tried_on_a_grid_of_a_power_of_ten(low, high, step, count):
    axis = Axis.of(between("x", low, high))
    assert (axis.fine, axis.ordered, axis.count) == (True, True, count)
    assert axis.step == pytest.approx(step)
    assert (axis.value(0), axis.value(count - 1), axis.value(count)) == (low, high, high)
    assert axis.value(1) == pytest.approx(low + step)
    assert axis.value(count - 2) < high
    for number in (0, 1, count // 2, count - 2, count - 1):
        assert axis.number(axis.value(number)) == number
    assert axis.number(low + 0.4 * step) is None
    assert axis.number(high + step) is None
    assert axis.number(low - step) is None


def test_a_value_of_a_grid_has_no_digits_of_rounding():
    axis = Axis.of(between("x", 0.0, 1.0))
    assert [axis.value(number) for number in (3, 7, 143, 999)] == [0.003, 0.007, 0.143, 0.999]
    uneven = Axis.of(between("x", 0.0, 1.0004))
    assert [uneven.value(number) for number in range(999, 1002)] == [0.999, 1.0, 1.0004]


@pytest.mark.parametrize("ordered", [False, True])
def test_values_that_are_listed(ordered):
    axis = Axis.of(listed("x", 3.0, 1.0, 8.0, ordered=ordered))
    assert (axis.count, axis.ordered, axis.fine) == (3, ordered, False)
    assert [axis.value(number) for number in range(3)] == [3.0, 1.0, 8.0]
    assert [axis.number(value) for value in (3.0, 1.0, 8.0, 2.0, 8.1, 8.0 + 1e-10)] == [0, 1, 2, None, None, 2]


THREE = (between("a", 0.0, 1.0), between("b", 0.0, 1.0), between("c", 0.0, 1.0))


@pytest.mark.parametrize(
    ("texts", "given", "result"),
    [
        (["a + b + c = 1"], (0.5, 0.2, 0.3), (0.5, 0.2, 0.3)),
        (["a + b + c = 1"], (9.0, 0.2, 0.3), (0.5, 0.2, 0.3)),
        (["2*b - a = 0.25"], (0.5, 9.0, 0.7), (0.5, 0.375, 0.7)),
        (["a + b + c = 1", "a = 2*b"], (9.0, 9.0, 0.4), (0.4, 0.2, 0.4)),
        (["a + b = 1", "b + c = 1", "a - c = 0"], (9.0, 9.0, 0.3), (0.3, 0.7, 0.3)),  # the third says nothing more
        (["a = 0.1", "b = 0.2", "c = 0.3"], (9.0, 9.0, 9.0), (0.1, 0.2, 0.3)),
    ],
)
def test_equalities_compute_decisions_from_the_others(texts, given, result):
    solved = Equalities.of(THREE, required(THREE, *texts))
    assert solved.completed(given) == pytest.approx(result, abs=1e-12)
    for each in required(THREE, *texts):
        assert each.holds_for(solved.completed(given))


def test_only_decisions_of_any_value_are_computed():
    mixed = (listed("a", 1.0, 2.0), between("b", 0.0, 1.0), listed("c", 0.0))
    solved = Equalities.of(mixed, required(mixed, "3*a + b = 4"))
    assert solved.computed == (1,)
    assert solved.completed((1.0, 9.0, 0.0)) == (1.0, 1.0, 0.0)
    assert Equalities.of(mixed, required(mixed, "a + c = 2")) is None
    assert Equalities.of(mixed, required(mixed, "a + b >= 2")) is None


def test_a_computed_value_shows_no_rounding():
    solved = Equalities.of(THREE, required(THREE, "a + b + c = 1"))
    assert solved.completed((9.0, 0.1, 0.2))[solved.computed[0]] in (0.7, 0.1, 0.2)
    zero = Equalities.of(THREE[:2], required(THREE[:2], "a + b = 0.3")).completed((9.0, 0.3))
    assert math.copysign(1.0, zero[0]) == 1.0


def test_a_space_of_what_decisions_alone_allow():
    decisions = (listed("a", 1.0, 2.0, 3.0), listed("b", 10.0, 20.0))
    space = Space.of(decisions, required(decisions, "10*a + b <= 40"))
    assert (space.size, space.finite) == (6, True)
    assert [*space.every()] == [(1.0, 10.0), (1.0, 20.0), (2.0, 10.0), (2.0, 20.0), (3.0, 10.0)]
    assert space.candidate([2, 1]) == (3.0, 20.0)
    assert space.excess((3.0, 10.0)) == 0.0
    assert space.excess((3.0, 20.0)) > 0.0
    assert not Space.of(THREE, ()).finite


def test_a_computed_decision_stays_within_its_range():
    decisions = (between("a", 0.0, 2.0), listed("b", -1.0, 0.5, 4.0))
    space = Space.of(decisions, required(decisions, "a + b = 1"))
    assert (space.size, space.finite) == (3, True)
    assert [space.candidate([0, number]) for number in range(3)] == [(2.0, -1.0), (0.5, 0.5), (-3.0, 4.0)]
    assert [*space.every()] == [(2.0, -1.0), (0.5, 0.5)]
    assert space.excess((-3.0, 4.0)) == pytest.approx(1.5)  # three of a range of two
    assert space.excess((3.0, -2.0)) == pytest.approx(0.5)
    assert space.axes[0].number(0.123) == 0


PULLS = np.array([1.0, -1.0])  # an error of √(2·2/1) = 2


def standing(goal=5.0, *slacks, excess=0.0):
    return Standing((), 2, Measured(goal), tuple(slacks), 0.0, excess)


@pytest.mark.parametrize(
    ("slacks", "sureness", "meets"),
    [
        ((), math.inf, True),
        ((Measured(4.0, PULLS),), MARGIN, True),
        ((Measured(3.9, PULLS),), 1.95, False),
        ((Measured(40.0, PULLS), Measured(-4.0, PULLS)), -2.0, False),
        ((Measured(0.0),), math.inf, True),  # of decisions alone, without an error
        ((Measured(-0.1),), -math.inf, False),
        ((Measured(math.nan),), -math.inf, False),
    ],
)
def test_by_how_many_errors_requirements_hold(slacks, sureness, meets):
    result = standing(5.0, *slacks)
    assert result.sureness == pytest.approx(sureness)
    assert result.meets is meets
    assert not standing(math.nan, *slacks).meets
    assert standing(5.0, *slacks, excess=0.01).sureness == -math.inf


def test_the_order_of_candidates():
    best_first = [
        standing(9.0, Measured(5.0, PULLS)),
        standing(8.0),
        standing(99.0, Measured(3.0, PULLS)),  # misses two errors, which are 4, by 1
        standing(1.0, Measured(2.0, PULLS)),
        standing(1.0, Measured(2.0, PULLS), Measured(3.5, PULLS)),
        standing(1.0, Measured(math.nan)),
        standing(1.0, Measured(math.nan), excess=0.5),
        standing(math.nan),
    ]
    assert sorted(best_first, key=lambda each: each.rank, reverse=True) == best_first
    assert [each.missing for each in best_first[2:5]] == pytest.approx([1.0, 2.0, 2.5])
    assert best_first[5].missing == 1e9


def test_certainty_is_95_percent_of_one_side():
    from scipy.stats import norm

    assert norm.cdf(SURE) == pytest.approx(0.95)
