"""A moved limit against the same book run again with the limit moved: the trials are the same, so are the answers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from simulated import simulated

from xlmc.analysis.studies.sensitivity import sensitivities
from xlmc.analysis.studies.sensitivity.limit_trials import limit_trials
from xlmc.analysis.studies.sensitivity.moved_limit import grid, moved_limit
from xlmc.montecarlo.model.model import CompiledModel

CELLS = {"A1": 0.5, "A2": 0.5, "A3": 0.5, "B1": "=A1+A2", "B2": "=A1*A3", "C1": "=A1", "C2": "=A2-A3", "C3": "=A3<0.9"}
FIELDS = {"at least": "at_least", "at most": "at_most", "above": "above", "below": "below"}


@pytest.fixture(scope="module")
def model(book):
    return book(
        CELLS,
        {name: {"cell": f"A{n}", "low": 0.0, "high": 1.0} for n, name in enumerate("abc", 1)},
        {"y": "B1", "z": "B2"},
        {"band": {"cell": "C1", "at_least": 0.2, "below": 0.7}, "slope": {"cell": "C2", "above": -0.25}, "whole": "C3"},
    )


def moved(model, limit, to):
    """The book with this limit at another value."""
    filters = tuple(replace(f, **{FIELDS[limit.relation]: to}) if f.name == limit.filter else f for f in model.filters)
    return CompiledModel(model.workbook, replace(model.definitions, filters=filters), model.path)


@pytest.fixture(scope="module")
def limits(model):
    return sensitivities(simulated(model, 6000, 4)).filter_limits


def test_every_numeric_limit_is_moved(limits):
    assert [(each.filter, each.relation, each.limit) for each in limits] == [
        ("band", "at least", 0.2),
        ("band", "below", 0.7),
        ("slope", "above", -0.25),
    ]
    for each in limits:
        assert len(each.points) == 7
        assert each.points[3].limit == each.limit
        assert each.loosened_trials == each.trials == 6000


@pytest.mark.parametrize("number", range(3))
def test_moved_limits_give_what_a_run_with_them_gives(model, limits, number):
    limit = limits[number]
    for point in limit.points:
        run = simulated(moved(model, limit, point.limit), 6000, 4)
        assert point.trials == run.accepted
        assert point.acceptance.value == pytest.approx(run.accepted / 6000)
        for answer in point.answers:
            result = run[answer.forecast]
            assert answer.mean.value == pytest.approx(result.mean.value)
            assert answer.mean.error == pytest.approx(result.mean.error, rel=1e-3)  # n/(n − 1)
            low, high = result.central()
            assert (answer.low.value, answer.high.value) == pytest.approx((low.value, high.value))


def test_the_change_is_that_of_the_mean_and_zero_where_nothing_moves(limits):
    for limit in limits:
        for place in range(2):
            now = limit.points[3].answers[place]
            assert (now.change.value, now.change.error) == (0.0, 0.0)
            for point in limit.points:
                answer = point.answers[place]
                assert answer.change.value == pytest.approx(answer.mean.value - now.mean.value)
                assert answer.change.error < np.hypot(answer.mean.error, now.mean.error)


@pytest.fixture(scope="module")
def below(book):
    """a + b of uniforms, a at most 0.66: the first of three steps of 0.1 or a little more."""
    return book(
        {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2"},
        {"a": {"cell": "A1", "low": 0.0, "high": 1.0}, "b": {"cell": "A2", "low": 0.0, "high": 1.0}},
        {"y": "B1"},
        {"f": {"cell": "A1", "at_most": 0.66}},
    )


def test_a_case_in_closed_form(below):
    """a below L, uniform: the mean of a + b is (L + 1)/2, the share L, the slope ½; within 4 standard errors."""
    (limit,) = sensitivities(simulated(below, 40_000, 1)).filter_limits
    assert limit.loosened_trials == 10_000
    for point in limit.points:
        assert abs(point.acceptance.value - point.limit) < 4.0 * point.acceptance.error
        answer = point.answers[0]
        assert abs(answer.mean.value - (point.limit + 1.0) / 2.0) < 4.0 * answer.mean.error
        if point.limit != limit.limit:
            assert abs(answer.change.value - (point.limit - 0.66) / 2.0) < 4.0 * answer.change.error
    assert abs(limit.slopes[0].mean.value - 0.5) < 4.0 * limit.slopes[0].mean.error


def test_errors_are_the_spread_between_runs(below, monkeypatch):
    """With further trials that each stand for four. The spread of 40 is known to 11 %; 4 times that is asked."""
    monkeypatch.setattr("xlmc.analysis.studies.sensitivity.limit_trials.LEAST_AGAIN", 4000)
    runs = []
    for seed in range(40):
        (tried,) = limit_trials(simulated(below, 16_000, seed), 1, [0]).tried
        runs.append(moved_limit(tried.trials, tried.grid, ["y"], [0.51]))
    numbers = {
        "slope": lambda limit: limit[1][0].mean,
        "loosest": lambda limit: limit[0][-1].answers[0].change,
        "tightest": lambda limit: limit[0][0].answers[0].change,
        "mean": lambda limit: limit[0][-1].answers[0].mean,
        "low": lambda limit: limit[0][-1].answers[0].low,
        "share": lambda limit: limit[0][-1].acceptance,
    }
    for name, number in numbers.items():
        each = [number(limit) for limit in runs]
        spread = np.std([estimate.value for estimate in each], ddof=1)
        assert np.mean([estimate.error for estimate in each]) == pytest.approx(spread, rel=0.45), name


def test_a_limit_in_a_cell_is_moved_and_one_that_varies_is_named(book):
    result = sensitivities(
        simulated(
            book(
                {"A1": 0.5, "A2": 0.5, "B1": "=A1+A2", "D1": "=0.25+0.25", "D2": "=0.9+A2"},
                {"a": {"cell": "A1", "low": 0.0, "high": 1.0}, "b": {"cell": "A2", "low": 0.0, "high": 1.0}},
                {"y": "B1"},
                {"fixed": {"cell": "A1", "at_most": "D1"}, "varying": {"cell": "B1", "below": "D2"}},
            ),
            2000,
            1,
        )
    )
    assert [(each.filter, each.limit) for each in result.filter_limits] == [("fixed", 0.5)]
    assert result.varying_limits == ("varying",)


@pytest.mark.parametrize("sampling", ["lhs", "sobol"])
def test_replicated_runs(model, sampling):
    run = simulated(model, 6000, 4, sampling=sampling)
    limit = sensitivities(run).filter_limits[0]
    again = simulated(moved(model, limit, limit.points[0].limit), 6000, 4, sampling=sampling)
    if sampling == "lhs":  # the order of Sobol dimensions may change with the limit
        assert limit.points[0].trials == again.accepted
    result, answer = run["y"].mean, limit.points[3].answers[0].mean
    assert answer.value == pytest.approx(result.value)
    assert answer.error == pytest.approx(result.error, rel=0.02)


@pytest.mark.parametrize(
    ("limit", "values", "expected"),
    [
        (0.25, [0.25 - 0.08, 0.1, 0.2], (0.175, 0.2, 0.225, 0.25, 0.275, 0.3, 0.325)),
        (0.0, [3.0, 4.0, 5.0], (-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0)),
        (1.0, [1.0, 1.0, 1.0], ()),
        (1.0, [], ()),
    ],
)
def test_limits_to_try_are_round_steps(limit, values, expected):
    assert grid(limit, np.array(values)) == expected


def test_trials_that_do_not_use_a_draw_without_a_distribution_count(book):
    assumptions = {name: {"cell": f"A{n}", "low": 0.0, "high": 1.0} for n, name in enumerate("ab", 1)}
    assumptions["c"] = {"cell": "A3", "low": 0.0, "high": "B1"}
    cells = {"A1": 0.5, "A2": 0.5, "A3": 0.1, "B1": "=A1-0.5", "B2": "=IF(A1>0.5,A3,0)+A2", "C1": "=A2"}
    model = book(cells, assumptions, {"y": "B2"}, {"least": {"cell": "C1", "at_least": 0.4}})
    (limit,) = sensitivities(simulated(model, 4000, 4)).filter_limits
    for point in (limit.points[0], limit.points[3], limit.points[-1]):
        run = simulated(moved(model, limit, point.limit), 4000, 4)
        assert point.trials == run.accepted == (run.prior["b"] >= point.limit).sum()
        assert point.answers[0].mean.value == pytest.approx(run["y"].mean.value)
