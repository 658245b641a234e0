"""How far the values lie from a fitted distribution: Anderson-Darling and Kolmogorov-Smirnov.

Statistics only. Their usual p-values hold for a distribution that was known beforehand; for one fitted to the same
values they are far too large, so none is given.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from xlmc.studies.fitting.candidate import Floats

__all__ = ["anderson_darling", "kolmogorov_smirnov", "kolmogorov_smirnov_of_counts"]


def anderson_darling(at: Floats) -> float:
    """A² of the distribution function at the values, `(n,)` rising; infinite where a value lies on its end.

    Source: T. W. Anderson and D. A. Darling, "A test of goodness of fit", 1954.
    """
    n = at.size
    if at[0] <= 0 or at[-1] >= 1:
        return np.inf
    weights = 2 * np.arange(1, n + 1) - 1
    return float(-n - np.sum(weights * (np.log(at) + np.log1p(-at[::-1]))) / n)


def kolmogorov_smirnov(at: Floats) -> float:
    """The largest distance between the distribution function, `(n,)` rising at the values, and the steps of these."""
    n = at.size
    steps = np.arange(n + 1) / n
    return float(max(np.max(steps[1:] - at), np.max(at - steps[:-1])))


def kolmogorov_smirnov_of_counts(x: Floats, cdf: Callable[[Floats], Floats]) -> float:
    """The same for whole numbers `(n,)`, rising: both functions are steps, compared on every whole number."""
    k = np.unique(np.concatenate([x - 1, x]))
    steps = np.searchsorted(x, k, side="right") / x.size
    return float(np.max(np.abs(steps - cdf(k))))
