"""Roots in many trials at once, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.engine.roots import SCANNED, find_roots


def alone(function, low, high):
    """The roots of one trial."""
    return find_roots(lambda x, _: function(x), np.array([float(low)]), np.array([float(high)])).values


def of(values, trials):
    return values if trials is None else values[trials]


def test_each_trial_has_its_own_root():
    c = np.random.default_rng(1).uniform(1, 100, 5_000)
    result = find_roots(lambda x, t: x**3 - of(c, t), np.zeros(c.size), np.full(c.size, 10.0))
    assert np.array_equal(result.trials, np.arange(c.size))
    assert np.max(np.abs(result.values / np.cbrt(c) - 1)) < 1e-14


@pytest.mark.parametrize(
    ("function", "low", "high", "roots"),
    [
        (lambda x: x - 5, 0, 10, [5]),
        (lambda x: x - 5, 5, 10, [5]),  # at an end
        (lambda x: x - 5, 5, 5, [5]),
        (lambda x: x * x - 4, -5, 10, [-2, 2]),
        (np.sin, 1, 10, [np.pi, 2 * np.pi, 3 * np.pi]),
        (lambda x: x**9, -1, 2, [0]),
        (lambda x: x**9, -1, 2.1, [0]),  # so flat that each step is far smaller than the distance to go
        (lambda x: 3 * x - 1, -1, 2.1, [1 / 3]),
        (lambda x: np.cbrt(x - 1), -3, 2, [1]),
        (lambda x: np.exp(x) - 1e300, 0, 709, [300 * np.log(10)]),
        (lambda x: 1e-300 * (x - 3), 0, 10, [3]),
        (lambda x: np.expm1(50 * (x - 9.5)), 0, 10, [9.5]),
        (lambda x: np.where(x < 2, np.nan, x - 5), 0, 10, [5]),
        (lambda x: 1 / (x - np.pi), 0, 10, []),  # a pole
        (lambda x: np.sign(x - 3.3), 0, 10, []),  # a jump
        (lambda x: np.where(x < 3.3, x - 5, x - 1), 0, 10, []),  # a jump past 0
        (lambda x: np.where(x < 3.3, x - 3.301, x), 0, 10, []),  # and one that begins near 0
        (lambda x: np.where(x < 3.3, x - 5, x - 3.299), 0, 10, []),
        (lambda x: np.where(x < 3.3, x - 3.3, 3 * x - 9.9), 0, 10, [3.3]),  # a kink
        (lambda x: np.where(np.abs(x - 3.3) < 0.1, np.nan, x - 3.3), 0, 10, []),
        (lambda x: x * x + 1, -5, 5, []),
        (lambda x: x - 5, 10, 0, []),
        (lambda x: x - 5, np.nan, 10, []),
    ],
)
def test_all_roots_and_no_others(function, low, high, roots):
    result = alone(function, low, high)
    assert result == pytest.approx(roots, rel=1e-13, abs=1e-13)


def test_first_and_last_of_several():
    result = find_roots(lambda x, _: x * x - 4, np.array([-5.0, 0.0, 3.0]), np.array([10.0, 10.0, 10.0]))
    assert result.counts(3).tolist() == [2, 1, 0]
    assert result.chosen(3) == pytest.approx([-2, 2, np.nan], nan_ok=True)
    assert result.chosen(3, last=True) == pytest.approx([2, 2, np.nan], nan_ok=True)


def test_roots_in_different_parts_of_the_scan_are_told_apart():
    a, b = 0.4, 0.4 + 2 / SCANNED
    assert alone(lambda x: (x - a) * (x - b), 0, 1) == pytest.approx([a, b])


def test_two_close_roots_are_two_wherever_a_point_of_the_scan_lies_between_them():
    """And none where none does, so that such a trial is an error either way."""
    rng = np.random.default_rng(2)
    middle, gap = rng.uniform(0.1, 0.9, 20_000), 10 ** rng.uniform(-9, -1.5, 20_000)
    low, high = middle - gap / 2, middle + gap / 2
    result = find_roots(lambda x, t: (x - of(low, t)) * (x - of(high, t)), np.zeros(middle.size), np.ones(middle.size))
    counts = result.counts(middle.size)
    between = np.floor(low * SCANNED) != np.floor(high * SCANNED)
    assert np.count_nonzero(between) > 500
    assert np.array_equal(counts, np.where(between, 2, 0))
    assert np.allclose(result.values[np.isin(result.trials, np.flatnonzero(between))][::2], low[between], atol=1e-8)


def test_a_trial_without_a_range_does_not_disturb_the_others():
    low, high = np.array([0.0, np.nan, 0.0]), np.array([10.0, 10.0, 10.0])
    target = np.array([2.0, 3.0, 4.0])
    result = find_roots(lambda x, t: x - of(target, t), low, high)
    assert result.trials.tolist() == [0, 2]
    assert result.values == pytest.approx([2, 4])
