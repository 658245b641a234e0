"""Forecasts that amplify: a small change of an assumption is a large one of the answer, whatever the formula's form."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from xlmc.studies.stability.case import Case
from xlmc.studies.stability.findings import Finding, Level

__all__ = ["amplifying_forecasts"]

_LIMIT: Final = 1e3
"""Relative change of the forecast per relative change of the assumptions, all together, in the median trial."""


def amplifying_forecasts(case: Case) -> Iterator[Finding]:
    """The forecasts that amplify a thousand times and more in half of the trials."""
    for forecast in case.model.forecasts:
        one = case.derivatives.forecasts[forecast.name]
        moved = np.abs(one.gradient * case.derivatives.points)
        with np.errstate(all="ignore"):
            amplified = np.nansum(moved, axis=1) / np.maximum(np.abs(one.value), 0.01 * case.scale(forecast.cell))
        known = amplified[np.isfinite(amplified)]
        if not known.size or np.median(known) < _LIMIT:
            continue
        through = case.derivatives.names[int(np.nansum(moved, axis=0).argmax())]
        factor = float(np.median(known))
        yield Finding(
            Level.NOTE,
            "amplification",
            forecast.cell,
            forecast.name,
            case.trees.written(forecast.cell),
            f"it changes by {factor:.2g} % when its assumptions change by 1 %, mostly through {through!r}",
            "this is in the problem: no other form and no more digits make it less; other evidence does",
            (),
            None,
            factor,
        )
