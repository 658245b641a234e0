"""Excel's what-if data tables: which of them a run would have to compute, which xlmc does not do.

Their cells hold no formulas, only what Excel last calculated, and so they would pass for constants.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from xlmc.address import Cell, host_of
from xlmc.errors import FormulaError
from xlmc.formula import Graph, Resolver, build_graph, ir
from xlmc.workbook.model import DataTable, Workbook

__all__ = ["TABLE_REASON", "TablesOfRun", "cells_of", "tables_of_run"]

TABLE_REASON: Final = "what-if data tables that depend on the run are not computed by xlmc"

_ANYWHERE: Final = re.compile(r"\b(?:OFFSET|INDIRECT)\s*\(", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class TablesOfRun:
    """The data tables that depend on the run.

    Attributes:
        stale: those that put values into an assumption, or compute what depends on results of the run. What Excel
            saved in them belongs to another run.
        varying: those that would have other values in each trial: the stale ones, and those over a formula that varies
            with an assumption. What Excel saved in the latter belongs to the base case, as in every other cell.
    """

    stale: tuple[DataTable, ...] = ()
    varying: tuple[DataTable, ...] = ()


def tables_of_run(
    workbook: Workbook,
    drawn: Collection[Cell],
    results: Collection[Cell],
    rewritten: Mapping[Cell, ir.Expression | FormulaError],
) -> TablesOfRun:
    """The data tables of a workbook that depend on the run.

    A formula that cannot be read, or that looks for its cells while it is computed, may depend on anything.

    Args:
        workbook: whose tables.
        drawn: the assumptions and draws.
        results: the cells that show results of the run, or should.
        rewritten: formulas with draws in place of calls, as in `Definitions`.
    """
    if not workbook.data_tables:
        return TablesOfRun()
    every = frozenset(drawn).union(results)
    upstream = _Upstream(workbook, every, rewritten)
    varying = _closed(upstream, every, every)
    stale = _closed(upstream, every, frozenset(results))
    return TablesOfRun(tuple(stale), tuple(varying))


def cells_of(workbook: Workbook, table: DataTable) -> Iterator[Cell]:
    """The cells of a table that the file holds."""
    for row, column in workbook.sheets[table.area.sheet].cells:
        cell = Cell(table.area.sheet, row, column)
        if cell in table.area:
            yield cell


class _Upstream:
    """What the formulas and values in the margins of the data tables depend on."""

    def __init__(
        self, workbook: Workbook, sources: frozenset[Cell], rewritten: Mapping[Cell, ir.Expression | FormulaError]
    ) -> None:
        self.workbook = workbook
        margins = [cell for table in workbook.data_tables for cell in table.margins()]
        given = sources.union(*(cells_of(workbook, table) for table in workbook.data_tables))
        resolver = Resolver(workbook, given, strict=False, rewritten=rewritten)
        self._graph: Graph = build_graph(resolver, margins, given, strict=False)

    def holds_one_of(self, table: DataTable, aims: frozenset[Cell]) -> bool:
        """Whether a table computes from one of these cells, or may do."""
        return bool(aims) and any(cell in aims or self._may_be_anything(cell) for cell in self._of(table))

    def _of(self, table: DataTable) -> Iterator[Cell]:
        seen: set[Cell] = set()
        open_ = list(table.margins())
        while open_:
            cell = open_.pop()
            if cell not in seen:
                yield cell
                seen.add(cell)
                open_ += self._graph.needs.get(cell, ())

    def _may_be_anything(self, cell: Cell) -> bool:
        return cell in self._graph.faults or _ANYWHERE.search(self._graph.text(cell)) is not None


def _closed(upstream: _Upstream, inputs: frozenset[Cell], aims: frozenset[Cell]) -> list[DataTable]:
    """The tables that put values into one of the inputs, compute from one of the aims, or from such a table."""
    tables = upstream.workbook.data_tables
    hosts = {host_of(cell) for cell in inputs}
    found = [table for table in tables if not hosts.isdisjoint(table.inputs)]
    while True:
        within = aims.union(*(cells_of(upstream.workbook, table) for table in found))
        more = [table for table in tables if table not in found and upstream.holds_one_of(table, within)]
        if not more:
            return found
        found += more
