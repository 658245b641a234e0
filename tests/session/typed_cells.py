"""Workbooks in which other numbers and texts are typed, without a file: openpyxl takes longer than a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from templates.writer.cached import computed
from xlmc.engine.engine import Target
from xlmc.engine.engines import ENGINES
from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.excel.address import Cell, parse_address
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.workbook.workbook import CellContent, CellValue, Workbook
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["computed_at", "model_of", "named_cells", "values_of", "with_typed"]


def model_of(workbook: Workbook) -> CompiledModel:
    """Its model, as `load` makes it of a file."""
    return build_model(workbook, Path("typed.xlsx"))


def named_cells(workbook: Workbook) -> dict[str, Cell]:
    """Name -> its cell; names of tables of data are left out."""
    result = {}
    for each in workbook.names:
        if not each.name.startswith("_xlnm"):
            sheet, _, place = each.text.removeprefix("=").rpartition("!")
            if ":" not in place:
                result[each.name] = parse_address(place, sheet.strip("'"))
    return result


def with_typed(workbook: Workbook, values: Mapping[str | Cell, CellValue]) -> Workbook:
    """The workbook with values in place of what cells hold, each of which is given by its name or its address.

    No formula is typed over. Values that the file shows for formulas stay as they were.
    """
    at, sheets = named_cells(workbook), dict(workbook.sheets)
    for given, value in values.items():
        cell = at[given] if isinstance(given, str) else given
        sheet = sheets[cell.sheet]
        before = sheet.cells.get((cell.row, cell.column), CellContent())
        assert before.formula is None, cell
        number = float(value) if isinstance(value, int) and not isinstance(value, bool) else value
        sheets[cell.sheet] = replace(sheet, cells={**sheet.cells, (cell.row, cell.column): CellContent(number)})
    return replace(workbook, sheets=sheets)


def values_of(workbook, wanted):
    """The values of cells, given by name, with every formula computed."""
    done, at = computed(workbook), named_cells(workbook)
    return [done[at[name].sheet, at[name].row - 1, at[name].column - 1] for name in wanted]


def computed_at(workbook, inputs, wanted):
    """Name of a cell -> its values `(n,)` for inputs `(n,)`, or numbers where n is 1; NaN for an error.

    Inputs are given by name or address. What is not given keeps the value of its cell.
    """
    at = named_cells(workbook)
    live = {given if isinstance(given, Cell) else at[given]: str(given) for given in inputs}
    resolver = Resolver(workbook, list(live))
    targets = [Target(at[name], at[name]) for name in wanted]
    places = [target.cell for target in targets]

    def lower(more):
        return Lowering(build_graph(resolver, places, frozenset(live), more=more), live, {})

    n = max(np.size(values) for values in inputs.values())
    full = {str(s): np.ascontiguousarray(np.broadcast_to(np.asarray(v, float), (n,))) for s, v in inputs.items()}
    program = ENGINES["numpy"].load()(lower_until_complete(lower), targets, [], frozenset(full))
    columns = program.evaluator(n).filters(full, n)
    return {name: column.as_floats().copy() for name, column in zip(wanted, columns, strict=True)}
