"""Families with heavy or long tails, whose likelihood is highest where a formula or an equation says.

Their logarithms and distribution functions are those of `xlmc.montecarlo.distributions`, with location 0 where they
have one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.analysis.studies.fitting.candidate import Candidate, Floats, Params, refuse
from xlmc.analysis.studies.fitting.solved_forms import maximise, root

__all__ = ["SKEWED_FORMS"]

_AT_ZERO = frozenset({"Location"})


def _laplace(x: Floats) -> Params:
    """Return the median, and √2 times the mean distance from it."""
    middle = float(np.median(x))
    return middle, float(np.sqrt(2) * np.mean(np.abs(x - middle)))


def _laplace_log(x: Floats, mean: float, std_dev: float) -> Floats:
    return np.asarray(-np.sqrt(2) * np.abs(x - mean) / std_dev - np.log(np.sqrt(2) * std_dev))


def _laplace_errors(x: Floats, params: Params) -> tuple[float, float]:
    """Return the errors, both σ/√(2n) and σ/√n: the likelihood has a corner at the median."""
    return params[1] / float(np.sqrt(2 * x.size)), params[1] / float(np.sqrt(x.size))


def _secant(x: Floats) -> Params:
    mean, spread = float(x.mean()), float(x.std())
    z = (x - mean) / spread
    middle, log_scale = maximise(lambda p: float(np.sum(_secant_log(z, p[0], np.exp(p[1])))), [0.0, 0.0])
    return mean + spread * float(middle), spread * float(np.exp(log_scale))


def _secant_log(x: Floats, mean: float, std_dev: float) -> Floats:
    z = np.abs(x - mean) * (np.pi / 2) / std_dev
    return np.asarray(-z - np.log1p(np.exp(-2 * z)) - np.log(std_dev))


def _inverse_gaussian(x: Floats) -> Params:
    refuse(x[0] <= 0, "it takes values above 0 only")
    mean = float(x.mean())
    # Not 1/(mean(1/x) − 1/mean), which loses all digits where the values lie close together.
    return 0.0, mean, 1 / float(np.mean(((x - mean) / mean) ** 2 / x))


def _inverse_gaussian_log(x: Floats, location: float, mean: float, shape: float) -> Floats:
    y, m = x - location, mean - location
    return np.asarray(np.log(shape / (2 * np.pi)) / 2 - 1.5 * np.log(y) - shape * (y - m) ** 2 / (2 * m * m * y))


def _log_logistic(x: Floats) -> Params:
    """Fit the log-logistic distribution, whose logarithm is logistic."""
    refuse(x[0] <= 0, "it takes values above 0 only")
    logs = np.log(x)
    mean, spread = float(logs.mean()), float(logs.std())
    z = (logs - mean) / spread

    def height(p: Floats) -> float:
        scaled = np.abs(z - p[0]) / np.exp(p[1])
        return float(np.sum(-scaled - 2 * np.log1p(np.exp(-scaled)) - p[1]))

    middle, log_scale = maximise(height, [0.0, float(np.log(0.55))])
    return 0.0, float(np.exp(mean + spread * middle)), 1 / (spread * float(np.exp(log_scale)))


def _log_logistic_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    z = shape * np.log((x - location) / scale)
    return np.asarray(np.log(shape) - np.log(x - location) - np.abs(z) - 2 * np.log1p(np.exp(-np.abs(z))))


def _frechet(x: Floats) -> Params:
    """One over it is Weibull."""
    refuse(x[0] <= 0, "it takes values above 0 only")
    logs = -np.log(x) + np.log(x[0])

    def slope(shape: float) -> float:
        powers = np.exp(shape * logs)
        return float(np.sum(powers * logs) / np.sum(powers) - 1 / shape - logs.mean())

    shape = root(slope, 0.1, 10.0)
    return 0.0, float(x[0] / np.mean(np.exp(shape * logs)) ** (1 / shape)), shape


def _frechet_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    z = np.log((x - location) / scale)
    return np.asarray(np.log(shape / scale) - (1 + shape) * z - np.exp(-shape * z))


def _fatigue_life(x: Floats) -> Params:
    """Fit the scale, from which the shape follows, by one equation (Birnbaum and Saunders 1969)."""
    refuse(x[0] <= 0, "it takes values above 0 only")
    mean, harmonic = float(x.mean()), 1 / float(np.mean(1 / x))

    def rising(scale: float) -> float:
        rest = 1 / float(np.mean(1 / (scale + x)))
        return scale * scale - scale * (2 * harmonic + rest) + harmonic * (mean + rest)

    from scipy.optimize import brentq

    refuse(not mean > harmonic * (1 + 1e-12), "all values are equal")
    scale = float(brentq(rising, harmonic, mean, xtol=1e-14 * mean, rtol=1e-14))
    return 0.0, scale, float(np.sqrt(mean / scale + scale / harmonic - 2))


def _fatigue_life_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    root_z = np.sqrt((x - location) / scale)
    score = (root_z - 1 / root_z) / shape
    height = np.log((root_z + 1 / root_z) / (2 * shape * (x - location)))
    return np.asarray(height - score**2 / 2 - np.log(2 * np.pi) / 2)


def _pearson5(x: Floats) -> Params:
    """One over it is gamma."""
    from scipy.special import digamma

    refuse(x[0] <= 0, "it takes values above 0 only")
    inverse = 1 / x
    gap = float(np.log(inverse.mean()) - np.log(inverse).mean())
    shape = root(lambda k: float(digamma(k) - np.log(k)) + gap, 0.1, 10.0)
    return 0.0, shape / float(inverse.mean()), shape


def _pearson5_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    from scipy.special import gammaln

    y = x - location
    return np.asarray(shape * np.log(scale) - (shape + 1) * np.log(y) - scale / y - gammaln(shape))


def _cdf(name: str) -> Callable[..., Floats]:
    """Return the distribution function of a family, for parameters in its order."""

    def below(x: Floats, *params: float) -> Floats:
        from xlmc.montecarlo.distributions import FAMILIES

        return FAMILIES[name].cdf(x, *params)

    return below


_SHAPED = ("Location", "Scale", "Shape")
SKEWED_FORMS = (
    Candidate(
        "Laplace",
        ("Mean", "Std dev"),
        _laplace,
        _laplace_log,
        _cdf("Laplace"),
        errors=_laplace_errors,
        errors_from="large samples",
    ),
    Candidate("Hyperbolic secant", ("Mean", "Std dev"), _secant, _secant_log, _cdf("Hyperbolic secant")),
    Candidate(
        "Inverse Gaussian",
        ("Location", "Mean", "Shape"),
        _inverse_gaussian,
        _inverse_gaussian_log,
        _cdf("Inverse Gaussian"),
        fixed=_AT_ZERO,
    ),
    Candidate("Log-logistic", _SHAPED, _log_logistic, _log_logistic_log, _cdf("Log-logistic"), fixed=_AT_ZERO),
    Candidate("Frechet", _SHAPED, _frechet, _frechet_log, _cdf("Frechet"), fixed=_AT_ZERO),
    Candidate("Fatigue life", _SHAPED, _fatigue_life, _fatigue_life_log, _cdf("Fatigue life"), fixed=_AT_ZERO),
    Candidate("Pearson5", _SHAPED, _pearson5, _pearson5_log, _cdf("Pearson5"), fixed=_AT_ZERO),
)
