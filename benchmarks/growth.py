"""How the cost of a run grows with formula cells, trials, forecasts and assumptions, with both fast engines.

Each point is a book of its own in a process of its own: the time-stepped books for the cells, the wide ones for
forecasts and assumptions, the case study for the trials. A series that is not measured keeps the points it has.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from books import CASE_STUDY, write_march, write_wide
from processes import answer_of

__all__ = ["COLUMNS", "SERIES", "TRIALS", "measure", "seconds_of", "slope"]

ENGINES = ("numpy", "jit")
ASSUMPTIONS = 100
"""Of the books whose forecasts are more and more."""

TRIALS = 100_000
"""Trials for which the cost of one is multiplied, where tables and pictures show seconds."""

MOST_TRIALS = {"numpy": 10**8, "jit": 10**9}
"""The longest runs: a run of 10⁹ trials with `numpy` takes more than three minutes."""

SIZES = {
    "cells": (100, 300, 1_000, 3_000, 10_000, 30_000, 100_000),
    "trials": tuple(10**power for power in range(3, 10)),
    "forecasts": (1, 3, 10, 30, 100, 300, 1_000),
    "assumptions": (1, 3, 10, 30, 100, 300, 1_000, 2_000),
}
SERIES = tuple(SIZES)

_WRITERS: dict[str, Callable[[Path, int], None]] = {
    "cells": write_march,
    "forecasts": lambda path, size: write_wide(path, ASSUMPTIONS, size),
    "assumptions": lambda path, size: write_wide(path, size, 1),
}

COLUMNS = ("loading", "program", "first", "a trial")
"""What is measured of a book: see `one_growth`."""


def measure(
    series: Sequence[str],
    known: dict[str, Any],
    folder: Path,
    seconds: float,
    limit: float,
    say: Callable[[str], None],
    most: int | None = None,
) -> dict[str, Any]:
    """Series -> engine -> points, one {"size", and what was measured or "absent"} a size.

    Args:
        series: those to measure.
        known: what was found before, for the others.
        folder: for the books.
        seconds: for one measurement of the cost of a trial, about.
        limit: seconds that one process may take.
        say: prints.
        most: leaves out larger sizes.
    """
    result = dict(known)
    for name in series:
        sizes = [size for size in SIZES[name] if most is None or size <= most]
        result[name] = {engine: [] for engine in ENGINES}
        for engine in ENGINES:
            points = (
                _runs(engine, sizes, limit) if name == "trials" else _books(name, engine, sizes, folder, seconds, limit)
            )
            for point in points:
                result[name][engine].append(point)
                say(f"{name}, {engine}: {point}")
    return {name: result[name] for name in SERIES if name in result}


def _books(name: str, engine: str, sizes: Sequence[int], folder: Path, seconds: float, limit: float) -> Any:
    for size in sizes:
        path = folder / f"{name}-{size}.xlsx"
        if not path.exists():
            _WRITERS[name](path, size)
        yield {"size": size, **_ask(engine, path, [], seconds, limit)}


def _runs(engine: str, sizes: Sequence[int], limit: float) -> Any:
    trials = [size for size in sizes if size <= MOST_TRIALS[engine]]
    answer = _ask(engine, CASE_STUDY, trials, 0, limit)
    for size, seconds in zip(trials, answer.get("runs", [None] * len(trials)), strict=True):
        yield {"size": size, "run": seconds} if seconds is not None else {"size": size, **answer}


def _ask(engine: str, path: Path, trials: Sequence[int], seconds: float, limit: float) -> dict[str, Any]:
    task = {"path": str(path), "engine": engine, "trials": list(trials), "seconds": seconds}
    answer = answer_of(Path(sys.executable), "one_growth.py", task, limit)
    return {"absent": answer} if isinstance(answer, str) else answer


def seconds_of(points: Sequence[dict[str, Any]], column: str) -> tuple[list[int], list[float]]:
    """Sizes and seconds of the points that have a column; the cost of a trial is that of TRIALS trials."""
    have = [point for point in points if column in point]
    scale = TRIALS if column == "a trial" else 1
    return [point["size"] for point in have], [scale * point[column] for point in have]


def slope(sizes: Sequence[int], seconds: Sequence[float], last: float = 10.0) -> float | None:
    """The exponent of the growth: least squares through the logarithms of the points of the last decade.

    >>> round(slope((1, 10, 100), (5.0, 1.0, 10.0)), 9)
    1.0
    """
    near = [(math.log(x), math.log(y)) for x, y in zip(sizes, seconds, strict=True) if x * last >= sizes[-1]]
    if len(near) < 2:
        return None
    mean_x, mean_y = (sum(values) / len(near) for values in zip(*near, strict=True))
    return sum((x - mean_x) * (y - mean_y) for x, y in near) / sum((x - mean_x) ** 2 for x, _ in near)
