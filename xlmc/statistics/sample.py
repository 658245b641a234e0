"""The values every statistic starts from: checked, sorted once, with their weights and replicates."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.columns import ascending, parts, picked
from xlmc.statistics.moments import Moments, moments_of

__all__ = ["Sample", "Values"]

Floats = NDArray[np.float64]
Groups = NDArray[np.intp]

LEAST_WEIGHT = 1e-30
"""Of the largest weight; less counts as none, for no sum could show it and its powers would overflow."""

MOST_GROUPS = 64
"""More replicates than this are joined: 63 degrees of freedom lose nothing, and the work for each stays small."""


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
    """

    x: Floats
    w: Floats | None = None
    group: Groups | None = None
    groups: int = 0

    @classmethod
    def of(cls, values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> Sample:
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
        w = None if weights is None else _normalised(np.asarray(weights, dtype=np.float64), x)
        ids = None if replicate is None else _matching(np.asarray(replicate), x, "replicate ids")
        return cls(*_sorted(x, w, ids))

    @property
    def n(self) -> int:
        """Trials."""
        return self.x.size

    @cached_property
    def effective(self) -> float:
        """Effective sample size (Σw)²/Σw²: how many equally weighted trials carry as much."""
        return float(self.n) if self.w is None else float(1.0 / np.sum(self.w * self.w)) if self.n else 0.0

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
        """(n,) the probability each trial stands at on the quantile curve: 0 for the first, 1 for the last."""
        return np.linspace(0.0, 1.0, self.n) if self.w is None else positions_of(self.w)

    def quantile(self, p: Floats) -> Floats:
        """The quantile curve at probabilities p: straight lines between the trials at their positions."""
        if self.w is not None and self.n > 1:
            return np.interp(p, self.positions, self.x)
        rank = p * (self.n - 1)
        low = np.floor(rank).astype(np.intp)
        left, right = picked(self.x, low), picked(self.x, np.minimum(low + 1, self.n - 1))
        return _between(left, right, rank - low)

    def per_unit(self, amounts: Floats) -> Floats:
        """Sums of (n,) amounts over each independent unit: (replicates,), or (n,) as they are."""
        if self.group is None:
            return amounts
        return np.bincount(self.group, weights=amounts, minlength=self.groups).astype(np.float64)

    def part(self, where: Groups) -> Sample:
        """The trials at these ascending positions, as independent ones."""
        w = None if self.w is None else self.w[where]
        return Sample(picked(self.x, where), None if w is None else w / w.sum())

    def replicate(self, number: int) -> Sample:
        """One replicate alone."""
        return self.part(np.flatnonzero(self.group == number))


Values = ArrayLike | Sample
"""(n,) values, or a `Sample` made of them, so that many statistics share one sort."""


def _between(left: Floats, right: Floats, share: Floats) -> Floats:
    """So much of the way from left to right; also where the way is longer than the largest number."""
    with np.errstate(over="ignore"):
        way = right - left
    if np.isfinite(way).all():
        return np.asarray(left + way * share)
    return np.asarray(left * (1.0 - share) + right * share)


def positions_of(w: Floats) -> Floats:
    """(n,) for each of n ≥ 2 weights, what stands before it as a share of all but itself."""
    below = np.concatenate([[0.0], np.cumsum(w[:-1])])
    above = np.concatenate([np.cumsum(w[:0:-1])[::-1], [0.0]])
    return np.asarray(below / (below + above))


def _matching(column: NDArray[np.generic], x: Floats, what: str) -> NDArray[np.generic]:
    if column.shape != x.shape:
        raise ValueError(f"{what} must match the values: shape {column.shape} beside {x.shape}")
    return column


def _normalised(w: Floats, x: Floats) -> Floats:
    """Weights that sum to 1; all zero if none carries weight."""
    _matching(w, x, "weights")
    if not np.all((w >= 0.0) & (w < np.inf)):
        raise ValueError("weights must be finite and not negative")
    largest = w.max(initial=0.0)
    if largest == 0.0:
        return w
    w = w / largest  # first, so that the sum cannot overflow
    w = np.where(w < LEAST_WEIGHT, 0.0, w)
    return np.asarray(w / w.sum())


def _sorted(
    x: Floats, w: Floats | None, ids: NDArray[np.generic] | None
) -> tuple[Floats, Floats | None, Groups | None, int]:
    if w is None and ids is None:
        return ascending(x), None, None, 0
    order = np.argsort(x, kind="stable")  # ties stay in trial order: the same sums on every machine
    if w is not None:
        order = order[w[order] > 0.0]
    group, groups = (None, 0) if ids is None else _grouped(ids[order])
    return x[order], None if w is None else w[order], group, groups


def _grouped(ids: NDArray[np.generic]) -> tuple[Groups, int]:
    """Replicates numbered from 0; beyond 64 the 65th joins the first, and so on."""
    names, group = np.unique(ids, return_inverse=True)
    return (group % MOST_GROUPS).astype(np.intp), min(names.size, MOST_GROUPS)
