"""One hash for the numbers of a run: equal exactly where every accepted trial is equal, bit for bit."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from xlmc.simulation import Simulation

__all__ = ["fingerprint"]


def fingerprint(simulation: Simulation) -> str:
    """SHA-256 (lower-case hex) of the accepted trials: indices, then inputs, then forecasts, in the workbook's order.

    Indices are 8-byte little-endian integers, the rest IEEE doubles, little-endian; every missing number is the same
    NaN.
    """
    digest = hashlib.sha256(simulation.trial_index.astype("<i8").tobytes())
    for values in (*simulation.inputs.values(), *simulation.forecasts.values()):
        digest.update(np.where(np.isnan(values), np.nan, values).astype("<f8").tobytes())
    return digest.hexdigest()
