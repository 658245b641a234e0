from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from xlmc.run.rare.envelope import COPIED, copies, height

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
    found = copies(np.full(n, log), luck, 0.0)
    assert found.mean() == pytest.approx(np.exp(log), abs=1 / n)
    assert np.ptp(found) <= 1
