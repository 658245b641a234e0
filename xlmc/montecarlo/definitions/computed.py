"""Which cells get their value from something: a formula, an array formula that reaches them, or a draw."""

from __future__ import annotations

from collections.abc import Container

from xlmc.excel.address import Cell
from xlmc.excel.formula.graph import Spills
from xlmc.excel.workbook.workbook import Workbook

__all__ = ["Computed"]


class Computed:
    """Knows of each cell of a workbook what gives it its value.

    Args:
        workbook: whose cells are asked about.
        drawn: the assumption cells; it may grow.
        python: the cells that a function of Python computes.
    """

    def __init__(self, workbook: Workbook, drawn: Container[Cell], python: Container[Cell] = ()) -> None:
        self._workbook = workbook
        self._drawn, self._python = drawn, python
        self._spills = Spills(workbook)

    def by_formula(self, cell: Cell) -> bool:
        """Whether a formula does: its own, an array formula of another cell that fills it, or a what-if data table."""
        own = self._workbook.content(cell).formula is not None or self._spills.anchor(cell) is not None
        return own or any(cell in table.area for table in self._workbook.data_tables)

    def at_all(self, cell: Cell) -> bool:
        """Whether anything does; otherwise the cell is a constant."""
        return cell in self._drawn or cell in self._python or self.by_formula(cell)
