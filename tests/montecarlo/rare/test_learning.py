"""What is known of a region from populations and rounds whose sizes and weights are given."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.montecarlo.rare import learning
from xlmc.montecarlo.rare.learning import Learned, Round, count_on, learn, learn_again, search_on
from xlmc.montecarlo.rare.splitting import Descent
from xlmc.montecarlo.rare.unexplained import Evidence


class Given:
    """A proposal whose unevenness is given."""

    def __init__(self, unevenness):
        self.value = unevenness
        self.asked = []

    def unevenness(self, points, weights):
        self.asked.append((points, weights))
        return self.value


def descent(points, log_probability=0.0, reached=True, explored=False):
    points = np.asarray(points, float).reshape(-1, 1)
    return Descent(points, reached, log_probability, (), len(points), points[0], explored)


def round_of(logs, unevenness=0.0, trials=1000):
    return Round(Given(unevenness), trials, np.zeros((len(logs), 1)), np.asarray(logs, float))


def test_evaluations_that_come_after_others():
    said = []
    count_on(30, said.append)(12)
    assert said == [42]


def test_a_round_of_equal_weights():
    drawn = round_of([math.log(2.0)] * 50)
    assert drawn.envelope == pytest.approx(math.log(2.0 / 1.01))  # copies may cost 1 %
    assert drawn.rate == pytest.approx(0.05 * 1.01)
    assert round_of([]).rate == 0.0


def test_the_probability_is_that_of_two_populations_on_average():
    """Half of 0.2 + 0.4 by splitting, half of 0.1 + 0.1 by exploring; one that did not arrive counts for nothing."""
    found = descent([1.0], math.log(0.2)), descent([2.0], math.log(0.4)), descent([9.0], math.log(0.9), reached=False)
    known = descent([3.0], math.log(0.1), explored=True), descent([4.0], math.log(0.1), explored=True)
    learned = Learned((*found, *known), (), (), 0)
    assert learned.searched == pytest.approx(0.3)
    assert learned.explored == pytest.approx(0.1)
    assert learned.probability == pytest.approx(0.4)


def test_the_best_round_has_enough_points_and_suits_the_populations():
    few, good, bad = round_of([0.0] * 99, 1.0), round_of([0.0] * 100, 2.0), round_of([0.0] * 500, 3.0)
    populations = descent([1.0, 2.0], math.log(0.3)), descent([5.0], math.log(0.1))
    learned = Learned(populations, (few, bad, good), (), 0)
    assert learned.best is good
    points, weights = good.proposal.asked[0]
    assert points.ravel().tolist() == [1.0, 2.0, 5.0]
    assert weights == pytest.approx([0.375, 0.375, 0.25])
    assert Learned(populations, (few,), (), 0).best is None


@pytest.mark.parametrize(
    ("descents", "halves"),
    [
        ((descent([1.0, 2.0]), descent([3.0])), [0, 0, 1]),
        ((descent([1.0]), descent([3.0], reached=False), descent([5.0, 6.0]), descent([7.0])), [0, 0, 0, 1]),
        ((descent([1.0, 2.0, 3.0]), descent([3.0], reached=False)), [0, 1, 0]),
    ],
)
def test_points_of_populations_are_in_two_halves(descents, halves):
    points, weights, result = learning._of_descents(descents)
    assert result.tolist() == halves
    assert weights.sum() == pytest.approx(1.0)
    assert len(points) == len(halves)


@pytest.mark.parametrize(("most", "count"), [(100, 3), (4, 2), (1, 0)])
def test_both_halves_are_dealt_in_turn(random, monkeypatch, most, count):
    monkeypatch.setattr(learning, "_FITTED", most)
    halves = np.array([0, 1, 1, 0, 0, 1, 1])
    order = learning._dealt(halves, random)
    assert halves[order].tolist() == [0, 1] * count
    assert len(set(order.tolist())) == 2 * count


def beyond(limit):
    """How far points are from x > limit, in the first coordinate."""
    return lambda points: np.maximum(limit - points[:, 0], 0.0)


class Plain:
    """Plain trials."""

    def log_weights(self, points):
        return np.zeros(len(points))


def learned_of(distance, random, dimensions=1, say=lambda _: None, most=math.inf, known=(), strata=()):
    """What is learned beside a hundred plain trials of which none was accepted."""
    none = Evidence.of(Plain(), 100, np.empty((0, dimensions)))
    return learn(distance, dimensions, random, say, most, (none, *known), strata)


@pytest.mark.parametrize(("limit", "dimensions"), [(3.0, 1), (4.5, 2)])
def test_a_half_line_is_learned(random, limit, dimensions):
    said = []
    learned = learned_of(beyond(limit), random, dimensions, said.append)
    truth = stats.norm.sf(limit)
    assert 0.5 * truth < learned.probability < 2.0 * truth
    assert learned.explored == 0.0
    assert len(learned.descents) == 2
    assert 1 <= len(learned.rounds) <= 5
    assert said == sorted(said)
    assert said[-1] == learned.evaluations
    best = learned.best
    assert best.rate > 0.05
    estimate = np.exp(best.logs).sum() / best.trials
    assert abs(estimate - truth) < 5 * math.sqrt(np.square(np.exp(best.logs)).sum()) / best.trials
    more = learn_again(beyond(limit), learned, best, random, said.append, math.inf)
    assert more.rounds[: len(learned.rounds) + 1] == (*learned.rounds, best)
    assert more.evaluations == learned.evaluations + sum(each.trials for each in more.rounds[len(learned.rounds) + 1 :])


def test_no_more_than_the_most(random):
    learned = learned_of(beyond(3.0), random, most=1)
    assert len(learned.rounds) == 1


def test_strata_have_populations_of_their_own(random):
    sides = beyond(3.0), lambda points: np.maximum(3.0 + points[:, 0], 0.0)
    learned = learned_of(lambda points: np.minimum(*(side(points) for side in sides)), random, strata=sides)
    assert len(learned.descents) == 4
    assert 0.5 < learned.probability / (2 * stats.norm.sf(3.0)) < 2.0
    signs = [np.sign(each.points[:, 0]).mean() for each in learned.descents]
    assert signs == [1.0, 1.0, -1.0, -1.0]


def test_where_no_population_arrives_known_trials_lead(random):
    """A distance that leads nowhere: a narrow band about 2 that no point comes nearer to."""

    def distance(points):
        return np.where(np.abs(points[:, 0] - 2.0) < 0.05, 0.0, np.inf)

    def monotone(points):
        return np.where(np.abs(points[:, 0] - 2.0) < 1e-9, 0.0, 1.0)

    assert learned_of(monotone, random).rounds == ()
    points = 2.0 + 0.1 * (random.random((50, 1)) - 0.5)
    trials = round(50 / (stats.norm.cdf(2.05) - stats.norm.cdf(1.95)))
    learned = learned_of(distance, random, known=[Evidence.of(Plain(), trials, points)])
    assert learned.rounds
    assert 0.4 < learned.probability * trials / 50 < 2.5


def test_a_search_goes_on_from_accepted_trials(random):
    """The other side of |x| > 3, from twenty trials there."""

    def both(points):
        return np.maximum(3.0 - np.abs(points[:, 0]), 0.0)

    learned = learned_of(beyond(3.0), random)
    points = -3.0 - 0.2 * random.random((20, 1))
    evidence = Evidence.of(Plain(), round(20 / stats.norm.sf(3.0)), points)
    more = search_on(both, learned, evidence, random, lambda _: None, math.inf)
    assert [each.explored for each in more.descents] == [False, False, True, True]
    assert more.evaluations > learned.evaluations
    assert 0.3 * stats.norm.sf(3.0) < more.explored < 3 * stats.norm.sf(3.0)
    assert (more.rounds[-1].points[:, 0] < 0).any()
