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
LIGHT = {"normal": stats.norm(), "uniform": stats.uniform(), "exponential": stats.expon(), "gumbel": stats.gumbel_r()}


def told(distribution, n, runs):
    rng = np.random.default_rng(5)
    draws = (distribution.rvs(n, random_state=rng) for _ in range(runs))
    return sum("standard deviation" in xs.too_short(x) for x in draws)


@pytest.mark.parametrize("n", [10_000, 50_000])
@pytest.mark.parametrize("name", HEAVY)
def test_power_tails_are_told(name, n):
    """In 30 runs; what is told in 95 % of them fails in 4 or fewer with a probability of 98 %."""
    assert told(HEAVY[name], n, 30) >= 26


@pytest.mark.parametrize("n", [10_000, 50_000])
@pytest.mark.parametrize("name", LIGHT)
def test_light_tails_are_not(name, n):
    """5 % at most: of 30 runs 4 or fewer with a probability of 98 %."""
    assert told(LIGHT[name], n, 30) <= 4


@pytest.mark.parametrize("scale", [1e-200, 1.0, 1e200])
def test_the_unit_does_not_matter(scale):
    x = stats.t(3).rvs(10_000, random_state=np.random.default_rng(6))
    assert xs.too_short(scale * x) == xs.too_short(x)
