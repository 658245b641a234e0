"""What formulas of the definition tables give, where the file does not say it, or says what may be older.

A program that writes a workbook without calculating it leaves the value of `=B4&" weight"` out, as openpyxl does, or
writes a 0, as XlsxWriter does. Excel fills it in when it opens the file, unless calculation is manual; xlmc does here.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace

from xlmc.engine.graph.lowering import lower_cells
from xlmc.errors import ErrorCode, FormulaError, Notice
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver
from xlmc.excel.workbook.lazy_sheets import with_cells
from xlmc.excel.workbook.workbook import CellContent, CellValue, Table, Workbook
from xlmc.montecarlo.definitions.tables.table_rows import as_text

__all__ = ["calculate_labels", "calculated_texts"]

_TABLES = "xlmc"
_POINTS = ("cell", "data")
"""The columns whose formulas say which cells are meant, and hold no text."""
_OF_VALUES = ("xlmc_settings", "xlmc_case")
"""Tables in which the column Value holds what is said; in others it holds the cell that is meant."""


def calculate_labels(workbook: Workbook) -> Workbook:
    """Return the workbook with texts, TRUE and FALSE of its tables `xlmc_…` calculated where the file has none.

    Where saved values may be older than the formulas, those of these tables are calculated again, whatever they are.
    A notice names what differs from the saved value.
    """
    tables = [table for table in workbook.tables if table.name.casefold().startswith(_TABLES)]
    stated = [cell for table in tables for cell in _stated(table)]
    missing = [cell for cell in stated if workbook.content(cell).is_uncalculated]
    values = _calculated(workbook, missing) if missing else {}
    result = {cell: value for cell, value in values.items() if isinstance(value, str | bool)}
    stale = _stale_values(workbook, stated) if workbook.may_be_stale else {}
    if not (missing or stale):
        return workbook
    written: dict[str, dict[tuple[int, int], CellContent]] = {}
    for cell, value in {**result, **stale}.items():
        at = cell.row, cell.column
        written.setdefault(cell.sheet, {})[at] = replace(workbook.sheets[cell.sheet].cells[at], value=value)
    notices = [_notice(cell, workbook.content(cell).value, value) for cell, value in stale.items()]
    return replace(workbook, sheets=with_cells(workbook.sheets, written), notices=(*workbook.notices, *notices))


def _stale_values(workbook: Workbook, stated: Iterable[Cell]) -> dict[Cell, CellValue]:
    """Say what formulas of the tables give that is not what the file says."""
    contents = {cell: workbook.content(cell) for cell in stated}
    cells = [cell for cell, each in contents.items() if each.formula is not None and each.value is not None]
    result = _calculated(workbook, cells) if cells else {}
    return {cell: value for cell, value in result.items() if _differs(contents[cell].value, value)}


def _differs(saved: CellValue, value: CellValue) -> bool:
    if isinstance(saved, float) and isinstance(value, float):
        return not math.isclose(saved, value, rel_tol=1e-9, abs_tol=1e-300)
    return type(saved) is not type(value) or saved != value


def _notice(cell: Cell, saved: CellValue, result: CellValue) -> Notice:
    shown = [repr(value) if isinstance(value, str) else as_text(value) for value in (saved, result)]
    message = f"the file says {shown[0]}, but the formula gives {shown[1]}, which is used"
    return Notice(f"{message}: let Excel calculate the workbook, and save it", cell)


def calculated_texts(workbook: Workbook, cells: Collection[Cell]) -> dict[Cell, str]:
    """Calculate the formulas of cells that give a text; a cell that cannot be calculated is left out."""
    return {cell: value for cell, value in _calculated(workbook, cells).items() if isinstance(value, str)}


def _calculated(workbook: Workbook, cells: Collection[Cell]) -> dict[Cell, CellValue]:
    """Calculate the formulas of cells; a cell that gives an error or cannot be calculated is left out."""
    try:
        lowering = lower_cells(Resolver(workbook), [*cells], {}, {})
    except FormulaError:
        if len(cells) == 1:
            return {}
        return {result: value for cell in cells for result, value in _calculated(workbook, [cell]).items()}
    values = {cell: lowering.value(cell) for cell in cells if not lowering.is_saved(cell)}
    known = {cell: value.objects().ravel()[0] for cell, value in values.items() if value is not None}
    return {cell: value for cell, value in known.items() if not isinstance(value, ErrorCode)}


def _stated(table: Table) -> Iterator[Cell]:
    """Return the cells of a table that hold what is said: not those that say which cell is meant, or are meant.

    A forecast that stands in the table itself may need every formula of the workbook.
    """
    skipped = _POINTS if table.name.casefold().startswith(_OF_VALUES) else (*_POINTS, "value")
    area = table.body
    for column, heading in enumerate(table.columns, area.left):
        if heading.strip().casefold() not in skipped:
            yield from (Cell(area.sheet, row, column) for row in range(area.top, area.bottom + 1))
