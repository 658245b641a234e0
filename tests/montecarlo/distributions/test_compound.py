"""Sums of a random number of amounts: moments, draws against an independent sampler, and what a draw depends on."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.distributions import FAMILIES, Truncated
from xlmc.montecarlo.distributions.compound import Compound, Part
from xlmc.montecarlo.distributions.discrete_uniform import DiscreteUniform

POISSON, EXPONENTIAL, NORMAL = FAMILIES["Poisson"], FAMILIES["Exponential"], FAMILIES["Normal"]
CLAIMS = Compound(Part("frequency", POISSON), Part("severity", EXPONENTIAL))
INSURED = Compound(Part("frequency", POISSON), Part("severity", EXPONENTIAL), deductible=True, limit=True)
LIMITED = Compound(Part("frequency", POISSON), Part("severity", EXPONENTIAL), limit=True)
DEDUCTED = Compound(Part("frequency", POISSON), Part("severity", EXPONENTIAL), deductible=True)
CUT_BOTH = Compound(Part("frequency", POISSON), Part("severity", FAMILIES["Uniform"], lower=True, upper=True))
DICE = Compound(Part("frequency", DiscreteUniform()), Part("severity", DiscreteUniform()))
N = 50_000


def uniforms(seed, n=N):
    return np.random.default_rng(seed).integers(1, 2**53, size=n) * 2.0**-53


def insured_moments(scale, deductible, limit):
    """Mean and mean square of min(max(Y - d, 0), L) for an exponential Y: the integrals of its tail."""
    at, rest = np.exp(-deductible / scale), np.exp(-limit / scale)
    return at * scale * (1 - rest), at * 2 * scale * (scale - (scale + limit) * rest)


CUT = (1 - 2 / np.e) / (1 - 1 / np.e), (2 - 5 / np.e) / (1 - 1 / np.e)
"""Mean and mean square of an exponential amount of rate 1 that is not above 1."""

CASES = {
    "claims": (CLAIMS, (5.0, 1e-3), 5000.0, 5 * 2e6),
    "few": (CLAIMS, (0.3, 1.0), 0.3, 0.6),
    "insured": (INSURED, (5.0, 1e-3, 500.0, 2000.0), *(5 * each for each in insured_moments(1000, 500, 2000))),
    "dice": (DICE, (1.0, 6.0, 1.0, 6.0), 3.5**2, 3.5 * 35 / 12 + 35 / 12 * 3.5**2),
    "a fixed number": (Compound(Part("frequency"), Part("severity", NORMAL)), (3.9, 10.0, 2.0), 30.0, 12.0),
    "fixed amounts": (Compound(Part("frequency", POISSON), Part("severity")), (5.0, 10.0), 50.0, 500.0),
    "cut and shifted": (
        Compound(Part("frequency", POISSON), Part("severity", NORMAL, lower=True, shifted=True)),
        (2.0, 0.0, 1.0, 0.0, 3.0),
        2 * (3 + np.sqrt(2 / np.pi)),
        2 * (1 + 6 * np.sqrt(2 / np.pi) + 9),
    ),
    "up to a limit": (LIMITED, (5.0, 1e-3, 2000.0), *(5 * each for each in insured_moments(1000, 0, 2000))),
    "above a deductible": (DEDUCTED, (5.0, 1e-3, 500.0), *(5 * each for each in insured_moments(1000, 500, 1e5))),
    "a limit below all amounts": (LIMITED, (5.0, 1e-3, 0.0), 0.0, 0.0),
    "fixed amounts above a deductible": (
        Compound(Part("frequency", POISSON), Part("severity"), deductible=True, limit=True),
        (5.0, 10.0, 3.0, 5.0),
        25.0,
        125.0,
    ),
    "cut at both ends": (
        CUT_BOTH,
        (2.0, 0.0, 10.0, 2.0, 5.0),
        2 * 3.5,
        2 * (5**3 - 2**3) / 9,
    ),
    "cut above, and shifted": (
        Compound(Part("frequency", POISSON), Part("severity", EXPONENTIAL, upper=True, shifted=True)),
        (2.0, 1.0, 1.0, 0.5),
        2 * (CUT[0] + 0.5),
        2 * (CUT[1] + CUT[0] + 0.25),
    ),
    "a shifted limit": (
        Compound(Part("frequency", POISSON), Part("severity", EXPONENTIAL, shifted=True), deductible=True, limit=True),
        (5.0, 1e-3, 500.0, 1000.0, 2000.0),
        *(5 * each for each in insured_moments(1000, 500, 2000)),
    ),
    "a count that is cut": (
        Compound(Part("frequency", DiscreteUniform(), upper=True), Part("severity")),
        (1.0, 6.0, 4.5, 2.0),
        5.0,
        5.0,
    ),
    "a count that is shifted": (
        Compound(Part("frequency", DiscreteUniform(), shifted=True), Part("severity", NORMAL)),
        (1.0, 4.0, 2.0, 10.0, 2.0),
        45.0,
        4.5 * 4 + 125.0,
    ),
    "a count with a fraction": (
        Compound(Part("frequency", FAMILIES["Uniform"]), Part("severity")),
        (0.0, 4.0, 1.0),
        1.5,
        1.25,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_moments_and_draws(name):
    """Mean and variance as in the formulas, and those of the draws within 4 standard errors."""
    family, params, mean, variance = CASES[name]
    assert family.fault(*params) is None
    sampled = 1e-4 if "a count" in name else 1e-9
    assert family.mean(*params) == pytest.approx(mean, rel=sampled)
    assert family.variance(*params) == pytest.approx(variance, rel=sampled)
    drawn = family.ppf(uniforms(7), *params)
    assert abs(drawn.mean() - mean) <= 4 * np.sqrt(variance / N)
    spread = (drawn - mean) ** 2
    assert abs(spread.mean() - variance) <= 4 * spread.std() / np.sqrt(N)


def test_against_an_independent_sampler():
    """Kolmogorov-Smirnov of 50,000 draws with NumPy's: a right one fails one seed in a thousand."""
    rng = np.random.default_rng(11)
    counts = rng.poisson(5.0, N)
    amounts = np.minimum(np.maximum(rng.exponential(1000.0, counts.sum()) - 500, 0), 2000)
    other = np.bincount(np.repeat(np.arange(N), counts), amounts, N)
    assert stats.ks_2samp(INSURED.ppf(uniforms(3), 5.0, 1e-3, 500.0, 2000.0), other).pvalue > 1e-3


