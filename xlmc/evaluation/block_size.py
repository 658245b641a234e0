"""How many trials are evaluated at once where arrays and texts take much memory in each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.evaluation.graph.dag import MANY, Dag
from xlmc.evaluation.reference.tracking import TrackingEvaluator
from xlmc.functions import Kind
from xlmc.functions.budget import MOST_LIVE, TooLargeError

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["array_bytes", "fitting_block"]

_MOST_BYTES: Final = 1 << 26
"""Of the arrays and texts of a block: functions need several times that while they work."""

_WIDE: Final = 1_000
"""Cells of an array that is worth a look."""


def array_bytes(lowering: Lowering, filters: Sequence[int], forecasts: Sequence[int]) -> int:
    """The bytes that values take at a time in one trial, measured with the inputs at their base values.

    It is 0, unmeasured, for a model without texts or wide arrays that vary.
    """
    dag = lowering.dag
    places = dag.upstream([*filters, *forecasts])
    if not any(_may_be_wide(dag, place) for place in places):
        return 0
    base = {name: lowering.graph.workbook.content(cell).value for cell, name in lowering.inputs.items()}
    inputs = {name: np.full(1, float(x) if isinstance(x, int | float) else 1.0) for name, x in base.items()}
    try:
        return TrackingEvaluator(dag, filters, forecasts).peak(inputs)
    except TooLargeError:
        return MOST_LIVE


def _may_be_wide(dag: Dag, place: int) -> bool:
    size = dag.sizes[place]
    if size is None:
        return dag.types[place] is Kind.TEXT
    return size == MANY or size[0] * size[1] > _WIDE


def fitting_block(block: int, array_bytes: int, number_bytes: int) -> int:
    """The largest power of two up to `block` whose trials fit into the memory; 1 where not even that does.

    Args:
        block: to start from.
        array_bytes: what arrays and texts take in a trial.
        number_bytes: what single numbers take.
    """
    while block > 1 and (block * array_bytes > _MOST_BYTES or block * number_bytes > MOST_LIVE):
        block //= 2
    return block
