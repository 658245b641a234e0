"""From the graph of formulas to one callable over blocks of trials, by the chosen engine.

>>> from xlmc import engine, excel
>>> book = engine.calculate(excel.load("examples/skid-100-ft.xlsx"))
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from xlmc.excel.workbook.workbook import CellValue, Workbook

__all__ = ["calculate"]


def calculate(book: Workbook, changes: Mapping[str, CellValue] | None = None, *, volatile: bool = False) -> Workbook:
    """Compute every formula of a workbook, and return the workbook with these values; the given one stays as it is.

    A saved value that the formula gives stays as it is, to the last digit. A formula that cannot be computed, or that
    Excel computes anew each time (`RAND`, `NOW`), keeps the value that is saved in the file; where none is saved, or
    where it depends on a change, it and every formula that depends on it have the value None. `notices` name each of
    them with its cell and the reason.

    Args:
        book: as `xlmc.excel.load` reads it.
        changes: what to type into cells first: `{"Inputs!B3": 4.2, "Rate": 0.07}`.
        volatile: compute NOW, TODAY, RAND and RANDBETWEEN, too.

    Raises:
        KeyError: a place of a change is no cell of the workbook.
        WorkbookError: a cell that is to be changed holds a formula.

    >>> from xlmc import excel
    >>> book = excel.load("examples/skid-100-ft.xlsx")
    >>> calculate(book)["Model!D10"] == book["Model!D10"]
    True
    """
    from xlmc.engine.calculation import calculated

    return calculated(book, changes or {}, volatile=volatile)
