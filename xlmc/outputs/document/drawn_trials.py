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
from xlmc.montecarlo.statistics.number_text import count_text
from xlmc.outputs.document.parts import Chart, Line, Lines
from xlmc.outputs.document.scene_drawing import scene_lines

if TYPE_CHECKING:
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
    workbook, scene = simulation.model.workbook, scene_lines(simulation.model.workbook)
    if scene is None or len(scene[1]) != 2 or not simulation.accepted:
        return None
    lines, (across, upwards) = scene
    columns = _columns(simulation)
    for mark in lines:
        pair = [columns.get(cell) for cell in _quantities(workbook, mark.where)] if len(mark.points) == 1 else []
        x, y = pair if len(pair) == 2 else (None, None)
        if x is None or y is None:
            continue
        points = _points(simulation, x, y)
        if len(set(points)) > 1:
            curves = tuple(Line(line.name, tuple(line.points)) for line in lines if not line.marks)
            cloud = Line("Accepted trials", tuple(points))
            said = f"{count_text(len(points))} accepted trials over {', '.join(line.name for line in curves)}"
            return Chart("", across, Lines(curves, upwards, cloud=cloud), said) if curves else None
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
    found = []
    for reference in where:
        sheet, address = split_sheet(reference)
        place = parse_address(address.replace("$", "").partition(":")[0], sheet)
        formula = None if isinstance(place, Area) else workbook.content(place).formula
        if formula is None or isinstance(place, Area):
            continue
        try:
            found.append(cell_of_reference(workbook, formula.text, place.sheet, place))
        except (DefinitionError, WorkbookError):
            continue  # a formula of its own: no quantity of the run
    return found


def _points(simulation: RunResult, x: NDArray[np.float64], y: NDArray[np.float64]) -> list[tuple[float, float]]:
    rows = min(x.size, y.size)
    if simulation.weighting is None:
        x, y = x[:rows], y[:rows]
    else:
        even = simulation.weighting.even_rows(rows)
        x, y = x[even], y[even]
    known = np.isfinite(x) & np.isfinite(y)
    return list(zip(x[known][:_MOST].tolist(), y[known][:_MOST].tolist(), strict=True))
