"""Families whose likelihood is highest where an equation of one unknown holds, or where a search finds it."""

from __future__ import annotations

import numpy as np

from xlmc.studies.fitting.candidate import Candidate, Floats, Params, refuse
from xlmc.studies.fitting.maximise import maximise, root

__all__ = ["SOLVED_FORMS"]

_AT_ZERO = frozenset({"Location"})
_MOST_FREEDOM = 200.0
"""Student's t with more degrees of freedom is a normal to the eye, and to any sample."""


def _gamma(x: Floats) -> Params:
    from scipy.special import digamma

    refuse(x[0] <= 0, "it takes values above 0 only")
    gap = float(np.log(x.mean()) - np.log(x).mean())
    shape = root(lambda k: float(digamma(k) - np.log(k)) + gap, 0.1, 10.0)
    return 0.0, float(x.mean()) / shape, shape


def _gamma_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    from scipy.special import gammaln

    z = (x - location) / scale
    return np.asarray((shape - 1) * np.log(z) - z - gammaln(shape) - np.log(scale))


def _gamma_cdf(x: Floats, location: float, scale: float, shape: float) -> Floats:
    from scipy.special import gammainc

    return np.asarray(gammainc(shape, (x - location) / scale))


def _weibull(x: Floats) -> Params:
    refuse(x[0] <= 0, "it takes values above 0 only")
    logs = np.log(x) - np.log(x[-1])

    def slope(shape: float) -> float:
        powers = np.exp(shape * logs)
        return float(np.sum(powers * logs) / np.sum(powers) - 1 / shape - logs.mean())

    shape = root(slope, 0.1, 10.0)
    return 0.0, float(x[-1] * np.mean(np.exp(shape * logs)) ** (1 / shape)), shape


def _weibull_log(x: Floats, location: float, scale: float, shape: float) -> Floats:
    z = np.log((x - location) / scale)
    return np.asarray(np.log(shape / scale) + (shape - 1) * z - np.exp(shape * z))


def _weibull_cdf(x: Floats, location: float, scale: float, shape: float) -> Floats:
    return np.asarray(-np.expm1(-(((x - location) / scale) ** shape)))


def _maximum_extreme(x: Floats) -> Params:
    mean, spread = float(x.mean()), float(x.std())
    z = (x - mean) / spread

    def slope(scale: float) -> float:
        weights = np.exp(-(z - z[0]) / scale)
        return scale + float(np.sum(z * weights) / np.sum(weights))

    scale = root(slope, 0.1, 2.0)
    likeliest = float(z[0]) - scale * float(np.log(np.mean(np.exp(-(z - z[0]) / scale))))
    return mean + spread * likeliest, spread * scale


def _maximum_log(x: Floats, likeliest: float, scale: float) -> Floats:
    z = (x - likeliest) / scale
    return np.asarray(-z - np.exp(-z) - np.log(scale))


def _maximum_cdf(x: Floats, likeliest: float, scale: float) -> Floats:
    return np.asarray(np.exp(-np.exp(-(x - likeliest) / scale)))


def _minimum_extreme(x: Floats) -> Params:
    likeliest, scale = _maximum_extreme(-x[::-1])
    return -likeliest, scale


def _minimum_log(x: Floats, likeliest: float, scale: float) -> Floats:
    return _maximum_log(-x, -likeliest, scale)


def _minimum_cdf(x: Floats, likeliest: float, scale: float) -> Floats:
    return np.asarray(-np.expm1(-np.exp((x - likeliest) / scale)))


def _logistic(x: Floats) -> Params:
    mean, spread = float(x.mean()), float(x.std())
    z = (x - mean) / spread
    middle, log_scale = maximise(lambda p: float(np.sum(_logistic_log(z, p[0], np.exp(p[1])))), [0.0, np.log(0.55)])
    return mean + spread * float(middle), spread * float(np.exp(log_scale))


