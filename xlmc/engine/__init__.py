"""From the graph of formulas to one callable over blocks of trials, by the chosen engine.

>>> from xlmc import engine, excel
>>> book = engine.calculate(excel.load("examples/skid-100-ft.xlsx"))
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Workbook

__all__ = ["calculate"]


def calculate(book: Workbook) -> Workbook:
    """Compute every formula of a workbook, and return the workbook with these values; the given one stays as it is.

    A formula that cannot be computed, or that Excel computes anew each time (`RAND`, `NOW`), keeps the value that is
    saved in the file. Where none is saved, it and every formula that depends on it have the value None. `notices` name
    each of them with its cell and the reason.

    >>> from xlmc import excel
    >>> book = excel.load("examples/skid-100-ft.xlsx")
    >>> calculate(book)["Model!D10"] == book["Model!D10"]
    True
    """
    from xlmc.engine.calculation import calculated

    return calculated(book)
