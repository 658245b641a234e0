"""One hash for the numbers of a run: equal exactly where every accepted trial is equal, bit for bit."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from xlmc.columns import parts
from xlmc.run.simulation import KEPT_INPUTS

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["fingerprint"]


def fingerprint(simulation: Simulation) -> str:
    """SHA-256 (lower-case hex) of the accepted trials: indices, then inputs, then forecasts, in the workbook's order.

    Inputs are those of the first 1,048,576 accepted trials, or what the run kept of them. Indices are 8-byte
    little-endian integers, the rest IEEE doubles, little-endian; every missing number is the same NaN.
    """
    digest = hashlib.sha256()
    for part in parts(simulation.trial_index):
        digest.update(part.astype("<i8", copy=False).data)
    for values in simulation.inputs.values():
        _update(digest, values[:KEPT_INPUTS])
    for values in simulation.forecasts.values():
        _update(digest, values)
    return digest.hexdigest()


def _update(digest: hashlib._Hash, values: NDArray[np.float64]) -> None:
    for part in parts(values):
        digest.update(np.where(np.isnan(part), np.nan, part).astype("<f8", copy=False).data)
