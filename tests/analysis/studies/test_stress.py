"""Stressed assumptions and what distinguishes answers, against closed forms of normal and uniform distributions."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import multivariate_normal

import xlmc
from xlmc.errors import SimulationError

UNIT = NormalDist()
SHARE = 0.1
LIMIT = UNIT.inv_cdf(SHARE)
SHIFT = UNIT.pdf(LIMIT) / SHARE
"""By how many SDs the mean of a normal distribution's lowest tenth lies below that of all."""


def sum_of_two(**more):
    """y = 3a + b with a of N(1, 2) and b of N(0, 3): a correlation of 6/√45 between a and y."""
    return xlmc.model(
        lambda a, b: {"y": 3 * a + b},
        {"a": xlmc.Normal(1, 2), "b": xlmc.Normal(0, 3)},
        {"y": {"threshold": 4.0}},
        **more,
    )


SD = math.sqrt(45)
RHO = 6 / SD


def both_below(a, y):
    """P(A <= a and Y <= y) of the standardised a and y."""
    return float(multivariate_normal([0, 0], [[1, RHO], [RHO, 1]]).cdf([a, y]))


def tail(result, name, *, high):
    return next(each for each in result.tails if each.assumption == name and each.is_high is high)


@pytest.fixture(scope="module")
def result():
    return xlmc.stress(sum_of_two(), trials=100_000, seed=5)


def test_means_and_shares_of_tails_are_those_of_the_closed_form(result):
    assert [(each.assumption, each.is_high) for each in result.tails] == [
        ("a", False),
        ("a", True),
        ("b", False),
        ("b", True),
    ]
    for each in result.tails:
        assert each.trials == 10_000
        side, size = (1 if each.is_high else -1), {"a": 6, "b": 3}[each.assumption]
        part = each.parts["y"]
        change, mean = part.changes["mean"], part.numbers["mean"]
        assert abs(change.value - side * size * SHIFT) < 4 * change.error
        assert abs(mean.value - (3 + side * size * SHIFT)) < 4 * mean.error
        assert mean.value - result.base["y"].numbers["mean"].value == pytest.approx(change.value)
    low = tail(result, "a", high=False)
    assert abs(low.limit - (1 + 2 * LIMIT)) < 4 * 2 * math.sqrt(0.09 / 100_000) / UNIT.pdf(LIMIT)
    part = low.parts["y"]
    above = 1 - both_below(LIMIT, (4 - 3) / SD) / SHARE
    assert abs(part.numbers["above"].value - above) < 4 * part.numbers["above"].error
    for name, p in (("low", 0.245), ("high", 0.755)):
        exact = 3 + SD * brentq(lambda y, p=p: both_below(LIMIT, y) / SHARE - p, -6, 6)
        assert abs(part.numbers[name].value - exact) < 4 * part.numbers[name].error


def test_the_assumption_that_moves_most_comes_first(result):
    assert [pair[0].assumption for pair in result.ranked("y")] == ["a", "b"]
    assert "y moves most with a" in str(result)


def test_medians_of_inputs_where_the_answer_is_high(result):
    (scenario,) = result.scenarios
    assert (scenario.forecast, scenario.words, scenario.trials) == ("y", "above P90", 10_000)
    assert [each.assumption for each in scenario.inputs] == ["a", "b"]
    limit = UNIT.inv_cdf(0.9)
    exact = brentq(lambda a: (UNIT.cdf(a) - both_below(a, limit)) / 0.1 - 0.5, -6, 6)
    moved = scenario.inputs[0]
    assert abs(moved.shift.value - exact) < 4 * moved.shift.error
    assert abs(moved.within.value - (1 + 2 * exact)) < 4 * moved.within.error
    assert abs(moved.at - UNIT.cdf(exact)) < 0.02
    assert moved.is_sure
    assert moved.chance < 1e-12


