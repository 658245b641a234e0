"""The measures that need nothing but trials, against closed forms.

A value must lie within 4 of its standard errors of the truth (6·10⁻⁵ a comparison, with fixed seeds). Errors: the
spread of 300 independent values is known to 1/√600 = 4.1 %, and must agree with the mean stated error to 4 times that
and 8 % for what is only true of many trials.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from xlmc.analysis.studies.sensitivity.given_data import (
    contributions,
    dependence,
    dependence_floor,
    explained_floor,
    explained_share,
    rank_correlation,
)
from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.analysis.studies.sensitivity.ranked import Ranked
from xlmc.montecarlo import statistics
from xlmc.montecarlo.statistics import Estimate

COLUMNS = st.integers(30, 200).flatmap(
    lambda n: st.tuples(*[arrays(np.float64, n, elements=st.integers(-20, 20).map(float))] * 2)
)


def gaussian(rng, n, r):
    x = rng.normal(size=n)
    return x, r * x + math.sqrt(1.0 - r * r) * rng.normal(size=n)


def cramer_von_mises(r):
    """Of two normals with correlation r (Chatterjee 2021, section 4)."""
    return 3.0 / math.pi * math.asin((1.0 + r * r) / 2.0) - 0.5


def spearman(r):
    return 6.0 / math.pi * math.asin(r / 2.0)


def found(x, y):
    ranked, other, units = Ranked.of(x), Ranked.of(y), Units.of(x.size)
    return rank_correlation(ranked, other, units), explained_share(ranked, y, units), dependence(ranked, other, units)


def near(estimate, truth):
    return abs(estimate.value - truth) < 4.0 * estimate.error


@pytest.mark.parametrize("r", [0.0, 0.3, -0.7, 0.95])
@pytest.mark.parametrize("n", [500, 4000])
def test_linear_gaussian(r, n):
    rank, share, index = found(*gaussian(np.random.default_rng(7), n, r))
    assert near(rank, spearman(r))
    assert near(share, r * r)
    assert near(index, cramer_von_mises(r))


@pytest.mark.parametrize("r", [0.0, 0.9])
def test_errors_are_the_spread_between_runs(r):
    rng = np.random.default_rng(11)
    runs = [found(*gaussian(rng, 800, r)) for _ in range(300)]
    for each in zip(*runs, strict=True):
        spread = np.std([estimate.value for estimate in each], ddof=1)
        assert np.mean([estimate.error for estimate in each]) == pytest.approx(spread, rel=4 * 0.041 + 0.08)


@pytest.mark.parametrize("r", [0.0, 0.5])
def test_shares_have_no_bias(r):
    """The mean of 300 runs is known to a 17th of one run's error; 4 times that is asked."""
    rng = np.random.default_rng(12)
    runs = [found(*gaussian(rng, 400, r))[1] for _ in range(300)]
    mean, error = np.mean([each.value for each in runs]), np.mean([each.error for each in runs])
    assert abs(mean - r * r) < 4.0 * error / math.sqrt(300)


def test_noise_stays_below_the_floor_as_often_as_it_says():
    """Of 200 tables with 5 assumptions without influence 5 % exceed a floor; 25 is the binomial's 1 − 10⁻⁵ point."""
    rng = np.random.default_rng(13)
    beyond = np.zeros(2)
    for _ in range(200):
        y = rng.exponential(size=300)
        other, units, above = Ranked.of(y), Units.of(300), np.zeros(2, bool)
        for _ in range(5):
            x = Ranked.of(rng.random(300))
            above[0] |= explained_share(x, y, units).value > explained_floor(x, 5)
            above[1] |= dependence(x, other, units).value > dependence_floor(x, 5)
        beyond += above
    assert (beyond <= 25).all()
    assert (beyond >= 2).all()  # and the floor is not so high that nothing reaches it


def test_what_only_widens_the_forecast_is_seen_by_dependence_alone():
    rng = np.random.default_rng(14)
    x = rng.uniform(-1.0, 1.0, 4000)
    y = (1.0 + 0.8 * x) * rng.normal(size=4000)
    ranked, units = Ranked.of(x), Units.of(4000)
    assert near(explained_share(ranked, y, units), 0.0)
    assert dependence(ranked, Ranked.of(y), units).value > 10.0 * dependence_floor(ranked, 1)


def test_an_effect_that_rises_and_falls_has_no_rank_correlation_but_is_explained():
    rng = np.random.default_rng(15)
    x = rng.uniform(-1.0, 1.0, 5000)
    rank, share, _ = found(x, x * x + 0.1 * rng.normal(size=5000))
    assert near(rank, 0.0)
    assert near(share, (4 / 45) / (4 / 45 + 0.01))


