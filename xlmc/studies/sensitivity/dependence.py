"""Whether a forecast depends on an assumption at all: the Cramér–von Mises index, from the trials as they are.

    C = ∫ Var(P(Y ≤ t | X)) dF(t) / ∫ F(t) (1 − F(t)) dF(t)

(Gamboa, Klein & Lagnoux 2018; the limit of Chatterjee's ξ 2021.) 0 only where Y does not depend on X, 1 where Y is a
function of X; the same whatever increasing scale either is measured on. It needs no density, as δ of Borgonovo 2007
does, and like it holds for correlated inputs and for trials that passed filters.

**Estimate.** The share that X explains (`explained.py`, the same classes and lines) of the indicators [Y ≤ t], pooled
over 31 values of t at equal steps of Y's ranks. **Error** likewise, from pulls.

**Floor.** Without influence the pooled square of the fit is Σ χ²/(π²j²) with k − 1 degrees of freedom each (Anderson &
Darling 1952); its upper quantile is taken from the χ² with the same mean and variance, 2.5 (k − 1) degrees of freedom
(Satterthwaite 1946).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from xlmc.statistics import Estimate
from xlmc.studies.sensitivity.explained import CHANCE
from xlmc.studies.sensitivity.ranked import Classes, Ranked
from xlmc.studies.sensitivity.units import Units

__all__ = ["dependence", "dependence_floor"]

Floats = NDArray[np.float64]
Places = NDArray[np.intp]

_WEIGHT = 2.5
"""(Σλ)²/Σλ² of λ = 1/(π²j²)."""


def dependence(x: Ranked, y: Ranked, units: Units) -> Estimate:
    """The index of y on x, columns `(n,)`; nan where y does not vary or the trials are too few."""
    classes, n = x.classes, x.n
    if not y.varies or n <= classes.freedom:
        return Estimate(math.nan, n=n)
    step, steps = y.steps[x.order], int(y.steps.max()) + 1
    means, slopes = _tables(classes, step, steps)
    below = np.cumsum(np.bincount(step, minlength=steps))[:-1] / n
    total = float(np.sum(below * (1.0 - below)))
    residual = _squares(means, slopes, step, classes.label, classes.centred)
    value = 1.0 - float(np.sum(residual)) / (n - classes.freedom) * ((n - 1.0) / n) / total
    alone = _squares_alone(below)[step]
    pulls = np.empty(n)
    pulls[x.order] = ((1.0 - value) * alone - residual * (n / (n - classes.freedom))) / total
    fitting = math.sqrt(2.0 * (classes.freedom - 1) / _WEIGHT) / n * (1.0 - value)
    return units.estimate(value, units.error_of_fit(pulls - pulls.mean(), fitting))


def dependence_floor(x: Ranked, assumptions: int) -> float:
    """What the largest of so many assumptions' indices stays below with 95 % probability where none has influence."""
    from scipy.special import chdtri

    n, q = x.n, x.classes.freedom - 1.0
    if q < 1.0 or n <= q + 1.0:
        return math.nan
    freedom = _WEIGHT * q
    return (float(chdtri(freedom, CHANCE / max(assumptions, 1))) / freedom - 1.0) * q / n


def _tables(classes: Classes, step: Places, steps: int) -> tuple[Floats, Floats]:
    """`(c, steps − 1)` the lines of the indicators [step ≤ t] in every class: their means and slopes."""
    size = classes.sizes.size
    place = classes.label * steps + step
    counts = np.bincount(place, minlength=size * steps).reshape(size, steps)
    sums = np.bincount(place, classes.centred, size * steps).reshape(size, steps)
    means = np.cumsum(counts, axis=1)[:, :-1] / classes.sizes[:, None]
    return means, np.cumsum(sums, axis=1)[:, :-1] / classes.squares[:, None]


def _squares_alone(below: Floats) -> Floats:
    """`(steps,)` Σ_t ([step ≤ t] − F(t))² of every step, from `(steps − 1,)` F(t)."""
    place = np.arange(below.size + 1)
    return np.asarray(np.sum(((place[:, None] <= place[None, :-1]) - below) ** 2, axis=1))


def _squares(means: Floats, slopes: Floats, step: Places, label: Places, centred: Floats) -> Floats:
    """`(n,)` Σ_t ([step ≤ t] − mean − slope·centred)², by sums over t that are made once a class."""
    steps = means.shape[1] + 1

    def from_on(table: Floats) -> Floats:
        """`(c, steps)` the sum over t from a step on."""
        summed = np.zeros((table.shape[0], steps))
        summed[:, :-1] = np.cumsum(table[:, ::-1], axis=1)[:, ::-1]
        return summed.ravel()

    place = label * steps + step
    hits = steps - 1.0 - step
    fit = from_on(means)[place] + from_on(slopes)[place] * centred
    squares = [np.sum(table, axis=1)[label] for table in (means**2, means * slopes, slopes**2)]
    return np.asarray(hits - 2.0 * fit + squares[0] + 2.0 * squares[1] * centred + squares[2] * centred**2)
