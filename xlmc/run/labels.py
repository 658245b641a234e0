"""The texts of the definition tables that a formula makes, where the file does not say what they are.

A program that writes a workbook without calculating it, as openpyxl does, leaves the value of `=B4&" weight"` out.
Excel fills it in when it opens the file; xlmc does here.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Collection, Iterator
from dataclasses import replace

from xlmc.address import Cell
from xlmc.errors import ErrorCode, FormulaError
from xlmc.evaluation.graph.lower import Lowering, lower_cells
from xlmc.formula import Resolver
from xlmc.workbook.workbook import CellContent, Table, Workbook

__all__ = ["calculate_labels", "calculated_texts"]

_TABLES = "xlmc"
_POINTS = "cell"
"""The column whose formula says which cell is meant, and not a text."""


def calculate_labels(workbook: Workbook) -> Workbook:
    """The workbook with the texts of its tables `xlmc_…` calculated where the file has none; itself if it has all."""
    tables = (table for table in workbook.tables if table.name.casefold().startswith(_TABLES))
    missing = [cell for table in tables for cell in _body(table) if workbook.content(cell).is_uncalculated]
    if not missing:
        return workbook
    written: dict[str, dict[tuple[int, int], CellContent]] = {}
    for cell, text in calculated_texts(workbook, missing).items():
        at = cell.row, cell.column
        written.setdefault(cell.sheet, {})[at] = replace(workbook.sheets[cell.sheet].cells[at], value=text)
    sheets = ((name, workbook.sheets[name], cells) for name, cells in written.items())
    calculated = {name: replace(sheet, cells={**sheet.cells, **cells}) for name, sheet, cells in sheets}
    # A ChainMap reads a sheet when it is looked up, and nobody writes to this one.
    return replace(workbook, sheets=ChainMap(calculated, workbook.sheets))  # type: ignore[arg-type]


def calculated_texts(workbook: Workbook, cells: Collection[Cell]) -> dict[Cell, str]:
    """What the formulas of cells give where that is a text; a cell that cannot be calculated is left out."""
    try:
        lowering = lower_cells(Resolver(workbook), [*cells], {}, {})
    except FormulaError:
        if len(cells) == 1:
            return {}
        return {found: text for cell in cells for found, text in calculated_texts(workbook, [cell]).items()}
    return {cell: text for cell in cells if (text := _text(lowering, cell)) is not None}


def _body(table: Table) -> Iterator[Cell]:
    """The cells of a table that may hold a text."""
    area = table.body
    for column, heading in enumerate(table.columns, area.left):
        if heading.strip().casefold() != _POINTS:
            yield from (Cell(area.sheet, row, column) for row in range(area.top, area.bottom + 1))


def _text(lowering: Lowering, cell: Cell) -> str | None:
    value = lowering.value(cell)
    found = None if value is None else value.objects().ravel()[0]
    return found if isinstance(found, str) and not isinstance(found, ErrorCode) else None
