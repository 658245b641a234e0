"""Families of counts. A parameter that is a whole number is found by trying whole numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from xlmc.analysis.studies.fitting.candidate import INFORMATION, Candidate, Errors, Floats, Params, refuse
from xlmc.montecarlo.distributions import FAMILIES

__all__ = ["COUNTS"]

_MOST = 10_000
"""More successes than this are a Poisson to any sample."""


def _cdf(name: str) -> Callable[..., Any]:
    return FAMILIES[name].cdf


_LARGEST = 2.0**43
_TOO_LARGE = "the values are too large to be counted one by one"


def _best_whole(score: Callable[[float], float], least: float, most: float) -> float:
    """Return the whole number with the highest score, which rises and then falls."""
    low, high = least, most
    while high - low > 2:
        third = np.floor((high - low) / 3)
        left, right = low + max(third, 1), high - max(third, 1)
        if left >= right:
            right = left + 1
        if score(left) < score(right):
            low = left
        else:
            high = right
    return max(np.arange(low, high + 1), key=lambda value: score(float(value)))


def _poisson(x: Floats) -> Params:
    return (float(x.mean()),)


def _poisson_log(x: Floats, rate: float) -> Floats:
    from scipy.special import gammaln, xlogy

    return np.asarray(xlogy(x, rate) - rate - gammaln(x + 1))


def _binomial(x: Floats) -> Params:
    refuse(x[-1] > _LARGEST, _TOO_LARGE)
    mean = float(x.mean())
    refuse(not x.var() < mean, "the variance of the values is not below their mean")
    trials = float(
        _best_whole(lambda n: float(np.sum(_binomial_log(x, mean / n, n))), float(x[-1]), max(float(x[-1]), 1) * 1000)
    )
    refuse(trials >= 999 * x[-1], "with this many trials use Poisson")
    return mean / trials, trials


def _binomial_log(x: Floats, probability: float, trials: float) -> Floats:
    from scipy.special import gammaln, xlog1py, xlogy

    log_count = gammaln(trials + 1) - gammaln(x + 1) - gammaln(trials - x + 1)
    return np.asarray(log_count + xlogy(x, probability) + xlog1py(trials - x, -probability))


def _geometric(x: Floats) -> Params:
    refuse(x[0] < 1, "it counts trials, which are 1 or more")
    return (1 / float(x.mean()),)


def _geometric_log(x: Floats, probability: float) -> Floats:
    return np.asarray(np.log(probability) + (x - 1) * np.log1p(-probability))


def _geomet(x: Floats) -> Params:
    return (1 / (1 + float(x.mean())),)


def _geomet_log(x: Floats, probability: float) -> Floats:
    return _geometric_log(x + 1, probability)


def _negative_binomial(x: Floats) -> Params:
    refuse(x[0] < 1, "it counts trials, which are 1 or more")
    refuse(x[-1] > _LARGEST, _TOO_LARGE)
    mean = float(x.mean())
    shape = float(_best_whole(lambda s: float(np.sum(_negative_log(x, s / mean, s))), 1.0, float(x[0])))
    return shape / mean, shape


def _negative_log(x: Floats, probability: float, shape: float) -> Floats:
    from scipy.special import gammaln

    log_count = gammaln(x) - gammaln(shape) - gammaln(x - shape + 1)
    return np.asarray(log_count + shape * np.log(probability) + (x - shape) * np.log1p(-probability))


def _negbin(x: Floats) -> Params:
    mean = float(x.mean())
    refuse(not x.var() > mean, "the variance of the values is not above their mean")

    def score(shape: float) -> float:
        return float(np.sum(_negative_log(x + shape, shape / (shape + mean), shape)))

    shape = float(_best_whole(score, 1.0, _MOST))
    refuse(shape > 0.99 * _MOST, "with this many successes use Poisson")
    return shape / (shape + mean), shape


def _negbin_log(x: Floats, probability: float, shape: float) -> Floats:
    return _negative_log(x + shape, probability, shape)


def _discrete_uniform(x: Floats) -> Params:
    return float(x[0]), float(x[-1])


def _discrete_uniform_log(x: Floats, low: float, high: float) -> Floats:
    return np.where((x >= low) & (x <= high), -np.log(high - low + 1), -np.inf)


def _no_errors(_: Floats, params: Params) -> Errors:
    return (None,) * len(params)


_GIVEN = f"{INFORMATION}, the whole number taken as continuous"

COUNTS = (
    Candidate("Poisson", ("Rate",), _poisson, _poisson_log, _cdf("Poisson")),
    Candidate(
        "Binomial",
        ("Probability", "Trials"),
        _binomial,
        _binomial_log,
        _cdf("Binomial"),
        errors_from=_GIVEN,
    ),
    Candidate("Geometric", ("Probability",), _geometric, _geometric_log, _cdf("Geometric")),
    Candidate("Geomet", ("Probability",), _geomet, _geomet_log, _cdf("Geomet")),
    Candidate(
        "Negative Binomial",
        ("Probability", "Shape"),
        _negative_binomial,
        _negative_log,
        _cdf("Negative Binomial"),
        errors_from=_GIVEN,
    ),
    Candidate(
        "Negbin",
        ("Probability", "Shape"),
        _negbin,
        _negbin_log,
        _cdf("Negbin"),
        errors_from=_GIVEN,
    ),
    Candidate(
        "Discrete Uniform",
        ("Low", "High"),
        _discrete_uniform,
        _discrete_uniform_log,
        _cdf("Discrete Uniform"),
        errors=_no_errors,
        errors_from="none: the ends are whole numbers",
    ),
)
