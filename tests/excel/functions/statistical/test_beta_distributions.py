from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

HELP = [
    ("BETA.DIST", (2, 8, 10, True, 1, 3), "0.6854706"),
    ("BETA.DIST", (2, 8, 10, False, 1, 3), "1.4837646"),
    ("BETADIST", (2, 8, 10, 1, 3), "0.6854706"),
    ("BETA.INV", (0.685470581, 8, 10, 1, 3), "2.0000000"),
    ("BETAINV", (0.685470581, 8, 10, 1, 3), "2.0000000"),
    ("F.DIST", (15.2069, 6, 4, True), "0.99"),
    ("F.DIST", (15.2069, 6, 4, False), "0.0012238"),
    ("F.DIST.RT", (15.20686486, 6, 4), "0.01000000"),
    ("FDIST", (15.20686486, 6, 4), "0.01000000"),
    ("F.INV", (0.01, 6, 4), "0.10930991"),
    ("F.INV.RT", (0.01, 6, 4), "15.20686"),
    ("FINV", (0.01, 6, 4), "15.20686"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE = [
    ("BETA.DIST", (0.4, 8, 10, True), 0.35949234293309440000),
    ("BETADIST", (0.4, 8, 10), 0.35949234293309440000),
    ("BETA.DIST", (1e-300, 0.5, 0.5, True), 6.3661977236758135105e-151),
    ("BETA.DIST", (1e-20, 3, 4, True), 1.9999999999999996709e-59),
    ("BETA.DIST", (0.25, 200, 3, True), 4.4369253716407351781e-117),
    ("BETA.DIST", (0.9999999999999999, 938584.9439931316, 0.01031978185445004, False), 73755795610199.53716),
    ("BETA.DIST", (1e-200, 0.5, 3, False), 9.3750000000000000839e99),
    ("BETA.DIST", (0.5, 0.001, 0.001, False), 0.0019972326127213066681),
    ("BETA.DIST", (1, 8, 10, True, 1, 3), 0),
    ("BETA.DIST", (3, 8, 10, True, 1, 3), 1),
    ("BETA.DIST", (1, 8, 10, True, None, 2), 0.68547058105468750),
    ("BETA.INV", (1.9999999999999996709e-59, 3, 4), 1e-20),
    ("F.DIST", (1e-9, 4, 7, True), 2.5714285660408166543e-18),
    ("F.DIST", (0.001, 40.9, 7.9, True), 8.0431306588998912949e-43),
    ("F.DIST", (0, 2, 5, False), 1),
    ("F.DIST", (0, 3, 5, False), 0),
    ("F.DIST", (0, 1, 5, True), 0),
    ("F.DIST.RT", (1e5, 3, 20), 6.4121350696154636638e-42),
    ("F.DIST.RT", (50, 10, 100), 1.9168227637538404789e-34),
    ("F.DIST.RT", (1e-9, 4, 7), 0.99999999999999999743),
    ("F.DIST.RT", (0, 4, 7), 1),
    ("F.INV", (0, 4, 7), 0),
    ("F.INV", (2.5714285660408166543e-18, 4, 7), 1e-9),
    ("F.INV.RT", (1, 4, 7), 0),
    ("F.INV.RT", (6.4121350696154636638e-42, 3, 20), 1e5),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-13)


ERRORS = [
    ("BETA.DIST", (0.9, 8, 10, True, 1, 3), NUM),
    ("BETA.DIST", (3.1, 8, 10, True, 1, 3), NUM),
    ("BETA.DIST", (1, 8, 10, True, 1, 1), NUM),
    ("BETA.DIST", (0.5, 0, 10, True), NUM),
    ("BETA.DIST", (0.5, 8, 0, False), NUM),
    ("BETA.DIST", (0, 1, 1, False), NUM),
    ("BETA.DIST", (0.7, 1, 1, False, 0.6, 0.7), NUM),
    ("BETA.DIST", (0.5, "x", NA, True), VALUE),
    ("BETA.INV", (0, 8, 10), NUM),
    ("BETA.INV", (1, 8, 10), NUM),
    ("BETAINV", (1, 8, 10, 1, 3), NUM),
    ("BETA.INV", (1.0000001, 8, 10), NUM),
    ("BETA.INV", (0.5, 0, 10), NUM),
    ("BETA.INV", (0.5, 8, 0), NUM),
    ("BETA.INV", (0.5, 8, 10, 0.7, 0.6), NUM),
    ("F.DIST", (-0.1, 6, 4, True), NUM),
    ("F.DIST", (1, 0.9, 4, True), NUM),
    ("F.DIST", (1, 6, 0.9, True), NUM),
    ("F.DIST", (0, 1, 4, False), NUM),
    ("F.DIST.RT", (-0.1, 6, 4), NUM),
    ("F.DIST.RT", (1, 6, 10000000001), NUM),
    ("F.INV", (-0.1, 6, 4), NUM),
    ("F.INV", (1, 6, 4), NUM),
    ("F.INV", (0.5, 0, 4), NUM),
    ("F.INV.RT", (0, 6, 4), NUM),
    ("F.INV.RT", (1.1, 6, 4), NUM),
    ("F.INV.RT", (0.5, 6, "x"), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), ERRORS)
def test_errors(check, name, arguments, expected):
    check(name, arguments, expected)


N = 1500
RNG = np.random.default_rng(3)
A, B = np.exp(RNG.uniform(-4, 13, (2, N)))
X = np.clip(RNG.beta(A, B), 1e-300, 1 - 1e-12)
M, K = np.floor(np.exp(RNG.uniform(0, 13, (2, N))))
RATIO, P = np.exp(RNG.uniform(-5, 5, N)), RNG.uniform(0, 1, N)


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [
        ("BETA.DIST", (X, A, B, 1), lambda: stats.beta.cdf(X, A, B)),
        ("BETA.DIST", (X, A, B, 0), lambda: stats.beta.pdf(X, A, B)),
        ("BETA.INV", (P, A, B), lambda: stats.beta.ppf(P, A, B)),
        ("F.DIST", (RATIO, M, K, 1), lambda: stats.f.cdf(RATIO, M, K)),
        ("F.DIST", (RATIO, M, K, 0), lambda: stats.f.pdf(RATIO, M, K)),
        ("F.DIST.RT", (RATIO, M, K), lambda: stats.f.sf(RATIO, M, K)),
        ("F.INV", (P, M, K), lambda: stats.f.ppf(P, M, K)),
        ("F.INV.RT", (P, M, K), lambda: stats.f.isf(P, M, K)),
    ],
)
def test_against_scipy_over_the_whole_range(over_trials, name, arguments, expected):
    np.testing.assert_allclose(over_trials(name, *arguments), expected(), rtol=1e-9, atol=1e-290)


NUM_OF_STUDENT_DISTRIBUTION, VALUE_OF_STUDENT_DISTRIBUTION, NA_OF_STUDENT_DISTRIBUTION, DIV0 = (
    ErrorCode.NUM,
    ErrorCode.VALUE,
    ErrorCode.NA,
    ErrorCode.DIV0,
)

HELP_OF_STUDENT_DISTRIBUTION = [
    ("T.DIST", (60, 1, True), "0.99469533"),
    ("T.DIST", (8, 3, False), "0.00073691"),
    ("T.DIST.2T", (1.959999998, 60), "0.054645"),
    ("T.DIST.RT", (1.959999998, 60), "0.027322"),
    ("TDIST", (1.959999998, 60, 2), "0.054644930"),
    ("TDIST", (1.959999998, 60, 1), "0.027322465"),
    ("T.INV", (0.75, 2), "0.8164966"),
    ("T.INV.2T", (0.546449, 60), "0.606533"),
    ("TINV", (0.05464, 60), "1.9600"),
    ("CONFIDENCE.T", (0.05, 1, 50), "0.284196855"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP_OF_STUDENT_DISTRIBUTION)
def test_examples_of_excels_help_student_distribution(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE_OF_STUDENT_DISTRIBUTION = [
    ("T.DIST.RT", (1e40, 6), 3.3749999999999993848e-239),
    ("T.DIST.RT", (1e7, 7), 1.3205206763543893545e-47),
    ("T.DIST.RT", (1e200, 1), 3.1830988618379068117e-201),
    ("T.DIST.RT", (5, 1e9), 2.8665162019758142154e-7),
    ("T.DIST.RT", (20, 956361), 2.8718036536032178418e-89),
    ("T.DIST.RT", (840000000.0, 7), 4.4749707733920552788e-61),
    ("T.DIST.RT", (830000000.0, 7), 4.8662964145352536e-61),
    ("T.DIST.RT", (1e-9, 3), 0.49999999963244740305),
    ("T.DIST.RT", (-1e40, 6), 1),
    ("T.DIST", (-1e7, 7.9, True), 1.3205206763543893545e-47),
    ("T.DIST", (0, 5, True), 0.5),
    ("T.DIST", (-2.505432179214386, 17174, False), 0.017298118084073185074),
    ("T.DIST", (3, 1e10, False), 0.0044318484188073722149),
    ("T.DIST", (1e60, 4, False), 1.2000000000000003037e-299),
    ("T.DIST", (0, 1, False), 0.31830988618379067154),
    ("T.DIST.2T", (0, 5), 1),
    ("TDIST", (2, 3.9, 1.9), 0.069662984279421588),
    ("T.INV", (0.5, 3), 0),
    ("T.INV", (3.1830988618379068117e-201, 1), -1e200),
    ("T.INV", (1.3205206763543893545e-47, 7), -1e7),
    ("T.INV", (0.3, 1e10), -0.524400512724756),
    ("T.INV.2T", (1, 3), 0),
    ("T.INV.2T", (2 * 3.3749999999999993848e-239, 6), 1e40),
    ("TINV", (2 * 2.8665162019758142154e-7, 1e9), 5),
    ("CONFIDENCE.T", (0.1, 1, 2.9), 4.46449651075355935),
    ("CONFIDENCE.T", (0.9, 10, 5), 0.598507596632140),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE_OF_STUDENT_DISTRIBUTION)
def test_table_student_distribution(check, name, arguments, expected):
    check(name, arguments, expected, rel=2e-13)


ERRORS_OF_STUDENT_DISTRIBUTION = [
    ("T.DIST", (1, 0.9, True), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.DIST", (1, 0.9, False), DIV0),
    ("T.DIST", (1, -1, False), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.DIST", (1, 10000000001, True), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.DIST", (1, 2, "x"), VALUE_OF_STUDENT_DISTRIBUTION),
    ("T.DIST.2T", (-1, 2), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.DIST.2T", (1, 0), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.DIST.RT", (1, 0), NUM_OF_STUDENT_DISTRIBUTION),
    ("TDIST", (-1, 2, 2), NUM_OF_STUDENT_DISTRIBUTION),
    ("TDIST", (1, 0, 2), NUM_OF_STUDENT_DISTRIBUTION),
    ("TDIST", (1, 2, 3), NUM_OF_STUDENT_DISTRIBUTION),
    ("TDIST", (1, 2, 0), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.INV", (0, 2), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.INV", (1, 2), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.INV", (0.5, 0.9), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.INV.2T", (0, 2), NUM_OF_STUDENT_DISTRIBUTION),
    ("T.INV.2T", (1.1, 2), NUM_OF_STUDENT_DISTRIBUTION),
    ("CONFIDENCE.T", (0, 1, 50), NUM_OF_STUDENT_DISTRIBUTION),
    ("CONFIDENCE.T", (1, 1, 50), NUM_OF_STUDENT_DISTRIBUTION),
    ("CONFIDENCE.T", (0.05, 0, 50), NUM_OF_STUDENT_DISTRIBUTION),
    ("CONFIDENCE.T", (0.05, 1, 0.9), NUM_OF_STUDENT_DISTRIBUTION),
    ("CONFIDENCE.T", (0.05, 1, 1.9), DIV0),
    ("CONFIDENCE.T", (NA_OF_STUDENT_DISTRIBUTION, "x", 1), NA_OF_STUDENT_DISTRIBUTION),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), ERRORS_OF_STUDENT_DISTRIBUTION)
def test_errors_student_distribution(check, name, arguments, expected):
    check(name, arguments, expected)


@given(st.floats(1e-290, 0.999999), st.integers(1, 300) | st.integers(1, 10**10))
@settings(max_examples=200, deadline=None)
def test_the_inverse_is_the_inverse(evaluate, p, freedom):
    """A relative step of t moves the probability by at most `freedom` such steps in the tail, t² in the middle."""
    t = evaluate("T.INV.2T", p, freedom)
    steepness = min(freedom, t * t) + 1
    assert evaluate("T.DIST.2T", t, freedom) == pytest.approx(p, rel=1e-13 * steepness + 1e-12)


@given(st.floats(0, 1e300))
def test_one_degree_of_freedom_is_an_arctangent(evaluate, t):
    """To 1e-10 only: of shares below 1e-16 SciPy's arcsine law is no better."""
    assert evaluate("T.DIST.RT", t, 1) == pytest.approx(math.atan2(1, t) / math.pi, rel=1e-10, abs=0)


def test_against_scipy_over_the_whole_range_student_distribution(over_trials):
    rng = np.random.default_rng(4)
    n = 1500
    t, p, k = rng.normal(0, 5, n), rng.uniform(1e-6, 1, n), np.floor(np.exp(rng.uniform(0, 20, n)))
    pairs = [
        (over_trials("T.DIST", t, k, 1), stats.t.cdf(t, k)),
        (over_trials("T.DIST", t, k, 0), stats.t.pdf(t, k)),
        (over_trials("T.DIST.RT", t, k), stats.t.sf(t, k)),
        (over_trials("T.INV", p, k), stats.t.ppf(p, k)),
        (over_trials("T.INV.2T", p, k), stats.t.isf(p / 2, k)),
    ]
    for result, expected in pairs:
        np.testing.assert_allclose(result, expected, rtol=1e-9)
