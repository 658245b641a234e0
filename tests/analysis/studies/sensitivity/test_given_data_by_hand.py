"""The measures of given data made by hand: a regression in each class, and trials left out one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.sensitivity.given_data import (
    contributions,
    dependence,
    dependence_floor,
    explained_floor,
    explained_share,
    fit_lines,
    rank_correlation,
    standardise,
)
from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.analysis.studies.sensitivity.ranked import Ranked
from xlmc.montecarlo.statistics import Estimate


def columns(n, seed=1, ties=False):
    rng = np.random.default_rng(seed)
    x = rng.normal(size=n)
    y = np.sin(2.0 * x) + 0.5 * rng.normal(size=n)
    return (np.round(x, 1), np.round(y, 1)) if ties else (x, y)


def lines_by_hand(x, y, classes):
    """y's regression on x in each class, in ascending order of x."""
    order = np.argsort(x)
    result = np.empty(x.size)
    for start, size in zip(classes.starts, classes.sizes, strict=True):
        part = slice(start, start + size)
        if np.ptp(x[order][part]) > 0.0:
            result[part] = np.polyval(np.polyfit(x[order][part], y[order][part], 1), x[order][part])
        else:
            result[part] = y[order][part].mean()
    return order, result


@pytest.mark.parametrize(
    ("n", "classes", "freedom"), [(49, 1, 2), (99, 1, 2), (100, 2, 4), (799, 15, 30), (800, 16, 32), (5_000, 16, 32)]
)
def test_classes_are_sixteen_of_fifty_trials_or_more(n, classes, freedom):
    result = Ranked.of(columns(n)[0]).classes
    assert (result.sizes.size, result.freedom) == (classes, freedom)
    assert result.sizes.sum() == n
    assert np.ptp(result.sizes) <= 1
    assert result.label.tolist() == np.repeat(np.arange(classes), result.sizes).tolist()


@pytest.mark.parametrize(
    ("n", "counts"), [(31, [1]), (32, [1, 4]), (800, [16, 64]), (2_047, [16, 64]), (2_048, [16, 64, 256])]
)
def test_finer_classes_are_four_times_as_many_of_eight_trials_or_more(n, counts):
    assert [each.sizes.size for each in Ranked.of(columns(n)[0]).ladder] == counts


@pytest.mark.parametrize("n", [60, 400, 1_000])
@pytest.mark.parametrize("ties", [False, True])
def test_the_explained_share_is_that_of_regressions_in_classes(n, ties):
    x, y = columns(n, ties=ties)
    ranked = Ranked.of(x)
    order, fitted = lines_by_hand(x, y, ranked.classes)
    assert fit_lines(ranked.classes, y[order]) == pytest.approx(fitted, abs=1e-9)
    k = ranked.classes.freedom
    adjusted = 1.0 - (np.sum((y[order] - fitted) ** 2) / (n - k)) / (np.sum((y - y.mean()) ** 2) / (n - 1))
    assert explained_share(ranked, y, Units.of(n)).value == pytest.approx(adjusted, abs=1e-9)


@pytest.mark.parametrize("n", [60, 400])
@pytest.mark.parametrize("ties", [False, True])
def test_dependence_is_that_of_indicators(n, ties):
    """Pooled over the limits between the classes of y, each indicator explained as a share of variance is."""
    x, y = columns(n, ties=ties)
    ranked, other = Ranked.of(x), Ranked.of(y)
    residual = total = 0.0
    for limit in range(int(other.steps.max())):
        below = (other.steps <= limit).astype(float)
        order, fitted = lines_by_hand(x, below, ranked.classes)
        residual += np.sum((below[order] - fitted) ** 2)
        total += np.sum((below - below.mean()) ** 2)
    value = 1.0 - (residual / (n - ranked.classes.freedom)) / (total / (n - 1))
    assert dependence(ranked, other, Units.of(n)).value == pytest.approx(value, abs=1e-9)


def left_out(measure, *given):
    """The jackknife's standard error."""
    n = given[0].size
    values = [measure(*(np.delete(each, i) for each in given)) for i in range(n)]
    return math.sqrt((n - 1) * np.var(values))


@pytest.mark.parametrize("ties", [False, True])
@pytest.mark.parametrize("r", [0.0, 0.5, -0.9])
def test_the_error_of_a_rank_correlation_is_that_of_the_jackknife(r, ties):
    """They agree to the order of 1/n."""
    rng = np.random.default_rng(3)
    x = rng.normal(size=300)
    y = r * x + math.sqrt(1.0 - r * r) * rng.normal(size=300)
    x, y = (np.round(x, 1), np.round(y, 1)) if ties else (x, y)
    result = rank_correlation(Ranked.of(x), Ranked.of(y), Units.of(300))
    assert result.value == pytest.approx(stats.spearmanr(x, y).statistic, abs=1e-12)
    assert result.error == pytest.approx(left_out(lambda a, b: stats.spearmanr(a, b).statistic, x, y), rel=0.02)
    z, half = math.atanh(result.value), stats.t.ppf(0.975, 299) * result.error / (1.0 - result.value**2)
    assert result.interval == pytest.approx((math.tanh(z - half), math.tanh(z + half)))


