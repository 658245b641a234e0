"""The workbook as a function of points: forecasts, the filters' verdicts, and what the filters look at.

Letters: n points, k assumptions, f forecasts, c filter cells.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.address import Cell
from xlmc.definitions.model import name_key
from xlmc.evaluation.engine import Target
from xlmc.evaluation.numpy.numpy_engine import NumpyProgram
from xlmc.run.model import Model
from xlmc.run.scene import condition

__all__ = ["Evaluation", "Outcomes"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_PORTION: Final = 8_192


@dataclass(frozen=True, slots=True, eq=False)
class Outcomes:
    """What the workbook makes of `n` points.

    Attributes:
        accepted: `(n,)` whether every filter is TRUE.
        forecasts: `(n, f)`, NaN where a forecast is no number.
        cells: `(n, c)` the further cells asked for, likewise.
    """

    accepted: Bools
    forecasts: Floats
    cells: Floats


class Evaluation:
    """Evaluates points with the engine `numpy`, a portion at a time, and counts them.

    Args:
        model: the workbook.
        cells: more cells that are wanted.

    Attributes:
        count: points evaluated so far.
    """

    def __init__(self, model: Model, cells: tuple[Cell, ...] = ()) -> None:
        self._keys = [name_key(a.name) for a in model.live]
        self._filters, self._forecasts, self._cells = len(model.filters), len(model.forecasts), len(cells)
        asked = [Target(condition(each), each.cell) for each in model.filters]
        asked += [Target(each.cell, each.cell) for each in model.forecasts]
        asked += [Target(cell, cell) for cell in cells]
        program = NumpyProgram.of(model.lowering, asked, [], frozenset(self._keys))
        self._portion = min(_PORTION, program.largest_block)
        self._evaluator = program.evaluator(self._portion)
        self.count = 0

    def __call__(self, points: Floats) -> Outcomes:
        """The outcomes at `(n, k)` points, columns in the order of the live assumptions."""
        parts = [*self._parts(points)]
        columns = np.concatenate(parts) if parts else np.empty((0, self._filters + self._forecasts + self._cells))
        self.count += len(points)
        verdicts, rest = columns[:, : self._filters], columns[:, self._filters :]
        accepted = np.all(np.nan_to_num(verdicts) != 0.0, axis=1)
        return Outcomes(accepted, rest[:, : self._forecasts], rest[:, self._forecasts :])

    def _parts(self, points: Floats) -> Iterator[Floats]:
        for start in range(0, len(points), self._portion):
            part = points[start : start + self._portion]
            inputs = {key: np.ascontiguousarray(part[:, place]) for place, key in enumerate(self._keys)}
            columns = self._evaluator.filters(inputs, len(part))
            yield np.column_stack([np.array(column.as_floats()) for column in columns])
