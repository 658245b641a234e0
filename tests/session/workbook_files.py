"""Workbook files of some rows, with xlmc's tables on them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import openpyxl
from openpyxl.utils import get_column_letter
from openpyxl.worksheet.table import Table
from openpyxl.worksheet.worksheet import Worksheet

__all__ = ["add_tables", "workbook_of"]


def workbook_of(sheets: Mapping[str, Iterable[Sequence[object]]], tables: Mapping[str, str]) -> openpyxl.Workbook:
    """A workbook, not saved yet: sheet -> its rows, and table -> its place, such as `Inputs!A1:F3`."""
    made = openpyxl.Workbook()
    made.remove(made.active)
    for name, rows in sheets.items():
        sheet = made.create_sheet(name)
        for row in rows:
            sheet.append(row)
    for name, place in tables.items():
        sheet_name, _, area = place.partition("!")
        made[sheet_name].add_table(Table(displayName=name, ref=area))
    return made


def add_tables(sheet: Worksheet, tables: Mapping[str, Sequence[Sequence[object]]]) -> None:
    """Write tables, each with its name and its rows, one below the other onto an empty sheet."""
    top = 1
    for name, rows in tables.items():
        for row in rows:
            sheet.append(row)
        last = get_column_letter(len(rows[0]))
        sheet.add_table(Table(displayName=name, ref=f"A{top}:{last}{top + len(rows) - 1}"))
        sheet.append([])
        top += len(rows) + 1
