from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from xlmc.montecarlo.rare.proposal import COPIED, copies, fit_proposal, fit_shear, height, refit


def bent_layer(random, n, dimensions):
    """Points near a parabola: |z₀ − z₁²/4| small."""
    points = random.normal(size=(n, dimensions))
    points[:, 0] = 0.25 * points[:, 1] ** 2 + 0.01 * points[:, 0]
    return points


@pytest.mark.parametrize("dimensions", [2, 5, 30])
def test_weights_are_1_on_average_whatever_was_learnt(random, dimensions):
    """Over all proposals, accepted or not: the densities are densities, and the draws come from them."""
    proposal = fit_proposal(bent_layer(random, 4000, dimensions), np.ones(4000), random)
    points = proposal.draw(20_000, random)
    weights = np.exp(proposal.log_weights(points))
    assert weights.max() <= 50.0 + 1e-9  # one in fifty proposals is a plain trial
    assert abs(weights.mean() - 1.0) < 4.5 * weights.std() / np.sqrt(weights.size)
    for moment, expected in ((points[:, 0], 0.0), (points[:, 0] ** 2, 1.0), (points[:, 1] * points[:, -1], 0.0)):
        if dimensions > 2 or expected != 0.0:
            product = weights * moment
            assert abs(product.mean() - expected) < 4.5 * product.std() / np.sqrt(weights.size)


def test_a_bent_layer_is_followed(random):
    proposal = fit_proposal(bent_layer(random, 4000, 5), np.ones(4000), random)
    points = proposal.draw(4000, random)
    assert np.mean(np.abs(points[:, 0] - 0.25 * points[:, 1] ** 2) < 0.03) > 0.5


def test_directions_that_do_not_matter_are_left_alone(random):
    points = random.normal(size=(4000, 40))
    points[:, 7] = 4.0 + 0.2 * points[:, 7]
    proposal = fit_proposal(points, np.ones(4000), random)
    assert proposal.directions <= 3
    assert refit(proposal, points, np.ones(4000), random).basis is proposal.basis


def test_the_basis_turns_and_does_not_stretch(random):
    basis = fit_proposal(bent_layer(random, 4000, 20), np.ones(4000), random).basis
    assert basis.T @ basis == pytest.approx(np.eye(20), abs=1e-12)


@pytest.mark.parametrize(("points", "terms"), [(20, 0), (400, 1 + 3 + 3), (4000, 1 + 3 + 6)])
def test_a_shear_has_no_more_terms_than_its_points_can_tell(random, points, terms):
    others = random.normal(size=(points, 3))
    thin = (others[:, :1] * others[:, 1:2]) + others[:, 2:] ** 2 + 1.0
    shear = fit_shear(thin, others, np.ones(points))
    result = (shear.constant != 0).sum() + (shear.linear != 0).sum() + (shear.quadratic != 0).sum()
    assert result <= terms
    if terms == 10:
        assert shear.shift(others) == pytest.approx(thin, abs=1e-7)


LOGS = arrays.arrays(np.float64, st.integers(1, 60), elements=st.floats(-30, 30))


def cost(logs, at):
    ratios = np.exp(logs - at)
    above = ratios[ratios > 1]
    return float(np.sum(above**2 - above)), float(ratios.sum())


@given(LOGS)
def test_the_envelope_is_the_lowest_whose_copies_cost_no_more_than_they_may(logs):
    at = height(logs)
    paid, kept = cost(logs, at)
    assert paid <= COPIED * kept
    paid, kept = cost(logs, at - 1e-6)
    assert paid > COPIED * kept or at <= logs.max() - 50 + 1e-6


@given(LOGS, st.floats(2, 1e6), st.floats(-40, 40))
def test_it_is_never_below_the_least_and_never_above_all_weights_without_need(logs, kept, least):
    at = height(logs, kept, least)
    assert at >= least
    assert at <= max(least, logs.max())
    assert cost(logs, at)[0] <= COPIED * kept


def test_no_weights_need_no_envelope():
    assert height(np.empty(0)) == -np.inf
    assert height(np.empty(0), 10, 3.0) == 3.0


@given(st.floats(-20, 5))
def test_copies_are_the_weight_on_average(log):
    n = 1000
    luck = (np.arange(n) + 0.5) / n
    result = copies(np.full(n, log), luck, 0.0)
    assert result.mean() == pytest.approx(np.exp(log), abs=1 / n)
    assert np.ptp(result) <= 1
