"""Normal: random errors around a known mean with a known standard deviation."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import MEAN, STD_DEV, above_zero

__all__ = ["Normal"]


class Normal(Family):
    """Normal with mean and standard deviation, e.g. the perception-response time N(1.25 s, 0.46 s).

    >>> normal = Normal()
    >>> print(normal.ppf(np.array([0.0, 0.5, 0.975]), mean=1.25, std_dev=0.46).round(4))
    [-2.5645  1.25    2.1516]
    >>> normal.check(mean=1.25, std_dev=-1)
    'Std dev (-1) must be above 0'
    >>> print(normal.ppf(0.5, 1.25, np.array([0.46, -0.46])))
    [1.25  nan]
    """

    name = "Normal"
    aliases = ("Gaussian",)
    parameters = (MEAN, STD_DEV)
    formula = "density ∝ exp(−((x − Mean)/Std dev)²/2)"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 1, ch. 13"
    elsewhere = (
        "Crystal Ball Normal (mean, std dev)",
        "@RISK Normal(mean, std dev)",
        "@RISK Erf(h): Mean 0, Std dev 1/(√2·h)",
    )
    roles = ("location", "scale")
    rules = (
        above_zero(
            parameters,
            "std_dev",
            "Give a positive number, or set Frozen to TRUE to hold the assumption at its cell's value",
        ),
    )
    open_below = True
    always_finite = True

    def _ppf(self, u: Array, mean: Values, std_dev: Values) -> Array:
        from scipy.special import ndtri

        ndtri(u, out=u)
        u *= std_dev
        u += mean
        return u

    def _cdf(self, x: Values, mean: Values, std_dev: Values) -> Values:
        from scipy.special import ndtr

        # A distance of more than 1e308 standard deviations overflows to infinity, which is right.
        with np.errstate(over="ignore"):
            return ndtr(np.divide(x - mean, std_dev))  # type: ignore[no-any-return]  # SciPy has no types

    def _mean(self, mean: Values, std_dev: Values) -> Values:
        return mean + 0 * std_dev

    def _variance(self, mean: Values, std_dev: Values) -> Values:
        return std_dev**2 + 0 * mean

    def _support(self, mean: Values, std_dev: Values) -> tuple[Values, Values]:
        return ends(-np.inf, np.inf, mean, std_dev)

    def _mirrored(self, mean: Values, std_dev: Values) -> tuple[Values, ...]:
        return -mean, std_dev
