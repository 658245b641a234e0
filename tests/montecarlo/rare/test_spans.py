"""A uniform in another order is a uniform: every position has one value, and those that are accepted come first."""

from __future__ import annotations

import numpy as np
import pytest

from xlmc.montecarlo.rare.spans import Rearranged

POSITIONS = np.linspace(0.0, 1.0, 20_001)[:-1]


@pytest.mark.parametrize(
    ("low", "high"),
    [
        ([0.2], [0.3]),
        ([0.2, 0.7], [0.3, 0.9]),
        ([0.0, 0.95], [0.1, 1.0]),
        ([0.5], [0.5 + 1e-9]),
        ([0.4, np.inf], [0.6, -np.inf]),
        ([np.inf], [-np.inf]),
        ([0.0], [1.0]),
    ],
)
def test_there_and_back(low, high):
    ends = [np.broadcast_to(np.array(each)[:, None], (len(low), POSITIONS.size)) for each in (low, high)]
    order = Rearranged.of(*ends)
    result = order.uniform_at(POSITIONS)
    assert np.abs(order.position_of(result) - POSITIONS).max() < 1e-14
    moved = np.unique(np.round(result - POSITIONS, 12))
    assert moved.size <= 2 * len(low) + 1  # pieces are moved, and none is stretched
    first = order.total > POSITIONS
    inside = np.any((ends[0] - 2e-3 <= result) & (result <= ends[1] + 2e-3), axis=0)
    assert inside[first].all()
    near = np.any((ends[0] <= result) & (result < ends[1]), axis=0)
    assert first[near].all()
    assert np.all(order.fold(POSITIONS)[order.total > 0] < order.total[order.total > 0])


def test_an_interval_is_taken_a_little_longer():
    """The filters decide what is accepted: rounding in what was solved must not."""
    order = Rearranged.of(np.array([[0.25]]), np.array([[0.25 + 1e-12]]))
    assert 1e-12 < order.total[0] < 1.02e-12
    assert order.uniform_at(np.zeros(1))[0] < 0.25
