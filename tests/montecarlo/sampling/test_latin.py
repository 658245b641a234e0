from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.montecarlo.sampling.latin import LatinHypercube
from xlmc.montecarlo.sampling.streams import Stream

SEED = 999


def drawn(strata, n, start=0, name="a", seed=SEED):
    out = np.empty(n)
    LatinHypercube(seed, name, strata).uniforms(start, out)
    return out


@pytest.mark.parametrize("strata", [1, 2, 7, 500, 4096, 16_384])
def test_every_interval_holds_one_draw_of_a_replicate(strata):
    u = drawn(strata, 3 * strata).reshape(3, strata)
    assert ((u >= 0) & (u < 1)).all()
    places = u * strata
    whole = np.floor(places + 1e-9)  # a draw on the edge itself may be rounded to either side
    assert np.array_equal(np.sort(whole, axis=1), np.broadcast_to(np.arange(strata), (3, strata)))


@pytest.mark.parametrize("strata", [1, 500, 16_384])
def test_the_largest_draw_of_the_last_interval_is_below_one(strata, monkeypatch):
    """Where the sum of interval and position is rounded up, the quotient would be 1, and its quantile infinite."""
    monkeypatch.setattr(Stream, "uniforms", lambda self, start, out: out.fill(1.0 - 2.0**-53))
    u = drawn(strata, strata)
    assert u.max() == 1.0 - 2.0**-53
    assert np.isfinite(stats.norm.ppf(u)).all()


@settings(max_examples=50)
@given(start=st.integers(0, 400), n=st.integers(1, 100), strata=st.sampled_from([1, 7, 64, 500]))
def test_a_draw_depends_on_its_trial_alone(start, n, strata):
    assert np.array_equal(drawn(strata, n, start), drawn(strata, 600)[start : start + n])


def test_within_its_interval_a_draw_stands_where_monte_carlo_has_it():
    u, plain = drawn(500, 2000), np.empty(2000)
    Stream(SEED, "a").uniforms(0, plain)
    assert u * 500 % 1 == pytest.approx(plain, abs=1e-9)


def test_every_order_of_the_intervals_is_as_likely():
    """24 orders of 4 intervals in 24,000 replicates; and each interval at each of 50 places in 5,000 replicates."""
    orders = np.floor(drawn(4, 4 * 24_000).reshape(-1, 4) * 4) @ [64, 16, 4, 1]
    counts = np.unique(orders, return_counts=True)[1]
    assert counts.size == 24
    assert stats.chisquare(counts).pvalue > 1e-3
    places = np.floor(drawn(50, 50 * 5_000).reshape(-1, 50) * 50 + 1e-9).astype(int)
    table = np.array([np.bincount(column, minlength=50) for column in places.T])
    # Rows and columns all add up to 5,000: 49 x 49 degrees of freedom, and a factor 49/50 for what they leave open.
    statistic = float(np.sum((table - 100.0) ** 2 / 100.0)) * 49 / 50
    assert stats.chi2(49 * 49).sf(statistic) > 1e-3


def test_neighbours_replicates_names_and_seeds_have_nothing_to_do_with_each_other():
    u = drawn(500, 50_000)
    others = [drawn(500, 50_000, name="b"), drawn(500, 50_000, seed=1), np.roll(u, 1), np.roll(u, 500)]
    for other in others:
        assert abs(np.corrcoef(u, other)[0, 1]) < 4 / np.sqrt(50_000)


def test_the_numbers_are_the_same_on_every_machine_and_in_every_version():
    assert drawn(10, 4).tolist() == PINNED[10]
    assert drawn(16_384, 2, start=10**12).tolist() == PINNED[16_384]


PINNED = {
    10: [0.22493999244971516, 0.4339805097953747, 0.1602308370514744, 0.02980567207449414],
    16_384: [0.1970165868953115, 0.26337926547757234],
}
