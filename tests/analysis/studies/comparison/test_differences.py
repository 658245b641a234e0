"""Two runs of a few trials each, compared by hand and by SciPy."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import ks_2samp, wasserstein_distance

from xlmc.analysis.studies.comparison.differences import (
    Change,
    _distance_of_shares,
    _of_deviations,
    _relative,
    acceptance,
    difference,
)
from xlmc.analysis.studies.comparison.paired_statistics import Accepted
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics import Estimate


def run_of(values, trials=None, kind=Kind.NUMBER, texts=()):
    values = np.asarray(values, np.float64)
    return Accepted.of(np.arange(values.size) if trials is None else np.asarray(trials), values, kind, texts)


FIRST, SECOND = [1.0, 2.0, 3.0, 4.0, 10.0], [1.5, 2.0, 2.0, 7.0, 11.5]


def test_statistics_of_both_and_their_differences():
    result = difference(run_of(FIRST), run_of(SECOND), 0.5)
    assert (result.mean.first.value, result.mean.second.value) == pytest.approx((4.0, 4.8))
    assert result.mean.difference.value == pytest.approx(0.8)
    apart = np.array(SECOND) - FIRST
    assert result.mean.difference.error == pytest.approx(apart.std(ddof=1) / math.sqrt(5))
    deviations = np.std(FIRST, ddof=1), np.std(SECOND, ddof=1)
    assert (result.standard_deviation.first.value, result.standard_deviation.second.value) == pytest.approx(deviations)
    assert result.standard_deviation.difference.value == pytest.approx(deviations[1] - deviations[0])
    ends = (result.low.first.value, result.high.first.value, result.low.second.value, result.high.second.value)
    assert ends == pytest.approx((*np.quantile(FIRST, [0.25, 0.75]), *np.quantile(SECOND, [0.25, 0.75])), abs=0.6)
    assert ends[0] < ends[1]
    assert result.largest == 3
    assert result.typical == pytest.approx(math.sqrt((0.25 + 0 + 1 + 9 + 2.25) / 5))
    assert result.above is None
    assert result.share == 0.5


def test_only_trials_that_both_accept_are_compared_one_by_one():
    result = difference(run_of([1.0, 2.0, 9.0], [0, 1, 2]), run_of([5.0, 4.0, 9.0], [5, 1, 6]), 0.5)
    assert (result.largest, result.typical) == (2, 2)
    none = difference(run_of([1.0, 2.0], [0, 1]), run_of([3.0, 4.0], [2, 3]), 0.5)
    assert math.isnan(none.largest)
    assert math.isnan(none.typical)


def test_probabilities_above_a_threshold():
    result = difference(run_of(FIRST), run_of(SECOND), 0.5, threshold=2.0)
    assert (result.above.first.value, result.above.second.value) == (0.6, 0.4)
    assert result.above.difference.value == pytest.approx(-0.2)
    assert [name for name, _ in result.changes] == ["mean", "SD", "lower end", "upper end", "P(> 2)"]


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("shared", [True, False])
def test_distances_are_those_of_scipy(seed, shared):
    rng = np.random.default_rng(seed)
    x, y = rng.normal(size=200), rng.gumbel(size=300)
    result = difference(run_of(x), run_of(y, np.arange(300) + (0 if shared else 200)), 0.5)
    assert result.kolmogorov.value == pytest.approx(ks_2samp(x, y).statistic)
    assert result.wasserstein.value == pytest.approx(wasserstein_distance(x, y))
    assert (result.kolmogorov.n, result.wasserstein.n) == (200, 200)


def test_the_error_of_a_distance_by_hand():
    """One run is the other shifted by 1: F - G has one sign, and W is the difference of means.

    G(x) - F(x) is largest, 1/4, where one value less of the second lies below; at 0, F is 1/4 and G is 0.
    """
    x = np.array([0.0, 2.0, 4.0, 6.0])
    apart = difference(run_of(x), run_of(x + 1, [10, 11, 12, 13]), 0.5)
    assert apart.wasserstein.value == pytest.approx(1)
    variance = x.var()
    # the potential rises with slope 1 where F > G, and stands still where they are equal: 0, 1, 1, 2, 2, 3, 3, 4
    mine, theirs = np.array([0.0, 1.0, 2.0, 3.0]), np.array([1.0, 2.0, 3.0, 4.0])
    squares = ((mine - mine.mean()) ** 2).sum() / 16 + ((theirs - theirs.mean()) ** 2).sum() / 16
    assert apart.wasserstein.error == pytest.approx(math.sqrt(squares * 4 / 3), rel=0.16)
    assert apart.wasserstein.error < math.sqrt(2 * variance / 3)
    assert apart.kolmogorov.value == pytest.approx(0.25)
    assert apart.kolmogorov.error == pytest.approx(math.sqrt(3 / 4 * 1 / 4 / 4), rel=0.16)


def test_nothing_is_known_of_no_trials():
    result = difference(run_of([]), run_of([1.0, 2.0]), 0.5)
    assert math.isnan(result.kolmogorov.value)
    assert math.isnan(result.wasserstein.value)


YES, NO = 1.0, 0.0


def test_shares_of_yes():
    first = run_of([YES, YES, NO, NO, NO], kind=Kind.YES_NO)
    second = run_of([YES, NO, NO, NO, NO], kind=Kind.YES_NO)
    result = difference(first, second, 0.5)
    ((name, change),) = result.changes
    assert name == "P(yes)"
    assert (change.first.value, change.second.value) == (0.4, 0.2)
    assert change.difference.value == pytest.approx(-0.2)
    assert result.kolmogorov.value == result.wasserstein.value == pytest.approx(0.2)
    deviations = [math.sqrt(p * (1 - p) * 5 / 4) for p in (0.4, 0.2)]
    assert [result.standard_deviation.first.value, result.standard_deviation.second.value] in (
        pytest.approx(deviations),
        pytest.approx([math.sqrt(p * (1 - p)) for p in (0.4, 0.2)]),
    )
    assert result.largest == 1


def test_shares_of_texts():
    first = run_of([0, 0, 1, 1], kind=Kind.CATEGORY, texts=("dry", "wet"))
    second = run_of([1, 0, 0, 0], kind=Kind.CATEGORY, texts=("wet", "dry"))
    result = difference(first, second, 0.5)
    shares = {name: (each.first.value, each.second.value) for name, each in result.changes}
    assert shares == {"P(dry)": (0.5, 0.25), "P(wet)": (0.5, 0.75)}
    assert result.largest == 1
    assert result.typical == pytest.approx(math.sqrt(1 / 4))  # one of four trials has another text
    for each in (result.mean, result.standard_deviation, result.low, result.high):
        assert all(math.isnan(number.value) for number in (each.first, each.second, each.difference))
    assert math.isnan(result.kolmogorov.value)


def test_texts_beside_numbers_have_nothing_in_common():
    result = difference(run_of([0, 0], kind=Kind.CATEGORY, texts=("dry",)), run_of([1.0, 2.0]), 0.5)
    assert result.shares == {}
    assert math.isnan(result.largest)
    assert math.isnan(result.typical)


@pytest.mark.parametrize(
    ("stated", "chance", "expected"),
    [
        (0.5, None, {"mean": 0.5, "SD": 0.5, "lower end": 0.5, "upper end": 0.5}),
        (0.5, 0.02, {"mean": 0.5, "SD": 0.5, "lower end": 0.5, "upper end": 0.5, "P(> 2)": 0.02}),
    ],
)
def test_tolerances_of_numbers(stated, chance, expected):
    result = difference(run_of(FIRST), run_of(SECOND), 0.5, threshold=2.0 if chance else None)
    assert result.tolerances(stated, chance) == expected


@pytest.mark.parametrize(("stated", "chance", "expected"), [(0.1, None, 0.1), (0.1, 0.02, 0.1), (math.nan, 0.02, 0.02)])
def test_tolerances_of_shares(stated, chance, expected):
    result = difference(run_of([YES, NO], kind=Kind.YES_NO), run_of([NO, NO], kind=Kind.YES_NO), 0.5)
    assert result.tolerances(stated, chance) == {"P(yes)": expected}


@pytest.mark.parametrize(
    ("both", "mine", "theirs", "value", "error"),
    [
        (80, 20, 0, -0.2, 0.8 * math.sqrt(20 / 100**2 + 80 * (1 / 80 - 1 / 100) ** 2)),
        (0, 100, 50, -0.5, 0.5 * math.sqrt(1 / 100 + 1 / 50)),
        (100, 0, 0, 0.0, 0.01),  # never less than that of one trial more
        (0, 10, 0, -1.0, 0.1),
    ],
)
def test_how_many_more_are_accepted(both, mine, theirs, value, error):
    result = _relative(both, mine, theirs)
    assert (result.value, result.error, result.n) == pytest.approx((value, error, both + mine))


def test_nothing_accepted():
    assert math.isnan(_relative(0, 0, 5).value)


def test_accepted_by_both_or_by_one():
    def run(*trials):
        return SimpleNamespace(trial_index=np.array(trials), accepted=len(trials), acceptance=Estimate(len(trials) / 9))

    result = acceptance(run(0, 2, 3, 5), run(2, 5, 7))
    assert (result.both, result.first_only, result.second_only) == (2, 2, 1)
    assert result.relative.value == pytest.approx(-0.25)
    assert (result.first.value, result.second.value) == (4 / 9, 3 / 9)


@pytest.mark.parametrize(
    ("value", "interval", "expected"),
    [
        (-0.2, (-0.3, -0.1), (0.1, 0.3)),
        (0.2, (0.1, 0.3), (0.1, 0.3)),
        (-0.1, (-0.3, 0.1), (0.0, 0.3)),
        (0.1, (0.0, 0.3), (0.0, 0.3)),
        (-0.1, None, None),
    ],
)
def test_the_distance_of_shares_has_no_sign(value, interval, expected):
    result = _distance_of_shares(Estimate(value, 0.1, interval, 10))
    assert (result.value, result.interval) == (abs(value), expected)


@pytest.mark.parametrize(("first", "second"), [(0.0, 0.0), (0.1, 0.3), (0.4, 0.5)])
def test_deviations_of_shares_are_known_no_better_than_after_one_more_yes(first, second):
    from xlmc.montecarlo.statistics.proportions import least_error

    n = 50
    low, high = (Estimate(math.sqrt(p * (1 - p)), 0.0, None, n) for p in (first, second))
    apart = Estimate(high.value - low.value, 1e-9, None, n)
    result = _of_deviations(Change(low, high, apart))
    moved = min(first + least_error(n), 0.5)
    assert result.error == pytest.approx(math.sqrt(moved * (1 - moved)) - low.value)
    assert result.value == apart.value
    known = Estimate(apart.value, 0.4, None, n)
    assert _of_deviations(Change(low, high, known)).error == 0.4
    unknown = Estimate(apart.value, None, None, n)
    assert _of_deviations(Change(low, high, unknown)) is unknown
