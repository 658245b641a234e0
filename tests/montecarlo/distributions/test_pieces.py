from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate

from xlmc.montecarlo.distributions import Truncated
from xlmc.montecarlo.distributions.pieces import Piece, Pieces

MIXED = Pieces(
    [
        Piece(-4, -4, 1.0),
        Piece(0, 2, 3.0, 1.0, 0.0),
        Piece(2, 5, 2.0),
        Piece(5, 5, 0.5),
        Piece(7, 9, 0.0),
        Piece(10, 11, 1.5, 0.2, 1.0),
    ]
)
VALUES = Pieces([Piece(1, 1, 1), Piece(2, 2, 2), Piece(6, 6, 5)])


def test_the_example_of_the_users_guide():
    """0.75 between 5 and 15 and 0.25 between 16 and 21: heights 0.075 and 0.05."""
    cost = Pieces([Piece(5, 15, 0.75), Piece(16, 21, 0.25)])
    assert cost.cdf(10.0) - cost.cdf(9.0) == pytest.approx(0.075, rel=1e-14)
    assert cost.cdf(18.0) - cost.cdf(17.0) == pytest.approx(0.05, rel=1e-14)
    assert cost.mean() == pytest.approx(0.75 * 10 + 0.25 * 18.5, rel=1e-14)
    assert cost.variance() == pytest.approx(
        0.75 * (100 / 12 + 10**2) + 0.25 * (25 / 12 + 18.5**2) - cost.mean() ** 2, rel=1e-13
    )


def test_a_slope_is_a_triangle():
    slope = Pieces([Piece(0, 2, 1.0, 1.0, 0.0)])
    u = np.linspace(0.001, 0.999, 50)
    np.testing.assert_allclose(slope.ppf(u), 2 - 2 * np.sqrt(1 - u), rtol=1e-12)
    assert slope.mean() == pytest.approx(2 / 3, rel=1e-14)
    assert slope.variance() == pytest.approx(2 / 9, rel=1e-14)


def test_moments_of_mixed_pieces_by_integration():
    """E(X - low) and E(X - low)² from the tail probabilities."""
    low, high = MIXED.support()
    breaks = [-4, 0, 2, 5, 7, 9, 10, 11]
    first = second = 0.0
    for start, end in itertools.pairwise(breaks):
        first += integrate.quad(lambda x: 1 - MIXED.cdf(x), start, end)[0]
        second += integrate.quad(lambda x: 2 * (x - low) * (1 - MIXED.cdf(x)), start, end)[0]
    assert (low, high) == (-4, 11)
    assert MIXED.mean() == pytest.approx(low + first, rel=1e-9)
    assert MIXED.variance() == pytest.approx(second - first**2, rel=1e-9)


@given(k=st.integers(1, 2**53 - 1))
def test_round_trip(k):
    u = k * 2.0**-53
    x = MIXED.ppf(u)
    before = MIXED.cdf(np.nextafter(x, -np.inf))
    assert before <= u + 1e-12
    assert MIXED.cdf(x) >= u - 1e-12
    assert MIXED.sf(x) == pytest.approx(1 - before, abs=1e-7)  # the slope at a corner moves fast
    assert MIXED.isf(1 - u) == pytest.approx(x, abs=1e-6) or before < u < MIXED.cdf(x) + 1e-12


@given(x=st.floats(-6, 13))
def test_both_tails_together_are_everything(x):
    single = {-4.0: 0.125, 5.0: 0.0625}.get(x, 0.0)
    assert MIXED.cdf(x) + MIXED.sf(x) == pytest.approx(1 + single, abs=1e-14)


def test_the_upper_tail_keeps_its_digits():
    q = np.array([1e-18, 1e-9])
    ramp = Pieces([Piece(0, 1, 1.0, 1.0, 0.0)])
    np.testing.assert_allclose(ramp.sf(1 - np.sqrt([1e-8])), [1e-8], rtol=1e-7)
    np.testing.assert_allclose(Pieces([Piece(0, 1), Piece(2, 3)]).isf(q), 3 - 2 * q, rtol=1e-15)


def test_quantiles_of_values_are_exact_at_every_jump():
    at = np.array([1 / 8, 3 / 8])
    np.testing.assert_array_equal(VALUES.cdf(np.array([1.0, 2.0, 6.0])), [*at, 1])
    np.testing.assert_array_equal(VALUES.ppf(at), [1, 2])
    np.testing.assert_array_equal(VALUES.ppf(np.nextafter(at, 1)), [2, 6])
    np.testing.assert_array_equal(VALUES.isf(np.array([5 / 8, 7 / 8])), [2, 1])
    np.testing.assert_array_equal(VALUES.ppf(np.array([0.0, 1 - 2.0**-53])), [1, 6])


@pytest.mark.parametrize(
    ("lower", "upper", "values", "shares"),
    [
        (2, math.inf, [2, 6], [2 / 7, 5 / 7]),
        (-math.inf, 2, [1, 2], [1 / 3, 2 / 3]),
        (1.5, 6, [2, 6], [2 / 7, 5 / 7]),
        (2, 5, [2], [1.0]),
    ],
)
def test_truncated_values_keep_both_cutoffs(lower, upper, values, shares):
    truncated = Truncated(VALUES)
    np.testing.assert_allclose(truncated.cdf(np.array(values, dtype=float), lower, upper), np.cumsum(shares))
    x = truncated.ppf((np.arange(7000) + 0.5) / 7000, lower, upper)
    np.testing.assert_allclose([np.mean(x == value) for value in values], shares, atol=1 / 7000)


def test_cutoffs_between_the_values():
    assert Truncated(VALUES).check(2.5, 5.5) == "Lower cutoff (2.5) leaves nothing of the distribution"


def test_a_weight_of_0_takes_a_piece_out():
    assert Pieces([Piece(0, 1, 0.0), Piece(5, 6)]).support() == (5, 6)
    assert not np.any((MIXED.ppf(np.linspace(0, 0.9999, 5000)) > 5) & (MIXED.ppf(np.linspace(0, 0.9999, 5000)) < 10))


def test_u_is_left_alone_unless_it_is_out():
    u = np.array([0.0, 0.3, 0.9])
    expected = MIXED.ppf(u)
    np.testing.assert_array_equal(u, [0.0, 0.3, 0.9])
    assert MIXED.ppf(u, out=u) is u
    np.testing.assert_array_equal(u, expected)


def test_a_parameter_is_a_type_error():
    with pytest.raises(TypeError, match="takes"):
        MIXED.ppf(0.5, 1.0)
