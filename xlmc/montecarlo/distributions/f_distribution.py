"""F: the ratio of two mean squares; what tests of variances are judged by."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import ParameterSpec, above_zero
from xlmc.montecarlo.distributions.pearson6 import Pearson6

__all__ = ["F"]

_RATIO = Pearson6()


class F(Family):
    """F with the degrees of freedom of numerator and denominator, which need not be whole.

    The mean is infinite up to 2 degrees of freedom of the denominator, the variance up to 4.

    >>> f = F()
    >>> print(f.ppf(np.array([0.1, 0.5, 0.95]), degrees_1=3, degrees_2=10).round(6))
    [0.19119  0.845081 3.708265]
    >>> f.check(degrees_1=0, degrees_2=10)
    'Degrees of freedom 1 (0) must be above 0'
    """

    name = "F"
    aliases = ("Fisher F", "Snedecor F")
    parameters = (
        ParameterSpec("degrees_1", ("Degrees of freedom 1", "DF1")),
        ParameterSpec("degrees_2", ("Degrees of freedom 2", "DF2")),
    )
    rules = (above_zero(parameters, "degrees_1"), above_zero(parameters, "degrees_2"))
    open_below = True
    formula = "the ratio of two independent chi-squares, each divided by its degrees of freedom"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 27"
    elsewhere = ("@RISK F(ν1, ν2)",)

    def _ppf(self, u: Array, first: Values, second: Values) -> Array:
        return _RATIO._ppf(u, *_of_ratio(first, second))

    def _isf(self, q: Array, first: Values, second: Values) -> Array:
        return _RATIO._isf(q, *_of_ratio(first, second))

    def _cdf(self, x: Values, first: Values, second: Values) -> Values:
        return _RATIO._cdf(x, *_of_ratio(first, second))

    def _sf(self, x: Values, first: Values, second: Values) -> Values:
        return _RATIO._sf(x, *_of_ratio(first, second))

    def _mean(self, first: Values, second: Values) -> Values:
        return _RATIO._mean(*_of_ratio(first, second))

    def _variance(self, first: Values, second: Values) -> Values:
        return _RATIO._variance(*_of_ratio(first, second))

    def _support(self, first: Values, second: Values) -> tuple[Values, Values]:
        return ends(0.0, np.inf, first, second)


def _of_ratio(first: Values, second: Values) -> tuple[Values, ...]:
    """Return the parameters of `Pearson6`."""
    return 0.0, np.divide(second, first), np.divide(first, 2), np.divide(second, 2)
