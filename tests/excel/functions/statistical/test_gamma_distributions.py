from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

HELP = [
    ("GAMMA", (2.5,), "1.329"),
    ("GAMMA", (-3.75,), "0.268"),
    ("GAMMALN", (4,), "1.7917595"),
    ("GAMMALN.PRECISE", (4.5,), "2.453736571"),
    ("GAMMA.DIST", (10.00001131, 9, 2, False), "0.032639"),
    ("GAMMA.DIST", (10.00001131, 9, 2, True), "0.068094"),
    ("GAMMADIST", (10.00001131, 9, 2, True), "0.068094"),
    ("GAMMA.INV", (0.068094, 9, 2), "10.0000112"),
    ("GAMMAINV", (0.068094, 9, 2), "10.0000112"),
    ("CHISQ.DIST", (0.5, 1, True), "0.52049988"),
    ("CHISQ.DIST", (2, 3, False), "0.20755375"),
    ("CHISQ.DIST.RT", (18.307, 10), "0.0500006"),
    ("CHIDIST", (18.307, 10), "0.0500006"),
    ("CHISQ.INV", (0.93, 1), "3.283020287"),
    ("CHISQ.INV", (0.6, 2), "1.832581464"),
    ("CHISQ.INV.RT", (0.050001, 10), "18.306973"),
    ("CHIINV", (0.050001, 10), "18.306973"),
    ("EXPON.DIST", (0.2, 10, True), "0.86466472"),
    ("EXPON.DIST", (0.2, 10, False), "1.35335283"),
    ("EXPONDIST", (0.2, 10, True), "0.86466472"),
    ("WEIBULL.DIST", (105, 20, 100, True), "0.929581"),
    ("WEIBULL.DIST", (105, 20, 100, False), "0.035589"),
    ("WEIBULL", (105, 20, 100, True), "0.929581"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE = [
    ("GAMMA", (5,), 24),
    ("GAMMA", ("0.5",), 1.77245385090551602730),
    ("GAMMA", (-2.5,), -0.945308720482941881226),
    ("GAMMALN", (1e10,), 220258509288.811),
    ("GAMMA.DIST", (1e-30, 0.5, 1, True), 1.1283791670955126209e-15),
    ("GAMMA.DIST", (50, 100, 1, True), 3.2000653245851252938e-10),
    ("GAMMA.DIST", (0.001, 20, 1, True), 4.1064049028301252161e-79),
    ("GAMMA.DIST", (91769368.88615413, 91780374.88172993, 1, False), 2.1526475002842968e-05),
    ("GAMMA.DIST", (1e-5, 1e-3, 1, False), 98.911316339601731),
    ("GAMMA.DIST", (0, 1, 2, False), 0.5),
    ("GAMMA.DIST", (0, 2, 2, False), 0),
    ("GAMMA.DIST", (0, 0.5, 2, True), 0),
    ("GAMMA.INV", (0, 9, 2), 0),
    ("CHISQ.DIST", (50, 200.9, True), 1.2293884805874628e-29),
    ("CHISQ.DIST", (0, 2, False), 0.5),
    ("CHISQ.DIST.RT", (1400, 4), 6.9116332571755993706e-302),
    ("CHISQ.DIST.RT", (600, 200.9), 1.4110215102111521394e-41),
    ("CHISQ.DIST.RT", (0, 1), 1),
    ("CHISQ.DIST.RT", (1e10, 1e10), 0.49999811936805483),
    ("CHISQ.INV", (0, 3), 0),
    ("CHISQ.INV.RT", (1, 3), 0),
    ("CHISQ.INV.RT", (6.9116332571755993706e-302, 4), 1400),
    ("EXPON.DIST", (1e-20, 1, True), 1e-20),
    ("EXPON.DIST", (0, 2, False), 2),
    ("WEIBULL.DIST", (1e-20, 1, 1, True), 1e-20),
    ("WEIBULL.DIST", (0, 0.5, 2, True), 0),
    ("WEIBULL.DIST", (0, 2, 3, False), 0),
    ("WEIBULL.DIST", (0, 1, 1, False), 0),
    ("WEIBULL.DIST", (1, 1, 1, False), 0.36787944117144232160),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-13)


ERRORS = [
    ("GAMMA", (0,), NUM),
    ("GAMMA", (-3,), NUM),
    ("GAMMA", (172,), NUM),
    ("GAMMALN", (0,), NUM),
    ("GAMMALN", (-0.5,), NUM),
    ("GAMMA.DIST", (-0.1, 9, 2, True), NUM),
    ("GAMMA.DIST", (1, 0, 2, True), NUM),
    ("GAMMA.DIST", (1, 9, 0, True), NUM),
    ("GAMMA.DIST", (0, 0.5, 2, False), NUM),
    ("GAMMA.DIST", (0, NA, 2, "x"), NA),
    ("GAMMA.INV", (-0.1, 9, 2), NUM),
    ("GAMMA.INV", (1, 9, 2), NUM),
    ("GAMMA.INV", (0.5, 0, 2), NUM),
    ("GAMMA.INV", (0.5, 9, 0), NUM),
    ("CHISQ.DIST", (-1, 1, True), NUM),
    ("CHISQ.DIST", (1, 0.9, True), NUM),
    ("CHISQ.DIST", (1, 10000000000.1, True), NUM),
    ("CHISQ.DIST", (0, 1, False), NUM),
    ("CHISQ.DIST.RT", (-1, 1), NUM),
    ("CHISQ.DIST.RT", ("x", 1), VALUE),
    ("CHISQ.INV", (1, 3), NUM),
    ("CHISQ.INV", (-0.1, 3), NUM),
    ("CHISQ.INV", (0.5, 0.9), NUM),
    ("CHISQ.INV.RT", (0, 3), NUM),
    ("CHISQ.INV.RT", (1.1, 3), NUM),
    ("EXPON.DIST", (-1, 1, True), NUM),
    ("EXPON.DIST", (1, 0, True), NUM),
    ("WEIBULL.DIST", (-1, 1, 1, True), NUM),
    ("WEIBULL.DIST", (1, 0, 1, True), NUM),
    ("WEIBULL.DIST", (1, 1, 0, True), NUM),
    ("WEIBULL.DIST", (0, 0.5, 1, False), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), ERRORS)
def test_errors(check, name, arguments, expected):
    check(name, arguments, expected)


N = 1500
RNG = np.random.default_rng(2)
SHAPE = np.exp(RNG.uniform(-7, 18, N))
X = SHAPE * np.exp(3 * RNG.normal(0, 1, N) / np.sqrt(SHAPE))
FREEDOM = np.floor(np.exp(RNG.uniform(0, 18, N)))
CHI = FREEDOM * np.exp(3 * RNG.normal(0, 1, N) / np.sqrt(FREEDOM))
P = RNG.uniform(0, 1, N)


@pytest.mark.parametrize(
    ("name", "arguments", "expected", "rel"),
    [
        ("GAMMA.DIST", (2 * X, SHAPE, 2, 1), lambda: stats.gamma.cdf(X, SHAPE), 1e-12),
        ("GAMMA.DIST", (2 * X, SHAPE, 2, 0), lambda: stats.gamma.pdf(X, SHAPE) / 2, 3e-7),  # SciPy's own digits
        ("GAMMA.INV", (P, SHAPE, 2), lambda: stats.gamma.ppf(P, SHAPE) * 2, 1e-13),
        ("CHISQ.DIST", (CHI, FREEDOM + 0.5, 1), lambda: stats.chi2.cdf(CHI, FREEDOM), 1e-13),
        ("CHISQ.DIST.RT", (CHI, FREEDOM), lambda: stats.chi2.sf(CHI, FREEDOM), 1e-13),
        ("CHISQ.INV", (P, FREEDOM), lambda: stats.chi2.ppf(P, FREEDOM), 1e-13),
        ("CHISQ.INV.RT", (P, FREEDOM), lambda: stats.chi2.isf(P, FREEDOM), 1e-13),
        ("EXPON.DIST", (X, SHAPE, 1), lambda: stats.expon.cdf(X, scale=1 / SHAPE), 1e-12),
        ("WEIBULL.DIST", (X, 3 * P + 0.1, SHAPE, 1), lambda: stats.weibull_min.cdf(X, 3 * P + 0.1, scale=SHAPE), 1e-12),
        ("WEIBULL.DIST", (X, 3 * P + 0.1, SHAPE, 0), lambda: stats.weibull_min.pdf(X, 3 * P + 0.1, scale=SHAPE), 1e-11),
    ],
)
def test_against_scipy_over_the_whole_range(over_trials, name, arguments, expected, rel):
    np.testing.assert_allclose(over_trials(name, *arguments), expected(), rtol=rel, atol=1e-300)
