"""Sorting a column that does not fit in memory: sorted runs, merged piece by piece.

Runs of 4 M values are sorted in memory and written. Splitters are every so manieth value of the runs, so chosen that at
most two runs' worth of values lies strictly between two of them (sampling at regular intervals: Shi & Schaeffer 1992);
each such piece is gathered from all runs, sorted and written. Values equal to a splitter are only counted, so that ties
cannot make a piece large.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xlmc.columns.folder import Folder
from xlmc.columns.mapped import on_disk, release
from xlmc.columns.passes import PART, parts

__all__ = ["ascending"]

Floats = NDArray[np.float64]
Places = NDArray[np.intp]

RUN = 1 << 22
"""Values sorted together."""


def ascending(values: Floats) -> Floats:
    """`(n,)` values without NaN in ascending order: in memory, or on disk where they were on disk.

    Raises:
        SimulationError: there is no room on the disk.
    """
    if not on_disk(values):
        return np.sort(values)
    folder = Folder()
    for part in parts(values, RUN):
        folder.append("runs", [np.sort(part)])
    runs = folder.array("runs", values.dtype)
    if values.size <= RUN:
        return runs
    _merge(folder, [runs[start : start + RUN] for start in range(0, runs.size, RUN)])
    folder.remove("runs")
    return folder.array("merged", values.dtype)


def _merge(folder: Folder, runs: list[Floats]) -> None:
    """Write the values of all ascending runs in ascending order."""
    splitters = _splitters(runs)
    before = np.array([np.searchsorted(run, splitters, side="left") for run in runs])
    after = np.array([np.searchsorted(run, splitters, side="right") for run in runs])
    release(runs[0])
    first, last = np.zeros((len(runs), 1), np.intp), np.array([[run.size] for run in runs])
    begins, ends = np.hstack([first, after]), np.hstack([before, last])
    for place in range(splitters.size + 1):
        piece = np.concatenate([run[b:e] for run, b, e in zip(runs, begins[:, place], ends[:, place], strict=True)])
        release(runs[0])
        piece.sort()
        folder.append("merged", [piece])
        if place < splitters.size:
            ties = int((after[:, place] - before[:, place]).sum())
            _repeat(folder, splitters[place], ties)


def _splitters(runs: list[Floats]) -> Floats:
    """Ascending values, no two equal."""
    k = len(runs)
    step = -(-runs[0].size // k)
    candidates = np.sort(np.concatenate([run[::step] for run in runs]))
    return np.unique(candidates[::k])


def _repeat(folder: Folder, value: np.float64, count: int) -> None:
    full = np.full(min(count, PART), value)
    folder.append("merged", (full[: min(PART, count - start)] for start in range(0, count, PART)))
