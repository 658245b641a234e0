"""Johnson by its moments, beside members whose moments are known in closed form or by integration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import expit, ndtr, ndtri

from xlmc.montecarlo.distributions.johnson_moments import JohnsonMoments, _member

JOHNSON = JohnsonMoments()
P = np.array([1e-9, 0.001, 0.05, 0.3, 0.5, 0.8, 0.99, 1 - 1e-9])


def _standard(raw):
    """Mean, standard deviation, skewness and kurtosis, of the means of x, x², x³ and x⁴."""
    m = raw[0]
    second = raw[1] - m**2
    third = raw[2] - 3 * m * raw[1] + 2 * m**3
    fourth = raw[3] - 4 * m * raw[2] + 6 * m**2 * raw[1] - 3 * m**4
    return m, math.sqrt(second), third / second**1.5, fourth / second**2


def unbounded(first, second):
    """sinh((z - first)/second), whose powers are sums of lognormal numbers."""

    def power(k):
        return math.exp(k * k / (2 * second**2) - k * first / second)

    raw = [sum(math.comb(n, k) * (-1) ** k * power(n - 2 * k) for k in range(n + 1)) / 2**n for n in range(1, 5)]
    return _standard(raw), np.sinh((ndtri(P) - first) / second)


def bounded(first, second):
    """1/(1 + exp(-(z - first)/second))."""

    def mean(n):
        def part(z):
            return expit((z - first) / second) ** n * math.exp(-z * z / 2) / math.sqrt(2 * math.pi)

        return quad(part, -12, 12, epsabs=0, epsrel=1e-13, limit=400)[0]

    return _standard([mean(n) for n in range(1, 5)]), expit((ndtri(P) - first) / second)


def lognormal(sigma):
    raw = [math.exp(n * n * sigma**2 / 2) for n in range(1, 5)]
    return _standard(raw), np.exp(sigma * ndtri(P))


MEMBERS = {
    "SU, even": (unbounded(0.0, 2.0), 1e-9),
    "SU, long tails": (unbounded(0.0, 1.1), 1e-9),
    "SU, to the right": (unbounded(-0.5, 1.5), 1e-9),
    "SU, to the left": (unbounded(0.5, 1.5), 1e-9),
    "SU, skewed": (unbounded(-3.0, 1.4), 1e-7),
    "SU, nearly normal": (unbounded(-1.0, 8.0), 1e-6),
    "SB, even": (bounded(0.0, 1.0), 1e-6),
    "SB, of two peaks": (bounded(0.0, 0.4), 1e-6),
    "SB, to the right": (bounded(1.0, 1.2), 1e-6),
    "SB, to the left": (bounded(-1.0, 1.2), 1e-6),
    "SB, skewed": (bounded(2.0, 0.8), 1e-6),
    "lognormal": (lognormal(0.5), 1e-7),
    "wide lognormal": (lognormal(1.0), 1e-7),
    "normal": (((5.0, 2.0, 0.0, 3.0), 5.0 + 2.0 * ndtri(P)), 1e-12),
}


@pytest.mark.parametrize("name", MEMBERS)
def test_the_member_with_these_moments_is_found(name):
    ((mean, deviation, skewness, kurtosis), quantiles), near = MEMBERS[name]
    params = mean, deviation, skewness, kurtosis
    assert JOHNSON.fault(*params) is None
    result = JOHNSON.ppf(P, *params)
    assert np.abs(result - quantiles).max() <= near * max(np.abs(quantiles - mean).max(), 1.0)
    assert JOHNSON.isf(1 - P[1:-1], *params) == pytest.approx(result[1:-1], rel=1e-9)
    assert JOHNSON.cdf(result, *params) == pytest.approx(P, rel=1e-6)
    assert JOHNSON.sf(result, *params) == pytest.approx(1 - P, rel=1e-6)
    assert (JOHNSON.mean(*params), JOHNSON.variance(*params)) == pytest.approx((mean, deviation**2))


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("SU, even", -math.inf, math.inf),
        ("SB, to the right", 0.0, 1.0),
        ("SB, to the left", 0.0, 1.0),
        ("lognormal", 0.0, math.inf),
        ("normal", -math.inf, math.inf),
    ],
)
def test_its_ends(name, low, high):
    params = MEMBERS[name][0][0]
    assert [float(end) for end in JOHNSON.support(*params)] == pytest.approx([low, high], abs=1e-5)


def test_the_mirror_image_of_a_lognormal_ends_above():
    mean, deviation, skewness, kurtosis = lognormal(0.5)[0]
    params = -mean, deviation, -skewness, kurtosis
    assert JOHNSON.ppf(P[1:-1], *params) == pytest.approx(-np.exp(0.5 * ndtri(1 - P[1:-1])), rel=1e-7)
    low, high = JOHNSON.support(*params)
    assert low == -math.inf
    assert float(high) == pytest.approx(0.0, abs=1e-9)


def _moments_of(member):
    """The four moments of a member, by integration over the normal deviate."""
    z = np.arange(-14, 14, 1 / 256)
    x = np.where(z < 0, member.ppf(ndtr(-np.abs(z))), member.isf(ndtr(-np.abs(z))))
    weight = np.exp(-(z**2) / 2) / 256 / math.sqrt(2 * math.pi)
    return _standard([float(weight @ x**n) for n in range(1, 5)])


def _line(omega):
    """Skewness and kurtosis of a lognormal with exp(σ²) = ω (Johnson 1949)."""
    return (omega + 2) * math.sqrt(omega - 1), omega**4 + 2 * omega**3 + 3 * omega**2 - 3


@pytest.mark.parametrize("omega", [1.001, 1.01, 1.1, 1.3])
@pytest.mark.parametrize("share", [1 - 1e-3, 1 - 1e-5, 1 - 2e-6, 1.0, 1 + 2e-6, 1 + 1e-5, 1 + 1e-3, 1.2])
def test_a_member_is_found_beside_the_line_of_the_lognormal(omega, share):
    skewness, line = _line(omega)
    kurtosis = share * line
    member = _member(skewness, kurtosis)
    assert member is not None
    ends = [float(end) for end in member.support()]
    if abs(share - 1) > 1e-6:  # SB has two ends, SU none
        assert np.isfinite(ends).tolist() == [share < 1] * 2
    else:
        assert np.isfinite(ends).tolist() == [True, False]
    assert _moments_of(member) == pytest.approx((0.0, 1.0, skewness, kurtosis), rel=1e-5, abs=1e-6)


@pytest.mark.parametrize(
    ("skewness", "kurtosis"),
    [
        (0.0, 3.1),
        (0.0, 30.0),
        (0.0, 2.9),
        (0.0, 1.9),
        (0.0, 1.3),
        (1.0, 2.5),
        (1.0, 3.5),
        (1.0, 40.0),
        (2.0, 5.8),
        (3.0, 60.0),
    ],
)
@pytest.mark.parametrize("sign", [1, -1])
def test_a_member_has_the_moments_that_are_asked_for(skewness, kurtosis, sign):
    member = _member(sign * skewness, kurtosis)
    assert _moments_of(member) == pytest.approx((0.0, 1.0, sign * skewness, kurtosis), rel=1e-5, abs=1e-6)


@pytest.mark.parametrize(
    ("params", "key"),
    [
        ((0.0, 0.0, 0.0, 3.0), "std_dev"),
        ((0.0, 1.0, 2.0, 5.0), "kurtosis"),
        ((0.0, 1.0, 0.0, 1.0), "kurtosis"),
        ((0.0, 1.0, 0.0, 1e12), "kurtosis"),
    ],
)
def test_what_no_member_has(params, key):
    fault = JOHNSON.fault(*params)
    assert fault.key == key
    assert fault.hint


def test_trials_of_other_moments_have_members_of_their_own():
    skewness, kurtosis = np.array([0.0, 0.5, -0.5, 0.5, 2.0]), np.array([3.0, 5.0, 5.0, 5.0, 5.0])
    result = JOHNSON.ppf(np.full(5, 0.9), 10.0, 2.0, skewness, kurtosis)
    alone = [JOHNSON.ppf(np.array([0.9]), 10.0, 2.0, s, k)[0] for s, k in zip(skewness, kurtosis, strict=True)]
    np.testing.assert_array_equal(result, alone)
    assert np.isnan(result).tolist() == [False, False, False, False, True]
    assert result[0] == pytest.approx(10 + 2 * ndtri(0.9))
    assert result[2] == pytest.approx(20 - JOHNSON.ppf(np.array([0.1]), 10.0, 2.0, 0.5, 5.0)[0])
