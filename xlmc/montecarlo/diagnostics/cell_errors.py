"""Errors in cells: those of the base case, and the cells that the errors of trials come from."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import TEXT_RESULT, Target
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell, InFormula
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.model.lowered_cells import lower_needed

if TYPE_CHECKING:
    from xlmc.engine.graph.lowering import Lowering
    from xlmc.montecarlo.definitions.definitions import Assumption, Definitions
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["BaseErrors", "Root", "error_roots", "errors_at_base"]

_BLOCK: Final = 1 << 12
_MOST_CELLS: Final = 10_000
"""Formula cells of a model that are computed once more to find where an error comes from: some seconds."""

Floats = NDArray[np.float64]
Root = tuple[Cell, ErrorCode]


@dataclass(frozen=True, slots=True)
class BaseErrors:
    """The errors among the needed cells of a workbook, every assumption at its cell's own value.

    Attributes:
        roots: cell -> its error, of the cells that need no other cell in error.
        others: likewise, of the cells that have their error from these.
        answers: whether a forecast, a filter or a check is among them.
    """

    roots: Mapping[Cell, ErrorCode]
    others: Mapping[Cell, ErrorCode]
    answers: bool


def errors_at_base(model: CompiledModel) -> BaseErrors:
    """Look at every cell that the forecasts, filters and checks need; at none where a draw has no base value."""
    definitions = model.definitions
    if any(a.base is None and isinstance(a.cell, InFormula) for a in model.live):
        return BaseErrors({}, {}, answers=False)
    lowering = _frozen_at(model, {})
    result, needs = dict(_errors(lowering)), lowering.graph.needs
    round_ = lowering.graph.circles  # whose cells all have their error from each other
    wrong = {cell: [need for need in needs[cell] if need in result] for cell in result}
    roots = {
        cell: result[cell] for cell, by in wrong.items() if not by or (cell in round_ and set(by) <= round_.keys())
    }
    others = {cell: code for cell, code in result.items() if cell not in roots}
    asked = {f.cell for f in definitions.forecasts} | {f.cell for f in definitions.filters}
    asked |= {check.cell for check in definitions.checks}
    return BaseErrors(roots, others, answers=not asked.isdisjoint(result))


def error_roots(model: CompiledModel, cells: Sequence[Cell], drawn: Sequence[Mapping[str, Floats]]) -> dict[Cell, Root]:
    """Find the origin of errors in trials: cell -> the first cell upstream that is an error by itself, and its error.

    One trial is looked at for each cell, the first that shows the error. A cell whose error no trial shows is left out.

    Args:
        model: the workbook.
        cells: forecasts and filters that were errors in some trials.
        drawn: sets of trials to look through: assumption -> its draws, `(n,)`.
    """
    if len(model.needed.graph.formulas) > _MOST_CELLS:
        return {}
    result = {}
    for cell in dict.fromkeys(cells):
        trial = next((trial for draws in drawn if (trial := _first_error(model, cell, draws)) is not None), None)
        root = None if trial is None else _root(_frozen_at(model, trial), cell)
        if root is not None:
            result[cell] = root
    return result


def _first_error(model: CompiledModel, cell: Cell, drawn: Mapping[str, Floats]) -> dict[str, float] | None:
    """Return the draws of the first trial in which a cell is an error."""
    from xlmc.montecarlo.loop.blocks import portions  # the base case needs no blocks

    trials = min((values.size for values in drawn.values()), default=0)
    evaluator = model.evaluator([Target(cell, cell)], _BLOCK)
    for part, block in portions(drawn, trials, _BLOCK):
        (column,) = evaluator.filters(block, part.stop - part.start)
        if column.codes is None:
            continue
        whole = np.all([np.isfinite(values) for values in block.values()], axis=0)
        wrong = np.flatnonzero((column.codes > 0) & (column.codes < TEXT_RESULT) & whole)
        if wrong.size:
            return {name: float(values[wrong[0]]) for name, values in block.items()}
    return None


def _root(lowering: Lowering, cell: Cell) -> Root | None:
    """Go upstream from a cell in error for as long as a cell that it needs is one, in a circle once round."""
    left, needs = dict(_errors(lowering)), lowering.graph.needs
    if cell not in left:
        return None
    code = left.pop(cell)
    while (cause := next((need for need in needs[cell] if need in left), None)) is not None:
        cell, code = cause, left.pop(cause)
    return cell, code


def _frozen_at(model: CompiledModel, trial: Mapping[str, float]) -> Lowering:
    """Lower all that is asked for, every assumption frozen: at its draw in a trial, or at its base value."""
    return lower_needed(model.workbook, _without_draws(model.definitions, trial), one_trial=True)[1]


def _without_draws(definitions: Definitions, trial: Mapping[str, float]) -> Definitions:
    def frozen_at(assumption: Assumption) -> Assumption:
        return replace(assumption, frozen=True, base=trial.get(assumption.name, assumption.base))

    cells = [(check.name, check.cell) for check in definitions.checks]
    cells += [(a.name, cell) for a in definitions.assumptions if not a.frozen for cell in a.cells]
    return replace(
        definitions,
        assumptions=tuple(frozen_at(a) for a in definitions.assumptions),
        forecasts=(*definitions.forecasts, *(Forecast(name, cell, cell) for name, cell in cells)),
        correlations=(),
        checks=(),
    )


def _errors(lowering: Lowering) -> Iterator[Root]:
    for cell in lowering.graph.formulas:
        known = lowering.value(cell)
        value = None if known is None else known.objects().ravel()[0]
        if isinstance(value, ErrorCode):
            yield cell, value
