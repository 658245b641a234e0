"""Influence of an assumption on a forecast, from the trials of a run as they are.

Three measures, each a statement on the joint distribution of an assumption X and a forecast Y. They mean the same for
correlated assumptions and for trials that passed filters. Each has its standard error, from the pulls of the trials
(`pull_errors`).

**Variance explained**, Var(E[Y | X]) / Var(Y), is the share of the forecast's variance that would go, on average, if X
were known, with whatever X tells of other assumptions. It is Pearson's correlation ratio, and for independent
assumptions Sobol's first-order index.

- *Estimate.* X is cut into classes of equal probability (Plischke, Borgonovo & Smith 2013; Strong & Oakley 2013), at
  most 16 and of at least 50 trials, and a straight line is laid through Y in each (a regression as in Strong, Oakley &
  Brennan 2014, but without a family of smooth functions). Where E[Y | X] is linear that is exact, however few the
  classes; a plain mean per class loses 1 to 2 % with normal X. Where Y jumps or bends inside a class, `explained` asks
  for finer ones. With k parameters,

      S = 1 − (RSS / (n − k)) / (TSS / (n − 1)),

  adjusted as R² is (Ezekiel 1930; Kelley's ε² for classes alone), so that without influence it is 0 on average.
- *Error.* A trial pulls S by ((1 − S) z² − e²)/n, z its standardised value and e its residual; what estimating the line
  costs is √(2 (k − 1))/n, which matters where S is about 0: the pulls hold it twice over, once too often.
- *Floor.* Without influence S exceeds what Fisher's F with k − 1 and n − k degrees of freedom gives it with 5 %
  probability; that is divided by the number of assumptions (Bonferroni), for the largest of all to stay below.
- Not taken: the rank estimator of Gamboa, Gremaud, Klein & Lagnoux 2022, without classes and without bias, but with
  noise of 1/√n where there is no influence, seven times as much at 3,500 trials.

**Dependence**, the Cramér–von Mises index, tells whether Y depends on X at all:

      C = ∫ Var(P(Y ≤ t | X)) dF(t) / ∫ F(t) (1 − F(t)) dF(t)

(Gamboa, Klein & Lagnoux 2018; the limit of Chatterjee's ξ 2021.) It is 0 only where Y does not depend on X, 1 where Y
is a function of X, and the same whatever increasing scale either is measured on. It needs no density, as δ of Borgonovo
2007 does.

- *Estimate.* The share that X explains (with the same classes and lines) of the indicators [Y ≤ t], pooled over 31
  values of t at equal steps of Y's ranks. Its *error* comes likewise from pulls.
- *Floor.* Without influence the pooled square of the fit is Σ χ²/(π²j²) with k − 1 degrees of freedom each (Anderson &
  Darling 1952); its upper quantile is taken from the χ² with the same mean and variance, 2.5 (k − 1) degrees of freedom
  (Satterthwaite 1946).

**Spearman's rank correlation**, and Crystal Ball's contribution to variance made of it. A trial pulls the correlation
directly and through the ranks of all others. With grades u and v (ranks from −½ to ½), the covariance is the mean of
uv, a statistic of three trials at a time; its first-order pulls are uᵢvᵢ + a(xᵢ) + b(yᵢ) less their mean, where a(x) is
the mean of v·[x′ > x] over the trials, half of those with x′ = x among them, and b likewise (Hoeffding 1948, Borkowf
2002). The spread of the grades, which equal values make smaller, is treated in the same way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.analysis.studies.sensitivity.ranked import Classes, Ranked
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import t_quantile

__all__ = [
    "contributions",
    "dependence",
    "dependence_floor",
    "explained_floor",
    "explained_share",
    "fit_lines",
    "rank_correlation",
    "standardise",
]

Floats = NDArray[np.float64]
_CHANCE = 0.05
"""The probability that noise alone lifts any of a forecast's assumptions above the floor."""

Indices = NDArray[np.intp]

_WEIGHT = 2.5
"""(Σλ)²/Σλ² of λ = 1/(π²j²)."""


def explained_share(x: Ranked, y: Floats, units: Units) -> Estimate:
    """Return the share of the variance of `(n,)` y that x explains; nan where y does not vary or the trials are too
    few.
    """
    classes, n = x.classes, x.n
    z = standardise(y)
    if z is None or n <= classes.freedom:
        return Estimate(math.nan, n=n)
    z = z[x.order]
    residual = z - fit_lines(classes, z)
    value = _adjust(float(np.sum(residual * residual)), n, classes.freedom)
    pulls = np.empty(n)
    pulls[x.order] = (1.0 - value) * z * z - residual * residual * (n / (n - classes.freedom))
    fitting = math.sqrt(2.0 * (classes.freedom - 1)) / n * (1.0 - value)
    return units.estimate(value, units.error_of_fit(pulls - pulls.mean(), fitting))


def explained_floor(x: Ranked, assumptions: int) -> float:
    """Return what the largest of so many assumptions' shares stays below with 95 % probability where none has
    influence.
    """
    from scipy.special import fdtri

    n, k = x.n, x.classes.freedom
    if k < 2 or n <= k:
        return math.nan
    f = float(fdtri(k - 1.0, n - float(k), 1.0 - _CHANCE / max(assumptions, 1)))
    left = 1.0 / (1.0 + f * (k - 1.0) / (n - k))
    return 1.0 - left * (n - 1.0) / (n - k)


