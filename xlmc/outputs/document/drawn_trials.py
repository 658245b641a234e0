"""The accepted trials over the drawing of the workbook, as where a published range of restitution is drawn.

A drawing marks the base case by one point. Where that point shows two quantities of the run, an assumption or a
forecast against another, each accepted trial has such a point, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from xlmc.errors import DefinitionError, WorkbookError
from xlmc.excel.address import Area, parse_address
from xlmc.montecarlo.definitions.cell_references import cell_of_reference, split_sheet
from xlmc.montecarlo.number_text import counted_text
from xlmc.outputs.document.parts import Chart, Line, Lines
from xlmc.outputs.document.scene_drawing import SceneLine, scenes

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from xlmc.excel.address import Cell
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["drawn_trials"]

_MOST: Final = 1_000
"""Trials that are drawn: more would hide each other."""


def drawn_trials(simulation: RunResult) -> Chart | None:
    """Draw up to 1,000 accepted trials over the curves of the drawing; None where its base case is no such point.

    Raises:
        WorkbookError: the part of a chart is no XML.
    """
    if not simulation.accepted:
        return None
    columns = _columns(simulation)
    result = (_over(simulation, columns, lines, axes) for lines, axes in scenes(simulation.model.workbook))
    return next((chart for chart in result if chart is not None), None)


def _over(
    simulation: RunResult, columns: Mapping[Cell, NDArray[np.float64]], lines: Sequence[SceneLine], axes: Sequence[str]
) -> Chart | None:
    """Draw the trials over one drawing."""
    curves = tuple(Line(line.name, tuple(line.points)) for line in lines if not line.marks)
    if len(axes) != 2 or not curves:
        return None
    for mark in lines:
        cells = _quantities(simulation.model.workbook, mark.where) if len(mark.points) == 1 else []
        if len(cells) != 2 or not columns.keys() >= {*cells}:
            continue
        points = _points(simulation, columns[cells[0]], columns[cells[1]])
        if len(set(points)) > 1:
            cloud = Line("Accepted trials", tuple(points))
            named = " and ".join(f"“{line.name}”" for line in curves)
            message = f"{counted_text(len(points), 'accepted trial')} over {named}"
            return Chart("", axes[0], Lines(curves, axes[1], cloud=cloud), message)
    return None


def _columns(simulation: RunResult) -> dict[Cell, NDArray[np.float64]]:
    """Return the accepted values of each assumption and forecast whose values are numbers, by its cell."""
    model, texts = simulation.model, simulation.labels
    columns = {each.cell: simulation.inputs[each.name] for each in model.assumptions if each.name in simulation.inputs}
    return columns | {
        each.cell: simulation.forecasts[each.name]
        for each in model.forecasts
        if each.name in simulation.forecasts and each.name not in texts
    }


def _quantities(workbook: Workbook, where: tuple[str, str]) -> list[Cell]:
    """Return the cells that the formulas of a point name; those of other formulas are left out."""
    cells = []
    for reference in where:
        sheet, address = split_sheet(reference)
        place = parse_address(address.replace("$", "").partition(":")[0], sheet)
        formula = None if isinstance(place, Area) else workbook.content(place).formula
        if formula is None or isinstance(place, Area):
            continue
        try:
            cells.append(cell_of_reference(workbook, formula.text, place.sheet, place))
        except (DefinitionError, WorkbookError):
            continue  # a formula of its own: no quantity of the run
    return cells


def _points(simulation: RunResult, x: NDArray[np.float64], y: NDArray[np.float64]) -> list[tuple[float, float]]:
    rows = min(x.size, y.size)
    if simulation.weighting is None:
        x, y = x[:rows], y[:rows]
    else:
        even = simulation.weighting.even_rows(rows)
        x, y = x[even], y[even]
    known = np.isfinite(x) & np.isfinite(y)
    return list(zip(x[known][:_MOST].tolist(), y[known][:_MOST].tolist(), strict=True))
