"""Passes over long columns, a part at a time, so that memory stays flat; and sorting in the same manner.

A column that does not fit in memory is sorted in runs of 4 M values, which are written and then merged piece by piece.
Splitters are every k-th value of the runs, so chosen that at most two runs' worth of values lies strictly between
two of them (sampling at regular intervals: Shi & Schaeffer 1992); each such piece is gathered from all runs, sorted and
written. Values equal to a splitter are only counted, so that ties cannot make a piece large.
"""

from __future__ import annotations

import mmap
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.columns.column_store import Folder, on_disk, release

__all__ = ["PART", "RUN", "ascending", "holds_nan", "numbers", "pairwise_sum", "parts", "passed", "picked"]

PART = 65_536
"""Values looked at together: a few arrays of so many fit in the processor's cache."""

RUN = 1 << 22
"""Values sorted together: a column of no more is short, and may be in memory as a whole."""

_PICKED = 512
"""Values picked before the pages that they lie on are given back: each may be on a page of its own."""

_PICKED_FROM = _PICKED * mmap.PAGESIZE
"""Bytes of a column that has no more pages than that."""


def parts(values: NDArray[Any], size: int = PART) -> Iterator[NDArray[Any]]:
    """Yield the column in order, `size` values at a time; take what you keep before the next part.

    The memory of a column on disk is given back on the way, that of a short one at the end.
    """
    for start in range(0, values.size, size):
        yield values[start : start + size]
        passed(values)
    release(values)


def passed(values: NDArray[Any]) -> None:
    """Give back the memory of what was read of a long column; that of a short one waits for `release`."""
    if values.size > RUN:
        release(values)


def pairwise_sum(term: Callable[[slice], NDArray[np.float64]], n: int) -> float:
    """Sum n terms, which are made for a slice of them at a time.

    To the bit what `np.sum` gives for all of them in one array: it halves at the same terms.
    """
    return float(_between(term, 0, n))


def _between(term: Callable[[slice], NDArray[np.float64]], start: int, stop: int) -> np.float64:
    n = stop - start
    if n <= PART:
        value: np.float64 = np.add.reduce(term(slice(start, stop)))
        return value
    half = n // 2
    half -= half % 8  # as NumPy, which sums in eights
    return _between(term, start, start + half) + _between(term, start + half, stop)


def picked(values: NDArray[Any], indices: NDArray[np.intp]) -> NDArray[Any]:
    """Return the values at `(m,)` indices, in memory of their own."""
    if not on_disk(values):
        return np.asarray(values[indices])
    if values.nbytes <= _PICKED_FROM:
        result = np.asarray(values[indices])
        release(values)
        return result
    result = np.empty(indices.size, values.dtype)
    together = _PICKED if values.size > RUN else max(indices.size, 1)
    for start in range(0, indices.size, together):
        here = slice(start, start + together)
        result[here] = values[indices[here]]
        release(values)
    return result


def holds_nan(part: NDArray[np.float64]) -> bool:
    """Whether one of the values, which are some, is NaN: their least is then, which is faster to ask."""
    return bool(np.isnan(part.min()))


def numbers(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """`(n,)` values without NaN, in their order: the column itself where it has none; on disk where it was on disk."""
    if not any(holds_nan(part) for part in parts(values)):
        return values
    if not on_disk(values):
        return values[~np.isnan(values)]
    folder = Folder()
    for part in parts(values):
        folder.append("numbers", [part[~np.isnan(part)]])
    return folder.array("numbers", values.dtype)


def ascending(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """`(n,)` values without NaN in ascending order: in memory, or on disk where they were on disk.

    Raises:
        SimulationError: there is no space on the disk.
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


def _merge(folder: Folder, runs: list[NDArray[np.float64]]) -> None:
    """Write the values of all ascending runs in ascending order."""
    splitters = _splitters(runs)
    before = np.array([np.searchsorted(run, splitters, side="left") for run in runs])
    after = np.array([np.searchsorted(run, splitters, side="right") for run in runs])
    release(runs[0])
    first, last = np.zeros((len(runs), 1), np.intp), np.array([[run.size] for run in runs])
    begins, ends = np.hstack([first, after]), np.hstack([before, last])
    for index in range(splitters.size + 1):
        piece = np.concatenate([run[b:e] for run, b, e in zip(runs, begins[:, index], ends[:, index], strict=True)])
        release(runs[0])
        piece.sort()
        folder.append("merged", [piece])
        if index < splitters.size:
            ties = int((after[:, index] - before[:, index]).sum())
            _repeat(folder, splitters[index], ties)


def _splitters(runs: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Ascending values, no two equal."""
    k = len(runs)
    step = -(-runs[0].size // k)
    candidates = np.sort(np.concatenate([run[::step] for run in runs]))
    return np.unique(candidates[::k])


def _repeat(folder: Folder, value: np.float64, count: int) -> None:
    full = np.full(min(count, PART), value)
    folder.append("merged", (full[: min(PART, count - start)] for start in range(0, count, PART)))