def _logistic_log(x: Floats, mean: float, scale: float) -> Floats:
    z = np.abs(x - mean) / scale
    return np.asarray(-z - 2 * np.log1p(np.exp(-z)) - np.log(scale))


def _logistic_cdf(x: Floats, mean: float, scale: float) -> Floats:
    from scipy.special import expit

    return np.asarray(expit((x - mean) / scale))


def _student(x: Floats) -> Params:
    """On values measured from their median in interquartile ranges, from three degrees of freedom up."""
    quarter, middle, three_quarters = (float(value) for value in np.percentile(x, [25, 50, 75]))
    spread = three_quarters - quarter
    refuse(not spread > 0, "half of the values are equal")
    z = (x - middle) / spread
    found = maximise(lambda p: float(np.sum(_student_log(z, p[0], np.exp(p[1]), np.exp(p[2])))), [0.0, -0.4, np.log(3)])
    midpoint, scale, freedom = float(found[0]), float(np.exp(found[1])), float(np.exp(found[2]))
    refuse(freedom > _MOST_FREEDOM, "the values have no heavier tails than the normal's")
    refuse(freedom < 0.1, "its likelihood has no highest point")
    return middle + spread * midpoint, spread * scale, freedom


def _student_log(x: Floats, midpoint: float, scale: float, freedom: float) -> Floats:
    from scipy.special import betaln

    z = (x - midpoint) / scale
    height = -betaln(0.5, freedom / 2) - np.log(freedom) / 2 - np.log(scale)
    return np.asarray(height - (freedom + 1) / 2 * np.log1p(z * z / freedom))


def _student_cdf(x: Floats, midpoint: float, scale: float, freedom: float) -> Floats:
    from scipy.special import stdtr

    return np.asarray(stdtr(freedom, (x - midpoint) / scale))


def _beta(x: Floats) -> Params:
    refuse(x[0] <= 0 or x[-1] >= 1, "it is fitted to values between 0 and 1 only")
    mean, variance = float(x.mean()), float(x.var())
    both = max(mean * (1 - mean) / variance - 1, 0.1)
    start = [np.log(mean * both), np.log((1 - mean) * both)]
    found = maximise(lambda p: float(np.sum(_beta_log(x, 0.0, 1.0, np.exp(p[0]), np.exp(p[1])))), start)
    return 0.0, 1.0, float(np.exp(found[0])), float(np.exp(found[1]))


def _beta_log(x: Floats, low: float, high: float, alpha: float, beta: float) -> Floats:
    from scipy.special import betaln

    z = (x - low) / (high - low)
    return np.asarray((alpha - 1) * np.log(z) + (beta - 1) * np.log1p(-z) - betaln(alpha, beta) - np.log(high - low))


def _beta_cdf(x: Floats, low: float, high: float, alpha: float, beta: float) -> Floats:
    from scipy.special import betainc

    return np.asarray(betainc(alpha, beta, (x - low) / (high - low)))


SOLVED_FORMS = (
    Candidate("Gamma", ("Location", "Scale", "Shape"), _gamma, _gamma_log, _gamma_cdf, fixed=_AT_ZERO),
    Candidate("Weibull", ("Location", "Scale", "Shape"), _weibull, _weibull_log, _weibull_cdf, fixed=_AT_ZERO),
    Candidate("Maximum Extreme", ("Likeliest", "Scale"), _maximum_extreme, _maximum_log, _maximum_cdf),
    Candidate("Minimum Extreme", ("Likeliest", "Scale"), _minimum_extreme, _minimum_log, _minimum_cdf),
    Candidate("Logistic", ("Mean", "Scale"), _logistic, _logistic_log, _logistic_cdf),
    Candidate("Student's t", ("Midpoint", "Scale", "Degrees of freedom"), _student, _student_log, _student_cdf),
    Candidate("Beta", ("Low", "High", "Alpha", "Beta"), _beta, _beta_log, _beta_cdf, fixed=frozenset({"Low", "High"})),
)
