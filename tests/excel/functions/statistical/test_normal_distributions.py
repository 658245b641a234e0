from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

HELP = [
    ("NORM.DIST", (42, 40, 1.5, True), "0.9087888"),
    ("NORM.DIST", (42, 40, 1.5, False), "0.10934"),
    ("NORMDIST", (42, 40, 1.5, True), "0.9087888"),
    ("NORM.INV", (0.908789, 40, 1.5), "42.000002"),
    ("NORMINV", (0.908789, 40, 1.5), "42.000002"),
    ("NORM.S.DIST", (1.333333, True), "0.908788726"),
    ("NORM.S.DIST", (1.333333, False), "0.164010148"),
    ("NORMSDIST", (1.333333,), "0.908788726"),
    ("NORM.S.INV", (0.908789,), "1.3333347"),
    ("NORMSINV", (0.9088,), "1.3334"),
    ("STANDARDIZE", (42, 40, 1.5), "1.33333333"),
    ("GAUSS", (2,), "0.47725"),
    ("PHI", (0.75,), "0.301137432"),
    ("LOGNORM.DIST", (4, 3.5, 1.2, True), "0.0390836"),
    ("LOGNORM.DIST", (4, 3.5, 1.2, False), "0.0176176"),
    ("LOGNORMDIST", (4, 3.5, 1.2), "0.0390836"),
    ("LOGNORM.INV", (0.039084, 3.5, 1.2), "4.0000252"),
    ("LOGINV", (0.039084, 3.5, 1.2), "4.0000252"),
    ("CONFIDENCE.NORM", (0.05, 2.5, 50), "0.692952"),
    ("CONFIDENCE", (0.05, 2.5, 50), "0.692952"),
    ("FISHER", (0.75,), "0.9729551"),
    ("FISHERINV", (0.972955,), "0.75"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE = [
    ("NORM.S.DIST", (-37.5, True), 4.6053530095819548438e-308),
    ("NORM.S.DIST", (-20, True), 2.7536241186062336951e-89),
    ("NORM.S.DIST", (-8, True), 6.2209605742717841235e-16),
    ("NORM.S.DIST", (-1e-9, True), 0.4999999996010577196),
    ("NORM.S.DIST", (5, True), 0.99999971334842812081),
    ("NORMSDIST", (-20,), 2.7536241186062336951e-89),
    ("NORM.S.INV", (2.7536241186062336951e-89,), -20),
    ("NORM.S.INV", (0.5,), 0),
    ("GAUSS", (1e-10,), 3.9894228040143269247e-11),
    ("GAUSS", (-0.3,), -0.11791142218895263307),
    ("GAUSS", (6,), 0.49999999901341235496),
    ("NORM.DIST", (40, 40, 1.5, True), 0.5),
    ("NORM.DIST", ("40", 40, "1.5", "TRUE"), 0.5),
    ("NORM.DIST", (None, 0, 1, True), 0.5),
    ("CONFIDENCE.NORM", (0.05, 2.5, 50.9), 0.692951912174839),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-13)


ERRORS = [
    ("NORM.DIST", (42, 40, 0, True), NUM),
    ("NORM.DIST", (42, 40, -1, False), NUM),
    ("NORM.DIST", ("x", 40, 0, True), VALUE),
    ("NORM.DIST", (42, 40, 1.5, "yes"), VALUE),
    ("NORM.DIST", (42, NA, 0, True), NA),
    ("NORM.INV", (0, 40, 1.5), NUM),
    ("NORM.INV", (1, 40, 1.5), NUM),
    ("NORM.INV", (0.5, 40, 0), NUM),
    ("NORM.S.INV", (0,), NUM),
    ("NORM.S.INV", (1,), NUM),
    ("NORM.S.INV", (-0.5,), NUM),
    ("STANDARDIZE", (1, 2, 0), NUM),
    ("LOGNORM.DIST", (0, 3.5, 1.2, True), NUM),
    ("LOGNORM.DIST", (-1, 3.5, 1.2, False), NUM),
    ("LOGNORM.DIST", (4, 3.5, 0, True), NUM),
    ("LOGNORM.INV", (0, 3.5, 1.2), NUM),
    ("LOGNORM.INV", (1, 3.5, 1.2), NUM),
    ("LOGNORM.INV", (0.5, 3.5, 0), NUM),
    ("CONFIDENCE.NORM", (0, 2.5, 50), NUM),
    ("CONFIDENCE.NORM", (1, 2.5, 50), NUM),
    ("CONFIDENCE.NORM", (0.05, 0, 50), NUM),
    ("CONFIDENCE.NORM", (0.05, 2.5, 0.9), NUM),
    ("FISHER", (1,), NUM),
    ("FISHER", (-1,), NUM),
    ("FISHER", ("x",), VALUE),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), ERRORS)
def test_errors(check, name, arguments, expected):
    check(name, arguments, expected)


def test_a_range_of_arguments_gives_a_range_of_results(evaluate):
    result = evaluate("NORM.S.DIST", [[0, -20]], [[True], [False]])
    expected = [[0.5, 2.7536241186062337e-89], [0.3989422804014327, 5.520948362159764e-88]]
    assert np.array(result) == pytest.approx(np.array(expected), rel=1e-13)


def test_against_scipy_over_the_whole_range(over_trials):
    rng = np.random.default_rng(1)
    n = 2000
    x, mean, deviation = np.exp(rng.uniform(-14, 14, n)), rng.normal(0, 3, n), np.exp(rng.uniform(-3, 2, n))
    z, p = rng.uniform(-37, 37, n), np.exp(rng.uniform(-690, 0, n))
    pairs = [
        (over_trials("NORM.DIST", z, mean, deviation, 1), stats.norm.cdf(z, mean, deviation)),
        (over_trials("NORM.DIST", z, mean, deviation, 0), stats.norm.pdf(z, mean, deviation)),
        (over_trials("NORM.INV", p, mean, deviation), stats.norm.ppf(p, mean, deviation)),
        (over_trials("LOGNORM.DIST", x, mean, deviation, 1), stats.norm.cdf(np.log(x), mean, deviation)),
        (over_trials("LOGNORM.DIST", x, mean, deviation, 0), stats.norm.pdf(np.log(x), mean, deviation) / x),
        (over_trials("LOGNORM.INV", p, mean, deviation), np.exp(stats.norm.ppf(p, mean, deviation))),
    ]
    for result, expected in pairs:
        np.testing.assert_allclose(result, expected, rtol=1e-12, atol=1e-300)
