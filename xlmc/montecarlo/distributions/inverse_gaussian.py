"""Inverse Gaussian (Wald): how long a random walk with drift takes to a level."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import LOCATION, MEAN, SHAPE, Constraint, above_zero

__all__ = ["InverseGaussian"]

_STEPS = 60
_CLOSE = 1e-15


class InverseGaussian(Family):
    """Inverse Gaussian with location, its lowest value, mean and shape.

    >>> wald = InverseGaussian()
    >>> print(wald.ppf(np.array([0.1, 0.5, 0.9]), mean=3, shape=5).round(6))
    [0.971668 2.323974 5.85918 ]
    >>> wald.check(mean=0, shape=5)
    'Mean (0) must be above Location (0)'
    """

    name = "Inverse Gaussian"
    aliases = ("InvGauss", "Wald")
    parameters = (LOCATION, MEAN, SHAPE)
    roles = ("ordered", "ordered", "scale")
    rules = (
        Constraint(
            "mean",
            lambda location, mean, _shape: mean > location,
            "Mean ({mean}) must be above Location ({location})",
            "Location is the lowest possible value, 0 if left blank",
        ),
        above_zero(parameters, "shape"),
    )
    open_below = True
    formula = "density √(Shape/(2π·y³))·exp(−Shape·(y − m)²/(2·m²·y)), y = x − Location, m = Mean − Location"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 15"
    elsewhere = ("@RISK and XLRisk Invgauss(mu, lambda): mean, shape",)

    def _ppf(self, u: Array, location: Values, mean: Values, shape: Values) -> Array:
        from scipy.special import ndtri

        above = np.subtract(mean, location)
        return np.asarray(location + above * _at_score(ndtri(u), np.divide(above, shape)))

    def _isf(self, q: Array, location: Values, mean: Values, shape: Values) -> Array:
        from scipy.special import ndtri

        above = np.subtract(mean, location)
        return np.asarray(location + above * _at_score(-ndtri(q), np.divide(above, shape)))

    def _cdf(self, x: Values, location: Values, mean: Values, shape: Values) -> Values:
        above = np.subtract(mean, location)
        y = np.maximum(np.subtract(x, location) / above, 0.0)
        return np.exp(_log_below(y, np.divide(above, shape)))

    def _sf(self, x: Values, location: Values, mean: Values, shape: Values) -> Values:
        above = np.subtract(mean, location)
        y = np.maximum(np.subtract(x, location) / above, 0.0)
        return np.exp(_log_above(y, np.divide(above, shape)))

    def _mean(self, location: Values, mean: Values, shape: Values) -> Values:
        return mean + 0 * np.add(location, shape)

    def _variance(self, location: Values, mean: Values, shape: Values) -> Values:
        above = np.subtract(mean, location)
        return above**2 * np.divide(above, shape)

    def _support(self, location: Values, mean: Values, shape: Values) -> tuple[Values, Values]:
        low, high = ends(0.0, np.inf, location, mean, shape)
        return low + location, high


def _parts(y: Array, dispersion: Values) -> tuple[Array, Array]:
    """Return the logarithms of the two terms of the distribution function, at mean 1; the first is that above."""
    from scipy.special import log_ndtr

    root = np.sqrt(dispersion * y)
    return (y - 1) / root, np.divide(2.0, dispersion) + log_ndtr(-(y + 1) / root)


def _log_below(y: Array, dispersion: Values) -> Array:
    from scipy.special import log_ndtr

    score, second = _parts(y, dispersion)
    value = np.logaddexp(log_ndtr(score), second)
    return np.where(y > 0, np.where(np.isfinite(y), np.minimum(value, 0.0), 0.0), -np.inf)


def _log_above(y: Array, dispersion: Values) -> Array:
    from scipy.special import log_ndtr

    score, second = _parts(y, dispersion)
    first = log_ndtr(-score)
    value = first + np.log(-np.expm1(np.minimum(second - first, 0.0)))
    return np.where(y > 0, np.where(np.isfinite(y), value, -np.inf), 0.0)


def _at_score(z: Array, dispersion: Values) -> Array:
    """Return the value, at mean 1, below which the probability is Φ(z).

    By Newton's method on the normal score of the probability as a function of ln y, which is nearly a straight line; a
    step that leaves what is known to hold the answer is replaced by halving.
    """
    from scipy.special import ndtri_exp

    shape = np.broadcast_shapes(np.shape(z), np.shape(dispersion))
    z, dispersion = (np.array(np.broadcast_to(each, shape), dtype=float).ravel() for each in (z, dispersion))
    spread = np.log1p(dispersion)
    t = np.clip(np.sqrt(spread) * z - spread / 2, -700.0, 700.0)
    low, high = np.full(t.shape, -745.0), np.full(t.shape, 709.0)
    left = np.flatnonzero(np.isfinite(z) & np.isfinite(dispersion))
    for _ in range(_STEPS):
        if not left.size:
            break
        at, d, goal = t[left], dispersion[left], z[left]
        y = np.exp(at)
        upper = goal > 0
        log_p = np.where(upper, _log_above(y, d), _log_below(y, d))
        score = np.where(upper, -1.0, 1.0) * ndtri_exp(log_p)
        off = score - goal
        low[left] = np.where(off <= 0, at, low[left])
        high[left] = np.where(off >= 0, at, high[left])
        log_density = -((y - 1) ** 2) / (2 * d * y) - np.log(d * y) / 2  # of ln y, without the normal's constant
        step = off * np.exp(np.clip(-(score**2) / 2 - log_density, -700.0, 700.0))
        onward = at - step
        inside = (onward > low[left]) & (onward < high[left])
        onward = np.where(inside, onward, (low[left] + high[left]) / 2)
        t[left] = np.where(off == 0, at, onward)
        left = left[np.abs(t[left] - at) > _CLOSE * np.maximum(1.0, np.abs(at))]
    t[~(np.isfinite(z) & np.isfinite(dispersion))] = np.nan
    return np.exp(t).reshape(shape)
