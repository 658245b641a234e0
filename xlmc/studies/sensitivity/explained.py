"""Var(E[Y | X]) / Var(Y) from the trials as they are: the share of a forecast's variance that an assumption explains.

Pearson's correlation ratio, which for independent inputs is Sobol's first-order index. It is a statement on the joint
distribution of X and Y, so that it means the same for correlated inputs and for trials that passed filters: the
variance that would go, on average, if X were known, whatever X tells of other inputs among it.

**Estimate.** X is cut into classes of equal probability (Plischke, Borgonovo & Smith 2013; Strong & Oakley 2013), at
most 16 and of at least 50 trials, and a straight line is laid through Y in each (a regression as in Strong, Oakley &
Brennan 2014, but without a family of smooth functions). Where E[Y | X] is linear that is exact, however few the
classes; a plain mean per class loses 1 to 2 % with normal X. With k parameters,

    S = 1 − (RSS / (n − k)) / (TSS / (n − 1)),

adjusted as R² is (Ezekiel 1930; Kelley's ε² for classes alone), so that without influence it is 0 on average.

**Error.** A trial pulls S by ((1 − S) z² − e²)/n, z its standardised value and e its residual; what estimating the line
costs is √(2 (k − 1))/n, which matters where S is about 0: the pulls hold it twice over, once too often.

**Floor.** Without influence S exceeds what Fisher's F with k − 1 and n − k degrees of freedom gives it with 5 %
probability; divided by the number of assumptions (Bonferroni), for the largest of all to stay below.

(Not taken: the rank estimator of Gamboa, Gremaud, Klein & Lagnoux 2022, without classes and without bias, but with
noise of 1/√n where there is no influence, seven times as much at 3,500 trials.)
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from xlmc.statistics import Estimate
from xlmc.studies.sensitivity.ranked import Classes, Ranked
from xlmc.studies.sensitivity.units import Units

__all__ = ["CHANCE", "explained", "explained_floor", "shares", "standardised"]

Floats = NDArray[np.float64]

CHANCE = 0.05
"""That noise alone lifts any of a forecast's assumptions above the floor."""


def explained(x: Ranked, y: Floats, units: Units) -> Estimate:
    """The share of the variance of `(n,)` y that x explains; nan where y does not vary or the trials are too few."""
    classes, n = x.classes, x.n
    z = standardised(y)
    if z is None or n <= classes.freedom:
        return Estimate(math.nan, n=n)
    z = z[x.order]
    residual = z - _fitted(classes, z)
    value = _adjusted(float(np.sum(residual * residual)), n, classes.freedom)
    pulls = np.empty(n)
    pulls[x.order] = (1.0 - value) * z * z - residual * residual * (n / (n - classes.freedom))
    fitting = math.sqrt(2.0 * (classes.freedom - 1)) / n * (1.0 - value)
    return units.estimate(value, units.error_of_fit(pulls - pulls.mean(), fitting))


def shares(x: Ranked, z: Floats) -> Floats:
    """`(f,)` the same, without errors, of forecasts `(f, n)` that are standardised: mean 0, mean square 1."""
    classes, sorted_ = x.classes, z[:, x.order]
    sums = np.add.reduceat(sorted_, classes.starts, axis=1)
    lines = np.add.reduceat(sorted_ * classes.centred, classes.starts, axis=1)
    fitted = np.sum(sums**2 / classes.sizes, axis=1) + np.sum(lines**2 / classes.squares, axis=1)
    n, k = x.n, classes.freedom
    return np.asarray(1.0 - (n - fitted) / (n - k) * ((n - 1.0) / n))


def explained_floor(x: Ranked, assumptions: int) -> float:
    """What the largest of so many assumptions' shares stays below with 95 % probability where none has influence."""
    from scipy.special import fdtri

    n, k = x.n, x.classes.freedom
    if k < 2 or n <= k:
        return math.nan
    f = float(fdtri(k - 1.0, n - float(k), 1.0 - CHANCE / max(assumptions, 1)))
    left = 1.0 / (1.0 + f * (k - 1.0) / (n - k))
    return 1.0 - left * (n - 1.0) / (n - k)


def _adjusted(residual: float, n: int, k: int) -> float:
    """1 − (RSS/(n − k))/(TSS/(n − 1)), where TSS is n."""
    return 1.0 - residual / (n - k) * ((n - 1.0) / n)


def _fitted(classes: Classes, y: Floats) -> Floats:
    """`(n,)` the lines at every trial, of y in ascending order of x."""
    means = np.add.reduceat(y, classes.starts) / classes.sizes
    slopes = np.add.reduceat(y * classes.centred, classes.starts) / classes.squares
    return np.asarray(np.repeat(means, classes.sizes) + np.repeat(slopes, classes.sizes) * classes.centred)


def standardised(y: Floats) -> Floats | None:
    """Mean 0 and mean square 1; None where y does not vary."""
    largest = float(np.max(np.abs(y), initial=0.0))
    if not largest > 0.0:
        return None
    apart = y / largest  # first, so that sums and squares cannot overflow
    apart = apart - apart.mean()
    scale = float(np.max(np.abs(apart)))
    if not scale > 1e-12:
        return None
    apart = apart / scale
    return np.asarray(apart / math.sqrt(float(np.mean(apart**2))))
