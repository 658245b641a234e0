"""Student's t: like the normal with heavier tails; what a mean of few measurements follows."""

from __future__ import annotations

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Family, Values, ends
from xlmc.montecarlo.distributions.parameters import SCALE, ParameterSpec, above_zero, at_most

__all__ = ["StudentsT"]


class StudentsT(Family):
    """Student's t with midpoint, scale and degrees of freedom, which need not be whole.

    The mean exists above 1 degree of freedom, the variance above 2.

    >>> students_t = StudentsT()
    >>> print(students_t.ppf(np.array([0.1, 0.5, 0.975]), midpoint=10, scale=2, degrees=5).round(6))
    [ 7.048232 10.       15.141164]
    >>> students_t.check(midpoint=10, scale=2, degrees=0)
    'Degrees of freedom (0) must be above 0'
    >>> print(students_t.ppf(0.975, 0.0, 1.0, np.array([5.0, 0.0])).round(6))
    [2.570582      nan]
    """

    name = "Student's t"
    aliases = ("Student’s t", "Student t", "Students t", "Student", "t")  # as Word types it
    parameters = (
        ParameterSpec("midpoint", ("Midpoint",)),
        SCALE,
        ParameterSpec("degrees", ("Degrees of freedom", "Deg. freedom", "Degrees", "DF")),
    )
    roles = ("location", "scale", "shape")
    rules = (
        above_zero(parameters, "scale"),
        above_zero(parameters, "degrees"),
        at_most(parameters, "degrees", 1e6, "With so many, choose Normal with Mean = Midpoint and Std dev = Scale"),
    )
    open_below = True
    formula = "density ∝ (1 + z²/df)^(−(df + 1)/2), z = (x − Midpoint)/Scale, df = Degrees of freedom"
    source = "Johnson, Kotz and Balakrishnan, Continuous Univariate Distributions, vol. 2, ch. 28"
    elsewhere = ("Crystal Ball Student's t (midpoint, scale, degrees of freedom)", "@RISK Student(degrees of freedom)")

    def _ppf(self, u: Array, midpoint: Values, scale: Values, degrees: Values) -> Array:
        below = u < 0.5
        distance = scale * _distance(np.where(below, u, 1 - u), degrees)
        return midpoint + np.where(below, -distance, distance)

    def _cdf(self, x: Values, midpoint: Values, scale: Values, degrees: Values) -> Values:
        with np.errstate(over="ignore"):
            z = np.divide(x - midpoint, scale)
        tail = _tail(np.abs(z), degrees)
        return np.where(z < 0, tail, 1 - tail)

    def _mean(self, midpoint: Values, scale: Values, degrees: Values) -> Values:
        return np.where(np.greater(degrees, 1), midpoint + 0 * scale, np.nan)

    def _variance(self, midpoint: Values, scale: Values, degrees: Values) -> Values:
        above = np.where(np.greater(degrees, 2), degrees, 3.0)
        finite = scale**2 * (above / (above - 2)) + 0 * midpoint
        return np.where(np.greater(degrees, 2), finite, np.where(np.greater(degrees, 1), np.inf, np.nan))

    def _support(self, midpoint: Values, scale: Values, degrees: Values) -> tuple[Values, Values]:
        return ends(-np.inf, np.inf, midpoint, scale, degrees)

    def _mirrored(self, midpoint: Values, scale: Values, degrees: Values) -> tuple[Values, ...]:
        return -midpoint, scale, degrees


def _distance(tail: Array, degrees: Values) -> Array:
    """Return the t that is exceeded with probability `tail`, at most 0.5.

    df/(df + t²) is beta distributed; near the middle its complement is, so that neither is a difference from 1.
    """
    from scipy.special import betaincinv

    outer = tail < 0.25
    half = np.divide(degrees, 2)
    part = betaincinv(np.where(outer, half, 0.5), np.where(outer, 0.5, half), np.where(outer, 2 * tail, 1 - 2 * tail))
    with np.errstate(divide="ignore", over="ignore"):
        square = np.where(outer, 1 / part - 1, part / (1 - part))
        return np.asarray(np.sqrt(degrees) * np.sqrt(square))


def _tail(t: Values, degrees: Values) -> Values:
    """Return the probability to exceed t, 0 or more."""
    from scipy.special import betainc

    half, ratio = np.divide(degrees, 2), t / np.sqrt(degrees)
    outer = ratio > 1
    with np.errstate(over="ignore", divide="ignore"):
        part = np.where(outer, 1 / (1 + ratio**2), 1 / (1 + ratio**-2.0))
    share = betainc(np.where(outer, half, 0.5), np.where(outer, 0.5, half), part) / 2
    return np.asarray(np.where(outer, share, 0.5 - share))
