"""The sample that every statistic starts from: values checked and sorted once, with weights and replicates."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.montecarlo.columns import ascending, parts, picked
from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.statistics.moments import Moments, moments_of

__all__ = ["Sample", "Values"]

Floats = NDArray[np.float64]
Groups = NDArray[np.intp]

LEAST_WEIGHT = 1e-30
"""A weight below this share of the largest counts as 0: it would change no sum, and its powers would overflow."""

_SLACK = 1e-9
"""Trials by which a share of them may be rounded: 0.07 of 100 are 7, though 0.07 * 100 is a little more."""

MOST_GROUPS = 64
"""More replicates than this are joined: 63 degrees of freedom are enough, and the work stays small."""


@dataclass(frozen=True)
class Sample:
    """n trials in ascending order of value.

    The independent units that errors are counted in are the trials, or the replicates where there are any: within a
    Latin hypercube or a scrambled Sobol set the trials depend on each other, and only whole sets are independent.

    Attributes:
        x: (n,) values, ascending; on disk where the values given were.
        w: (n,) weights that sum to 1, None if all are equal; trials without weight are left out.
        group: (n,) the replicate of each trial, 0 … groups − 1, None if the trials themselves are independent.
        groups: how many replicates there are, at most 64.
        still: no draw reaches the values: they are the same in every trial there could be.
        two_valued: where all values are 0, or all 1, the other one is the only further value that there could be.
    """

    x: Floats
    w: Floats | None = None
    group: Groups | None = None
    groups: int = 0
    still: bool = False
    two_valued: bool = True

    @classmethod
    def of(
        cls,
        values: Values,
        weights: ArrayLike | None = None,
        replicate: ArrayLike | None = None,
        *,
        still: bool = False,
        two_valued: bool = True,
    ) -> Sample:
        """Read (n,) values, nonnegative weights and integer replicate ids; a `Sample` is returned as it is.

        A replicate that kept no trial cannot be seen here and is not counted.

        Raises:
            ValueError: a value or weight is not finite, a weight is negative, or the lengths differ.
        """
        if isinstance(values, Sample):
            return values
        x = np.asarray(values, dtype=np.float64)
        if x.ndim != 1:
            raise ValueError(f"values must be one column, not of shape {x.shape}")
        if not all(np.isfinite(part).all() for part in parts(x)):
            raise ValueError("values must be finite; trials without a number are left out before")
        w = None if weights is None else _normalise(np.asarray(weights, dtype=np.float64), x)
        ids = None if replicate is None else _check_shape(np.asarray(replicate), x, "replicate ids")
        return cls(*_sort(x, w, ids), still=still, two_valued=two_valued)

    @property
    def n(self) -> int:
        """Trials."""
        return self.x.size

    @cached_property
    def effective(self) -> float:
        """Effective sample size (Σw)²/Σw²: how many equally weighted trials carry as much."""
        return float(self.n) if self.w is None else float(1.0 / np.sum(self.w * self.w)) if self.n else 0.0

    @cached_property
    def even(self) -> Floats:
        """The values; with weights, as many as carry as much, of equal weight: quantiles at even distances."""
        if self.w is None or not self.n:
            return self.x
        count = max(1, round(self.effective))
        return self.quantile((np.arange(count) + 0.5) / count)

    @cached_property
    def yes_no(self) -> bool:
        """Whether every value is 0 or 1, of two trials or more, and draws decide which."""
        if self.still or self.n < 2 or self.x[0] not in (0.0, 1.0) or self.x[-1] not in (0.0, 1.0):
            return False
        if self.x[0] == self.x[-1]:
            return self.two_valued
        first = int(np.searchsorted(self.x, 0.0, side="right"))
        return first == self.n or bool(self.x[first] == 1.0)

    @property
    def yes_no_at_most(self) -> bool:
        """Whether every value is 0 or 1, of any number of trials, also where no draw decides which."""
        return self.yes_no or (bool(self.n) and self.x[0] == self.x[-1] and self.x[0] in (0.0, 1.0))

    @cached_property
    def whole(self) -> bool:
        """Whether every value is a whole number, and not all are the same."""
        if self.n < 2 or self.x[0] == self.x[-1] or max(abs(self.x[0]), abs(self.x[-1])) >= 2.0**53:
            return False
        return all(bool(np.all(part == np.floor(part))) for part in parts(self.x))

    @property
    def units(self) -> float:
        """Independent units: replicates, or else (effective) trials."""
        return self.effective if self.group is None else float(self.groups)

    @property
    def dof(self) -> float:
        """Degrees of freedom of every error: independent units less one."""
        return self.units - 1.0

    @cached_property
    def moments(self) -> Moments:
        """Central moments and their sampling covariance."""
        return moments_of(self.x, self.w, self.group, self.groups, self.units)

    @cached_property
    def positions(self) -> Floats:
        """(n,) the probability of each trial on the quantile curve: 0 for the first, 1 for the last."""
        return np.linspace(0.0, 1.0, self.n) if self.w is None else positions_of(self.w)

    def quantile(self, p: Floats) -> Floats:
        """Return the quantile curve at probabilities p: straight lines between the trials at their positions."""
        if self.w is not None and self.n > 1:
            return np.interp(p, self.positions, self.x)
        rank = p * (self.n - 1)
        low = np.floor(rank).astype(np.intp)
        left, right = picked(self.x, low), picked(self.x, np.minimum(low + 1, self.n - 1))
        return _interpolate(left, right, rank - low)

    def reaching(self, p: float) -> float:
        """Return the first of the values, in their order, that a share p of the trials do not exceed."""
        least = p - _SLACK / self.n
        place = math.ceil(least * self.n) - 1 if self.w is None else int(np.searchsorted(np.cumsum(self.w), least))
        return float(self.x[min(max(place, 0), self.n - 1)])

    def per_unit(self, amounts: Floats) -> Floats:
        """Sum (n,) amounts over each independent unit: (replicates,), or (n,) as they are."""
        if self.group is None:
            return amounts
        return np.bincount(self.group, weights=amounts, minlength=self.groups).astype(np.float64)

    def part(self, where: Groups) -> Sample:
        """Return the trials at these ascending positions, as independent ones."""
        w = None if self.w is None else self.w[where]
        return Sample(picked(self.x, where), None if w is None else w / w.sum())

    def replicate(self, number: int) -> Sample:
        """Return one replicate alone."""
        return self.part(np.flatnonzero(self.group == number))


Values = ArrayLike | Sample
"""(n,) values, or a `Sample` made of them, so that many statistics share one sort."""


def _interpolate(left: Floats, right: Floats, share: Floats) -> Floats:
    """Interpolate from left to right, even where their distance is larger than the largest double."""
    with np.errstate(over="ignore"):
        step = right - left
    if np.isfinite(step).all():
        return np.asarray(left + step * share)
    return np.asarray(left * (1.0 - share) + right * share)


def positions_of(w: Floats) -> Floats:
    """Return (n,) for each of n ≥ 2 weights, the sum of those before it as a share of all others."""
    below = np.concatenate([[0.0], np.cumsum(w[:-1])])
    above = np.concatenate([np.cumsum(w[:0:-1])[::-1], [0.0]])
    return np.asarray(below / (below + above))


def _check_shape(column: NDArray[np.generic], x: Floats, what: str) -> NDArray[np.generic]:
    if column.shape != x.shape:
        raise ValueError(f"{what} must match the values: shape {column.shape} beside {x.shape}")
    return column


def _normalise(w: Floats, x: Floats) -> Floats:
    """Make the weights sum to 1; all are 0 if they were."""
    _check_shape(w, x, "weights")
    if not np.all((w >= 0.0) & (w < np.inf)):
        raise ValueError("weights must be finite and not negative")
    largest = w.max(initial=0.0)
    if largest == 0.0:
        return w
    w = w / largest  # first, so that the sum cannot overflow
    w = np.where(w < LEAST_WEIGHT, 0.0, w)
    return np.asarray(w / w.sum())


def _sort(
    x: Floats, w: Floats | None, ids: NDArray[np.generic] | None
) -> tuple[Floats, Floats | None, Groups | None, int]:
    checkpoint()
    if w is None and ids is None:
        return ascending(x), None, None, 0
    order = np.argsort(x, kind="stable")  # ties stay in trial order: the same sums on every machine
    if w is not None:
        order = order[w[order] > 0.0]
    group, groups = (None, 0) if ids is None else _number_replicates(ids[order])
    return x[order], None if w is None else w[order], group, groups


def _number_replicates(ids: NDArray[np.generic]) -> tuple[Groups, int]:
    """Give the replicates numbers from 0; the 65th joins the first, and so on."""
    names, group = np.unique(ids, return_inverse=True)
    return (group % MOST_GROUPS).astype(np.intp), min(names.size, MOST_GROUPS)
