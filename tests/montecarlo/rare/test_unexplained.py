"""Accepted trials of other origin say where the search did not look, and a part that it cannot describe is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import norm
from simulated import simulated

from xlmc.montecarlo.rare.account import RareAccount, probability_text
from xlmc.montecarlo.rare.limit_state_function import points_of
from xlmc.montecarlo.rare.search import find, plain_uniforms
from xlmc.montecarlo.rare.splitting import explore
from xlmc.montecarlo.rare.unexplained import (
    Evidence,
    Tempered,
    _quantile,
    find_unexplained,
    join_evidence,
    plain_assumptions,
    pool,
    wide_assumptions,
)
from xlmc.montecarlo.statistics import Estimate

NORMAL = {"distribution": "Normal", "mean": 0, "std_dev": 1}


@pytest.mark.parametrize("dimensions", [1, 2, 8, 40])
def test_widened_assumptions_cover_the_plain_ones(random, dimensions):
    """Weights are bounded, since some trials are plain ones, and 1 on average, since both are densities."""
    spread = wide_assumptions(dimensions)
    assert spread.shares.sum() == pytest.approx(1.0)
    weights = np.exp(spread.log_weights(spread.draw(30_000, random)))
    assert weights.max() <= 1 / spread.shares[0] + 1e-9
    assert abs(weights.mean() - 1.0) < 4.5 * weights.std() / np.sqrt(weights.size)


def test_they_estimate_a_rare_share_whatever_was_found(random):
    spread = wide_assumptions(3)
    points = spread.draw(65_536, random)
    result = Evidence.of(spread, 65_536, points[points[:, 1] > 4.75])
    error = np.sqrt(np.exp(2 * result.logs).sum()) / result.trials
    assert abs(result.mass - ndtr(-4.75)) < 4.5 * error < ndtr(-4.75)


def test_plain_trials_are_found_again_by_their_numbers(book):
    cells = {"A1": 1.0, "A2": 1.0, "A3": 1.0}
    given = {
        "a": {"cell": "A1", "low": 2, "high": 4},
        "b": {"cell": "A2", **NORMAL},
        "c": {"cell": "A3", **NORMAL},
    }
    filters = {"f": {"cell": "A1", "above": 3.99}, "g": {"cell": "A2", "above": 0}, "h": {"cell": "A3", "above": 0}}
    model = book(cells, given, {"x": "A2"}, filters, {("b", "c"): 0.6})
    run = simulated(model, 20_000, seed=3)
    points = points_of(plain_uniforms(model, 3, run.trial_index))
    places = [a.name for group in model.groups for a in model.live if a.name in group.names] or ["b", "c"]
    order = [*places, "a"]
    assert 2 + 2 * ndtr(points[:, order.index("a")]) == pytest.approx(run.inputs["a"], abs=1e-9)
    assert points[:, order.index("b")] == pytest.approx(run.inputs["b"], abs=1e-9)


@pytest.mark.parametrize(
    ("dimensions", "together"),
    [
        (1, [1.5, 2.0, 3.0, 4.0]),
        (3, [1.5, 2.0, 3.0, 4.0]),  # 4³ is 64, the largest ratio at the median
        (4, [1.5, 2.0]),
        (6, [1.5, 2.0]),
        (7, [1.5]),
        (11, [64.0 ** (1 / 11)]),
    ],
)
def test_spreads_and_shares_of_widened_assumptions(dimensions, together):
    """Plain in 0.15 of the trials, all together in 0.5, one alone four times as wide in 0.35."""
    spread = wide_assumptions(dimensions)
    count = len(together)
    assert spread.shares == pytest.approx([0.15, *[0.5 / count] * count, *[0.35 / dimensions] * dimensions])
    assert (spread.spreads[0] == 1.0).all()
    assert spread.spreads[1 : count + 1] == pytest.approx(np.outer(together, np.ones(dimensions)))
    assert spread.spreads[count + 1 :].tolist() == np.where(np.eye(dimensions), 4.0, 1.0).tolist()


def test_weights_are_ratios_of_densities():
    """Of a mixture of normals of spreads 1 and 3, 2 and 0.5, in two dimensions, by SciPy."""
    shares, spreads = np.array([0.25, 0.75]), np.array([[1.0, 3.0], [2.0, 0.5]])
    points = np.array([[0.0, 0.0], [1.0, -2.0], [-3.0, 0.5]])
    plain = norm.pdf(points).prod(axis=1)
    each = [norm.pdf(points, scale=scale).prod(axis=1) for scale in spreads]
    mixed = shares[0] * each[0] + shares[1] * each[1]
    assert np.exp(Tempered(shares, spreads).log_weights(points)) == pytest.approx(plain / mixed)


@pytest.mark.parametrize(
    ("weights", "share", "value"),
    [
        ([1, 1, 1, 1], 0.5, 2.0),
        ([1, 1, 1, 1], 0.51, 3.0),
        ([1, 1, 1, 1], 1.0, 4.0),
        ([1, 1, 1, 1], 0.0, 1.0),
        ([0, 0, 6, 2], 0.75, 3.0),
        ([5, 1, 1, 1], 0.6, 1.0),
    ],
)
def test_weighted_quantiles(weights, share, value):
    order = [2, 0, 3, 1]  # in any order
    values = np.array([1.0, 2.0, 3.0, 4.0])[order]
    assert _quantile(values, np.array(weights, float)[order], share) == value


def test_masses_and_shares():
    result = Evidence(plain_assumptions(1), 50, np.zeros((3, 1)), np.log([0.1, 0.2, 0.7]))
    assert result.mass == pytest.approx(1.0 / 50)
    assert result.log_mass == pytest.approx(np.log(1.0 / 50))
    assert result.shares == pytest.approx([0.1, 0.2, 0.7])
    assert result.tells(1.99)
    assert not result.tells(2.01)  # a hundredth of the probability


@pytest.mark.parametrize(("times", "unexplained"), [(29.0, False), (31.0, True)])
def test_what_is_thirty_times_heavier_than_usual_is_unexplained(times, unexplained):
    """Under N(0, 0.5²) a point z weighs exp(1.5 z²)/2 as much as a plain trial."""
    proposal = Tempered(np.ones(1), np.array([[0.5]]))
    usual = np.full((1000, 1), 0.2)
    far = np.array([[np.sqrt(0.04 + np.log(times) / 1.5)]])
    known = [Evidence.of(plain_assumptions(1), 1000, far)]
    assert len(find_unexplained(proposal, known, usual, np.ones(1000)).points) == unexplained


def test_evidence_is_joined_as_if_from_one_source():
    parts = [
        Evidence.of(plain_assumptions(1), 500, np.array([[0.0]])),
        Evidence.of(plain_assumptions(1), 300, np.empty((0, 1))),
    ]
    result = join_evidence(parts)
    assert (result.trials, result.points.tolist()) == (800, [[0.0]])
    assert result.logs == pytest.approx([0.0])
    assert not len(join_evidence(parts[1:]).points)


def two_parts(z):
    """Two half spaces whose distances from acceptance have different scales; either has P(z > 4.75) of the trials."""
    return np.maximum(0.0, np.minimum(4.75 - z[:, 0], 50.0 * (22.5625 - z[:, 1] * np.abs(z[:, 1]))))


def test_a_part_whose_scale_is_another_is_not_lost():
    """Splitting alone loses the second part with every seed."""
    truth = 1 - (1 - ndtr(-4.75)) ** 2
    random = [np.random.default_rng((21, 0, each)) for each in (0, 1)]
    result = find(two_parts, lambda z: two_parts(z) == 0.0, 2, 1000, 10**8, *random)
    points, acceptance = result.resampled.points, result.resampled.acceptance
    assert abs(acceptance.value - truth) < 4.5 * acceptance.error < 0.1 * truth
    assert abs(np.mean(points[:, 1] > 4.7) - 0.5) < 4.5 * np.sqrt(0.25 / 1000)


def test_a_single_plain_trial_is_evidence_enough(random, monkeypatch):
    """Without the widened assumptions, one accepted plain trial of the lost part leads to it."""
    monkeypatch.setattr(
        "xlmc.montecarlo.rare.search.wide_assumptions",
        lambda dimensions: Tempered(np.ones(1), np.ones((1, dimensions))),
    )
    plain = Evidence.of(plain_assumptions(2), 10**6, np.array([[0.3, 4.8]]))
    result = find(two_parts, lambda z: two_parts(z) == 0.0, 2, 500, 10**8, random, random, plain=[plain])
    truth = 1 - (1 - ndtr(-4.75)) ** 2
    assert abs(result.resampled.acceptance.value - truth) < 4.5 * result.resampled.acceptance.error


def test_populations_about_a_point_fill_its_part(random):
    result = explore(lambda z: np.maximum(0.0, 4.0 - z[:, 0]), np.array([[4.01, 2.5]]), np.ones(1), -10.0, random)
    assert result.points.min(axis=0)[0] >= 4.0
    assert abs(result.points[-1024:, 1].mean()) < 0.5
    assert result.log_probability == -10.0


def test_unexplained_trials_are_those_a_proposal_hardly_draws(random):
    proposal = Tempered(np.ones(1), np.array([[0.2, 1.0]]))
    points = proposal.draw(1000, random) * 0.5
    near, far = np.array([[0.1, 0.2]]), np.array([[3.0, 0.2]])
    known = [Evidence.of(plain_assumptions(2), 1000, np.concatenate([near, far]))]
    result = find_unexplained(proposal, known, points, np.ones(1000))
    assert result.points.tolist() == far.tolist()
    assert result.mass == pytest.approx(1e-3)
    assert result.tells(0.05)
    assert not result.tells(0.2)


def test_pooled_weights_count_every_source(random):
    """Half plain, half wide: each point is as likely as under the mean of both."""
    wide = Tempered(np.ones(1), np.array([[3.0]]))
    points = np.array([[0.0], [4.0]])
    parts = [Evidence.of(plain_assumptions(1), 500, points[:1]), Evidence.of(wide, 500, points[1:])]
    both = Tempered(np.full(2, 0.5), np.array([[1.0], [3.0]]))
    assert pool(parts)[1] == pytest.approx(both.log_weights(points))


ACCOUNT = RareAccount(
    evaluations=2_000_000,
    learning=800_000,
    proposals=130_000,
    proposals_accepted=60_000,
    fresh=65_000,
    kept=10_000,
    acceptance=Estimate(1e-6, 4e-9, (0.99e-6, 1.01e-6), 65_000),
    effective=30_000.0,
    size=9_950.0,
    searched=1.02e-6,
    levels=9,
    components=4,
    directions=2,
    dimensions=2,
    lost=0,
    plain=1_000_000,
    plain_accepted=2,
    checked=65_536,
    missed=0.0,
    ways=1,
    explored=0.0,
    solved=(),
)


@pytest.mark.parametrize(
    ("searched", "explored", "ways", "warns"),
    [
        (2.1e-6, 0.0, 1, True),
        (0.45e-6, 0.0, 1, True),
        (0.45e-6, 0.8e-6, 1, False),  # known accepted trials led to the rest
        (2.1e-6, 0.8e-6, 1, True),
        (2.1e-6, 0.0, 4, False),  # each population is smaller
        (4.1e-6, 0.0, 4, True),
    ],
)
def test_splitting_and_drawing_may_differ_by_as_much_as_splitting_is_known(searched, explored, ways, warns):
    result = replace(ACCOUNT, searched=searched, explored=explored, ways=ways)
    assert bool(result.warnings) is warns


def test_what_agrees_is_no_warning():
    assert ACCOUNT.warnings == []
    assert probability_text(ACCOUNT).startswith("(1.000")


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"missed": 4e-7}, "may add 4e-07"),
        ({"plain_accepted": 9}, "9 were accepted, where 1 were to be expected"),
    ],
)
def test_what_disagrees_is_known_from_below_only(changed, words):
    result = replace(ACCOUNT, **changed)
    (warning,) = result.warnings
    assert words in warning
    assert "at least 1e-06" in warning
    assert probability_text(result).startswith("at least ")
