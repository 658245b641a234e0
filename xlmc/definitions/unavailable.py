"""Cells that depend on the run in a way that xlmc cannot compute: what a person is told of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from typing import Final

from xlmc.address import Area, Cell
from xlmc.definitions.findings import Findings
from xlmc.definitions.tables.data_tables import TABLE_REASON, TablesOfRun, cells_of
from xlmc.errors import FormulaError
from xlmc.workbook.model import DataTable, Workbook

__all__ = ["areas_text", "faults_of", "remark_on_tables", "remark_on_unavailable"]

MOST: Final = 20
"""Areas that are named one by one."""

_SHOWN: Final = "in the result workbook"


def faults_of(workbook: Workbook, tables: Iterable[DataTable]) -> dict[Cell, FormulaError]:
    """The cells of these data tables, each with why nothing can be computed from it."""
    hint = "Let no forecast and no filter depend on it"
    cells = (cell for table in tables for cell in cells_of(workbook, table))
    return {cell: FormulaError(TABLE_REASON, where=cell, hint=hint) for cell in cells}


def remark_on_tables(tables: Iterable[DataTable], of_run: TablesOfRun, findings: Findings) -> None:
    """One notice for each what-if data table."""
    for table in tables:
        if table in of_run.stale:
            message = f"{TABLE_REASON}: its cells, and all that depends on them, show #N/A {_SHOWN}"
        else:
            message = "a what-if data table: its cells are kept at the values Excel last calculated"
        if table in of_run.varying and table not in of_run.stale:
            message += " for the base case, and no forecast and no filter may depend on them"
        findings.notice(message, table.area)


def remark_on_unavailable(unavailable: Mapping[Cell, str], findings: Findings) -> None:
    """One notice for each reason why cells cannot show what they should."""
    for reason in dict.fromkeys(unavailable.values()):
        cells = [cell for cell, why in unavailable.items() if why == reason]
        more = f" in {areas_text(cells)}" if len(cells) > 1 else ""
        findings.notice(f"{reason}{more}: #N/A is shown {_SHOWN}, here and wherever something depends on it", cells[0])


def areas_text(cells: Iterable[Cell]) -> str:
    """Cells by name; those below one another together: `S!B4:B6, S!C9 and 5 cells more`."""
    areas = list(_columns(sorted(cells, key=lambda cell: (cell.sheet, cell.column, cell.row))))
    shown = [str(area) if area.rows > 1 else str(Cell(area.sheet, area.top, area.left)) for area in areas[:MOST]]
    rest = sum(area.rows for area in areas[MOST:])
    return ", ".join(shown) + (f" and {rest:,} cell{'s' * (rest > 1)} more" if rest else "")


def _columns(cells: Sequence[Cell]) -> Iterable[Area]:
    numbered = enumerate(cells)
    for _, run in groupby(numbered, key=lambda each: (each[1].sheet, each[1].column, each[1].row - each[0])):
        first, *others = (cell for _, cell in run)
        last = others[-1] if others else first
        yield Area(first.sheet, first.row, first.column, last.row, last.column)
