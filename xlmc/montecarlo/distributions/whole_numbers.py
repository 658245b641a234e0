"""What the distributions of counts have in common: whole numbers, drawn by table or by search.

The quantile of u is the smallest whole number k with F(k) >= u, where F is the family's own `cdf`, so the two agree at
every jump to the last bit. With parameters that are numbers, F is tabulated once and looked up; a table that would be
long, and parameters that vary by trial, are searched from a Cornish-Fisher guess that is seldom more than one off.

Shapes as in `base`.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.distributions.base import SMALLEST_U, Array, Family, Values
from xlmc.montecarlo.distributions.parameters import Constraint, ParameterSpec

__all__ = [
    "MOST",
    "POPULATION",
    "PROBABILITY",
    "RATE",
    "SHAPE",
    "SUCCESS",
    "TRIALS",
    "WholeNumbers",
    "probability",
    "smallest",
    "whole",
    "within_reach",
]

MOST = 1e9
"""No count may be larger."""

LONGEST = 2**15
"""Tables with more entries are not made."""

LARGEST_U = 1 - 2.0**-53

PROBABILITY = ParameterSpec("probability", ("Probability",))
TRIALS = ParameterSpec("trials", ("Trials",))
SUCCESS = ParameterSpec("success", ("Success", "Successes"))
POPULATION = ParameterSpec("population", ("Population",))
SHAPE = ParameterSpec("shape", ("Shape",))
RATE = ParameterSpec("rate", ("Rate", "Mean"))

FARTHEST = 2.0**52
"""Whole numbers are exact up to here."""

Holds = Callable[[Array, NDArray[np.intp]], NDArray[np.bool_]]
"""A test of candidates `(m,)` and their trials `(m,)`: whether it holds. It holds from some number up."""


class WholeNumbers(Family):
    """A distribution of whole numbers. A family gives `_at_most`, `_at_least`, `_skewness` and the hooks of `Family`.

    Both probabilities are asked for inside the support only, whole numbers and parameters that keep every rule.
    """

    open_below = True  # F(k) >= 0 holds everywhere, so u = 0 says nothing; it stands for its half step
    always_finite = True  # none passes 2^52

    @abstractmethod
    def _at_most(self, k: Array, *args: Any) -> Values:
        """P(X <= k)."""

    @abstractmethod
    def _at_least(self, k: Array, *args: Any) -> Values:
        """P(X >= k)."""

    @abstractmethod
    def _skewness(self, *args: Any) -> Values:
        """Return the third standardised moment, or nearly that: it only guides the search. Not asked for constants."""

    def cutoffs(self, lower: Values, upper: Values) -> tuple[tuple[Values, Values], tuple[Values, Values]]:
        """Both cutoffs are kept: the first whole number that is kept and the last one that is not, at either end."""
        first, last = np.ceil(lower), np.floor(upper)
        return (first, first - 1), (last, last + 1)

    def _cdf(self, x: Values, *params: Values) -> Values:
        low, high = self._support(*params)
        k = np.floor(x)
        inside = self._at_most(np.clip(k, low, np.minimum(high, FARTHEST)), *params)
        return np.where(k < low, 0.0, np.where(k >= high, 1.0, inside))

    def _sf(self, x: Values, *params: Values) -> Values:
        low, high = self._support(*params)
        k = np.ceil(x)
        inside = self._at_least(np.clip(k, low, np.minimum(high, FARTHEST)), *params)
        return np.where(k <= low, 1.0, np.where(k > high, 0.0, inside))

    def _ppf(self, u: Array, *params: Values) -> Array:
        if all(np.ndim(value) == 0 for value in params) and (u.size == 0 or u.min() >= SMALLEST_U):
            table = _table(self, tuple(float(value) for value in params))
            if table is not None:
                first, probabilities = table
                return np.asarray(first + np.searchsorted(probabilities, np.minimum(u, LARGEST_U)))
        return self._searched(u, u, 1 - u, params, lambda k, u, *of: self._cdf(k, *of) >= u)

    def _isf(self, q: Array, *params: Values) -> Array:
        return self._searched(q, 1 - q, q, params, lambda k, q, *of: self._sf(k + 1, *of) <= q)

    def _searched(
        self, asked: Array, u: Array, q: Array, params: Sequence[Values], reached: Callable[..., Any]
    ) -> Array:
        """Find the smallest k with `reached(k, asked, *params)`; u and q are the probabilities below and above it."""
        shape = np.shape(asked)
        columns = [np.broadcast_to(value, shape).ravel() for value in (asked, *params)]
        low, high = (np.array(np.broadcast_to(end, shape), dtype=float).ravel() for end in self._support(*params))
        guess = np.broadcast_to(self._guess(u, q, *params), shape).ravel()

        def holds(k: Array, trials: Any) -> Any:
            return reached(k, *(column[trials] for column in columns))

        return np.asarray(smallest(holds, guess, low, high).reshape(shape))

    def _guess(self, u: Array, q: Array, *params: Values) -> Array:
        """Near the quantile. Source: E. A. Cornish and R. A. Fisher, 1937; the normal quantile bent by the skewness."""
        spread = np.sqrt(self._variance(*params))
        bend = np.where(np.asarray(spread) > 0, self._skewness(*params), 0.0) / 6
        z = standard_normal(u, q)
        return np.asarray(self._mean(*params) + spread * (z + bend * (z * z - 1)))

    def _mirrored(self, *params: Values) -> tuple[Values, ...]:
        raise TypeError(f"{self.name} has no mirror image in its family")  # _sf and _isf do without


def standard_normal(u: Array, q: Array) -> Array:
    """Return the normal quantile of the probabilities u below and q above it, from the smaller one; finite."""
    from scipy.special import ndtri

    z = np.where(u < q, ndtri(np.clip(u, 1e-300, 0.5)), -ndtri(np.clip(q, 1e-300, 0.5)))
    return np.asarray(z)


@lru_cache(maxsize=64)
def _table(family: WholeNumbers, params: tuple[float, ...]) -> tuple[float, Array] | None:
    """Return the first whole number that a draw may be, and F from there to the last; None if that is too long."""
    ends = np.array([SMALLEST_U, LARGEST_U])
    first, last = family._searched(ends, ends, 1 - ends, params, lambda k, u, *of: family._cdf(k, *of) >= u)
    if not last - first < LONGEST:
        return None
    probabilities = np.asarray(family._cdf(np.arange(first, last + 1), *params))
    return float(first), np.maximum.accumulate(probabilities)


def probability(parameters: Sequence[ParameterSpec], *, positive: bool = False) -> Constraint:
    """Require Probability to lie between 0 and 1; 1 is allowed, and so is 0 unless it must be `positive`."""
    index = parameters.index(PROBABILITY)
    return Constraint(
        "probability",
        lambda *values: ((values[index] > 0) if positive else (values[index] >= 0)) & (values[index] <= 1),
        f"Probability ({{probability}}) must be {'above 0 and at most 1' if positive else 'from 0 to 1'}",
        "Type a share, such as 0.25 for 25 %",
    )


def within_reach(successes: Callable[..., Any]) -> Constraint:
    """Require that waiting for so many successes, of the parameters, does not pass what counts can reach."""
    return Constraint(
        "probability",
        lambda *values: successes(*values) <= 1e13 * values[0],
        "Probability ({probability}) is so small that the count may pass 1E15",
        "Give a larger probability, or use a continuous distribution",
    )


def whole(parameters: Sequence[ParameterSpec], spec: ParameterSpec, least: float) -> Constraint:
    """Require a parameter to be a whole number from `least` to `MOST`."""
    index = parameters.index(spec)
    return Constraint(
        spec.key,
        lambda *values: (values[index] >= least) & (values[index] <= MOST) & (values[index] == np.floor(values[index])),
        f"{spec.heading} ({{{spec.key}}}) must be a whole number from {least:.0f} to {MOST:,.0f}",
        "Correct the number, or wrap its formula in ROUND",
    )


def smallest(holds: Holds, guess: Array, low: Array, high: Array) -> Array:
    """Find the smallest whole number in [low, high] for which `holds`; `high` where it holds nowhere below.

    Steps that double lead from the guess to a bracket, halving narrows it: a right guess costs two questions.

    Args:
        holds: the condition.
        guess: `(n,)`; NaN in trials that have no answer.
        low: `(n,)`, where to begin.
        high: `(n,)`, where to end; may be infinite.
    """
    below, above = low - 1, np.minimum(high, FARTHEST)
    k = np.clip(np.rint(guess), low, above)
    step = np.ones_like(k)
    open_ = np.flatnonzero(np.isfinite(k) & (above - below > 1))
    while open_.size:
        here = k[open_]
        satisfied = holds(here, open_)
        above[open_] = np.where(satisfied, here, above[open_])
        below[open_] = np.where(satisfied, below[open_], here)
        onward = np.where(satisfied, here - step[open_], here + step[open_])
        within = (onward > below[open_]) & (onward < above[open_])
        k[open_] = np.where(within, onward, np.floor((below[open_] + above[open_]) / 2))
        step[open_] *= 2
        open_ = open_[above[open_] - below[open_] > 1]
    return np.where(np.isfinite(k), above, np.nan)
