from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA, DIV0 = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA, ErrorCode.DIV0

HELP = [
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


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE = [
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


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=2e-13)


ERRORS = [
    ("T.DIST", (1, 0.9, True), NUM),
    ("T.DIST", (1, 0.9, False), DIV0),
    ("T.DIST", (1, -1, False), NUM),
    ("T.DIST", (1, 10000000001, True), NUM),
    ("T.DIST", (1, 2, "x"), VALUE),
    ("T.DIST.2T", (-1, 2), NUM),
    ("T.DIST.2T", (1, 0), NUM),
    ("T.DIST.RT", (1, 0), NUM),
    ("TDIST", (-1, 2, 2), NUM),
    ("TDIST", (1, 0, 2), NUM),
    ("TDIST", (1, 2, 3), NUM),
    ("TDIST", (1, 2, 0), NUM),
    ("T.INV", (0, 2), NUM),
    ("T.INV", (1, 2), NUM),
    ("T.INV", (0.5, 0.9), NUM),
    ("T.INV.2T", (0, 2), NUM),
    ("T.INV.2T", (1.1, 2), NUM),
    ("CONFIDENCE.T", (0, 1, 50), NUM),
    ("CONFIDENCE.T", (1, 1, 50), NUM),
    ("CONFIDENCE.T", (0.05, 0, 50), NUM),
    ("CONFIDENCE.T", (0.05, 1, 0.9), NUM),
    ("CONFIDENCE.T", (0.05, 1, 1.9), DIV0),
    ("CONFIDENCE.T", (NA, "x", 1), NA),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), ERRORS)
def test_errors(check, name, arguments, expected):
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


def test_against_scipy_over_the_whole_range(over_trials):
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
    for found, expected in pairs:
        np.testing.assert_allclose(found, expected, rtol=1e-9)
