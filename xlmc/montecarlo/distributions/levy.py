"""Lévy: the time until a random walk first reaches a level; half of it lies far out, and it has no finite mean."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.located import Located

__all__ = ["Levy"]


class Levy(Located):
    """Lévy with location, its lowest value, and scale. Mean and variance are infinite.

    >>> levy = Levy()
    >>> print(levy.ppf(np.array([0.1, 0.5, 0.9]), location=1, scale=2).round(6))
    [  1.739223   5.396219 127.656235]
    >>> print(levy.mean(location=1, scale=2))
    inf
    >>> levy.check(scale=-1)
    'Scale (-1) must be above 0'
    """

    name = "Levy"
    aliases = ("Lévy",)
    open_below = True
    formula = "P(X ≤ x) = 2·(1 − Φ(√(Scale/(x − Location)))), x ≥ Location; mean and variance are infinite"
    source = "Feller, An Introduction to Probability Theory and Its Applications, vol. 2 (1971), II.4"
    elsewhere = ("@RISK Levy(a, c): location, scale",)

    def _quantile(self, u: Array) -> Array:
        from scipy.special import erfcinv

        return np.asarray(0.5 / np.square(erfcinv(u)))

    def _quantile_above(self, q: Array) -> Array:
        from scipy.special import erfinv

        return np.asarray(0.5 / np.square(erfinv(q)))

    def _below(self, z: Array) -> Values:
        from scipy.special import erfc

        return np.asarray(erfc(np.sqrt(0.5 / z)))

    def _above(self, z: Array) -> Values:
        from scipy.special import erf

        return np.asarray(erf(np.sqrt(0.5 / z)))

    def _moments(self) -> tuple[Values, Values]:
        return np.inf, np.inf
