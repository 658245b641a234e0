"""Spearman's rank correlation with its error, and Crystal Ball's contribution to variance made of it.

A trial pulls the correlation directly and through the ranks of all others. With grades u and v (ranks from −½ to ½),
the covariance is the mean of uv, a statistic of three trials at a time; its first-order pulls are
uᵢvᵢ + a(xᵢ) + b(yᵢ) less their mean, where a(x) is the mean of v·[x′ > x] over the trials, half of those with x′ = x
among them, and b likewise (Hoeffding 1948, Borkowf 2002). The spread of the grades, which equal values make smaller, is
treated in the same way.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from xlmc.statistics import Estimate
from xlmc.statistics.estimate import t_quantile
from xlmc.studies.sensitivity.ranked import Ranked
from xlmc.studies.sensitivity.units import Units

__all__ = ["contributions", "rank_correlation"]


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


def contributions(correlations: Sequence[Estimate]) -> list[Estimate]:
    """Each squared correlation over the sum of all, a share, with its correlation's sign.

    Their errors are those of the correlations, taken to be independent of each other.
    """
    r = np.array([each.value for each in correlations])
    errors = np.array([math.nan if each.error is None else each.error for each in correlations])
    squares = np.nan_to_num(r) ** 2
    total = float(squares.sum())
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
