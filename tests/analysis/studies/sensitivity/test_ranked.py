"""Order, grades and classes of a column, counted by hand and by SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.sensitivity.ranked import Ranked, _squarable

TIED = np.array([3.0, 1.0, 3.0, 2.0, 3.0])


def test_ties_of_five_values():
    """In order they are 1, 2, 3, 3, 3."""
    first, end = Ranked.of(TIED).ties
    assert first.tolist() == [0, 1, 2, 2, 2]
    assert end.tolist() == [1, 2, 5, 5, 5]


@pytest.mark.parametrize("x", [TIED, np.random.default_rng(1).normal(size=31)], ids=["tied", "normal"])
def test_grades_are_mean_ranks(x):
    ranked = Ranked.of(x)
    np.testing.assert_allclose(ranked.grades, (stats.rankdata(x) - 0.5) / x.size - 0.5, atol=1e-14)
    assert ranked.grades.sum() == pytest.approx(0, abs=1e-12)
    assert ranked.spread == pytest.approx(np.mean(ranked.grades**2))
    assert ranked.n == x.size


def test_the_spread_of_grades():
    assert Ranked.of(np.arange(1000.0)).spread == pytest.approx(1 / 12, rel=1e-5)
    assert Ranked.of(np.ones(7)).spread == 0
    assert not Ranked.of(np.ones(7)).varies
    assert Ranked.of(TIED).varies


def test_amounts_above_a_value_count_whole_and_those_beside_it_half():
    amounts = np.array([4.0, -1.0, -5.0, 3.0, -1.0])
    above = [
        (amounts[value < TIED].sum() + amounts[value == TIED].sum() / 2) / TIED.size for value in TIED
    ]  # fmt: skip
    np.testing.assert_allclose(Ranked.of(TIED).above(amounts), above, atol=1e-14)


def test_pulls_are_the_derivative_of_the_spread():
    """A trial that counts a little more moves the spread by its pull, so the mean of pulls is 0."""
    x = np.random.default_rng(2).normal(size=40)
    ranked, more, by = Ranked.of(x), np.ones(40), 1e-6

    def spread(weights):
        share = weights / weights.sum()
        grades = np.array([share[x < each].sum() + share[x == each].sum() / 2 for each in x]) - 0.5
        return np.sum(share * grades**2)

    for trial in (0, 7, 39):
        more = np.ones(40)
        more[trial] += by
        slope = (spread(more) - spread(np.ones(40))) / (by / 40)
        assert ranked.pulls[trial] == pytest.approx(slope, abs=1e-4)
    assert ranked.pulls.mean() == pytest.approx(0, abs=1e-14)


def test_classes_of_equal_probability():
    x = np.random.default_rng(3).permutation(np.arange(64.0))
    steps = Ranked.of(x).steps
    np.testing.assert_array_equal(steps, x.astype(int) // 2)  # 32 of them, in the order of the trials
    cut = Ranked.of(x).cut(4)
    assert cut.starts.tolist() == [0, 16, 32, 48]
    assert cut.sizes.tolist() == [16] * 4
    np.testing.assert_array_equal(cut.label, np.repeat(np.arange(4), 16))
    np.testing.assert_allclose(cut.centred, np.tile(np.arange(16) - 7.5, 4), atol=1e-12)
    np.testing.assert_allclose(cut.squares, [340] * 4)  # 16 · (16² - 1)/12
    assert cut.freedom == 8


def test_equal_values_stay_together_and_have_no_line():
    x = np.array([0.0] * 6 + [1.0, 2.0])
    cut = Ranked.of(x).cut(4)
    assert cut.starts.tolist() == [0, 6]
    assert cut.sizes.tolist() == [6, 2]
    assert cut.label.tolist() == [0] * 6 + [1] * 2
    np.testing.assert_allclose(cut.centred, [0] * 6 + [-0.5, 0.5])
    np.testing.assert_allclose(cut.squares, [1, 0.5])
    assert cut.freedom == 3


@pytest.mark.parametrize(
    ("n", "counts"),
    [
        (40, [1, 4]),  # one class below 100 trials; of 4 there are 10 trials in each
        (31, [1]),
        (32, [1, 4]),
        (99, [1, 4]),
        (100, [2, 8]),
        (799, [15, 60]),
        (800, [16, 64]),
        (10_000, [16, 64, 256, 1024]),
        (8 * 64 - 1, [10, 40]),
        (127, [2, 8]),
        (128, [2, 8]),
    ],
)
def test_how_many_classes(n, counts):
    """16 at most and 50 trials in each; then four times as many as long as 8 trials are in each."""
    ranked = Ranked.of(np.arange(float(n)))
    assert [classes.starts.size for classes in ranked.ladder] == counts
    assert ranked.classes is ranked.ladder[0]
    assert n // counts[-1] >= 8 > n // (4 * counts[-1])


def test_very_large_values_are_measured_in_the_largest():
    x = np.array([1e150, -2e150, 5e149])
    np.testing.assert_allclose(_squarable(x), [0.5, -1, 0.25])
    small = np.array([1e100, 5.0])
    assert _squarable(small) is small
    assert np.isfinite(Ranked.of(np.linspace(-1e300, 1e300, 200)).cut(2).squares).all()
