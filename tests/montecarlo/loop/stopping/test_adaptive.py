from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import bdtr

from xlmc.montecarlo.definitions.stopping import StableDigits
from xlmc.montecarlo.loop.stopping import adaptive
from xlmc.montecarlo.loop.stopping.adaptive import (
    LEAST_SEQUENCES,
    Sequences,
    UntilStable,
    numerical_tolerance,
    sequence_length,
)


@pytest.mark.parametrize(
    ("deviation", "digits", "tolerance"),
    [
        (0.35, 2, 0.005),  # JCGM 101, 7.9.2, example 1: 0.35 = 35 × 10⁻²
        (0.35, 1, 0.05),
        (0.000_35, 2, 0.000_005),
        (2.0, 1, 0.5),  # example 2: 2 g = 2 × 10⁰
        (2.0, 2, 0.05),
        (41.0, 1, 5.0),
        (99.4, 2, 0.5),
        (99.6, 2, 5.0),  # 1.0 × 10², that is 10 × 10¹
        (0.0, 2, 0.0),
    ],
)
def test_the_numerical_tolerance(deviation, digits, tolerance):
    assert numerical_tolerance(deviation, digits) == tolerance


@pytest.mark.parametrize(("share", "length"), [(0.51, 10_000), (0.95, 10_000), (0.99, 10_000), (0.995, 20_000)])
def test_the_length_of_a_sequence(share, length):
    assert sequence_length(share) == length


def test_sequences_are_those_of_the_standard():
    """The same as when all numbers are there at once, whatever blocks they come in."""
    rng = np.random.default_rng(1)
    values = rng.gamma(3.0, size=63_000)
    sequences = Sequences(0.9)
    for part in np.array_split(np.insert(values, [7, 30_000], np.nan), [0, 100, 9_000, 45_000, 45_001]):
        sequences.add(part)
    whole = values[:60_000].reshape(6, 10_000)
    low, high = np.quantile(whole, [0.05, 0.95], axis=1)
    estimates = np.array([whole.mean(axis=1), whole.std(axis=1, ddof=1), low, high])
    worst = 2.0 * (estimates.std(axis=1, ddof=1) / math.sqrt(6)).max()
    assert sequences.count == 6
    for digits in (1, 2, 3):
        tolerance = numerical_tolerance(values.std(ddof=1), digits)
        assert sequences.excess(digits) == pytest.approx(worst / tolerance, rel=1e-9)


def test_one_sequence_says_nothing():
    sequences = Sequences(0.5)
    assert sequences.excess(1) == math.inf
    sequences.add(np.ones(19_999))
    assert sequences.excess(1) == math.inf
    sequences.add(np.ones(1))
    assert sequences.excess(1) == 0.0


def normal_blocks(block, seed, size=1000, blocks=1000, scale=1.0):
    rng = np.random.default_rng(seed)
    return (block(scale * rng.standard_normal(size)) for _ in range(blocks))


def test_it_ends_when_the_standard_would_but_not_before_enough_sequences(block, run_rule, monkeypatch):
    monkeypatch.setattr(adaptive, "sequence_length", lambda share: 500)
    few, _ = run_rule(UntilStable(StableDigits(1), [(0, "x", 0.5)]), normal_blocks(block, 1))
    assert few == LEAST_SEQUENCES * 500 // 1000
    many, (values,) = run_rule(UntilStable(StableDigits(2), [(0, "x", 0.5)]), normal_blocks(block, 1, scale=4.0))
    whole = values.reshape(-1, 500)
    ends = np.quantile(whole, [0.25, 0.75], axis=1)
    result = np.array([whole.mean(axis=1), whole.std(axis=1, ddof=1), *ends])

    def worst(count):
        return 2.0 * (result[:, :count].std(axis=1, ddof=1) / math.sqrt(count)).max()

    assert worst(2 * many) <= 0.05 < worst(2 * many - 2)
    assert many > few


def test_every_forecast_that_counts_must_be_stable(block, run_rule, monkeypatch):
    monkeypatch.setattr(adaptive, "sequence_length", lambda share: 50)
    rng = np.random.default_rng(2)
    blocks = [block(rng.normal(size=1000), 9.0 * rng.normal(size=1000)) for _ in range(60)]
    assert run_rule(UntilStable(StableDigits(1), [(0, "x", 0.5)]), blocks)[0] == LEAST_SEQUENCES * 50 // 1000
    both, _ = run_rule(UntilStable(StableDigits(1), [(0, "x", 0.5), (1, "y", 0.5)]), blocks)
    second, _ = run_rule(UntilStable(StableDigits(1), [(1, "y", 0.5)]), blocks)
    assert both == second > LEAST_SEQUENCES * 50 // 1000


@pytest.mark.parametrize("needed", [12, 15, 20, 30, 60])
def test_with_so_many_sequences_an_average_is_within_the_tolerance_as_often_as_it_should_be(needed):
    """Of 2,000 runs that stop at 2s ≤ δ, at least 94 % but for chance; one in five would fail so in 1 % of all seeds.

    A sequence is its mean, a standard normal number, and δ is what so many sequences need.
    """
    means, tolerance = np.random.default_rng(needed).standard_normal((2000, 300)), 2.0 / math.sqrt(needed)
    h = np.arange(1, 301)
    average = means.cumsum(axis=1) / h
    squares = (means**2).cumsum(axis=1) - h * average**2
    met = 4.0 * np.maximum(squares, 0.0) / np.maximum(h - 1, 1) / h <= tolerance**2

    def within(least):
        stopped = (met & (h >= least)).argmax(axis=1)
        return int((np.abs(average[np.arange(2000), stopped]) <= tolerance).sum())

    assert bdtr(within(LEAST_SEQUENCES), 2000, 0.94) > 0.01 / 5
    assert within(2) < 0.9 * 2000  # as the standard has it


def test_in_words():
    assert UntilStable(StableDigits(1), [(0, "x", 0.5)]).goal == "x was stable to 1 significant digit (JCGM 101, 7.9)"
    assert UntilStable(StableDigits(2), [(0, "x", 0.5), (1, "y", 0.5)]).goal.startswith(
        "x and y were stable to 2 significant digits"
    )
