"""Fatigue life (Birnbaum and Saunders): how long it takes until cracks that grow by chance reach a limit."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import Located
from xlmc.montecarlo.distributions.parameters import LOCATION, SCALE, SHAPE, above_zero

__all__ = ["FatigueLife"]


class FatigueLife(Located):
    """Fatigue life with location, its lowest value, scale, its median above that, and shape.

    >>> fatigue = FatigueLife()
    >>> print(fatigue.ppf(np.array([0.1, 0.5, 0.9]), location=1, scale=2, shape=0.5).round(6))
    [2.064874 3.       4.756313]
    >>> fatigue.check(scale=2, shape=0)
    'Shape (0) must be above 0'
    """

    name = "Fatigue life"
    aliases = ("Birnbaum-Saunders",)
    parameters = (LOCATION, SCALE, SHAPE)
    roles = ("location", "scale", "shape")
    rules = (above_zero(parameters, "scale"), above_zero(parameters, "shape"))
    open_below = True
    formula = "P(X ≤ x) = Φ((√z − 1/√z)/Shape), z = (x − Location)/Scale"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 33"
    elsewhere = ("@RISK FatigueLife(y, beta, alpha): location, scale, shape",)

    def _quantile(self, u: Array, shape: Values) -> Array:
        from scipy.special import ndtri

        y = shape * ndtri(u)
        # The sum of two numbers of one sign, whichever that is.
        root = (np.abs(y) + np.sqrt(np.square(y) + 4)) / 2
        return np.asarray(np.where(y < 0, 1 / root, root) ** 2)

    def _quantile_above(self, q: Array, shape: Values) -> Array:
        return 1 / self._quantile(q, shape)

    def _below(self, z: Array, shape: Values) -> Values:
        from scipy.special import ndtr

        return np.asarray(ndtr(_score(z, shape)))

    def _above(self, z: Array, shape: Values) -> Values:
        from scipy.special import ndtr

        return np.asarray(ndtr(-_score(z, shape)))

    def _moments(self, shape: Values) -> tuple[Values, Values]:
        square = np.square(shape)
        return 1 + square / 2, square * (1 + 1.25 * square)


def _score(z: Array, shape: Values) -> Array:
    root = np.sqrt(z)
    return np.asarray((root - 1 / root) / shape)
