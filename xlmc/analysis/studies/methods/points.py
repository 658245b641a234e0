"""Points of the assumptions: the box that they lie in, and what the workbook makes of them.

The box has the lowest and the highest value of each assumption, whatever the others are.
Letters: n points, k assumptions, f forecasts, c filter cells.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Target
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.excel.address import Cell
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.model.needed import filter_condition, upstream
from xlmc.montecarlo.number_text import count_text, number_text
from xlmc.montecarlo.sampling.draws import Draw

__all__ = ["Box", "Evaluation", "Outcomes", "assumptions_of", "box_of"]

_CUT: Final = 0.001
"""What an unbounded end is cut at: the quantile of this probability, and that of all but it."""

_DRAWN: Final = 32_768
"""Draws whose extremes stand for the ends of an assumption whose parameters vary."""

Floats = NDArray[np.float64]

Bools = NDArray[np.bool_]

_PORTION: Final = 8_192


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """The ends of `k` assumptions, in the order of the model's.

    Attributes:
        low, high: `(k,)`.
        remarks: where an end is not that of the distribution, in words.
    """

    low: Floats
    high: Floats
    remarks: tuple[str, ...]

    @property
    def width(self) -> Floats:
        return self.high - self.low


def box_of(model: CompiledModel, seed: int) -> Box:
    """Make the box of a model; the seed is that of the draws which are looked at where parameters vary."""
    cut, varying = [], []
    ends = np.empty((len(model.live), 2))
    for index, assumption in enumerate(model.live):
        draw = model.draws[assumption.name]
        pair = draw.ends
        if pair is not None:
            ends[index] = pair
        elif draw.fixed:
            ends[index] = _cut(draw)
            cut.append(assumption.name)
        else:
            varying.append(index)
    if varying:
        drawn = model.sampler(seed, _DRAWN).draw(0)
        for index in varying:
            column = drawn[model.draws[model.live[index].name].name]
            ends[index] = np.nanmin(column), np.nanmax(column)
    return Box(ends[:, 0], ends[:, 1], tuple(_remarks(model, cut, varying)))


def _cut(draw: Draw) -> tuple[float, float]:
    """Return the ends, infinite ones replaced by quantiles."""
    at = np.array([0.0, _CUT, 1.0 - _CUT, 1.0])
    with np.errstate(all="ignore"):
        draw.fill(at, {})
    lowest, low, high, highest = at.tolist()
    # A family that is open below reads 0 as the least probability there is, and its quantile is finite.
    closed_below = np.isfinite(lowest) and not draw.family.open_below
    return (lowest if closed_below else low), (highest if np.isfinite(highest) else high)


def _remarks(model: CompiledModel, cut: list[str], varying: list[int]) -> list[str]:
    result = []
    if cut:
        names = ", ".join(cut)
        result.append(
            f"unbounded ends are cut at the {number_text(100 * _CUT)} and "
            f"{number_text(100 - 100 * _CUT)} % quantiles: {names}"
        )
    if varying:
        names = ", ".join(model.live[index].name for index in varying)
        result.append(f"parameters vary, so the extremes of {count_text(_DRAWN)} draws stand for the ends: {names}")
    if model.groups:
        result.append("correlations are not seen: any corner counts as possible")
    return result


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

    def __init__(self, model: CompiledModel, cells: tuple[Cell, ...] = ()) -> None:
        self._names = [a.name for a in model.live]
        self._filters, self._forecasts, self._cells = len(model.filters), len(model.forecasts), len(cells)
        asked = [Target(filter_condition(each), each.cell) for each in model.filters]
        asked += [Target(each.cell, each.cell) for each in model.forecasts]
        asked += [Target(cell, cell) for cell in cells]
        program = NumpyProgram.of(model.lowering, asked, [], frozenset(self._names))
        self._portion = min(_PORTION, program.largest_block)
        self._evaluator = program.evaluator(self._portion)
        self.count = 0

    def __call__(self, points: Floats) -> Outcomes:
        """Return the outcomes at `(n, k)` points, columns in the order of the live assumptions."""
        parts = [*self._parts(points)]
        columns = np.concatenate(parts) if parts else np.empty((0, self._filters + self._forecasts + self._cells))
        self.count += len(points)
        verdicts, rest = columns[:, : self._filters], columns[:, self._filters :]
        accepted = np.all(np.nan_to_num(verdicts) != 0.0, axis=1)
        return Outcomes(accepted, rest[:, : self._forecasts], rest[:, self._forecasts :])

    def _parts(self, points: Floats) -> Iterator[Floats]:
        for start in range(0, len(points), self._portion):
            part = points[start : start + self._portion]
            inputs = {name: np.ascontiguousarray(part[:, index]) for index, name in enumerate(self._names)}
            columns = self._evaluator.filters(inputs, len(part))
            yield np.column_stack([np.array(column.as_floats()) for column in columns])


def assumptions_of(model: CompiledModel, cells: Iterable[Cell]) -> list[int]:
    """Return the indices of the live assumptions that reach any of these cells, ascending.

    An assumption that only moves another's parameters does not count.
    """
    reached = upstream(model.needed.graph, cells, {})
    return [index for index, assumption in enumerate(model.live) if assumption.cell in reached]