def test_one_amount_is_the_amount():
    drawn = Compound(Part("frequency"), Part("severity", EXPONENTIAL)).ppf(uniforms(5), 1.0, 2.0)
    assert stats.kstest(drawn, stats.expon(0, 0.5).cdf).pvalue > 1e-3


def test_a_draw_depends_on_its_uniform_alone():
    """Whatever stands beside it, and whether parameters are numbers or vary by trial."""
    u = uniforms(1, 1000)
    whole = INSURED.ppf(u, 5.0, 1e-3, 500.0, 2000.0)
    np.testing.assert_array_equal(INSURED.ppf(u[400:500], 5.0, 1e-3, 500.0, 2000.0), whole[400:500])
    columns = [np.full(1000, value) for value in (5.0, 1e-3, 500.0, 2000.0)]
    np.testing.assert_array_equal(INSURED.ppf(u, *columns), whole)


def test_trials_without_a_distribution_are_nan():
    result = CLAIMS.ppf(uniforms(1, 3), np.array([5.0, -1.0, 5.0]), np.array([1.0, 1.0, np.nan]))
    np.testing.assert_array_equal(np.isnan(result), [False, True, True])


def test_ranks_are_those_of_the_count_and_percentiles_those_of_the_sums():
    u = uniforms(2, 1000)
    member = CLAIMS.checked(5.0, 1e-3)
    np.testing.assert_array_equal(member.order(u), POISSON.ppf(u, 5.0))
    drawn = CLAIMS.ppf(uniforms(9), 5.0, 1e-3)
    for p in (0.1, 0.5, 0.9):
        share = np.mean(drawn <= member.percentile(np.array([p]))[0])
        assert abs(share - p) < 5 * np.sqrt(p * (1 - p) * (1 / N + 1 / 65536))


