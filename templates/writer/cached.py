"""The value each formula cell shows until someone recalculates: xlmc computes them all from the workbook itself.

The tests compare them with LibreOffice, and the answers with numbers worked out independently.
"""

from __future__ import annotations

from collections.abc import Mapping

from xlmc.engine.graph.lowering import Lowering, lower_cells
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver
from xlmc.excel.workbook.workbook import Workbook

__all__ = ["Shown", "Values", "computed"]

Shown = float | bool | str
Values = Mapping[tuple[str, int, int], Shown]
"""(sheet, row, column), counted from 0 -> the value of its formula; an error as Excel shows it."""


def computed(workbook: Workbook) -> Values:
    """The value of every formula cell of a workbook, from the numbers in its other cells.

    Raises:
        FormulaError: a formula cannot be computed.
    """
    cells = [
        Cell(sheet.name, row, column)
        for sheet in workbook.sheets.values()
        for (row, column), content in sheet.cells.items()
        if content.formula is not None
    ]
    lowering = lower_cells(Resolver(workbook), cells, {}, {})
    return {(cell.sheet, cell.row - 1, cell.column - 1): _shown(lowering, cell) for cell in cells}


def _shown(lowering: Lowering, cell: Cell) -> Shown:
    value = lowering.value(cell)
    assert value is not None, f"{cell} is volatile"
    result = value.objects().ravel()[0]
    if isinstance(result, ErrorCode):
        return result.text
    return 0.0 if result is None else result  # type: ignore[no-any-return]
