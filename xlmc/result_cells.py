"""Cells that show results of a run, `=CB.GetForeStatFN(B9,2)`, and the cells that depend on them: their values.

A draw cell and all else keeps the value that Excel saved. A cell that cannot be computed keeps its own, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from xlmc.address import Cell
from xlmc.compile.lower import Lowering
from xlmc.compile.widening import widened
from xlmc.definitions.in_cell_trees import number_of
from xlmc.definitions.model import name_key
from xlmc.definitions.result_functions import CRYSTAL_BALL_STATISTICS, Asked, asked_for, is_result
from xlmc.errors import ErrorCode, FormulaError
from xlmc.formula import Resolver, build_graph, ir
from xlmc.formula.substitute import substituted
from xlmc.workbook import CellValue, Workbook
from xlmc.workbook.injection.cached_values import with_values

if TYPE_CHECKING:
    from xlmc.simulation import ForecastResult, Simulation

__all__ = ["filled_sheets", "result_values"]


def filled_sheets(simulation: Simulation) -> dict[str, bytes]:
    """The parts of the sheets that show results, with the run's values: name -> bytes.

    Args:
        simulation: the finished run.
    """
    workbook = simulation.model.workbook
    by_sheet: dict[str, dict[tuple[int, int], CellValue]] = {}
    for cell, value in result_values(simulation).items():
        by_sheet.setdefault(cell.sheet, {})[cell.row, cell.column] = value
    parts = {name: workbook.sheets[name].part for name in by_sheet}
    return {parts[name]: with_values(workbook.parts[parts[name]], parts[name], by_sheet[name]) for name in by_sheet}


def result_values(simulation: Simulation) -> dict[Cell, CellValue]:
    """The values of the cells that show results, and of those that depend on them."""
    workbook, shown = simulation.model.workbook, simulation.model.definitions.results
    if not shown:
        return {}
    trees = {cell: _with_numbers(cell, simulation) for cell in shown}
    formulas = list(_formulas(workbook))
    whole = build_graph(Resolver(workbook, strict=False), formulas, frozenset(shown), strict=False)
    changed = _with_spills(workbook, (whole.varying | {*shown}) - whole.faults.keys())
    lowering = _lowered(workbook, trees, changed, frozenset(formulas) - changed)
    values = ((cell, _value(lowering, cell)) for cell in sorted(changed & lowering.graph.formulas.keys()))
    return {cell: value for cell, value in values if cell not in lowering.saved and value is not None}


def _with_numbers(cell: Cell, simulation: Simulation) -> ir.Expression:
    """The formula of a cell with the results in place of the calls that ask for them."""
    workbook = simulation.model.workbook
    formula = workbook.content(cell).formula
    assert formula is not None  # a call was found in it
    return substituted(
        Resolver(workbook).formula(cell, formula),
        lambda part: _answer(asked_for(part), simulation) if isinstance(part, ir.Call) and is_result(part) else None,
    )


def _answer(asked: Asked, simulation: Simulation) -> ir.Expression:
    """What a call shows: a number, or an error where there is none."""
    result = _result(asked.place, simulation)
    if result is None or result.values.size == 0:
        return ir.ErrorLiteral(ErrorCode.NA)
    number = None
    if asked.number is not None:
        number = number_of(asked.number, lambda cell: _saved_number(simulation.model.workbook, cell))
        if number is None:
            return ir.ErrorLiteral(ErrorCode.VALUE)
    value = _statistic(result, asked.what, number)
    return ir.ErrorLiteral(ErrorCode.NUM) if value is None or not np.isfinite(value) else ir.Number(value)


def _result(place: Cell | str, simulation: Simulation) -> ForecastResult | None:
    for result in simulation.results.values():
        definition = result.definition
        if definition.cell == place or (isinstance(place, str) and name_key(definition.name) == name_key(place)):
            return result
    return None


def _statistic(result: ForecastResult, what: str, number: float | None) -> float | None:
    """One number of a result; None where there is no such percentile, trial or statistic."""
    if number is None:
        return _by_name(result, what)
    match what:
        case "statistic":
            known = number.is_integer() and 1 <= number <= len(CRYSTAL_BALL_STATISTICS)
            return _by_name(result, CRYSTAL_BALL_STATISTICS[int(number) - 1]) if known else None
        case "percent" | "share" | "share from above":
            percent = number if what == "percent" else 100 * (number if what == "share" else 1 - number)
            return result.percentile(percent).value if 0 <= percent <= 100 else None
        case "certainty":
            return 1 - result.probability_above(number).value
        case "certainty in percent":
            return 100 * (1 - result.probability_above(number).value)
        case "certainty from above":
            return result.probability_above(number).value
        case "trial":
            held = number.is_integer() and 1 <= number <= result.values.size
            return float(result.values[int(number) - 1]) if held else None
        case _:
            raise ValueError(what)


def _by_name(result: ForecastResult, what: str) -> float:
    found = getattr(result.statistics, what)
    return float(found) if what == "trials" else float(found.value)


def _saved_number(workbook: Workbook, cell: Cell) -> float | None:
    value = workbook.content(cell).value
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool | ErrorCode) else None


def _formulas(workbook: Workbook) -> Iterator[Cell]:
    for sheet in workbook.sheets.values():
        for (row, column), content in sheet.cells.items():
            if content.formula is not None:
                yield Cell(sheet.name, row, column)


def _with_spills(workbook: Workbook, cells: Iterable[Cell]) -> frozenset[Cell]:
    """The cells, and those that their array formulas fill."""
    found = set(cells)
    for cell in tuple(found):
        formula = workbook.content(cell).formula
        if formula is not None and formula.array is not None:
            found.update(formula.array.cells())
    return frozenset(found)


def _lowered(
    workbook: Workbook, trees: Mapping[Cell, ir.Expression], changed: frozenset[Cell], held: frozenset[Cell]
) -> Lowering:
    """The changed cells, computed from the results and from what Excel saved in all others."""
    stuck: set[Cell] = set()
    resolver = Resolver(workbook, strict=False, rewritten=trees)

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        given = held | stuck
        graph = build_graph(resolver, changed - stuck, frozenset(), given, more=more, strict=False)
        return Lowering(graph, {}, {cell: workbook.content(cell).value for cell in graph.reached & given})  # type: ignore[misc]

    while True:
        try:
            return widened(lower)
        except FormulaError as error:  # it has no saved value either: it stays blank, as it is
            found = {cell for cell in changed - stuck if str(cell) == error.where}
            if not found:
                raise
            stuck |= found


def _value(lowering: Lowering, cell: Cell) -> CellValue:
    value = lowering.value(cell)
    return None if value is None else value.objects().ravel()[0]
