from __future__ import annotations

from fractions import Fraction
from itertools import accumulate
from math import comb

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from xlmc.errors import ErrorCode

NUM, VALUE, NA = ErrorCode.NUM, ErrorCode.VALUE, ErrorCode.NA

HELP = [
    ("POISSON.DIST", (2, 5, True), "0.124652"),
    ("POISSON.DIST", (2, 5, False), "0.084224"),
    ("POISSON", (2, 5, False), "0.084224"),
    ("BINOM.DIST", (6, 10, 0.5, False), "0.2050781"),
    ("BINOMDIST", (6, 10, 0.5, False), "0.2050781"),
    ("BINOM.DIST.RANGE", (60, 0.75, 48), "0.084"),
    ("BINOM.DIST.RANGE", (60, 0.75, 45, 50), "0.524"),
    ("BINOM.INV", (6, 0.5, 0.75), "4"),
    ("CRITBINOM", (6, 0.5, 0.75), "4"),
    ("NEGBINOM.DIST", (10, 5, 0.25, True), "0.3135141"),
    ("NEGBINOM.DIST", (10, 5, 0.25, False), "0.0550487"),
    ("NEGBINOMDIST", (10, 5, 0.25), "0.05504866"),
    ("HYPGEOM.DIST", (1, 4, 8, 20, True), "0.4654"),
    ("HYPGEOM.DIST", (1, 4, 8, 20, False), "0.3633"),
    ("HYPGEOMDIST", (1, 4, 8, 20), "0.363261"),
]


@pytest.mark.parametrize(("name", "arguments", "printed"), HELP)
def test_examples_of_excels_help(shows, name, arguments, printed):
    shows(name, arguments, printed)


TABLE = [
    ("POISSON.DIST", (0, 0, True), 1),
    ("POISSON.DIST", (0, 0, False), 1),
    ("POISSON.DIST", (5.9, 2, False), 0.036089408863096716),
    ("POISSON.DIST", (993702635, 993655954, False), 4.2274572874897610619e-6),
    ("POISSON.DIST", (0, 700, True), 9.859676543759770e-305),
    ("BINOM.DIST", (6.9, 10.9, 0.5, True), 0.828125),
    ("BINOM.DIST", (0, 0, 0.5, False), 1),
    ("BINOM.DIST", (0.5, 0.4, 1, False), 1),
    ("BINOM.DIST", (0, 7, 0, True), 1),
    ("BINOM.DIST", (7, 7, 1, False), 1),
    ("BINOM.DIST", (6, 7, 1, True), 0),
    ("BINOM.DIST", (22937751, 182492109, 0.1258196291747408, True), 9.448453254686476e-8),
    ("BINOM.DIST.RANGE", (60, 0.75, 0, 60), 1),
    ("BINOM.DIST.RANGE", (60, 0.75, 48, 48.9), 0.08397496742904752),
    ("BINOM.INV", (0, 0.8, 0.999), 0),
    ("BINOM.INV", (1, 0.8, 0.2), 0),  # 1 - 0.8 falls short of 0.2 in doubles; Excel gives 0 nevertheless
    ("BINOM.INV", (1, 0.1, 0.9), 0),
    ("BINOM.INV", (1000.9, 0.8, 0.999), 838),
    ("BINOM.INV", (2**31 - 1, 0.5, 1e-300), 1072883425),
    ("NEGBINOM.DIST", (10.9, 20.9, 0.5, True), 0.0493685733526945114),
    ("HYPGEOM.DIST", (4.9, 12, 20, 40, False), 0.10924300273577196),
    ("HYPGEOM.DIST", (12, 12, 20, 40, True), 1),
    ("HYPGEOM.DIST", (0, 12, 20, 40, True), 0.00002254757538406058),
    ("HYPGEOM.DIST", (69900, 480640, 136444, 940713, True), 0.86323816592413617),
    ("HYPGEOM.DIST", (69696, 480640, 136444, 940713, True), 0.46021676087218487),
    ("HYPGEOM.DIST", (20, 20, 20, 20, True), 1),
    ("HYPGEOMDIST", (20, 20, 20, 20), 1),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), TABLE)
def test_table(check, name, arguments, expected):
    check(name, arguments, expected, rel=1e-13)


ERRORS = [
    ("POISSON.DIST", (-0.01, 5, True), NUM),
    ("POISSON.DIST", (2, -0.01, True), NUM),
    ("POISSON.DIST", ("x", -1, True), VALUE),
    ("BINOM.DIST", (-1, 10, 0.5, True), NUM),
    ("BINOM.DIST", (11, 10, 0.5, True), NUM),
    ("BINOM.DIST", (1, 10, -0.1, True), NUM),
    ("BINOM.DIST", (1, 10, 1.1, False), NUM),
    ("BINOM.DIST.RANGE", (60, 0.75, 50, 45), NUM),
    ("BINOM.DIST.RANGE", (60, 0.75, 50, 61), NUM),
    ("BINOM.DIST.RANGE", (60, 0.75, -1, 6), NUM),
    ("BINOM.DIST.RANGE", (60, 1.75, 1, 6), NUM),
    ("BINOM.DIST.RANGE", (60, 0.75, 61), NUM),
    ("BINOM.INV", (-1, 0.5, 0.5), NUM),
    ("BINOM.INV", (10, -0.1, 0.5), NUM),
    ("BINOM.INV", (10, 1.1, 0.5), NUM),
    ("BINOM.INV", (10, 0, 0.5), NUM),
    ("BINOM.INV", (10, 1, 0.5), NUM),
    ("BINOM.INV", (10, 0.5, 0), NUM),
    ("BINOM.INV", (10, 0.5, 1), NUM),
    ("BINOM.INV", (2**31, 0.5, 0.5), NUM),
    ("NEGBINOM.DIST", (-1, 1, 0.5, True), NUM),
    ("NEGBINOM.DIST", (0, 0.9, 0.5, True), NUM),
    ("NEGBINOM.DIST", (0, 1, 0, False), NUM),
    ("NEGBINOM.DIST", (0, 1, 1, True), NUM),
    ("NEGBINOM.DIST", (0, 1, 1.1, True), NUM),
    ("NEGBINOMDIST", (0, NA, 1.1), NA),
    ("HYPGEOM.DIST", (-1, 4, 8, 20, True), NUM),
    ("HYPGEOM.DIST", (5, 4, 8, 20, True), NUM),
    ("HYPGEOM.DIST", (9, 10, 8, 20, True), NUM),
    ("HYPGEOM.DIST", (0, 15, 8, 20, True), NUM),
    ("HYPGEOM.DIST", (0, 0, 8, 20, True), NUM),
    ("HYPGEOM.DIST", (1, 21, 8, 20, True), NUM),
    ("HYPGEOM.DIST", (0, 4, 0, 20, True), NUM),
    ("HYPGEOM.DIST", (1, 4, 21, 20, True), NUM),
    ("HYPGEOM.DIST", (1, 4, 8, 2**31, True), NUM),
]


