"""The xlsx package: read formulas, cached values, names, tables and array flags; write results back into it."""

from __future__ import annotations

from xlmc.workbook.model import CellContent, CellValue, DefinedName, Formula, Sheet, Table, Workbook
from xlmc.workbook.reader import read_workbook

__all__ = [
    "CellContent",
    "CellValue",
    "DefinedName",
    "Formula",
    "Sheet",
    "Table",
    "Workbook",
    "read_workbook",
]
