from __future__ import annotations

import numpy as np
import pytest
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
