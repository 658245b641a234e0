"""Variance explained, by classes as fine as the forecast asks for, and what is said where none are fine enough.

`given_data` fits a line in each of 16 classes. A forecast that jumps or bends inside a class leaves a residual there
that is no noise, and the share would be too low. So the same is fitted in 4, 16, … times as many classes, down to 8
trials each, and last of all each trial is compared with the mean of its two neighbours in rank (Gasser, Sroka &
Jennen-Steinmetz 1986).

- *Choice.* The coarsest classes above which no finer fit explains more than noise would (Lepski 1991). The difference
  of two shares with k and k' parameters has, without any lack of fit, the variance 2 (k' − k) Σ m σ⁴/n³, with σ² the
  residual variance in a class of m trials; against the neighbours it is (35/9 − 2) Σ m σ⁴/n².
- *Bound of the bias.* What the next finer fit explains more is added to the upper end of the interval, for it may be no
  noise; where classes had to be finer, also what is left in the one class that leaves most: it may hold a jump.
- *At least.* Where the neighbours still explain more than the finest classes, or where a few trials decide the error,
  the number is a lower bound, and is called one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.given_data import fit_lines, standardise
from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.analysis.studies.sensitivity.ranked import Classes, Ranked
from xlmc.montecarlo.statistics import Estimate

__all__ = ["Explained", "explained"]

Floats = NDArray[np.float64]

_TELLING = 2.5
"""Errors by which a finer fit must explain more."""

_SMALL = 5e-4
"""A share of the variance that needs no finer classes: the interval is made longer by it."""

_NEIGHBOURS = 35.0 / 9.0 - 2.0

_FEW = 0.1
"""The part of the squared pulls that one trial may have."""

_WIDE = 0.003
"""An error below which it does not matter how few trials decide it."""


@dataclass(frozen=True, slots=True)
class Explained:
    """The share of a forecast's variance that an assumption explains.

    Attributes:
        share: the estimate.
        at_least: whether it is a lower bound only.
        coarse_enough: whether the first classes, 16 at most, were fine enough.
    """

    share: Estimate
    at_least: bool
    coarse_enough: bool


@dataclass
class _Fit:
    """Lines in classes, fitted to `(n,)` z of mean square 1 in ascending order of x; what they leave."""

    classes: Classes
    z: Floats

    @property
    def n(self) -> int:
        return int(self.z.size)

    @cached_property
    def left(self) -> Floats:
        """`(c,)` sums of squared residuals."""
        classes, z = self.classes, self.z
        squares, sums, lines = (np.add.reduceat(each, classes.starts) for each in (z * z, z, z * classes.centred))
        return np.asarray(np.maximum(squares - sums**2 / classes.sizes - lines**2 / classes.squares, 0.0))

    @cached_property
    def value(self) -> float:
        """The share explained."""
        return 1.0 - float(self.left.sum()) / (self.n - self.classes.freedom) * ((self.n - 1.0) / self.n)

    @cached_property
    def fourth(self) -> float:
        """The mean of σ⁴ over the trials; the square of an estimate of σ² is too large by what it varies."""
        free = np.maximum(self.classes.sizes - 2.0, 1.0)
        return float(np.sum(self.classes.sizes * (self.left / free) ** 2 / (1.0 + 2.0 / free))) / self.n


def explained(x: Ranked, y: Floats, units: Units) -> Explained:
    """Return the share of the variance of `(n,)` y that x explains; nan where y does not vary or the trials are too
    few.
    """
    z = standardise(y)
    if z is None or x.n <= x.classes.freedom:
        return Explained(Estimate(math.nan, n=x.n), at_least=False, coarse_enough=True)
    z = z[x.order]
    fits = [_Fit(each, z) for each in x.ladder if each.freedom < x.n]
    beside = _beside_neighbours(z)
    enough = next((i for i, fit in enumerate(fits) if _is_enough(fit, fits[i + 1 :], beside)), None)
    chosen = len(fits) - 1 if enough is None else enough
    estimate, few = _estimate(x, z, fits[chosen], units)
    if estimate.interval is not None:
        low, high = estimate.interval
        high = max(estimate.value, min(high + _allowance(fits, chosen, beside), 1.0))
        estimate = replace(estimate, interval=(low, high))
    return Explained(estimate, enough is None or few, enough == 0)


def _beside_neighbours(z: Floats) -> float:
    """Return the share explained by the neighbours in rank."""
    if z.size < 3:
        return -math.inf
    apart = z[1:-1] - 0.5 * (z[:-2] + z[2:])
    return 1.0 - float(np.mean(apart * apart)) / 1.5


def _is_enough(fit: _Fit, finer: list[_Fit], beside: float) -> bool:
    """Whether no finer fit explains more than noise would."""
    for other in finer:
        more, freedom = other.value - fit.value, max(other.classes.freedom - fit.classes.freedom, 0)
        if more > _SMALL and more > _TELLING * math.sqrt(2.0 * freedom * other.fourth) / fit.n:
            return False
    more, last = beside - fit.value, finer[-1] if finer else fit
    return more <= _SMALL or more <= _TELLING * math.sqrt(_NEIGHBOURS * last.fourth / fit.n)


def _allowance(fits: list[_Fit], chosen: int, beside: float) -> float:
    """Return what the classes may miss."""
    fit, finer = fits[chosen], fits[chosen + 1 :]
    more = max(finer[0].value - fit.value, 0.0) if finer else 0.0
    more = max(more, min(max([beside, *(each.value for each in finer)]) - fit.value, _SMALL))
    return more + (float(fit.left.max()) / fit.n if chosen else 0.0)


def _estimate(x: Ranked, z: Floats, fit: _Fit, units: Units) -> tuple[Estimate, bool]:
    """Return the share with its error, and whether a few trials decide that."""
    n, k = fit.n, fit.classes.freedom
    pulls = np.empty(n)
    residual = z - fit_lines(fit.classes, z)
    pulls[x.order] = (1.0 - fit.value) * z * z - residual * residual * (n / (n - k))
    pulls -= pulls.mean()
    fitting = math.sqrt(2.0 * (k - 1)) / n * (1.0 - fit.value)
    estimate = units.estimate(fit.value, units.error_of_fit(pulls, fitting))
    squares = pulls * pulls
    few = float(squares.max()) > _FEW * float(squares.sum())
    return estimate, few and estimate.error is not None and estimate.error > _WIDE
