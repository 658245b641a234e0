"""Trials of equal weight out of proposals whose weights, and whose answer, are known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.rare import resampling
from xlmc.montecarlo.rare.resampling import BATCH, resample


class Shifted:
    """Proposals from N(shift, 1) in one dimension, of which the trials are N(0, 1)."""

    basis = np.eye(1)

    def __init__(self, shift):
        self.shift = shift

    def draw(self, count, random):
        return random.standard_normal((count, 1)) + self.shift

    def log_weights(self, points):
        return 0.5 * self.shift**2 - self.shift * points[:, 0]


def above(limit):
    return lambda points: points[:, 0] > limit


def test_equal_weights_are_plain_rejection(random):
    said = []
    result = resample(above(1.0), Shifted(0.0), 0.0, 0.0, 3_000, 10**9, random, said.append)
    share = stats.norm.sf(1.0)
    assert result.points.shape == (3_000, 1)
    assert (result.points > 1.0).all()
    assert result.size == 3_000.0
    assert (result.proposals, result.fresh) == (2 * BATCH, BATCH)
    assert said == [BATCH, 2 * BATCH]
    assert abs(result.accepted - result.proposals * share) < 5 * math.sqrt(result.proposals * share)
    assert abs(result.acceptance.value - share) < 5 * math.sqrt(share * (1 - share) / BATCH)
    assert result.acceptance.error == pytest.approx(math.sqrt(share * (1 - share) / BATCH), rel=0.05)
    assert result.acceptance.n == BATCH
    assert result.effective == pytest.approx(result.acceptance.value * BATCH)
    assert result.surprise is None


def test_weights_of_a_rare_region(random):
    """P(x > 3.5) = 2.3e-4 out of proposals about 3.5; the trials are those of the truncated normal distribution."""
    limit = 3.5
    proposal = Shifted(limit)
    highest = float(proposal.log_weights(np.array([[limit]]))[0])
    result = resample(above(limit), proposal, highest, highest, 20_000, 10**9, random)
    truth = stats.norm.sf(limit)
    assert abs(result.acceptance.value - truth) < 5 * result.acceptance.error
    assert result.acceptance.error < 0.01 * truth
    assert 0.9 * len(result.points) < result.size <= len(result.points) == 20_000
    tail = stats.truncnorm(limit, np.inf)
    assert abs(result.points.mean() - tail.mean()) < 5 * tail.std() / math.sqrt(20_000)
    assert stats.kstest(result.points[:, 0], tail.cdf).pvalue > 1e-4
    weights_mean = truth * result.fresh
    second = result.fresh * np.exp(limit**2) * stats.norm.sf(2 * limit)
    assert result.effective <= 1.02 * weights_mean**2 / second


def test_the_most_is_not_passed(random):
    result = resample(above(2.0), Shifted(0.0), 0.0, 0.0, 10_000, 3 * BATCH, random)
    assert result.proposals == 3 * BATCH
    assert result.fresh == 0
    assert len(result.points) == result.accepted < 10_000
    assert abs(result.acceptance.value - stats.norm.sf(2.0)) < 5 * result.acceptance.error
    assert result.acceptance.n == 3 * BATCH
    rounded = resample(above(2.0), Shifted(0.0), 0.0, 0.0, 10_000, 2 * BATCH + 1, random)
    assert rounded.proposals == 3 * BATCH


def test_nothing_is_accepted(random):
    result = resample(above(99.0), Shifted(0.0), 0.0, 0.0, 10, BATCH, random)
    assert (result.points.shape, result.size, result.accepted, result.effective) == ((0, 1), 0.0, 0, 0.0)
    assert (result.acceptance.value, result.acceptance.n) == (0.0, BATCH)


def test_what_is_hopeless_ends_early(random, monkeypatch):
    """After two batches some 45 of 4,000 are kept: the most there may be would not give half."""
    monkeypatch.setattr(resampling, "_PATIENCE", 2 * BATCH)
    result = resample(above(3.2), Shifted(0.0), 0.0, 0.0, 4_000, 60 * BATCH, random)
    assert (result.proposals, result.fresh) == (2 * BATCH, 0)
    more = resample(above(3.2), Shifted(0.0), 0.0, 0.0, 400, 60 * BATCH, random)
    assert more.proposals > 2 * BATCH
    assert len(more.points) == 400


def test_a_surprise_ends_the_drawing(random):
    """The envelope is believed to be e^-9 high, and the weights are 1: e^9 is more than the 30 that it may grow."""
    said = []
    result = resample(above(0.0), Shifted(0.0), -9.0, -9.0, 100, 10**9, random, said.append)
    assert result.proposals == BATCH
    assert said == [BATCH]
    assert result.surprise.trials == BATCH
    assert (result.surprise.points > 0.0).all()
    assert not result.surprise.logs.any()
    assert len(result.surprise.points) == result.accepted
    calm = resample(above(0.0), Shifted(0.0), -9.0, -9.0, 100, 10**9, random, surprises=False)
    assert calm.surprise is None
    assert len(calm.points) == 100
    near = resample(above(0.0), Shifted(0.0), -math.log(29.0), 0.0, 100, 10**9, random)
    assert near.surprise is None


def test_an_uneven_proposal_is_worth_less_than_its_weights_say(random):
    """The populations know of a mean weight of 4 among the accepted: Σw² is 4Σw, and (Σw)²/Σw² a quarter."""
    even = resample(above(0.0), Shifted(0.0), 0.0, 0.0, 10, 10**9, np.random.default_rng(3))
    uneven = resample(above(0.0), Shifted(0.0), 0.0, math.log(4.0), 10, 10**9, np.random.default_rng(3))
    assert uneven.effective == pytest.approx(even.effective / 4.0)
    p, n = even.acceptance.value, even.fresh
    assert even.acceptance.error == pytest.approx(math.sqrt((p - p * p) / (n - 1)))
    assert uneven.acceptance.error == pytest.approx(math.sqrt((4 * p - p * p) / (n - 1)))


def test_rare_acceptance_takes_more_fresh_proposals(random):
    """A hundred accepted ones are wanted for the probability, where 3 in 10,000 are."""
    result = resample(above(3.4), Shifted(0.0), 0.0, 0.0, 5, 10**9, random)
    expected = 100 / stats.norm.sf(3.4)
    assert 0.3 * expected < result.fresh < 4 * expected
    assert result.acceptance.n == result.fresh


@pytest.mark.parametrize(
    ("rows", "runs"),
    [([[1, 2]], [1]), ([[1, 2], [1, 2], [1, 3]], [2, 1]), ([[1, 2], [2, 2], [1, 2], [1, 2]], [1, 1, 2])],
)  # fmt: skip
def test_how_often_points_stand(rows, runs):
    assert resampling._runs(np.array(rows, float)).tolist() == runs
