"""Workbooks in which other numbers and texts are typed, without a file: openpyxl takes longer than a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from xlmc.excel.address import Cell, parse_address
from xlmc.excel.workbook.workbook import CellContent, CellValue, Workbook
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["model_of", "named_cells", "with_typed"]


def model_of(workbook: Workbook) -> CompiledModel:
    """Its model, as `load` makes it of a file."""
    return build_model(workbook, Path("typed.xlsx"))


def named_cells(workbook: Workbook) -> dict[str, Cell]:
    """Name -> its cell; names of tables of data are left out."""
    found = {}
    for each in workbook.names:
        if not each.name.startswith("_xlnm"):
            sheet, _, place = each.text.removeprefix("=").rpartition("!")
            if ":" not in place:
                found[each.name] = parse_address(place, sheet.strip("'"))
    return found


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
