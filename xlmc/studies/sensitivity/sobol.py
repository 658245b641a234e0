"""Sobol's indices by pick and freeze, each with its standard error.

Two independent sets of trials, A and B; ABᵢ is A with assumption i taken from B. With answers a, b and c of these, each
`(n,)`, and v the variance of a and b,

    first order   Sᵢ = 1 − mean((b − c)²) / 2v        (Jansen 1999)
    total         Tᵢ = mean((a − c)²) / 2v            (Jansen 1999, Saltelli et al. 2010)

Sᵢ is the share of the variance that assumption i explains alone, Tᵢ what would be left on average if all others were
known. They hold for independent assumptions and trials that no filter rejects.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from xlmc.statistics import Estimate
from xlmc.studies.sensitivity.units import Units

__all__ = ["sobol_indices"]

Floats = NDArray[np.float64]


def sobol_indices(a: Floats, b: Floats, c: Floats) -> tuple[Estimate, Estimate]:
    """First-order and total index from the answers `(n,)` of A, B and ABᵢ; nan where they do not vary.

    Pairs in which one of the answers is no number (NaN) are left out.
    """
    known = ~(np.isnan(a) | np.isnan(b) | np.isnan(c))
    a, b, c = a[known], b[known], c[known]
    units = Units(int(a.size))
    if units.n < 2:
        return Estimate(math.nan, n=units.n), Estimate(math.nan, n=units.n)
    largest = max(float(np.max(np.abs(a))), float(np.max(np.abs(b)))) or 1.0
    a, b, c = a / largest, b / largest, c / largest  # first, so that sums and squares cannot overflow
    middle = 0.5 * (a.mean() + b.mean())
    scale = max(float(np.max(np.abs(a - middle))), float(np.max(np.abs(b - middle))))
    if not scale > 1e-12:
        return Estimate(math.nan, n=units.n), Estimate(math.nan, n=units.n)
    a, b, c = (a - middle) / scale, (b - middle) / scale, (c - middle) / scale
    squares = a * a + b * b  # of mean 2v
    first, total = (_share((each - c) ** 2, squares, units) for each in (b, a))
    alone = units.estimate(1.0 - first.value, first.error if first.error is not None else math.nan)
    return alone, total


def _share(part: Floats, whole: Floats, units: Units) -> Estimate:
    """mean(part)/mean(whole), with the error of a ratio."""
    size = float(whole.mean())
    value = float(part.mean()) / size
    return units.estimate(value, units.error((part - value * whole) / size))
