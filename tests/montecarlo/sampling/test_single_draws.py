"""What one assumption's draw says of itself, and draws of two loops."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.errors import SimulationError
from xlmc.excel.address import Cell
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.sampling.copula import GaussianCopula
from xlmc.montecarlo.sampling.draws import CorrelatedGroup, Draw, DrawStage, Sampler
from xlmc.montecarlo.sampling.sampling_plan import Repeated, SamplingPlan
from xlmc.montecarlo.sampling.streams import Stream

AT, THERE = Cell("S", 1, 1), Cell("S", 2, 1)
U = np.array([0.05, 0.25, 0.5, 0.9])


def draw(family, **given):
    return Draw.of("a", FAMILIES[family], given)


def filled(one, u=U, dynamic=None):
    out = np.array(u, float)
    one.fill(out, dynamic or {})
    return out


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"mean": 3, "std_dev": 2}, stats.norm(3, 2).ppf(U)),
        (
            {"mean": 3, "std_dev": 2, "lower_cutoff": 1, "upper_cutoff": 5},
            stats.truncnorm(-1, 1, 3, 2).ppf(U),
        ),
        ({"mean": 3, "std_dev": 2, "lower_cutoff": 3}, stats.truncnorm(0, np.inf, 3, 2).ppf(U)),
        ({"mean": 3, "std_dev": 2, "upper_cutoff": 3}, stats.truncnorm(-np.inf, 0, 3, 2).ppf(U)),
    ],
)
def test_quantiles_with_and_without_cutoffs(given, expected):
    one = draw("Normal", **given)
    assert filled(one) == pytest.approx(expected)
    assert one.reached(expected) == pytest.approx(U)
    assert one.percentiles(U, {}) == pytest.approx(expected)
    assert (one.fixed, one.varying, one.fault()) == (True, [], None)


def test_parameters_that_vary_are_those_of_each_trial():
    one = draw("Normal", mean=AT, std_dev=2, lower_cutoff=THERE, upper_cutoff=9)
    assert (one.fixed, one.varying) == (False, [AT, THERE])
    dynamic = {AT: np.array([3.0, 3.0, 5.0, 5.0]), THERE: np.array([3.0, 1.0, -1.0, 99.0])}
    result = filled(one, dynamic=dynamic)
    expected = [
        stats.truncnorm((low - mean) / 2, (9 - mean) / 2, mean, 2).ppf(u)
        for u, mean, low in ((0.05, 3, 3), (0.25, 3, 1), (0.5, 5, -1))
    ]
    assert result[:3] == pytest.approx(expected)
    assert math.isnan(result[3])  # its cutoffs leave nothing
    assert (one.fault(), one.ends, one.ties(), one.has_mean) == (None, None, None, True)
    at_base = {AT: np.array([3.0]), THERE: np.array([3.0])}
    assert one.percentiles(np.array([0.05]), at_base) == pytest.approx(expected[:1])


@pytest.mark.parametrize(
    ("family", "given", "fault"),
    [
        ("Normal", {"mean": 0, "std_dev": 1}, False),
        ("Normal", {"mean": 0, "std_dev": -1}, True),
        ("Normal", {"mean": 0, "std_dev": 1, "lower_cutoff": 2, "upper_cutoff": 1}, True),
        ("Normal", {"mean": AT, "std_dev": -1}, False),  # each trial has its own
        ("Uniform", {"low": 2, "high": 1}, True),
    ],
)
def test_numbers_that_are_no_distribution(family, given, fault):
    assert (draw(family, **given).fault() is not None) is fault


@pytest.mark.parametrize(
    ("family", "given", "has_mean"),
    [
        ("Normal", {"mean": 0, "std_dev": 1}, True),
        ("Cauchy", {"location": 0, "scale": 1}, False),
        ("Cauchy", {"location": 0, "scale": 1, "lower_cutoff": 0}, False),
        ("Cauchy", {"location": 0, "scale": 1, "lower_cutoff": -9, "upper_cutoff": 9}, True),
        ("Cauchy", {"location": AT, "scale": 1}, True),
        ("Pareto", {"location": 1, "shape": 1}, False),
        ("Pareto", {"location": 1, "shape": 1.5}, True),
    ],
)
def test_which_draws_have_a_mean(family, given, has_mean):
    assert draw(family, **given).has_mean is has_mean


@pytest.mark.parametrize(
    ("family", "given", "ends"),
    [
        ("Uniform", {"low": 2, "high": 5}, (2.0, 5.0)),
        ("Normal", {"mean": 0, "std_dev": 1}, None),
        ("Normal", {"mean": 0, "std_dev": 1, "lower_cutoff": -1, "upper_cutoff": 2}, (-1.0, 2.0)),
        ("Uniform", {"low": AT, "high": 5}, None),
        ("Uniform", {"low": 3, "high": 3}, (3.0, 3.0)),
    ],
)
def test_the_least_and_the_largest_draw(family, given, ends):
    assert draw(family, **given).ends == (None if ends is None else pytest.approx(ends))


def test_draws_too_small_for_a_cell_are_0():
    assert filled(draw("Uniform", low=0, high=4e-308), [0.25, 0.75]).tolist() == [0.0, 3e-308]


@pytest.mark.parametrize(
    ("family", "given", "draws", "refused"),
    [
        ("Cauchy", {"location": 0, "scale": 1}, [1.0, math.nan], True),
        ("Cauchy", {"location": 0, "scale": 1}, [1.0, math.inf], True),
        ("Cauchy", {"location": 0, "scale": 1}, [1.7e308, 1.7e308], False),  # their sum alone overflows
        ("Cauchy", {"location": 0, "scale": 1}, [1.0, 2.0], False),
        ("Cauchy", {"location": AT, "scale": 1}, [1.0, math.nan], False),  # an error trial
    ],
)
def test_draws_that_are_no_numbers(family, given, draws, refused):
    one = draw(family, **given)
    if refused and not one.family.always_finite:
        with pytest.raises(SimulationError, match="Cauchy of the assumption 'a' gives draws that are not numbers"):
            one.refuse_no_numbers(np.array(draws))
    else:
        one.refuse_no_numbers(np.array(draws))


@pytest.mark.parametrize(
    ("family", "given", "tied"),
    [
        ("Uniform", {"low": 0, "high": 1}, False),
        ("Yes-No", {"probability": 0.3}, True),
        ("Poisson", {"rate": 2}, True),
        ("Poisson", {"rate": AT}, False),
    ],
)
def test_draws_that_are_equal(family, given, tied):
    assert (draw(family, **given).ties() is not None) is tied


@pytest.mark.parametrize(
    ("start", "size", "times"), [(0, 12, 4), (3, 7, 4), (5, 2, 4), (4, 4, 4), (7, 9, 3), (2, 5, 1)]
)
def test_each_draw_is_kept_for_several_trials(start, size, times):
    every, result = np.empty(40), np.empty(size)
    Stream(5, "a").uniforms(0, every)
    Repeated(Stream(5, "a"), times).uniforms(start, result)
    assert result.tolist() == [every[trial // times] for trial in range(start, start + size)]


def test_two_loops():
    plan = SamplingPlan.nested({"a"}, 50, 20)
    assert (plan.trials, plan.size, plan.replicates, plan.method) == (1_000, 20, 50, "mc")
    outer, inner = (np.empty(1_000) for _ in range(2))
    for margin, out in zip(plan.margins(7, ["a", "b"]), (outer, inner), strict=True):
        margin.uniforms(0, out)
    drawn = outer.reshape(50, 20)
    assert (drawn == drawn[:, :1]).all()
    assert sorted(np.floor(drawn[:, 0] * 50)) == list(range(50))  # a Latin hypercube of outer draws
    assert np.unique(inner).size == 1_000


@pytest.mark.parametrize(
    ("method", "trials", "size", "run"),
    [
        ("mc", 1_000, 0, 1_000),
        ("lhs", 200_000, 12_500, 200_000),
        ("sobol", 200_000, 8_192, 204_800),
        ("lhs", 1_001, 63, 1_008),
    ],
)
def test_plans(method, trials, size, run):
    plan = SamplingPlan.of(method, trials)
    assert (plan.size, plan.trials) == (size, run)
    assert plan.replicates == (run // size if size else 0)
    assert SamplingPlan.of(method, plan.trials) == plan
    with pytest.raises(ValueError, match="there is no sampling method"):
        SamplingPlan.of("halton", 100)


def sampler(*draws, groups=(), **more):
    return Sampler(3, [DrawStage(draws)], groups, [], 16, **more)


def test_samplers_that_draw_by_lines_alone_say_so():
    first, second = Draw("a", FAMILIES["Uniform"], (2.0, 5.0)), Draw("b", FAMILIES["Uniform"], (0.0, 1.0))
    made = sampler(first, second)
    assert (made.names, dict(made.row_of)) == (("a", "b"), {"a": 0, "b": 1})
    assert tuple(made.linear.maps) == ((2.0, 3.0), (0.0, 1.0))
    assert len(made.linear.streams) == 2
    assert sampler(first, Draw("b", FAMILIES["Normal"], (0.0, 1.0))).linear is None
    pair = CorrelatedGroup(("a", "b"), GaussianCopula(np.array([[1.0, 0.5], [0.5, 1.0]])))
    assert sampler(first, second, groups=[pair]).linear is None
    assert sampler(first, second, plan=SamplingPlan.of("lhs", 16)).linear is None