def test_the_error_of_an_explained_share_is_near_that_of_the_jackknife():
    """Of one straight line, where the fit's own noise hardly counts."""
    rng = np.random.default_rng(4)
    x = rng.normal(size=99)
    y = 0.7 * x + 0.5 * rng.normal(size=99)
    result = explained_share(Ranked.of(x), y, Units.of(99))
    assert result.error == pytest.approx(left_out(lambda a, b: np.corrcoef(a, b)[0, 1] ** 2, x, y), rel=0.06)


def test_shares_of_very_few_trials_or_of_no_variation_are_not_known():
    x, y = columns(2)
    assert math.isnan(explained_share(Ranked.of(x), y, Units.of(2)).value)
    assert math.isnan(dependence(Ranked.of(x), Ranked.of(y), Units.of(2)).value)
    x, y = columns(3)
    assert not math.isnan(explained_share(Ranked.of(x), y, Units.of(3)).value)
    assert standardise(np.zeros(5)) is None
    assert standardise(np.full(5, 3.0)) is None
    assert standardise(1.0 + 1e-13 * np.arange(5.0)) is None
    assert standardise(1e300 * np.array([1.0, 3.0])) == pytest.approx([-1.0, 1.0])


@pytest.mark.parametrize(("n", "assumptions"), [(60, 1), (400, 1), (400, 10), (5_000, 3)])
def test_floors_are_quantiles_of_f_and_chi_square(n, assumptions):
    """An adjusted share with F = (fit/(k − 1))/(rest/(n − k)) is 1 − (n − 1)/((n − k) + (k − 1)·F)."""
    ranked = Ranked.of(columns(n)[0])
    k = ranked.classes.freedom
    f = stats.f.ppf(1.0 - 0.05 / assumptions, k - 1, n - k)
    assert explained_floor(ranked, assumptions) == pytest.approx(1.0 - (n - 1) / ((n - k) + (k - 1) * f))
    freedom = 2.5 * (k - 1)
    wanted = (stats.chi2.ppf(1.0 - 0.05 / assumptions, freedom) / freedom - 1.0) * (k - 1) / n
    assert dependence_floor(ranked, assumptions) == pytest.approx(wanted)
    assert math.isnan(explained_floor(Ranked.of(np.ones(50)), 1))
    assert math.isnan(dependence_floor(Ranked.of(np.ones(50)), 1))


def test_contributions_and_their_errors():
    """Shares r²/(Σr² + others), with the signs of r, and the errors of their first derivatives."""
    values, errors, others = np.array([0.6, -0.3, 0.1]), np.array([0.02, 0.03, 0.01]), 0.05
    given = [Estimate(r, e, None, 100) for r, e in zip(values, errors, strict=True)]
    result = contributions(given, others)
    total = np.sum(values**2) + others
    assert [each.value for each in result] == pytest.approx(np.sign(values) * values**2 / total)

    def share(r):
        return r**2 / (np.sum(r**2) + others)

    steps = np.eye(3) * 1e-6
    slopes = np.array([(share(values + step) - share(values - step)) / 2e-6 for step in steps]).T
    assert [each.error for each in result] == pytest.approx(np.sqrt((slopes**2) @ errors**2), rel=1e-6)
    assert {each.n for each in result} == {100}


def test_contributions_of_what_is_not_known():
    unknown, plain = Estimate(math.nan, None, None, 50), Estimate(0.5, None, None, 50)
    first, second = contributions([unknown, plain])
    assert math.isnan(first.value)
    assert (second.value, second.error) == (1.0, None)
    assert all(math.isnan(each.value) for each in contributions([unknown, unknown]))
    assert math.isnan(contributions([Estimate(0.0, 0.1, None, 50)])[0].value)


def test_units_count_replicates():
    units = Units.of(6, np.array([7, 7, 3, 3, 9, 9]))
    assert (units.count, units.dof) == (3, 2.0)
    pulls = np.array([1.0, 2.0, -1.0, -3.0, 0.5, 0.5])
    sums = np.array([3.0, -4.0, 1.0])
    assert units.error(pulls) == pytest.approx(math.sqrt(np.sum(sums**2) * 3 / 2) / 6)
    assert Units.of(6).error(pulls) == pytest.approx(math.sqrt(np.sum(pulls**2) * 6 / 5) / 6)
    assert Units.of(6).error(1e300 * pulls) == pytest.approx(1e300 * Units.of(6).error(pulls))
    assert math.isnan(Units.of(1).error(np.zeros(1)))
    plain = Units.of(6).error(pulls)
    assert Units.of(6).error_of_fit(pulls, 0.1) == pytest.approx(math.sqrt(plain**2 - 0.01))
    assert Units.of(6).error_of_fit(pulls, 0.9 * plain) == pytest.approx(0.9 * plain)  # never below the fit's own
