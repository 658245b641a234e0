"""Minimum, maximum and range width: facts about the trials, without an error to state.

What lies beyond the largest of n trials no sample can bound without assuming a distribution.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from xlmc.statistics.estimate import Estimate
from xlmc.statistics.sample import Sample, Values

__all__ = ["maximum", "minimum", "range_width"]


def minimum(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> Estimate:
    """The smallest of (n,) values that carries weight."""
    sample = Sample.of(values, weights, replicate)
    return Estimate(float(sample.x[0]) if sample.n else np.nan, n=sample.n)


def maximum(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> Estimate:
    """The largest of (n,) values that carries weight."""
    sample = Sample.of(values, weights, replicate)
    return Estimate(float(sample.x[-1]) if sample.n else np.nan, n=sample.n)


def range_width(values: Values, weights: ArrayLike | None = None, replicate: ArrayLike | None = None) -> Estimate:
    """Largest less smallest; nan where that is too large for a number."""
    sample = Sample.of(values, weights, replicate)
    width = maximum(sample).value - minimum(sample).value
    return Estimate(np.nan if math.isinf(width) else width, n=sample.n)
