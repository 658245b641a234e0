"""A workbook's file with other values in its cells, and every other byte as it was."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from xlmc.excel.address import Cell
from xlmc.excel.workbook.formats import other_format
from xlmc.excel.workbook.injection.cell_edit import with_calculation_on_load, with_contents
from xlmc.excel.workbook.injection.content_types import roles
from xlmc.excel.workbook.injection.formula_values import with_values
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.workbook import CellValue, Workbook

__all__ = ["copy_with_values"]


def copy_with_values(
    book: Workbook,
    typed: Mapping[Cell, CellValue],
    computed: Mapping[Cell, CellValue],
    unknown: Collection[Cell],
) -> bytes:
    """Return the file of a workbook with these values; the file as it is where there are none.

    Excel calculates the workbook when it opens the file only where a formula has no value.

    Args:
        book: as it was read.
        typed: cell -> what a person types into it; no formula stands there.
        computed: cell of a formula, or one that an array formula fills -> the value to be saved with it.
        unknown: cells of formulas that are to have no saved value.

    Raises:
        WorkbookError: the sheet is damaged.
    """
    parts = dict(book.parts)
    for name, contents in _by_sheet(typed).items():
        part = book.sheets[name].part
        parts[part] = with_contents(parts[part], part, name, contents)
    values, cleared = _by_sheet(computed), _by_sheet(dict.fromkeys(unknown))
    for name in {**values, **cleared}:
        part = book.sheets[name].part
        parts[part] = with_values(parts[part], part, values.get(name, {}), cleared.get(name, {}), complete=True)
    if unknown:
        part = roles(parts).workbook
        parts[part] = with_calculation_on_load(parts[part], part)
    changed = typed or computed or unknown
    return checked_bytes(parts, book.parts) if changed or other_format(book.data) is not None else book.data


def _by_sheet(cells: Mapping[Cell, CellValue]) -> dict[str, dict[tuple[int, int], CellValue]]:
    result: dict[str, dict[tuple[int, int], CellValue]] = {}
    for cell, value in cells.items():
        result.setdefault(cell.sheet, {})[cell.row, cell.column] = value
    return result
