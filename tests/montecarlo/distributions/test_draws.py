"""100,000 draws of every family through the sampler, as a run makes them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, ByPercentiles
from xlmc.montecarlo.sampling.draws import Draw, DrawStage, Sampler

TRIALS, BLOCK, BINS = 100_000, 25_000, 500
CUMUL = FAMILIES["Cumul"].built(np.array([[1.0, 0.25], [1.5, 0.75]]))
GENERAL = FAMILIES["General"].built(np.array([[0.70, 2.0], [0.85, 2.0]]))
HISTOGRM = FAMILIES["Histogrm"].built(np.array([[1.0], [4.0], [2.0]]))
MEDIAN_7 = ByPercentiles(FAMILIES["Weibull"], ("location", "shape"), (50.0,))
LOGNORM = stats.lognorm(np.sqrt(np.log(1.09)), 0, 10 / np.sqrt(1.09))
CASES = {
    "Beta": (FAMILIES["Beta"], (10.0, 20.0, 0.5, 3.0), stats.beta(0.5, 3.0, 10, 10)),
    "BetaPERT": (FAMILIES["BetaPERT"], (0.0, 1.0, 4.0), stats.beta(2, 4, 0, 4)),
    "Exponential": (FAMILIES["Exponential"], (0.2,), stats.expon(0, 5)),
    "Gamma": (FAMILIES["Gamma"], (1.0, 2.0, 0.7), stats.gamma(0.7, 1, 2)),
    "Logistic": (FAMILIES["Logistic"], (3.0, 2.0), stats.logistic(3, 2)),
    "Lognormal": (FAMILIES["Lognormal"], (0.0, 10.0, 3.0), LOGNORM),
    "Lognorm2": (FAMILIES["Lognorm2"], (2.0, 1.0, 0.5), stats.lognorm(0.5, 2, np.e)),
    "Maximum Extreme": (FAMILIES["Maximum Extreme"], (3.0, 2.0), stats.gumbel_r(3, 2)),
    "Minimum Extreme": (FAMILIES["Minimum Extreme"], (3.0, 2.0), stats.gumbel_l(3, 2)),
    "Pareto": (FAMILIES["Pareto"], (10.0, 1.5), stats.pareto(1.5, scale=10)),
    "Student's t": (FAMILIES["Student's t"], (3.0, 2.0, 4.0), stats.t(4, 3, 2)),
    "Trigen": (FAMILIES["Trigen"], (1.0, 2.0, 3.0, 12.5, 87.5), stats.triang(0.5, 0, 4)),
    "Weibull": (FAMILIES["Weibull"], (1.0, 2.0, 2.5), stats.weibull_min(2.5, 1, 2)),
    "Weibull by median": (MEDIAN_7, (1.0, 2.0, 7.0), stats.weibull_min(2, 1, 6 / np.sqrt(np.log(2)))),
    "Cumul": (CUMUL, (0.5, 2.5), stats.rv_histogram((np.array([1, 2, 1]), [0.5, 1.0, 1.5, 2.5]), density=False)),
    "General": (GENERAL, (0.45, 1.05), stats.trapezoid(0.25 / 0.6, 0.4 / 0.6, 0.45, 0.6)),
    "Histogrm": (HISTOGRM, (0.0, 3.0), stats.rv_histogram((np.array([1, 4, 2]), [0.0, 1.0, 2.0, 3.0]))),
}


def drawn(family, parameters, cutoffs=None):
    draw = Draw("speed", family, parameters, cutoffs)
    sampler = Sampler(999, [DrawStage((draw,))], [], [], BLOCK)
    return np.concatenate([sampler.draw(start)["speed"].copy() for start in range(0, TRIALS, BLOCK)])


def p_value(draws, edges):
    """Chi-square of counts between edges that hold equal shares."""
    counts = np.bincount(np.searchsorted(edges, draws), minlength=BINS)
    return stats.chisquare(counts).pvalue


@pytest.mark.parametrize("name", CASES)
def test_draws_fit(name):
    """Chi-square over 500 bins of equal probability; a right family fails one seed in a thousand."""
    family, parameters, oracle = CASES[name]
    assert p_value(drawn(family, parameters), oracle.ppf(np.arange(1, BINS) / BINS)) > 1e-3


@pytest.mark.parametrize("name", ["Gamma", "Student's t", "Lognormal", "Weibull"])
def test_draws_of_an_upper_tail_fit(name):
    """Beyond the quantile of 1 - 1e-9: of a thousand million draws without cutoff, one."""
    family, parameters, oracle = CASES[name]
    cutoff = float(oracle.isf(1e-9))
    edges = oracle.isf(oracle.sf(cutoff) * (1 - np.arange(1, BINS) / BINS))
    draws = drawn(family, parameters, (cutoff, np.inf))
    assert draws.min() >= cutoff
    assert p_value(draws, edges) > 1e-3


def test_every_continuous_family_is_drawn():
    # The others are drawn by tests of their own; those of test_risk_families.py too.
    risk_alone = {
        family.name for family in FAMILIES.values() if family.elsewhere[:1] and "@RISK" in family.elsewhere[0]
    }
    by_percentiles = {family.name for family in FAMILIES.values() if family.roles} - risk_alone
    newer = by_percentiles - {"Triangular", "Trapezoid", "Normal", "Uniform"} | {
        "Trigen",
        "Cumul",
        "General",
        "Histogrm",
    }
    assert newer <= CASES.keys()
