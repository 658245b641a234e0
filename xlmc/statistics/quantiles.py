"""Percentiles, median and central range.

Linear interpolation as Excel's PERCENTILE.INC. With weights, a trial stands at the probability p where the weight below
it is to the weight above it as p to 1 − p; equal weights give PERCENTILE.INC again, and whole-number weights agree at
every trial with a sample in which each trial is repeated that often. Errors and intervals: see `ranks`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from xlmc.statistics.estimate import Estimate
from xlmc.statistics.ranks import by_rank, by_replicate
from xlmc.statistics.sample import Sample, Values

__all__ = ["central_interval", "median", "percentile", "percentiles"]

Floats = NDArray[np.float64]


def percentiles(
    values: Values,
    percents: Sequence[float],
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
) -> dict[float, Estimate]:
    """Percent -> percentile of (n,) values; 0 and 100 are the extremes and have no error.

    Raises:
        ValueError: a percent is not between 0 and 100, or a value is not finite.

    >>> percentiles([10.0, 20.0, 40.0], [0, 50, 75])[75].value
    30.0
    """
    sample = Sample.of(values, weights, replicate)
    p = np.asarray(percents, dtype=np.float64) / 100.0
    if not np.all((p >= 0.0) & (p <= 1.0)):
        raise ValueError(f"percentiles lie between 0 and 100: {list(percents)}")
    return dict(zip((float(each) for each in percents), _estimates(sample, p, confidence), strict=True))


def percentile(
    values: Values,
    percent: float,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
) -> Estimate:
    """One percentile, `percent` between 0 and 100."""
    return percentiles(values, [percent], weights, replicate, confidence=confidence)[float(percent)]


def median(
    values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None, *, confidence: float = 0.95
) -> Estimate:
    """The 50th percentile."""
    return percentile(values, 50.0, weights, replicate, confidence=confidence)


def central_interval(
    values: Values,
    share: float = 0.51,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    confidence: float = 0.95,
) -> tuple[Estimate, Estimate]:
    """The range that leaves (1 − share)/2 on either side: 24.5 to 75.5 % for 51 %. It is not the shortest range.

    Raises:
        ValueError: the share is not between 0 and 1.
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"a share lies between 0 and 1, not at {share}")
    tail = (1.0 - share) / 2.0
    sample = Sample.of(values, weights, replicate)
    lower, upper = _estimates(sample, np.array([tail, 1.0 - tail]), confidence)
    return lower, upper


def _estimates(sample: Sample, p: Floats, confidence: float) -> list[Estimate]:
    if sample.n == 0:
        return [Estimate(np.nan) for _ in p]
    found = by_rank if sample.group is None else by_replicate
    inner = iter(found(sample, p[(p > 0.0) & (p < 1.0)], confidence))
    ends = {0.0: Estimate(float(sample.x[0]), n=sample.n), 1.0: Estimate(float(sample.x[-1]), n=sample.n)}
    return [ends[each] if each in ends else next(inner) for each in p.tolist()]
