from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xlmc.errors import SimulationError
from xlmc.montecarlo.sampling.sampling_methods import METHODS, REPLICATES
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.sampling.sobol_points import DIMENSIONS

STRATIFIED = [method for method in METHODS if method != "mc"]


@given(st.sampled_from(STRATIFIED), st.integers(1, 10**12))
def test_whole_replicates_sixteen_or_more(method, trials):
    plan = SamplingPlan.of(method, trials)
    assert plan.size * plan.replicates == plan.trials >= trials
    assert plan.replicates >= REPLICATES
    assert SamplingPlan.of(method, plan.trials) == plan
    smallest = REPLICATES * METHODS[method].replicate(1)
    assert plan.trials < max(trials + max(16, plan.size), smallest + 1)
    if method == "sobol":
        assert plan.size & (plan.size - 1) == 0
        assert plan.replicates < 2 * REPLICATES


@pytest.mark.parametrize(
    ("method", "trials", "run", "size"),
    [
        ("mc", 200_000, 200_000, 0),
        ("lhs", 200_000, 200_000, 12_500),
        ("lhs", 200_001, 200_016, 12_501),
        ("lhs", 1_000_000, 1_015_808, 16_384),
        ("lhs500", 10_000, 10_000, 500),
        ("lhs500", 1_000, 1_008, 63),
        ("sobol", 131_072, 131_072, 8_192),
        ("sobol", 200_000, 204_800, 8_192),
        ("sobol", 261_000, 262_144, 16_384),
        ("sobol", 1, 16, 1),
    ],
)
def test_plans(method, trials, run, size):
    assert SamplingPlan.of(method, trials) == SamplingPlan(method, run, size)


def test_the_replicate_of_a_trial():
    trials = np.array([0, 499, 500, 9_999])
    assert SamplingPlan.of("lhs500", 10_000).replicate_of(trials).tolist() == [0, 0, 1, 19]
    assert SamplingPlan.of("mc", 10_000).replicate_of(trials) is None


def test_an_unknown_method():
    with pytest.raises(ValueError, match="there is no sampling method 'dice'"):
        SamplingPlan.of("dice", 100)


def test_more_assumptions_than_dimensions():
    with pytest.raises(SimulationError, match="Sobol points have 21,201 dimensions, and 21,202 assumptions are drawn"):
        SamplingPlan.of("sobol", 100).margins(1, [str(i) for i in range(DIMENSIONS + 1)])


@pytest.mark.parametrize("method", ["lhs", "lhs500"])
def test_more_trials_begin_with_the_same(method):
    """Once a replicate has its full size."""
    few, many = np.empty(40_000), np.empty(40_000)
    for trials, out in ((300_000, few), (10**9, many)):
        SamplingPlan.of(method, trials).margins(1, ["a"])[0].uniforms(100_000, out)
    assert np.array_equal(few, many)


@pytest.mark.parametrize("method", METHODS)
def test_what_one_assumption_is_drawn_with_does_not_depend_on_those_after_it(method):
    plan, alone, among = SamplingPlan.of(method, 4_000), np.empty(1_000), np.empty(1_000)
    plan.margins(1, ["a"])[0].uniforms(500, alone)
    plan.margins(1, ["a", "b"])[0].uniforms(500, among)
    assert np.array_equal(alone, among)