def test_what_has_nothing_to_do_with_the_answer_distinguishes_nothing():
    model = xlmc.model(lambda a, b: {"y": a, "z": b}, {"a": xlmc.Uniform(0, 1), "b": xlmc.Uniform(0, 1)}, ["y", "z"])
    chances = []
    for seed in range(60):
        result = xlmc.stress(model, trials=2_000, seed=seed, forecasts=["y"])
        assert [each.forecast for each in result.scenarios] == ["y"]
        inputs = {each.assumption: each for each in result.scenarios[0].inputs}
        assert inputs["a"].is_sure
        chances.append(inputs["b"].chance)
        assert tail(result, "b", high=True).parts["y"].changes["mean"].error > 0
    assert 0 < sum(chance < 0.2 for chance in chances) < 25  # 12 are expected
    assert sum(chance < 0.003 for chance in chances) <= 2


def test_errors_are_what_other_seeds_show():
    """Those of a tail's limit are in them: of y = a they are most of it."""
    model = xlmc.model(
        lambda a, b: {"y": a, "z": 3 * a + b}, {"a": xlmc.Normal(0, 1), "b": xlmc.Normal(0, 1)}, ["y", "z"]
    )
    result = {}
    for seed in range(100):
        study = xlmc.stress(model, trials=1_500, seed=seed, scenarios=["between P20 and P60"])
        for name in ("y", "z"):
            part = tail(study, "a", high=False).parts[name]
            for key in ("mean", "high"):
                for what in ("numbers", "changes"):
                    number = getattr(part, what)[key]
                    result.setdefault((name, key, what), []).append((number.value, number.error))
        moved = next(each for each in study.scenarios[1].inputs if each.assumption == "a")
        result.setdefault("median", []).append((moved.shift.value, moved.shift.error))
    for key, pairs in result.items():
        values, errors = np.array(pairs).T
        assert 0.75 < values.std(ddof=1) / errors.mean() < 1.35, key


def test_what_is_correlated_moves_as_well():
    """Of two normal inputs with a correlation of .8 the mean of the other moves by .8 of what the one does."""
    model = xlmc.model(
        lambda a, b: {"y": b},
        {"a": xlmc.Normal(0, 1), "b": xlmc.Normal(0, 1)},
        ["y"],
        correlations={("a", "b"): 6 / math.pi * math.asin(0.4)},
    )
    result = xlmc.stress(model, trials=50_000, assumptions=["a"])
    change = tail(result, "a", high=True).parts["y"].changes["mean"]
    assert abs(change.value - 0.8 * SHIFT) < 4 * change.error


def test_tails_are_those_of_the_accepted_trials():
    """Of a on (-1, 1), of which a filter leaves (0, 1), the lowest fifth ends at .2."""
    model = xlmc.model(lambda a: {"y": a, "f": a}, {"a": xlmc.Uniform(-1, 1)}, ["y"], {"f": {"at_least": 0}})
    result = xlmc.stress(model, trials=40_000, share=20)
    low = tail(result, "a", high=False)
    assert low.limit == pytest.approx(0.2, abs=0.01)
    mean = low.parts["y"].numbers["mean"]
    assert abs(mean.value - 0.1) < 4 * mean.error


def test_values_that_many_trials_have_belong_to_a_tail_together():
    model = xlmc.model(
        lambda coin, still, x: {"y": coin + x + still},
        {"coin": xlmc.YesNo(0.3), "still": xlmc.Uniform(2, 2), "x": xlmc.Uniform(0, 1)},
        ["y"],
    )
    result = xlmc.stress(model, trials=20_000)
    low, high = (tail(result, "coin", high=high) for high in (False, True))
    assert (low.limit, high.limit) == (0, 1)
    assert low.trials + high.trials == 20_000
    change = high.parts["y"].changes["mean"]
    assert abs(change.value - 0.7) < 4 * change.error
    assert "still" not in {each.assumption for each in result.tails}