def _adjust(residual: float, n: int, k: int) -> float:
    """1 − (RSS/(n − k))/(TSS/(n − 1)), where TSS is n."""
    return 1.0 - residual / (n - k) * ((n - 1.0) / n)


def fit_lines(classes: Classes, y: Floats) -> Floats:
    """`(n,)` the lines at every trial, of y in ascending order of x."""
    means = np.add.reduceat(y, classes.starts) / classes.sizes
    slopes = np.add.reduceat(y * classes.centred, classes.starts) / classes.squares
    return np.asarray(np.repeat(means, classes.sizes) + np.repeat(slopes, classes.sizes) * classes.centred)


def standardise(y: Floats) -> Floats | None:
    """Mean 0 and mean square 1; None if y does not vary."""
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


def dependence(x: Ranked, y: Ranked, units: Units) -> Estimate:
    """Return the index of y on x, columns `(n,)`; nan where y does not vary or the trials are too few."""
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
    """Return what the largest of so many assumptions' indices stays below with 95 % probability where none has
    influence.
    """
    from scipy.special import chdtri

    n, q = x.n, x.classes.freedom - 1.0
    if q < 1.0 or n <= q + 1.0:
        return math.nan
    freedom = _WEIGHT * q
    return (float(chdtri(freedom, _CHANCE / max(assumptions, 1))) / freedom - 1.0) * q / n


def _tables(classes: Classes, step: Indices, steps: int) -> tuple[Floats, Floats]:
    """`(c, steps − 1)` the lines of the indicators [step ≤ t] in every class: their means and slopes."""
    size = classes.sizes.size
    flat = classes.label * steps + step
    counts = np.bincount(flat, minlength=size * steps).reshape(size, steps)
    sums = np.bincount(flat, classes.centred, size * steps).reshape(size, steps)
    means = np.cumsum(counts, axis=1)[:, :-1] / classes.sizes[:, None]
    return means, np.cumsum(sums, axis=1)[:, :-1] / classes.squares[:, None]


def _squares_alone(below: Floats) -> Floats:
    """Return `(steps,)` Σ_t ([step ≤ t] − F(t))² of every step, from `(steps − 1,)` F(t)."""
    step = np.arange(below.size + 1)
    return np.asarray(np.sum(((step[:, None] <= step[None, :-1]) - below) ** 2, axis=1))


def _squares(means: Floats, slopes: Floats, step: Indices, label: Indices, centred: Floats) -> Floats:
    """`(n,)` Σ_t ([step ≤ t] − mean − slope·centred)², by sums over t that are made once a class."""
    steps = means.shape[1] + 1

    def from_on(table: Floats) -> Floats:
        """`(c, steps)` the sum over t from a step on."""
        summed = np.zeros((table.shape[0], steps))
        summed[:, :-1] = np.cumsum(table[:, ::-1], axis=1)[:, ::-1]
        return summed.ravel()

    flat = label * steps + step
    hits = steps - 1.0 - step
    fit = from_on(means)[flat] + from_on(slopes)[flat] * centred
    squares = [np.sum(table, axis=1)[label] for table in (means**2, means * slopes, slopes**2)]
    return np.asarray(hits - 2.0 * fit + squares[0] + 2.0 * squares[1] * centred + squares[2] * centred**2)


def rank_correlation(x: Ranked, y: Ranked, units: Units) -> Estimate:
    """Spearman's correlation, −1 to 1, of the `(n,)` columns x and y; nan where one of them does not vary.

    The interval is symmetric in Fisher's z.
    """
    if not (x.varies and y.varies):
        return Estimate(math.nan, n=x.n)
    scale = math.sqrt(x.spread * y.spread)
    value = min(1.0, max(-1.0, float(np.mean(x.grades * y.grades)) / scale))
    pulls = x.grades * y.grades + x.above(y.grades) + y.above(x.grades)
    pulls = (pulls - pulls.mean()) / scale - 0.5 * value * (x.pulls / x.spread + y.pulls / y.spread)
    error = units.error(pulls)
    if not math.isfinite(error):
        return Estimate(value, n=x.n)
    if abs(value) > 1.0 - 1e-12:
        return Estimate(value, 0.0, (value, value), x.n)
    half = t_quantile(units.dof, 0.95) * error / (1.0 - value**2)
    z = math.atanh(value)
    return Estimate(value, error, (math.tanh(z - half), math.tanh(z + half)), x.n)


def contributions(correlations: Sequence[Estimate], others: float = 0.0) -> list[Estimate]:
    """Divide each squared correlation by the sum of all: a share, with its correlation's sign.

    Their errors are those of the correlations, taken to be independent of each other.

    Args:
        correlations: those that are measured.
        others: the sum of the squares of all others.
    """
    r = np.array([each.value for each in correlations])
    errors = np.array([math.nan if each.error is None else each.error for each in correlations])
    squares = np.nan_to_num(r) ** 2
    total = float(squares.sum()) + others
    if total == 0.0:
        return [Estimate(math.nan, n=each.n) for each in correlations]
    share = squares / total
    moves = 2.0 * np.nan_to_num(r * errors) / total  # of each square, in units of the total
    others = float(np.sum(moves**2)) - moves**2
    spread = np.sqrt((1.0 - share) ** 2 * moves**2 + share**2 * others)
    return [
        Estimate(math.nan, n=each.n)
        if math.isnan(each.value)
        else Estimate(math.copysign(part, each.value), None if each.error is None else float(error), None, each.n)
        for each, part, error in zip(correlations, share.tolist(), spread, strict=True)
    ]
