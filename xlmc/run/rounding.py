"""What float32 changes: the first trials of a run computed in both arithmetics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import Notice, RoundingError
from xlmc.run.blocks import Block, Task
from xlmc.run.scheduling.recipe import worker_of

if TYPE_CHECKING:
    from xlmc.definitions import Settings
    from xlmc.evaluation import Program
    from xlmc.run.model import Model

__all__ = ["MOST_DECISIONS", "MOST_DIFFERENCE", "Rounding", "checked_rounding"]

Floats = NDArray[np.float64]

MOST_DECISIONS: Final = 1e-4
"""The share of trials that may be accepted in one arithmetic and rejected in the other."""

MOST_DIFFERENCE: Final = 1e-3
"""How far a forecast may be off in a trial, relative to it or to its standard deviation, whichever is larger."""

_TRIALS: Final = 131_072
"""That are computed twice: enough to see a share of decisions well below the bound."""


@dataclass(frozen=True, slots=True)
class Rounding:
    """Of the first trials of a run, computed in float32 and in float64.

    Attributes:
        trials: how many.
        accepted: of them in both.
        decisions: of them accepted in one and rejected in the other.
        differences: forecast -> the largest difference in a trial that both accept, relative to its value or to its
            standard deviation over these, whichever is larger; infinite where one has no number and the other has.
    """

    trials: int
    accepted: int
    decisions: int
    differences: Mapping[str, float]

    @property
    def notice(self) -> Notice:
        """For whoever reads the results."""
        largest = max(self.differences.values(), default=0.0)
        return Notice(
            f"computed in float32: results carry its rounding. Of the first {self.trials:,} trials, {self.decisions:,} "
            f"were accepted or rejected otherwise than in float64; forecasts differ by up to {largest:.1g} of their "
            "value or standard deviation"
        )


def checked_rounding(model: Model, program: Program, settings: Settings, block: int) -> Rounding:
    """What float32 changes in the first trials of a run.

    Args:
        model: what is run.
        program: its, in float32.
        settings: of the run.
        block: trials per block.

    Raises:
        RoundingError: more than it may.
    """
    single = worker_of(model, program, settings.engine, settings.seed, block)
    double = worker_of(model, model.program("numpy"), "numpy", settings.seed, block)
    trials = min(settings.trials, _TRIALS)
    tasks = [Task(start, min(block, trials - start), False, False) for start in range(0, trials, block)]
    names = [forecast.name for forecast in model.forecasts]
    found = _compared([single.run(task) for task in tasks], [double.run(task) for task in tasks], names, trials)
    worst = max(found.differences, key=lambda name: found.differences[name], default="")
    hint = "use --arithmetic float64"
    if found.decisions > MOST_DECISIONS * trials:
        message = (
            f"{found.decisions:,} of the first {trials:,} trials are accepted or rejected otherwise than in float64"
        )
        raise RoundingError(f"float32 is too coarse for this model: {message}", hint=hint)
    if worst and found.differences[worst] > MOST_DIFFERENCE:
        cell = next(forecast.cell for forecast in model.forecasts if forecast.name == worst)
        message = f"{worst} differs from float64 by {found.differences[worst]:.1g} of its value or standard deviation"
        raise RoundingError(f"float32 is too coarse for this model: {message}", where=cell, hint=hint)
    return found


def _compared(single: list[Block], double: list[Block], names: list[str], trials: int) -> Rounding:
    ours, theirs = (np.concatenate([block.accepted for block in blocks]) for blocks in (single, double))
    both, mine, yours = np.intersect1d(ours, theirs, assume_unique=True, return_indices=True)
    differences = {
        name: _difference(_column(single, place)[mine], _column(double, place)[yours])
        for place, name in enumerate(names)
    }
    return Rounding(trials, both.size, ours.size + theirs.size - 2 * both.size, differences)


def _column(blocks: list[Block], place: int) -> Floats:
    return np.concatenate([block.forecasts[place] for block in blocks])


def _difference(rounded: Floats, exact: Floats) -> float:
    """See `Rounding.differences`; of `(m,)` values each."""
    known = np.isfinite(exact)
    if (np.isfinite(rounded) != known).any():
        return float("inf")
    rounded, exact = rounded[known], exact[known]
    if not exact.size:
        return 0.0
    scale = np.maximum(np.abs(exact), exact.std())
    off = np.abs(rounded - exact)
    return float(np.max(np.divide(off, scale, out=np.where(off > 0, np.inf, 0.0), where=scale > 0)))
