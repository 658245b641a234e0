"""Cells that depend on the run in a way that xlmc cannot compute, and what is said of them.

Excel's what-if data tables are among them: their cells hold no formulas, only what Excel last calculated, and so they
would pass for constants.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Area, Cell, host_of
from xlmc.excel.formula import Graph, Resolver, build_graph, ir
from xlmc.excel.formula.graph import reached
from xlmc.excel.workbook.workbook import DataTable, Workbook
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.number_text import count_text

__all__ = [
    "TABLE_REASON",
    "TablesOfRun",
    "areas_text",
    "faults_of",
    "remark_on_tables",
    "remark_on_unavailable",
    "tables_of_run",
]

MOST: Final = 20
"""Areas that are named one by one."""

_SHOWN: Final = "in the result workbook"

TABLE_REASON: Final = "what-if data tables that depend on the run are not computed by xlmc"

_ANYWHERE: Final = re.compile(r"\b(?:OFFSET|INDIRECT)\s*\(", re.IGNORECASE)


def faults_of(workbook: Workbook, tables: Iterable[DataTable]) -> dict[Cell, FormulaError]:
    """Return the cells of these data tables, each with why nothing can be computed from it."""
    hint = "Let no forecast and no filter depend on it"
    cells = (cell for table in tables for cell in _cells_of(workbook, table))
    return {cell: FormulaError(TABLE_REASON, where=cell, hint=hint) for cell in cells}


def remark_on_tables(tables: Iterable[DataTable], of_run: TablesOfRun, findings: Findings) -> None:
    """One notice for each what-if data table."""
    for table in tables:
        if table in of_run.stale:
            message = f"{TABLE_REASON}: its cells, and all that depends on them, show #N/A {_SHOWN}"
        else:
            message = "a what-if data table: its cells are kept at the values Excel last calculated"
        if table in of_run.varying and table not in of_run.stale:
            message += " for the base case; where a forecast or filter needs them, they are computed in each trial"
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
    return ", ".join(shown) + (f" and {count_text(rest)} cell{'s' * (rest > 1)} more" if rest else "")


def _columns(cells: Sequence[Cell]) -> Iterable[Area]:
    numbered = enumerate(cells)
    for _, run in groupby(numbered, key=lambda each: (each[1].sheet, each[1].column, each[1].row - each[0])):
        first, *others = (cell for _, cell in run)
        last = others[-1] if others else first
        yield Area(first.sheet, first.row, first.column, last.row, last.column)


@dataclass(frozen=True, slots=True)
class TablesOfRun:
    """The data tables that depend on the run.

    Attributes:
        stale: those that compute what depends on results of the run. What Excel saved in them belongs to another run.
        varying: those that have other values in each trial: the stale ones, and those over a formula that varies with
            an assumption, or that put values into one. What Excel saved in the latter belongs to the base case, as in
            every other cell.
    """

    stale: tuple[DataTable, ...] = ()
    varying: tuple[DataTable, ...] = ()


def tables_of_run(
    workbook: Workbook,
    drawn: Collection[Cell],
    results: Collection[Cell],
    rewritten: Mapping[Cell, ir.Expression | FormulaError],
) -> TablesOfRun:
    """Return the data tables of a workbook that depend on the run.

    A formula that cannot be read, or that looks for its cells while it is computed, may depend on anything.

    Args:
        workbook: whose tables.
        drawn: the assumptions and draws.
        results: the cells that show results of the run, or should.
        rewritten: formulas with draws instead of calls, as in `Definitions`.
    """
    if not workbook.data_tables:
        return TablesOfRun()
    every = frozenset(drawn).union(results)
    upstream = _Upstream(workbook, every, rewritten)
    varying = _closed(upstream, every, every)
    stale = _closed(upstream, frozenset(results), frozenset(results))
    return TablesOfRun(tuple(stale), tuple(varying))


def _cells_of(workbook: Workbook, table: DataTable) -> Iterator[Cell]:
    """Return the cells of a table that the file holds."""
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
        given = sources.union(*(_cells_of(workbook, table) for table in workbook.data_tables))
        resolver = Resolver(workbook, given, strict=False, rewritten=rewritten)
        self._graph: Graph = build_graph(resolver, margins, given, strict=False)

    def holds_one_of(self, table: DataTable, aims: frozenset[Cell]) -> bool:
        """Whether a table computes from one of these cells, or may do."""
        return bool(aims) and any(cell in aims or self._may_be_anything(cell) for cell in self._of(table))

    def _of(self, table: DataTable) -> Iterator[Cell]:
        return reached(table.margins(), lambda cell: self._graph.needs.get(cell, ()))

    def _may_be_anything(self, cell: Cell) -> bool:
        return cell in self._graph.faults or _ANYWHERE.search(self._graph.text(cell)) is not None


def _closed(upstream: _Upstream, inputs: frozenset[Cell], aims: frozenset[Cell]) -> list[DataTable]:
    """Return the tables that put values into one of the inputs, compute from one of the aims, or from such a table."""
    tables = upstream.workbook.data_tables
    hosts = {host_of(cell) for cell in inputs}
    data_tables = [table for table in tables if not hosts.isdisjoint(table.inputs)]
    while True:
        within = aims.union(*(_cells_of(upstream.workbook, table) for table in data_tables))
        more = [table for table in tables if table not in data_tables and upstream.holds_one_of(table, within)]
        if not more:
            return data_tables
        data_tables += more
