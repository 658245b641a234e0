"""The interval of a standard deviation is called short under power tails, and not under light ones."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

import xlmc.montecarlo.statistics as xs

HEAVY = {
    "t3": stats.t(3),
    "pareto3": stats.pareto(3),
    "lognormal1.5": stats.lognorm(1.5),
    "lognormal2": stats.lognorm(2),
}
LIGHT = {
    "normal": stats.norm(),
    "uniform": stats.uniform(),
    "triangular": stats.triang(0.3),
    "exponential": stats.expon(),
    "gamma2": stats.gamma(2),
    "gumbel": stats.gumbel_r(),
    "poisson": stats.poisson(0.1),
}


def times_warned(distribution, n, runs):
    rng = np.random.default_rng(5)
    draws = (distribution.rvs(n, random_state=rng) for _ in range(runs))
    return sum("standard deviation" in xs.too_short(x) for x in draws)


@pytest.mark.parametrize("n", [10_000, 50_000])
@pytest.mark.parametrize("name", HEAVY)
def test_power_tails_give_a_warning(name, n):
    """In 30 runs; a warning of 95 % of them fails in 4 or fewer with a probability of 98 %."""
    assert times_warned(HEAVY[name], n, 30) >= 26


@pytest.mark.parametrize("n", [10_000, 50_000])
@pytest.mark.parametrize("name", LIGHT)
def test_light_tails_are_not(name, n):
    """5 % at most: of 30 runs 4 or fewer with a probability of 98 %."""
    assert times_warned(LIGHT[name], n, 30) <= 4


@pytest.mark.parametrize("name", LIGHT)
def test_nor_with_a_thousand_trials(name):
    """1 % of the runs: of 200 runs 7 or fewer with a probability of 99.9 %."""
    assert times_warned(LIGHT[name], 1_000, 200) <= 7


@pytest.mark.parametrize("n", [100, 1_000])
@pytest.mark.parametrize(("name", "truth"), [("t3", 3**0.5), ("pareto3", 0.75**0.5), ("lognormal2", 53.5949)])
def test_a_miss_is_told(name, truth, n):
    """In a run that lacks the far trials the rest of the tail tells: 8 % at most miss in silence, + 3 errors."""
    rng, runs, silent = np.random.default_rng(9), 600, 0
    for _ in range(runs):
        sample = xs.Sample.of(HEAVY[name].rvs(n, random_state=rng))
        low, high = xs.standard_deviation(sample).interval
        silent += not low <= truth <= high and "standard deviation" not in xs.too_short(sample)
    assert silent / runs < 0.08 + 3 * (0.08 * 0.92 / runs) ** 0.5


def test_the_mean_of_a_hundred_trials_of_a_long_tail():
    """The mean of exp(2z) is missed by 10 % of such runs, and at most 8 % say nothing."""
    rng, runs, silent, truth = np.random.default_rng(10), 800, 0, np.exp(2.0)
    for _ in range(runs):
        sample = xs.Sample.of(HEAVY["lognormal2"].rvs(100, random_state=rng))
        low, high = xs.mean(sample).interval
        silent += not low <= truth <= high and "mean" not in xs.too_short(sample)
    assert silent / runs < 0.065  # before the part of √n: .083


def test_hundreds_of_events_are_enough():
    """A hundredth of the trials lies far off, as losses do: with 100,000 trials that is no tail."""
    rng = np.random.default_rng(11)
    x = rng.normal(size=100_000) + 50.0 * (rng.random(100_000) < 0.01)
    assert xs.too_short(x) == []
    assert xs.too_short(x[:1_000]) != []


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_the_unit_does_not_matter(scale):
    x = stats.t(3).rvs(10_000, random_state=np.random.default_rng(6))
    assert xs.too_short(scale * x) == xs.too_short(x)