@pytest.mark.parametrize(
    ("family", "params", "key", "message"),
    [
        (CLAIMS, (-1.0, 1.0), "frequency rate", "Frequency: Rate (-1) must be from 0 to 1,000,000,000"),
        (CLAIMS, (5.0, 0.0), "severity rate", "Severity: Rate (0) must be above 0"),
        (CLAIMS, (5e6, 1.0), "frequency rate", "Frequency may be 5,018,258, and at most 1,000,000 amounts are added"),
        (INSURED, (5.0, 1.0, 0.0, -1.0), "limit", "Limit (-1) must be 0 or more"),
        (
            Compound(Part("frequency", POISSON), Part("severity", NORMAL, lower=True, upper=True)),
            (5.0, 0.0, 1.0, 2.0, 1.0),
            "severity lower cutoff",
            "Severity: Lower cutoff (2) is not below Upper cutoff (1)",
        ),
    ],
)
def test_bad_parameters(family, params, key, message):
    fault = family.fault(*params)
    assert (fault.key, fault.message) == (key, message)
    assert fault.hint


def test_it_cannot_be_cut_off():
    fault = Truncated(CLAIMS).fault(-np.inf, 100.0, 5.0, 1.0)
    assert (fault.key, fault.message) == ("upper_cutoff", "Compound cannot be cut off")


@pytest.mark.parametrize(
    ("family", "good", "bad"),
    [
        (CLAIMS, (5.0, 1.0), [(-1.0, 1.0), (5.0, 0.0), (np.nan, 1.0), (5.0, np.inf)]),
        (INSURED, (5.0, 1.0, -2.0, 0.0), [(5.0, 1.0, 0.0, -1.0), (5.0, 1.0, np.inf, 1.0), (-1.0, 1.0, 0.0, 1.0)]),
        (CUT_BOTH, (2.0, 0.0, 9.0, 2.0, 5.0), [(2.0, 0.0, 9.0, 5.0, 5.0), (2.0, 9.0, 0.0, 2.0, 5.0)]),
        (CASES["fixed amounts"][0], (5.0, -10.0), [(-5.0, 10.0), (5.0, np.nan)]),
    ],
)  # fmt: skip
def test_where_parameters_are_a_distribution(family, good, bad):
    columns = np.array([good, *bad, good]).T
    np.testing.assert_array_equal(family.valid(*columns), [True, *[False] * len(bad), True])
    np.testing.assert_array_equal(np.isnan(family.ppf(uniforms(1, len(bad) + 2), *columns)), ~family.valid(*columns))


def test_many_amounts_are_drawn_in_pieces():
    """More than half a million together, beside trials with none, and one trial alone with more than that."""
    fixed = Compound(Part("frequency"), Part("severity", EXPONENTIAL))
    counts = np.array([0.0, 400_000.0, 300_000.0, 0.0, 700_000.0, 1.0, 0.0])
    u = uniforms(4, counts.size)
    sums = fixed.ppf(u, counts, 2.0)
    alone = [fixed.ppf(u[i : i + 1], count, 2.0)[0] for i, count in enumerate(counts)]
    np.testing.assert_array_equal(sums, alone)
    assert (np.abs(sums - counts / 2) <= 4 * np.sqrt(counts) / 2).all()
    assert (sums[counts == 0] == 0).all()


def test_the_most_amounts_of_one_draw():
    fixed = Compound(Part("frequency"), Part("severity"))
    assert fixed.fault(1_000_000.0, 1.0) is None
    assert fixed.fault(1_000_001.0, 1.0).key == "frequency"
    assert fixed.ppf(uniforms(1, 1), 1_000_000.0, 2.0) == 2_000_000.0
