"""Many draws of every distribution of counts through the sampler, against SciPy's probabilities.

Chi-square with cells of 25 draws or more: a right sampler fails one seed in ten thousand, and the seed is fixed.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

TRIALS, FEWER = 80_000, 40_000
LEVEL = 1e-4
CASES = {
    "Binomial": ({"probability": 0.3, "trials": 20}, stats.binom(20, 0.3)),
    "Discrete Uniform": ({"low": -3, "high": 9}, stats.randint(-3, 10)),
    "Geometric": ({"probability": 0.25}, stats.geom(0.25)),
    "Geomet": ({"probability": 0.25}, stats.geom(0.25, loc=-1)),
    "Hypergeometric": ({"success": 20, "trials": 10, "population": 50}, stats.hypergeom(50, 20, 10)),
    "Negative Binomial": ({"probability": 0.25, "shape": 3}, stats.nbinom(3, 0.25, loc=3)),
    "Negbin": ({"probability": 0.25, "shape": 3}, stats.nbinom(3, 0.25)),
    "Poisson": ({"rate": 4}, stats.poisson(4)),
    "Yes-No": ({"probability": 0.25}, stats.bernoulli(0.25)),
}


def fits(draws, oracle):
    values, counts = np.unique(draws, return_counts=True)
    k = np.arange(values[0], values[-1] + 1)
    seen = np.zeros(k.size)
    seen[np.searchsorted(k, values)] = counts
    expected = draws.size * oracle.pmf(k)
    rest_below, rest_above = draws.size * oracle.cdf(k[0] - 1), draws.size * oracle.sf(k[-1])
    expected[0] += rest_below
    expected[-1] += rest_above
    large = expected >= 25
    cells = np.append(seen[large], seen[~large].sum()), np.append(expected[large], expected[~large].sum())
    used = cells[1] > 0
    return stats.chisquare(cells[0][used], cells[1][used]).pvalue


@pytest.mark.parametrize("name", CASES)
def test_constant_parameters(book, name):
    given, oracle = CASES[name]
    model = book({"A1": 1.0}, {"a": {"cell": "A1", "distribution": name, **given}}, {"x": "A1"})
    assert fits(model.sampler(999, TRIALS).draw(0)["a"], oracle) > LEVEL


@pytest.mark.parametrize("name", ["Binomial", "Geometric", "Hypergeometric", "Poisson", "Yes-No"])
def test_parameters_that_vary_by_trial(book, name):
    """The first parameter of each is drawn, too, from one of two values: the draws are a mixture."""
    key = next(iter(CASES[name][0]))
    low, high = {"probability": (0.25, 0.5), "success": (20, 30), "rate": (3, 5)}[key]
    given = {**CASES[name][0], key: "B1"}
    model = book(
        {"A1": 1.0, "A2": 0.0, "B1": f"={low}+{high - low}*A2"},
        {
            "which": {"cell": "A2", "distribution": "Yes-No", "probability": 0.5},
            "a": {"cell": "A1", "distribution": name, **given},
        },
        {"x": "A1"},
    )
    oracles = {
        "Binomial": (stats.binom(20, 0.25), stats.binom(20, 0.5)),
        "Geometric": (stats.geom(0.25), stats.geom(0.5)),
        "Hypergeometric": (stats.hypergeom(50, 20, 10), stats.hypergeom(50, 30, 10)),
        "Poisson": (stats.poisson(3), stats.poisson(5)),
        "Yes-No": (stats.bernoulli(0.25), stats.bernoulli(0.5)),
    }[name]
    draws = model.sampler(999, FEWER).draw(0)
    assert fits(draws["a"], Mixture(oracles)) > LEVEL


def test_truncated(book):
    given = {"distribution": "Poisson", "rate": 4, "lower_cutoff": 2, "upper_cutoff": 6}
    model = book({"A1": 1.0}, {"a": {"cell": "A1", **given}}, {"x": "A1"})
    draws = model.sampler(999, TRIALS).draw(0)["a"]
    shares = stats.poisson(4).pmf(np.arange(2, 7))
    values, counts = np.unique(draws, return_counts=True)
    np.testing.assert_array_equal(values, [2, 3, 4, 5, 6])
    assert stats.chisquare(counts, TRIALS * shares / shares.sum()).pvalue > LEVEL


def test_parameters_that_are_no_distribution_in_some_trials(book):
    given = {"cell": "A1", "distribution": "Binomial", "probability": 0.5, "trials": "B1"}
    model = book(
        {"A1": 1.0, "A2": 0.0, "B1": "=A2*2.5"},
        {"which": {"cell": "A2", "distribution": "Discrete Uniform", "low": 0, "high": 3}, "a": given},
        {"x": "A1"},
    )
    draws = model.sampler(999, 1000).draw(0)
    np.testing.assert_array_equal(np.isnan(draws["a"]), draws["which"] % 2 == 1)


class Mixture:
    """Two distributions, half and half."""

    def __init__(self, parts):
        self.parts = parts

    def __getattr__(self, name):
        return lambda k: sum(getattr(part, name)(k) for part in self.parts) / 2
