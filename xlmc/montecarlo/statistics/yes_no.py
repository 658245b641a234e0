"""Forecasts that are 0 or 1 in every trial: their mean is a share, and all that follows from it has its interval.

With p the share of ones, the variance is p(1 − p), greatest at ½; the interval of the standard deviation is where p's
interval leads, and its error is half of that interval over 1.96, never 0: that no trial was 1 does not prove that none
can be. The share's interval is that of `proportions`, with weights and replicates too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.statistics.estimate import Estimate, t_quantile
from xlmc.montecarlo.statistics.proportions import probability_above
from xlmc.montecarlo.statistics.sample import Sample

__all__ = ["are_yes_no", "coefficient_of_share", "deviation_of_share", "share_of_ones", "variance_of_share"]


def are_yes_no(x: NDArray[np.float64]) -> bool:
    """Whether all of `(n,)` values are 0 or 1, and there are some.

    >>> are_yes_no(np.array([0.0, 1.0])), are_yes_no(np.array([0.0, 0.5])), are_yes_no(np.array([]))
    (True, False, False)
    """
    return bool(x.size) and bool(np.all((x == 0.0) | (x == 1.0)))


def share_of_ones(sample: Sample, confidence: float = 0.95) -> Estimate | None:
    """Return the mean of a sample of zeros and ones; None of any other."""
    return probability_above(sample, 0.5, confidence=confidence) if sample.yes_no else None


def variance_of_share(share: Estimate, value: float, confidence: float = 0.95) -> Estimate:
    """Return the variance, of the given value, of zeros and ones of which ones have this share."""
    return _through(share, value, lambda p: p * (1.0 - p), confidence)


def deviation_of_share(share: Estimate, value: float, confidence: float = 0.95) -> Estimate:
    """Return the standard deviation, likewise."""
    return _through(share, value, lambda p: math.sqrt(p * (1.0 - p)), confidence)


def coefficient_of_share(share: Estimate, value: float, confidence: float = 0.95) -> Estimate:
    """Return the coefficient of variation, √((1 − p)/p), likewise; its upper end is infinite where p may be 0."""
    return _through(share, value, lambda p: math.sqrt((1.0 - p) / p) if p > 0.0 else math.inf, confidence)


def _through(share: Estimate, value: float, function: Callable[[float], float], confidence: float) -> Estimate:
    """Estimate a function of the share that is monotonic, or greatest at ½."""
    if share.interval is None or not math.isfinite(value):
        return Estimate(value, n=share.n)
    low, high = share.interval
    inside = [0.5] if low < 0.5 < high else []
    reached = [value, *(function(p) for p in (low, high, *inside))]
    ends = min(reached), max(reached)
    half = (ends[1] - ends[0]) / 2.0 / t_quantile(np.inf, confidence)
    return replace(share, value=value, error=half if math.isfinite(half) else None, interval=ends)
