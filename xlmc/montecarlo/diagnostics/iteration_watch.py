"""Whether circles that are computed iteratively settle: in the first trials of a run, as they were drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.tracking import TrackingEvaluator
from xlmc.errors import Notice
from xlmc.montecarlo.loop.blocks import portions
from xlmc.montecarlo.number_text import count_text

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["unconverged_notices"]

_TRIALS: Final = 1 << 14
"""Trials that are looked at: they are computed once more."""

_BLOCK: Final = 1 << 12

Floats = NDArray[np.float64]


def unconverged_notices(model: CompiledModel, drawn: Mapping[str, Floats]) -> list[Notice]:
    """Say which circles do not settle, and how often.

    Args:
        model: the workbook.
        drawn: assumption -> its draws, `(n,)`, in trials as they were drawn.
    """
    circles, iteration = model.lowering.iterated, model.workbook.iteration
    if not circles or iteration is None:
        return []
    draws = {name: values[:_TRIALS] for name, values in drawn.items()}
    n = next((values.size for values in draws.values()), 0)
    evaluator = TrackingEvaluator(model.lowering.dag, [circle.converged for circle in circles], [])
    counts = np.zeros(len(circles), np.int64)
    for part, block in portions(draws, n, _BLOCK):
        for index, column in enumerate(evaluator.filters(block, part.stop - part.start)):
            counts[index] += np.count_nonzero(column.values == 0.0)
    return [
        Notice(
            f"{circle.name} does not settle in {count_text(count)} of {count_text(n)} trials that were "
            "looked at: their "
            f"values are those after {count_text(iteration.count)} iterations",
            circle.cells[0],
        )
        for circle, count in zip(circles, counts.tolist(), strict=True)
        if count
    ]
