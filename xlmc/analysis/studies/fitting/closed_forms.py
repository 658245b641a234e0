"""Families whose likelihood is highest at a point that a formula gives."""

from __future__ import annotations

import numpy as np

from xlmc.analysis.studies.fitting.candidate import Candidate, Errors, Floats, Params, refuse

__all__ = ["CLOSED_FORMS"]

_LOG_2PI = float(np.log(2 * np.pi))
_EXACT = "exact sampling distribution"


def _normal(x: Floats) -> Params:
    return float(x.mean()), float(x.std())


def _normal_log(x: Floats, mean: float, std_dev: float) -> Floats:
    z = (x - mean) / std_dev
    return np.asarray(-z * z / 2 - np.log(std_dev) - _LOG_2PI / 2)


def _normal_cdf(x: Floats, mean: float, std_dev: float) -> Floats:
    from scipy.special import ndtr

    return np.asarray(ndtr((x - mean) / std_dev))


def _uniform(x: Floats) -> Params:
    return float(x[0]), float(x[-1])


def _uniform_log(x: Floats, low: float, high: float) -> Floats:
    return np.where((x >= low) & (x <= high), -np.log(high - low), -np.inf)


def _uniform_cdf(x: Floats, low: float, high: float) -> Floats:
    return np.clip((x - low) / (high - low), 0.0, 1.0)


def _uniform_errors(x: Floats, params: Params) -> Errors:
    """Fit a Uniform: the smallest and the largest of n uniforms have the variance n/((n + 1)²(n + 2)) of the width
    squared.
    """
    n, (low, high) = x.size, params
    error = (high - low) * float(np.sqrt(n / (n + 2))) / (n + 1)
    return error, error


def _lognormal(x: Floats) -> Params:
    refuse(x[0] <= 0, "it takes values above 0 only")
    mu, sigma = float(np.log(x).mean()), float(np.log(x).std())
    mean = float(np.exp(mu + sigma**2 / 2))
    return 0.0, mean, mean * float(np.sqrt(np.expm1(sigma**2)))


def _of_logarithm(mean: float, std_dev: float) -> tuple[float, float]:
    """Mean and standard deviation of ln X from those of X."""
    square = np.log1p((std_dev / mean) ** 2)
    return float(np.log(mean) - square / 2), float(np.sqrt(square))


def _lognormal_log(x: Floats, location: float, mean: float, std_dev: float) -> Floats:
    logarithm = np.log(x - location)
    return _normal_log(logarithm, *_of_logarithm(mean, std_dev)) - logarithm


def _lognormal_cdf(x: Floats, location: float, mean: float, std_dev: float) -> Floats:
    return _normal_cdf(np.log(x - location), *_of_logarithm(mean, std_dev))


def _exponential(x: Floats) -> Params:
    refuse(x[0] < 0, "it takes values from 0 up only")
    return (1 / float(x.mean()),)


def _exponential_log(x: Floats, rate: float) -> Floats:
    return np.asarray(np.log(rate) - rate * x)


def _exponential_cdf(x: Floats, rate: float) -> Floats:
    return np.asarray(-np.expm1(-rate * x))


def _pareto(x: Floats) -> Params:
    refuse(x[0] <= 0, "it takes values above 0 only")
    return float(x[0]), x.size / float(np.sum(np.log(x / x[0])))


def _pareto_log(x: Floats, location: float, shape: float) -> Floats:
    return np.where(x >= location, np.log(shape / x) - shape * np.log(x / location), -np.inf)


def _pareto_cdf(x: Floats, location: float, shape: float) -> Floats:
    return np.asarray(-np.expm1(-shape * np.log(np.maximum(x / location, 1.0))))


def _pareto_errors(x: Floats, params: Params) -> Errors:
    """Fit a Pareto: the smallest of n has the shape n times as large; n/shape over the estimate is a gamma number."""
    n, (location, shape) = x.size, params
    both = n * shape
    of_location = location * np.sqrt(both / (both - 2)) / (both - 1) if both > 2 else None
    of_shape = shape * n / ((n - 2) * np.sqrt(n - 3)) if n > 3 else None
    return None if of_location is None else float(of_location), None if of_shape is None else float(of_shape)


CLOSED_FORMS = (
    Candidate("Normal", ("Mean", "Std dev"), _normal, _normal_log, _normal_cdf),
    Candidate(
        "Uniform", ("Low", "High"), _uniform, _uniform_log, _uniform_cdf, errors=_uniform_errors, errors_from=_EXACT
    ),
    Candidate(
        "Lognormal",
        ("Location", "Mean", "Std dev"),
        _lognormal,
        _lognormal_log,
        _lognormal_cdf,
        fixed=frozenset({"Location"}),
    ),
    Candidate("Exponential", ("Rate",), _exponential, _exponential_log, _exponential_cdf),
    Candidate(
        "Pareto", ("Location", "Shape"), _pareto, _pareto_log, _pareto_cdf, errors=_pareto_errors, errors_from=_EXACT
    ),
)
