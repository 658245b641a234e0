"""How far two distributions lie apart, from the accepted trials of two runs.

**Kolmogorov's distance** D = max |G(x) − F(x)|, the largest difference of the two distribution functions (Smirnov 1939
for two samples). Its error is that of G − F at the place of the maximum (Raghavachari 1973).

**Wasserstein's distance** W₁ = ∫ |G(x) − F(x)| dx, in the forecast's unit: the least mean distance by which the trials
of the one must be moved to lie as those of the other (Kantorovich 1942; this form Vallender 1974). It is the difference
of the means of a potential whose slope is the sign of F − G, and its error is that of this difference (del Barrio, Giné
& Matrán 1999).

Neither can be negative, so that two runs of one model with trials of their own lie apart, too, by about the error.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xlmc.statistics import Estimate
from xlmc.statistics.estimate import with_error
from xlmc.studies.comparison.influences import Pair

__all__ = ["kolmogorov", "wasserstein"]

Floats = NDArray[np.float64]


def kolmogorov(pair: Pair) -> Estimate:
    """The largest difference of the distribution functions, 0 to 1."""
    first, second, n = pair.first, pair.second, _fewest(pair)
    if n == 0:
        return Estimate(np.nan)
    places = np.union1d(first.sample.x, second.sample.x)
    gaps = _share_below(second.sample.x, places) - _share_below(first.sample.x, places)
    most = int(np.argmax(np.abs(gaps)))
    pulls = [
        ((run.values <= places[most]) - _share_below(run.sample.x, places[most])) / run.m for run in (first, second)
    ]
    return with_error(abs(float(gaps[most])), pair.error(*pulls), n - 1.0, 0.95, n)


def wasserstein(pair: Pair) -> Estimate:
    """The area between the distribution functions, in the unit of the values."""
    first, second, n = pair.first, pair.second, _fewest(pair)
    if n == 0:
        return Estimate(np.nan)
    places = np.union1d(first.sample.x, second.sample.x)
    gaps = (_share_below(second.sample.x, places) - _share_below(first.sample.x, places))[:-1]
    widths = np.diff(places)
    potential = np.concatenate([[0.0], -np.cumsum(np.sign(gaps) * widths)])
    held = [potential[np.searchsorted(places, run.values)] for run in (first, second)]
    pulls = [(g - g.mean()) / g.size for g in held]
    return with_error(float(np.sum(np.abs(gaps) * widths)), pair.error(*pulls), n - 1.0, 0.95, n)


def _fewest(pair: Pair) -> int:
    return min(pair.first.m, pair.second.m)


def _share_below(ascending: Floats, places: Floats) -> Floats:
    """The share of the values that are not above each place."""
    return np.asarray(np.searchsorted(ascending, places, side="right") / ascending.size)
