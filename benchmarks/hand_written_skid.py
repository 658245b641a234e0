"""The skid sheet of `books.py` hand-written in NumPy: with little arithmetic, so that drawing and keeping count.

`formulas` is what the sheet says, cell by cell, and draws as xlmc does: from a PCG64DXSM stream for every assumption.
`identity` is sharper: cos(atan t) = 1/√(1 + t²) and sin(atan t) = t cos(atan t), which other bits come of, and one
SFC64 stream for all assumptions. Both keep the speed and the number of every trial.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from books import SKID, G
from numpy.typing import NDArray

__all__ = ["HIGH", "KERNELS", "LOW", "Kept", "evaluate", "evaluate_formulas", "simulate"]

Array = NDArray[np.float64]
LOW = np.array([low for *_, low, _ in SKID])
HIGH = np.array([high for *_, high in SKID])


class Kept(NamedTuple):
    """Columns of a run: speeds in mph, (1, trials), the trials' numbers, and draws, (3, trials), where asked for."""

    speeds: Array
    index: NDArray[np.int64]
    draws: Array | None


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


def evaluate_formulas(inputs: Array) -> Array:
    """The same by the sheet's own formulas."""
    friction, distance, grade = inputs
    grade /= 100
    slope = np.arctan(grade, out=grade)
    friction *= np.cos(slope)
    friction += np.sin(slope, out=slope)
    distance *= 2 * G
    friction *= distance
    np.sqrt(friction, out=friction)
    friction *= 3600
    friction /= 5280
    return inputs[:1]


def _own_streams(seed: int) -> list[np.random.Generator]:
    return [np.random.Generator(np.random.PCG64DXSM([seed, number])) for number in range(len(SKID))]


def _one_stream(seed: int) -> list[np.random.Generator]:
    return [np.random.Generator(np.random.SFC64(seed))] * len(SKID)


KERNELS: dict[str, tuple[Callable[[Array], Array], Callable[[int], list[np.random.Generator]]]] = {
    "formulas": (evaluate_formulas, _own_streams),
    "identity": (evaluate, _one_stream),
}
"""Name -> the model, and the streams of a seed, one for each assumption."""


def simulate(trials: int, seed: int, chunk: int, kernel: str = "identity", keep_draws: bool = False) -> Kept:
    """So many trials, one thread."""
    model, make_streams = KERNELS[kernel]
    streams = make_streams(seed)
    low, width = LOW[:, None], (HIGH - LOW)[:, None]
    buffer, speeds, index = np.empty((len(SKID), chunk)), np.empty((1, trials)), np.empty(trials, np.int64)
    draws = np.empty((len(SKID), trials)) if keep_draws else None
    for start in range(0, trials, chunk):
        end = min(start + chunk, trials)
        for row, stream in zip(buffer, streams, strict=True):
            stream.random(out=row)
        buffer *= width
        buffer += low
        if draws is not None:
            draws[:, start:end] = buffer[:, : end - start]
        speeds[:, start:end] = model(buffer)[:, : end - start]
        index[start:end] = np.arange(start, end)
    return Kept(speeds, index, draws)
