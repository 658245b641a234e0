"""Distributions fitted to the accepted trials of a forecast, to be drawn over its bars: they describe, nothing more."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.fitting import FEW, Fitted, fit, parameter_texts, share_at_most
from xlmc.errors import SimulationError
from xlmc.montecarlo.columns import picked, release
from xlmc.outputs.histogram import Histogram

__all__ = ["FittedCurve", "fitted_curves"]

Floats = NDArray[np.float64]

_VALUES: Final = 2_000
"""Trials that are fitted, each the middle one of as many: enough to tell a shape, in some hundredths of a second."""

_MOST: Final = 4
_PARTS: Final = 8
"""Points of a curve for each bar."""

_DIGITS: Final = 8

_SEEN: Final = 0.01
"""Difference between two curves, as shares, that can be seen."""


@dataclass(frozen=True, slots=True)
class FittedCurve:
    """A family with the parameters that describe the trials best.

    Attributes:
        name: of the family.
        parameters: in words.
        distance: the largest distance between its cumulative curve and that of the trials, 0 to 1.
        parts: points for each bar.
        shares: `(parts * b + 1,)` the share up to each point, from the lower edge of the first bar to the upper one of
            the last; of whole numbers, up to half a step below each edge.
    """

    name: str
    parameters: str
    distance: float
    parts: int
    shares: Floats


def fitted_curves(x: Floats, bins: Histogram) -> list[FittedCurve]:
    """Fit distributions, the best first by Akaike's criterion; return none if trials are too few or all equal.

    Args:
        x: `(n,)` ascending, in memory or on disk.
        bins: that they are drawn in.
    """
    if x.size < FEW or x[0] == x[-1]:
        return []
    taken = min(x.size, _VALUES)
    ranks = ((np.arange(taken) + 0.5) * (x.size / taken)).astype(np.intp)
    values = picked(x, ranks)
    release(x)
    whole = bins.width == 1.0 and bool(np.all(values == np.floor(values)))
    edges = np.append(bins.edges, bins.upper_edges[-1])
    parts = 1 if whole else _PARTS
    at = np.interp(np.arange(parts * bins.edges.size + 1) / parts, np.arange(edges.size), edges)
    try:
        with np.errstate(all="ignore"):  # over hundreds of orders of magnitude some families have no number to show
            fitting = fit(values, kind="counts" if whole and values[0] >= 0 else "continuous", errors=False)
            fits = (fitted for fitted in fitting.fits if np.isfinite(fitted.ks))
            curves = (_curve(fitted, at - 0.5 if whole else at, parts) for fitted in fits)
            return list(islice((curve for curve in curves if np.isfinite(curve.shares).all()), _MOST))
    except SimulationError:
        return []


def _curve(fitted: Fitted, at: Floats, parts: int) -> FittedCurve:
    message = ", ".join(f"{heading} {text}" for heading, text in parameter_texts(fitted, least=4, same=_SEEN).items())
    return FittedCurve(fitted.name, message, fitted.ks, parts, np.round(share_at_most(fitted, at), _DIGITS))
