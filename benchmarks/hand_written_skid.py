"""The skid sheet of `books.py` hand-written in NumPy: a yardstick with almost no arithmetic, where drawing counts."""

from __future__ import annotations

import numpy as np
from books import SKID, G
from numpy.typing import NDArray

__all__ = ["HIGH", "LOW", "evaluate", "simulate"]

Array = NDArray[np.float64]
LOW = np.array([low for *_, low, _ in SKID])
HIGH = np.array([high for *_, high in SKID])


def evaluate(inputs: Array) -> Array:
    """Friction, distance in ft and grade in percent, (3, n), which it overwrites -> speed in mph, (1, n).

    The grade's angle is never needed: cos = 1/√(1 + t²) and sin = t cos of its tangent t.
    """
    friction, distance, tangent = inputs
    tangent *= 0.01
    friction += tangent
    friction *= distance
    friction *= 2 * G
    np.square(tangent, out=tangent)
    tangent += 1
    friction /= np.sqrt(tangent, out=tangent)
    np.sqrt(friction, out=friction)
    friction *= 3600 / 5280
    return inputs[:1]


def simulate(trials: int, seed: int, chunk: int) -> Array:
    """Speeds in mph, (1, trials), one thread."""
    rng = np.random.Generator(np.random.SFC64(seed))
    low, width = LOW[:, None], (HIGH - LOW)[:, None]
    inputs, speeds = np.empty((3, chunk)), np.empty((1, trials))
    for start in range(0, trials, chunk):
        rng.random(out=inputs)
        inputs *= width
        inputs += low
        part = speeds[:, start : start + chunk]
        part[:] = evaluate(inputs)[:, : part.shape[1]]
    return speeds
