"""Families of counts: their probabilities against SciPy's, their fits against every whole number tried one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from xlmc.analysis.studies.fitting.candidate import Unfit
from xlmc.analysis.studies.fitting.count_families import COUNTS, _best_whole

FAMILIES = {each.name: each for each in COUNTS}
SCIPY = {
    "Poisson": (lambda rate: stats.poisson(rate), (3.5,)),
    "Binomial": (lambda p, n: stats.binom(n, p), (0.3, 12.0)),
    "Geometric": (lambda p: stats.geom(p), (0.3,)),
    "Geomet": (lambda p: stats.geom(p, loc=-1), (0.3,)),
    "Negative Binomial": (lambda p, r: stats.nbinom(r, p, loc=r), (0.3, 4.0)),
    "Negbin": (lambda p, r: stats.nbinom(r, p), (0.3, 4.0)),
    "Discrete Uniform": (lambda low, high: stats.randint(low, high + 1), (4.0, 9.0)),
}


def test_every_family_is_tried():
    assert FAMILIES.keys() == SCIPY.keys()


@pytest.mark.parametrize("name", SCIPY)
def test_logarithms_of_probabilities(name):
    made, parameters = SCIPY[name]
    law = made(*parameters)
    x = np.arange(*law.support()[:1], law.support()[0] + 12.0) if name != "Discrete Uniform" else np.arange(4.0, 10.0)
    assert FAMILIES[name].log_density(x, *parameters) == pytest.approx(law.logpmf(x), rel=1e-10)


def test_outside_of_its_ends_a_discrete_uniform_is_impossible():
    assert FAMILIES["Discrete Uniform"].log_density(np.array([3.0, 4.0, 9.0, 10.0]), 4.0, 9.0) == pytest.approx(
        [-math.inf, -math.log(6), -math.log(6), -math.inf]
    )


@pytest.mark.parametrize("least", [0.0, 1.0, 7.0])
@pytest.mark.parametrize("size", [0, 1, 2, 3, 4, 5, 8, 50])
def test_the_best_whole_number_is_found_wherever_it_is(least, size):
    for best in range(size + 1):
        result = _best_whole(lambda value, best=best: -abs(value - least - best), least, least + size)
        assert result == least + best


def likelihood(law, x):
    return float(np.sum(law.logpmf(x)))


@pytest.mark.parametrize("seed", range(4))
def test_the_whole_number_is_the_likeliest_of_all(seed):
    rng = np.random.default_rng(seed)
    x = np.sort(rng.binomial(15, 0.4, 300)).astype(float)
    p, n = FAMILIES["Binomial"].estimate(x)
    scores = {each: likelihood(stats.binom(each, x.mean() / each), x) for each in range(int(x[-1]), 200)}
    assert n == max(scores, key=scores.get)
    assert p == pytest.approx(x.mean() / n)
    x = np.sort(rng.negative_binomial(4, 0.4, 300)).astype(float)
    p, r = FAMILIES["Negbin"].estimate(x)
    scores = {each: likelihood(stats.nbinom(each, each / (each + x.mean())), x) for each in range(1, 200)}
    assert r == max(scores, key=scores.get)
    assert p == pytest.approx(r / (r + x.mean()))
    x += 4.0
    p, r = FAMILIES["Negative Binomial"].estimate(x)
    scores = {each: likelihood(stats.nbinom(each, each / x.mean(), loc=each), x) for each in range(1, int(x[0]) + 1)}
    assert r == max(scores, key=scores.get)
    assert p == pytest.approx(r / x.mean())


@pytest.mark.parametrize(
    ("name", "x", "result"),
    [
        ("Poisson", [0.0, 2.0, 4.0], (2.0,)),
        ("Geometric", [1.0, 2.0, 3.0], (0.5,)),
        ("Geomet", [0.0, 1.0, 2.0], (0.5,)),
        ("Discrete Uniform", [2.0, 5.0, 9.0], (2.0, 9.0)),
    ],
)
def test_closed_forms(name, x, result):
    assert FAMILIES[name].estimate(np.array(x)) == pytest.approx(result)


@pytest.mark.parametrize(
    ("name", "x", "why"),
    [
        ("Binomial", [0.0, 2.0, 4.0], "the variance of the values is not below their mean"),  # 8/3 beside 2
        ("Binomial", [1.0, 3.0, 1.0, 3.0, 2.0, 2.0, 0.0, 4.0], None),  # 1.5 beside 2
        ("Binomial", [2.0, 2.0, 2.0, 2.0**44], "the values are too large to be counted one by one"),
        ("Negbin", [1.0, 2.0, 3.0], "the variance of the values is not above their mean"),
        ("Negbin", [0.0, 4.0], None),
        ("Negative Binomial", [0.0, 4.0], "it counts trials, which are 1 or more"),
        ("Negative Binomial", [1.0, 4.0], None),
        ("Geometric", [0.0, 4.0], "it counts trials, which are 1 or more"),
    ],
)
def test_what_cannot_be_fitted_says_why(name, x, why):
    if why is None:
        assert FAMILIES[name].estimate(np.sort(np.array(x)))
        return
    with pytest.raises(Unfit, match=why):
        FAMILIES[name].estimate(np.sort(np.array(x)))


@pytest.mark.parametrize(
    ("name", "ones", "scale", "refused"),
    [
        ("Binomial", 3_001, 1, True),  # a variance below the mean by 1/9001: 9,001 trials, three thousand times the 3
        ("Binomial", 3_010, 1, False),
        ("Negbin", 29_999, 10, True),  # above it by 1/89999: as many successes
        ("Negbin", 29_900, 10, False),
    ],
)
def test_with_very_many_trials_or_successes_it_is_a_poisson(name, ones, scale, refused):
    """Zeros, ones, twos and threes with a mean near 1: mean less variance is about (ones − 3·threes)/n."""
    threes, twos = 1_000 * scale, 1_500 * scale
    x = np.repeat([0.0, 1.0, 2.0, 3.0], [twos + 2 * threes, ones, twos, threes])
    if refused:
        with pytest.raises(Unfit, match="use Poisson"):
            FAMILIES[name].estimate(x)
    else:
        assert 500 < FAMILIES[name].estimate(x)[1] < 1_000  # by moments it is 900