def test_yes_and_no_are_shares():
    model = xlmc.model(lambda a: {"y": a > 0.5}, {"a": xlmc.Uniform(0, 1)}, ["y"])
    result = xlmc.stress(model, trials=5_000)
    assert not result.scenarios
    share = tail(result, "a", high=True).parts["y"].numbers["mean"]
    assert (share.value, share.error > 0) == (1.0, True)
    assert "the probability is" in str(result)


@pytest.mark.parametrize(
    ("words", "low", "high", "trials"),
    [
        ("above 0.75", 0.75, math.inf, 0.25),
        ("below 20%", -math.inf, 0.2, 0.2),
        ("Between P10  and p20", 0.1, 0.2, 0.1),
        ("between -1 and .5", -1, 0.5, 0.5),
        ("above 1.5", 1.5, math.inf, 0.0),
    ],
)
def test_ranges_of_answers(words, low, high, trials):
    model = xlmc.model(lambda a: {"y": a}, {"a": xlmc.Uniform(0, 1)}, ["y"])
    (scenario,) = xlmc.stress(model, trials=20_000, scenarios=[words]).scenarios
    assert (scenario.low, scenario.high) == pytest.approx((low, high), abs=0.01)
    assert scenario.trials / 20_000 == pytest.approx(trials, abs=0.015)
    assert bool(scenario.inputs) == bool(trials)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"share": 0}, "A tail of 0 % is none"),
        ({"share": 60}, "Give a percentage above 0 and up to 50"),
        ({"scenarios": ["high"]}, "'high' is no range of answers. Such as 'above P90'"),
        ({"scenarios": ["above P100"]}, "P100 is no percentile"),
        ({"scenarios": ["between 3 and 2"]}, "the first end is not below the second"),
        ({"assumptions": ["c"]}, "'c'"),
        ({"forecasts": ["x"]}, "'x'"),
        ({"trials": 200}, "a tail of 10 % then has fewer than 30. Give more trials"),
    ],
)
def test_what_cannot_be_asked_is_refused(more, message):
    with pytest.raises(SimulationError, match=message):
        xlmc.stress(sum_of_two(), **{"trials": 1_000, **more})


def test_of_many_inputs_and_answers_those_that_matter_are_told():
    """Of 30 inputs the 20 with the largest factors, and of 25 forecasts the first 20, or those that are named."""
    names = [f"a{number}" for number in range(30)]
    model = xlmc.model(
        lambda **a: {f"y{at}": sum((k + 1) * a[name] for k, name in enumerate(names)) + at for at in range(25)},
        dict.fromkeys(names, xlmc.Uniform(0, 1)),
        [f"y{at}" for at in range(25)],
    )
    result = xlmc.stress(model, trials=20_000)
    assert [each.name for each in result.forecasts] == [f"y{at}" for at in range(20)]
    assert result.left_out == 5
    messages = [pair[0].assumption for pair in result.ranked("y3") if "y3" in pair[0].parts]
    assert len(messages) == 20
    assert set(messages) >= set(names[14:])
    assert messages[0] in names[27:]
    assert len(result.scenarios[0].inputs) == 20
    assert "Shown are the first 20 forecasts; 5 more can be named" in str(result)
    assert [each.name for each in xlmc.stress(model, trials=2_000, forecasts=["y24"]).forecasts] == ["y24"]


def test_counts_and_shares_are_told_as_such():
    model = xlmc.model(
        lambda n, a: {"count": n * 1.0, "rare": 1.0 * (n > 6) * (a > -9)},
        {"n": xlmc.Poisson(3), "a": xlmc.Normal(0, 1)},
        {"count": {"kind": "whole number"}, "rare": {"kind": "yes/no"}},
    )
    messages = str(xlmc.stress(model, trials=4_000, seed=1))
    assert "rare moves most with n: with its highest 10 % the probability is" in messages
    assert "count above P90 (5 or more, " in messages
