"""Excel's what-if data tables: which of them a run would have to compute, which xlmc does not do.

Their cells hold no formulas, only what Excel last calculated, and so they would pass for constants.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import Final

from xlmc.address import Cell, host_of
from xlmc.errors import FormulaError
from xlmc.formula import Graph, Resolver, build_graph, ir
from xlmc.workbook.model import DataTable, Workbook

__all__ = ["TABLE_REASON", "cells_of", "tables_of_the_run"]

TABLE_REASON: Final = "what-if data tables that depend on the run are not computed by xlmc"

_ANYWHERE: Final = re.compile(r"\b(?:OFFSET|INDIRECT)\s*\(", re.IGNORECASE)


def tables_of_the_run(
    workbook: Workbook, sources: Collection[Cell], rewritten: Mapping[Cell, ir.Expression | FormulaError]
) -> list[DataTable]:
    """The data tables that put values into an assumption, or compute what depends on the run.

    A formula that cannot be read, or that looks for its cells while it is computed, may depend on anything.

    Args:
        workbook: whose tables.
        sources: the assumptions, draws and results; what depends on one depends on the run.
        rewritten: formulas with draws in place of calls, as in `Definitions`.
    """
    if not workbook.data_tables:
        return []
    found: list[DataTable] = []
    while True:
        within = {cell for table in found for cell in cells_of(workbook, table)}
        reached = _Reached(workbook, within.union(sources), rewritten)
        more = [table for table in workbook.data_tables if table not in found and reached.depends(table)]
        if not more:
            return found
        found += more


def cells_of(workbook: Workbook, table: DataTable) -> Iterator[Cell]:
    """The cells of a table that the file holds."""
    for row, column in workbook.sheets[table.area.sheet].cells:
        cell = Cell(table.area.sheet, row, column)
        if cell in table.area:
            yield cell


class _Reached:
    """Which cells depend on a source."""

    def __init__(
        self, workbook: Workbook, sources: Collection[Cell], rewritten: Mapping[Cell, ir.Expression | FormulaError]
    ) -> None:
        self._sources = sources = frozenset(sources)
        margins = [cell for table in workbook.data_tables for cell in table.margins()]
        resolver = Resolver(workbook, sources, strict=False, rewritten=rewritten)
        self._graph: Graph = build_graph(resolver, margins, sources, strict=False)

    def depends(self, table: DataTable) -> bool:
        """Whether a table does."""
        if not {host_of(cell) for cell in self._sources}.isdisjoint(table.inputs):
            return True
        seen: set[Cell] = set()
        open_ = list(table.margins())
        while open_:
            cell = open_.pop()
            if cell in self._sources or cell in self._graph.faults or _ANYWHERE.search(self._graph.text(cell)):
                return True
            if cell not in seen:
                seen.add(cell)
                open_ += self._graph.needs.get(cell, ())
        return False
