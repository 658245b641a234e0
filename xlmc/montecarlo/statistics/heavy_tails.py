"""Three tests of forecasts that a few far trials decide: how much one trial contributes, and how heavy the tail is.

**One trial.** If a forecast has a variance, the part of it that comes from the farthest trial goes to 0 as trials are
added: with 1,000 trials it is about 1 % for a normal forecast, 4 % for an exponential one. If it has none, the part
does not go to 0: for a ratio whose denominator passes 0 (Cauchy) it is 25 to 100 %, however many trials there are. The
mean of such a forecast does not exist; the number printed for it depends on the seed alone, and so does its error.

**The tail.** Hill's estimator gives its index α: P(|x - median| > t) falls as t^-α. The mean exists if α is above 1,
the standard deviation if it is above 2. A ratio whose denominator passes 0 has α = 1.

**The spread.** The error of a standard deviation comes from the fourth moment, which exists if α is above 4. The runs
whose interval is too short are those without far trials, so the far trials cannot tell. The shape of the tail before
them can: beyond a high threshold t, P(x > t + y) falls as (1 + ξy/s)^(-1/ξ) with ξ = 1/α (Pickands 1975, Ann. Stat. 3,
119). L-moments estimate ξ (Hosking & Wallis 1987, Technometrics 29, 339); it is 0 for the tails of normal, gamma and
Gumbel forecasts, wherever t lies. The interval may be too short unless ξ is below 1/4 by nearly its standard error, or
if ten trials hold more than half of the sum of fourth powers.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.montecarlo.statistics.sample import Sample, Values

__all__ = ["decides_spread", "farthest_part", "heavy_tail"]


def farthest_part(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> float:
    """Return the part of the sum of squares about the mean that the farthest trial gives; nan if nothing varies.

    >>> round(farthest_part([0.0, 0.0, 0.0, 4.0]), 12)
    0.75
    """
    sample = Sample.of(values, weights, replicate)
    m = sample.moments
    if sample.n == 0 or not m.scale > 0.0:
        return math.nan
    shares = (1.0 / sample.n,) * 2 if sample.w is None else (float(sample.w[0]), float(sample.w[-1]))
    ends = float(sample.x[0]), float(sample.x[-1])
    return max(share * ((end - m.mean) / m.scale) ** 2 for share, end in zip(shares, ends, strict=True))


Floats = NDArray[np.float64]

_SHARE: Final = 0.02
_FEWEST: Final = 40
"""The share of the numbers that counts as the tail, and the fewest: the error of α is a sixth of it, or less."""

_FAR: Final = 0.25
"""The share of the tail that must be as heavy by itself; if it is not, only a few trials lie apart from the rest."""


def _tail_index(ascending: Floats, part: float = 1.0) -> tuple[float, float]:
    """Return Hill's index of the heavier tail, and its standard error; infinite if there are too few numbers.

    Args:
        ascending: the numbers.
        part: the share of the tail that is used, from the far end.
    """
    n = ascending.size
    k = int(max(_FEWEST, _SHARE * n))
    if n < 10 * k:
        return np.inf, 0.0
    used, size = int(part * k) + 1, max(-float(ascending[0]), float(ascending[-1])) or 1.0
    middle = 0.5 * (ascending[(n - 1) // 2] / size) + 0.5 * (ascending[n // 2] / size)
    best = np.inf
    for largest in (ascending[-used:] / size - middle, middle - ascending[:used][::-1] / size):
        if largest[0] > 0:
            best = min(best, 1.0 / max(float(np.mean(np.log(largest[1:] / largest[0]))), 1e-300))
    return best, best / np.sqrt(k)


_LIMIT: Final = 2.0
"""The index below which the standard deviation does not exist."""

_FEW: Final = 10
_TRIALS_FOR_ONE: Final = 1_000
"""Ten trials count as a few if they are at most one in so many."""

_LEAST_OF_TAIL: Final = 20
_TRIALS_OF_FIFTH: Final = 1_000
"""Up to so many trials the tail is a fifth of them; of more trials, a share that falls as 1/√n."""

_SHAPE_OF_SPREAD: Final = 0.25
"""The shape above which the fourth moment does not exist."""


def heavy_tail(x: Floats) -> tuple[float, float] | None:
    """Return index and standard error of a tail so heavy that the standard deviation does not converge, else None."""
    ascending = np.sort(x[np.isfinite(x)])
    index, error = _tail_index(ascending)
    return (index, error) if index + 2 * error < _LIMIT and _tail_index(ascending, _FAR)[0] < _LIMIT else None


def decides_spread(ascending: Floats, mean: float, scale: float, kurtosis: float) -> bool:
    """Return whether the tail of (n,) ascending values makes the interval of their standard deviation too short.

    Args:
        ascending: the values.
        mean: their mean.
        scale: the root of their mean square about it.
        kurtosis: their kurtosis.
    """
    n = ascending.size
    if not scale > 0.0 or kurtosis < 3.0 + math.sqrt(24.0 / n):  # no more far trials than a normal forecast has
        return False
    return _few_hold_half(ascending, mean, scale, kurtosis) or _is_heavy(ascending / scale)


def _few_hold_half(ascending: Floats, mean: float, scale: float, kurtosis: float) -> bool:
    """Return whether ten trials hold more than half of the sum of fourth powers."""
    if ascending.size < _FEW * _TRIALS_FOR_ONE:
        return False
    ends = (np.concatenate([ascending[:_FEW], ascending[-_FEW:]]) - mean) / scale
    return float(np.sort(ends**4)[-_FEW:].sum()) > 0.5 * kurtosis * ascending.size


def _is_heavy(ascending: Floats) -> bool:
    """Return whether the shape of either tail, and that of its far quarter, may be above 1/4.

    The standard error of a shape of 1/4 from k exceedances is 1.27/√k.
    """
    n = ascending.size
    k = int(0.2 * math.sqrt(n * min(n, _TRIALS_OF_FIFTH)))
    if k < _LEAST_OF_TAIL:
        return False
    far = max(int(_FAR * k), _LEAST_OF_TAIL)
    return any(
        _shape(tail[:k] - tail[k]) > _SHAPE_OF_SPREAD - k**-0.5
        and _shape(tail[:far] - tail[far]) > _SHAPE_OF_SPREAD - 3.0 * far**-0.5
        for tail in (ascending[::-1], -ascending)
    )


def _shape(beyond: Floats) -> float:
    """Return the shape ξ of (k,) descending exceedances by their L-moments; -inf if nearly all are at the threshold."""
    beyond = beyond[beyond > 0.0]
    k = beyond.size
    if 2 * k < _LEAST_OF_TAIL:
        return -math.inf
    first = float(beyond.mean())
    second = float(np.mean(beyond * (1.0 - (2.0 * np.arange(k) + 1.0) / k)))
    return 2.0 - first / second if second > 0.0 else -math.inf
