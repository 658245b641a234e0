"""Standard errors from pulls: how far each trial moves a statistic (Hampel 1974; the infinitesimal jackknife).

The error is the root of the sum of the squared pulls of the independent units: the trials, or the replicates of a Latin
hypercube or scrambled Sobol run, within which trials depend on each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import LEAST_DOF, with_error

__all__ = ["Units"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Units:
    """n trials, and what is independent among them.

    Attributes:
        n: trials.
        replicate: `(n,)` numbered from 0; None if the trials themselves are independent.
    """

    n: int
    replicate: NDArray[np.intp] | None = None

    @classmethod
    def of(cls, n: int, ids: NDArray[np.int64] | None = None) -> Units:
        """Make the errors by the replicate ids of the trials, `(n,)`, if there are any."""
        if ids is None:
            return cls(n)
        return cls(n, np.unique(ids, return_inverse=True)[1].astype(np.intp))

    @property
    def count(self) -> int:
        """How many are independent."""
        return self.n if self.replicate is None else int(self.replicate.max(initial=-1)) + 1

    @property
    def dof(self) -> float:
        return self.count - 1.0

    def error(self, pulls: Floats) -> float:
        """Return the standard error of a mean of `(n,)` pulls, which sum to about 0; nan of fewer than two units."""
        checkpoint()
        if self.dof < LEAST_DOF:
            return float("nan")
        sums = pulls if self.replicate is None else np.bincount(self.replicate, pulls, self.count)
        largest = float(np.max(np.abs(sums), initial=0.0)) or 1.0  # taken out, so that squares cannot overflow
        scaled = sums / largest
        return float(largest / self.n * np.sqrt(np.sum(scaled * scaled) * (self.count / self.dof)))

    def error_of_fit(self, pulls: Floats, fitting: float) -> float:
        """Return the same for a share that a fit explains, where the fit alone has noise of the size `fitting`.

        The fitted line follows the trials, so the pulls hold twice that noise's variance in excess of what they should.
        """
        value = self.error(pulls)
        return value if np.isnan(value) else float(np.sqrt(max(value**2 - fitting**2, fitting**2)))

    def estimate(self, value: float, error: float) -> Estimate:
        """Return a value with its 95 % interval; without an error where there is none."""
        return with_error(value, error, self.dof, 0.95, self.n)