@pytest.mark.parametrize(
    ("x", "y", "truth"),
    [
        ("sum", 0, 1 / 4),  # E[Y | X] = (1 + X)/2, Var X = Var Y = 1/18
        ("difference", 0, 3 / 4),  # E[Y | X] = (3X − 1)/2, Var Y = 1/6
        ("first", 1, 1 / 4),  # in no formula of Y, only in the filter: E[Y | X] = (1 − X)/2
    ],
)
def test_among_trials_that_passed_a_filter(x, y, truth):
    """Uniform on the triangle a + b ≤ 1, a, b ≥ 0."""
    draws = np.random.default_rng(16).random((2, 20_000))
    draws = draws[:, draws.sum(axis=0) <= 1.0]
    answers = {"sum": draws.sum(axis=0), "difference": draws[0] - draws[1], "first": draws[0]}
    assert near(found(draws[y], answers[x])[1], truth)


def test_a_yes_or_no_assumption():
    rng = np.random.default_rng(17)
    x = (rng.random(6000) < 0.03).astype(float)
    _, share, _ = found(x, x + rng.normal(size=6000))
    assert near(share, 0.0291 / 1.0291)


def test_a_forecast_that_is_the_assumption_is_explained_whole():
    x = np.random.default_rng(18).normal(size=3000)
    rank, share, index = found(x, 3.0 * x - 1.0)
    assert (rank.value, rank.error) == (1.0, 0.0)
    assert share.value == pytest.approx(1.0, abs=1e-12)
    assert index.value > 0.95


@settings(max_examples=60)
@given(COLUMNS)
def test_the_rank_correlation_is_that_of_the_statistics(columns):
    x, y = columns
    units = Units.of(x.size)
    mine, theirs = rank_correlation(Ranked.of(x), Ranked.of(y), units), statistics.rank_correlation(x, y)
    assert mine.value == pytest.approx(theirs.value, abs=1e-12, nan_ok=True)


@settings(max_examples=60)
@given(COLUMNS)
def test_rank_measures_do_not_know_the_scale(columns):
    """Cubing is exact in these numbers, rising, and bends."""
    x, y = columns
    units = Units.of(x.size)
    plain, bent = (rank_correlation(Ranked.of(x), Ranked.of(each), units) for each in (y, y**3))
    assert plain == bent or math.isnan(plain.value)
    first, second = (dependence(Ranked.of(x), Ranked.of(each), units) for each in (y, y**3))
    assert first == second or math.isnan(first.value)


@settings(max_examples=60)
@given(COLUMNS, st.floats(0.01, 100.0), st.floats(-100.0, 100.0))
def test_the_share_does_not_know_the_unit(columns, factor, offset):
    x, y = columns
    units = Units.of(x.size)
    plain, other = explained_share(Ranked.of(x), y, units), explained_share(Ranked.of(x), factor * y + offset, units)
    assert other.value == pytest.approx(plain.value, abs=1e-6, nan_ok=True)


@given(st.lists(st.integers(-500, 500).map(lambda n: n / 500), min_size=1, max_size=12))
def test_contributions_add_up_to_one_and_keep_their_signs(values):
    shares_found = contributions([Estimate(value, 0.01, None, 100) for value in values])
    if any(value**2 for value in values):
        assert sum(abs(each.value) for each in shares_found) == pytest.approx(1.0)
        assert all(each.value * value >= 0.0 for each, value in zip(shares_found, values, strict=True))
    else:
        assert all(math.isnan(each.value) for each in shares_found)


def test_a_column_that_does_not_vary_says_nothing():
    still, moving = np.full(100, 2.5), np.random.default_rng(19).normal(size=100)
    assert all(math.isnan(each.value) for each in found(moving, still))
    assert math.isnan(found(still, moving)[0].value)
    assert found(still, moving)[1].value == pytest.approx(0.0, abs=1e-9)


def test_replicates_count_as_one_unit_each():
    """Trials that all stand twice have the error of half as many; as replicates of two it is told."""
    rng = np.random.default_rng(20)
    x, y = (np.repeat(column, 2) for column in gaussian(rng, 1000, 0.5))
    pairs = Units.of(2000, np.repeat(np.arange(1000), 2))
    alone, joined = (rank_correlation(Ranked.of(x), Ranked.of(y), units) for units in (Units.of(2000), pairs))
    assert joined.error == pytest.approx(alone.error * math.sqrt(2.0), rel=0.01)


def test_classes_of_the_largest_numbers_are_those_of_their_size():
    values = np.linspace(-1.0, 1.0, 2_001) ** 3
    plain, huge = Ranked.of(values).classes, Ranked.of(values * 1.7e308).classes
    np.testing.assert_array_equal(huge.label, plain.label)
    np.testing.assert_allclose(huge.squares, plain.squares, rtol=1e-12)
