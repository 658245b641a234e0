"""Workbooks and what their formulas mean: this layer works alone.

>>> from xlmc import excel
>>> book = excel.load("examples/skid-100-ft.xlsx")
>>> book["Inputs!D10"]
0.65
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Workbook

__all__ = ["load"]


def load(path: str | Path, *, functions: str | Path | None = None) -> Workbook:
    """Read an `.xlsx` or `.xlsm` workbook: cells with formulas and saved values, names, tables.

    Nothing is calculated: `book["Sheet!B4"]` is the value that is saved in the file, None if none is. Sheets are
    parsed when they are first looked up. An `.xls`, `.xlsb` or `.ods` is converted by LibreOffice,
    where it is installed.

    Args:
        path: of the workbook.
        functions: a file of Python, which is run: `xlmc.engine.calculate` computes its functions where formulas call
            them by name.

    Raises:
        WorkbookError: the file cannot be opened, is no workbook, is encrypted, damaged or unreasonably large.
    """
    from xlmc.excel.own_functions import load_functions
    from xlmc.excel.workbook.reader import read_workbook

    return read_workbook(path, functions=None if functions is None else load_functions(functions))
