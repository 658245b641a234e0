"""Hypergeometric: how many of those drawn without replacement are of one kind."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from xlmc.montecarlo.distributions.base import Array, Values
from xlmc.montecarlo.distributions.parameters import Constraint
from xlmc.montecarlo.distributions.whole_numbers import POPULATION, SUCCESS, TRIALS, WholeNumbers, whole

__all__ = ["Hypergeometric"]

_REACH, _MORE = 40.0, 200.0
"""Standard deviations, and numbers beside them, on either side of the mode: beyond, the probability is below 1e-300."""


class Hypergeometric(WholeNumbers):
    """Hypergeometric: `success` of a population are of the kind, and `trials` of the population are drawn.

    Its distribution function is a sum, so the trials that share parameters share a table.

    >>> hypergeometric = Hypergeometric()
    >>> print(hypergeometric.ppf(np.array([0.0, 0.5, 0.99]), success=20, trials=10, population=50))
    [0. 4. 7.]
    >>> hypergeometric.check(success=20, trials=60, population=50)
    'Trials (60) is above Population (50)'
    >>> print(hypergeometric.ppf(0.5, 20.0, np.array([10.0, 60.0]), 50.0))
    [ 4. nan]
    """

    name = "Hypergeometric"
    formula = "P(k) = C(Success, k)·C(Population - Success, Trials - k) / C(Population, Trials)"
    source = "N. L. Johnson, A. W. Kemp and S. Kotz, Univariate Discrete Distributions, 2005, chapter 6"
    elsewhere = ("Crystal Ball CB.Hypergeometric2(success, trials, population)", "@RISK Hypergeo(n, D, M)")
    parameters = (SUCCESS, TRIALS, POPULATION)
    rules = (
        whole(parameters, SUCCESS, 0),
        whole(parameters, TRIALS, 0),
        whole(parameters, POPULATION, 1),
        Constraint(
            "success",
            lambda success, _trials, population: success <= population,
            "Success ({success}) is above Population ({population})",
            "Success counts those of the kind among the whole population",
        ),
        Constraint(
            "trials",
            lambda _success, trials, population: trials <= population,
            "Trials ({trials}) is above Population ({population})",
            "No more can be drawn than there are",
        ),
    )

    def _at_most(self, k: Array, success: Values, trials: Values, population: Values) -> Values:
        return self._looked_up(0, k, success, trials, population)

    def _at_least(self, k: Array, success: Values, trials: Values, population: Values) -> Values:
        return self._looked_up(1, k, success, trials, population)

    def _looked_up(self, side: int, k: Values, *params: Values) -> Array:
        columns = np.broadcast_arrays(k, *params)
        asked, values = columns[0].ravel(), np.full(columns[0].size, np.nan)
        for row, here in _alike(columns[1:]):
            first, *tails = _tails(*row)
            index = np.clip(asked[here] - first + 1, 0, tails[side].size - 1)
            values[here] = tails[side][index.astype(np.intp)]
        return values.reshape(columns[0].shape)

    def _ppf(self, u: Array, *params: Values) -> Array:
        columns = np.broadcast_arrays(u, *params)
        values = np.full(u.size, np.nan)
        for row, here in _alike(columns[1:]):
            first, at_most, _ = _tails(*row)
            values[here] = first - 1 + np.searchsorted(at_most, u.ravel()[here])
        return values.reshape(u.shape)

    def _mean(self, success: Values, trials: Values, population: Values) -> Values:
        return trials * (success / population)

    def _variance(self, success: Values, trials: Values, population: Values) -> Values:
        share = success / population
        left = (population - trials) / np.maximum(population - 1, 1)
        return trials * share * (1 - share) * left

    def _skewness(self, success: Values, trials: Values, population: Values) -> Values:
        spread = np.sqrt(np.maximum(self._variance(success, trials, population), 1e-300))
        return (1 - 2 * (success / population)) * (1 - 2 * (trials / population)) / spread

    def _support(self, success: Values, trials: Values, population: Values) -> tuple[Values, Values]:
        return np.maximum(0.0, success + trials - population), np.minimum(success, trials) + 0 * population


def _alike(columns: Sequence[Array]) -> Iterator[tuple[tuple[float, ...], Any]]:
    """Return the parameters that occur, and the trials that have them; trials without any are left out."""
    if columns[0].size == 0:
        return
    if all((column == column.flat[0]).all() for column in columns):
        yield tuple(float(column.flat[0]) for column in columns), slice(None)
        return
    rows = np.stack([column.ravel() for column in columns], axis=1)
    kinds, which, counts = np.unique(rows, axis=0, return_inverse=True, return_counts=True)
    groups = np.split(np.argsort(which.ravel(), kind="stable"), np.cumsum(counts)[:-1])
    for row, here in zip(kinds, groups, strict=True):
        if not np.isnan(row).any():
            yield tuple(float(value) for value in row), here


@lru_cache(maxsize=64)
def _tails(success: float, trials: float, population: float) -> tuple[float, Array, Array]:
    """Return the first number with a probability that counts, and P(X <= k), P(X >= k) from the number before it to
    beyond.

    Masses in units of that of the mode follow from one another by simple ratios; their sum makes them probabilities.
    """
    low, high = max(0.0, success + trials - population), min(success, trials)
    mode = np.floor((success + 1) * (trials + 1) / (population + 2))
    family = Hypergeometric()
    reach = np.ceil(_REACH * np.sqrt(family._variance(success, trials, population)) + _MORE)
    first, last = max(low, mode - reach), min(high, mode + reach)
    k = np.arange(first, last)
    ratio = (success - k) * (trials - k) / ((k + 1) * (population - success - trials + k + 1))
    peak = int(mode - first)
    with np.errstate(under="ignore"):
        up, down = np.cumprod(ratio[peak:]), np.cumprod(1 / ratio[:peak][::-1])[::-1]
    mass = np.concatenate([down, [1.0], up])
    at_most, at_least = np.cumsum(mass), np.cumsum(mass[::-1])[::-1]
    below = np.concatenate([[0.0], at_most / at_most[-1], [1.0]])
    above = np.concatenate([[1.0], at_least / at_least[0], [0.0]])
    return float(first), below, above
