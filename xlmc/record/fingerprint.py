"""One hash for the numbers of a run: equal exactly where every accepted trial is equal, bit for bit."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import numpy as np

from xlmc.scratch import parts

if TYPE_CHECKING:
    from xlmc.simulation import Simulation

__all__ = ["fingerprint"]


def fingerprint(simulation: Simulation) -> str:
    """SHA-256 (lower-case hex) of the accepted trials: indices, then inputs, then forecasts, in the workbook's order.

    Inputs are those that the run kept, see `Simulation`. Indices are 8-byte little-endian integers, the rest IEEE
    doubles, little-endian; every missing number is the same NaN.
    """
    digest = hashlib.sha256()
    for part in parts(simulation.trial_index):
        digest.update(part.astype("<i8", copy=False).data)
    for columns in (simulation.inputs, simulation.forecasts):
        for values in columns.values():
            for part in parts(values):
                digest.update(np.where(np.isnan(part), np.nan, part).astype("<f8", copy=False).data)
    return digest.hexdigest()