@pytest.mark.parametrize(("name", "arguments", "expected"), ERRORS)
def test_errors(check, name, arguments, expected):
    check(name, arguments, expected)


@given(st.integers(1, 40), st.fractions(0, 1, max_denominator=50), st.data())
@settings(max_examples=150, deadline=None)
def test_binomial_sums_are_exact(evaluate, n, p, data):
    k = data.draw(st.integers(0, n))
    masses = [comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(n + 1)]
    assert evaluate("BINOM.DIST", k, n, float(p), False) == pytest.approx(float(masses[k]), rel=1e-12, abs=1e-300)
    below = float(sum(masses[: k + 1]))
    assert evaluate("BINOM.DIST", k, n, float(p), True) == pytest.approx(below, rel=1e-12, abs=1e-300)
    most = data.draw(st.integers(k, n))
    between = float(sum(masses[k : most + 1]))
    assert evaluate("BINOM.DIST.RANGE", n, float(p), k, most) == pytest.approx(between, rel=1e-11, abs=1e-300)


@given(st.integers(1, 40), st.integers(1, 19), st.integers(1, 99))
@settings(max_examples=150, deadline=None)
def test_the_critical_number_is_the_first_to_reach_alpha(evaluate, n, twentieths, hundredths):
    p, alpha = Fraction(twentieths, 20), Fraction(hundredths, 100)
    below = list(accumulate(comb(n, k) * p**k * (1 - p) ** (n - k) for k in range(n + 1)))
    first = next(k for k in range(n + 1) if below[k] >= alpha)
    assert evaluate("BINOM.INV", n, float(p), float(alpha)) == first


@given(st.integers(1, 40), st.data())
@settings(max_examples=150, deadline=None)
def test_hypergeometric_sums_are_exact(evaluate, size, data):
    drawn, marked = data.draw(st.integers(1, size)), data.draw(st.integers(1, size))
    least, most = max(0, drawn - size + marked), min(drawn, marked)
    x = data.draw(st.integers(least, most))
    ways = [comb(marked, k) * comb(size - marked, drawn - k) for k in range(x + 1)]
    mass, below = (float(Fraction(result, comb(size, drawn))) for result in (ways[x], sum(ways)))
    assert evaluate("HYPGEOM.DIST", x, drawn, marked, size, False) == pytest.approx(mass, rel=1e-12)
    assert evaluate("HYPGEOM.DIST", x, drawn, marked, size, True) == pytest.approx(below, rel=1e-12)


N = 1000
RNG = np.random.default_rng(5)
TRIALS, P = np.floor(np.exp(RNG.uniform(0, 16, N))), RNG.uniform(0, 1, N) * np.exp(RNG.uniform(-7, 0, N))
K = np.clip(np.floor(TRIALS * P + 3 * RNG.normal(0, 1, N) * np.sqrt(TRIALS * P)), 0, TRIALS)
S = np.floor(np.exp(RNG.uniform(0, 10, N)))
F = np.floor(S * (1 - P) / P)
MEAN = np.exp(RNG.uniform(-7, 14, N))
X = np.floor(np.maximum(MEAN + 4 * RNG.normal(0, 1, N) * np.sqrt(MEAN), 0))
ALPHA = RNG.uniform(0, 1, N)


@pytest.mark.parametrize(
    ("name", "arguments", "expected"),
    [
        ("POISSON.DIST", (X, MEAN, 1), lambda: stats.poisson.cdf(X, MEAN)),
        ("POISSON.DIST", (X, MEAN, 0), lambda: stats.poisson.pmf(X, MEAN)),
        ("BINOM.DIST", (K, TRIALS, P, 1), lambda: stats.binom.cdf(K, TRIALS, P)),
        ("BINOM.DIST", (K, TRIALS, P, 0), lambda: stats.binom.pmf(K, TRIALS, P)),
        ("BINOM.INV", (TRIALS, P, ALPHA), lambda: stats.binom.ppf(ALPHA, TRIALS, P)),
        ("NEGBINOM.DIST", (F, S, P, 1), lambda: stats.nbinom.cdf(F, S, P)),
        ("NEGBINOM.DIST", (F, S, P, 0), lambda: stats.nbinom.pmf(F, S, P)),
    ],
)
def test_against_scipy_over_the_whole_range(over_trials, name, arguments, expected):
    np.testing.assert_allclose(over_trials(name, *arguments), expected(), rtol=1e-8, atol=1e-290)
