"""Cells of the tables that are read once, before the run: none of them may differ from trial to trial."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from xlmc.errors import FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, build_graph, ir
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Assumption
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import Row

__all__ = ["refuse_varying"]

_TEST: Final = "Write it into the cell that is tested, such as =OR(B7<1,B9>0)"
_ANSWER: Final = "Compare in a cell of its own, such as =B9>B7, and make that cell a forecast"
_TYPED: Final = "Type the value itself, or let the formula use cells that do not vary"

_READ_ONCE: Final[Mapping[str, Mapping[str, str]]] = {
    "xlmc_assumptions": dict.fromkeys(("Distribution", "Frozen", "Cumulative"), _TYPED),
    "xlmc_forecasts": {
        **dict.fromkeys(("Threshold", "Certainty from", "Certainty to"), _ANSWER),
        **dict.fromkeys(("Range %", "Report to", "Kind", "Role"), _TYPED),
    },
    "xlmc_filters": {"Use": _TEST, "Only for": _TYPED},
    "xlmc_evidence": {"Use": _TEST, "Error": _TYPED},
    "xlmc_settings": {"Value": _TYPED},
}
"""The columns of each table, and what to do instead."""


def refuse_varying(
    workbook: Workbook,
    tables: Mapping[str, Iterable[DefinitionTable]],
    assumptions: Iterable[Assumption],
    rewritten: Mapping[Cell, ir.Expression | FormulaError],
    findings: Findings,
) -> None:
    """Refuse formulas in such cells that depend on an assumption: the run would take what they are at the base case.

    Args:
        workbook: that is read.
        tables: its tables, by kind.
        assumptions: all of them.
        rewritten: the formulas that mean something else than what Excel computes.
        findings: takes the mistakes.
    """
    asked = [
        (row, heading, hint)
        for kind, columns in _READ_ONCE.items()
        for table in tables[kind]
        for row in _rows(workbook, table)
        for heading, hint in columns.items()
        if row.filled(heading) and row.content(heading).formula is not None
    ]
    if not asked:
        return
    drawn = {each.cell: each.name for each in assumptions if not each.frozen}
    frozen = frozenset(each.cell for each in assumptions if each.frozen)
    resolver = Resolver(workbook, [*drawn, *frozen], strict=False, rewritten=rewritten)
    for row, heading, hint in asked:
        graph = build_graph(resolver, [row.cell(heading)], frozenset(drawn), frozen, strict=False)
        name = next((drawn[cell] for cell in sorted(graph.reached) if cell in drawn), None)
        if name is not None:
            message = f"{row.heading(heading)} depends on the assumption {name!r}, and is one for all trials"
            # whatever else was found in the cell, such as no saved value, is of no use
            findings.problems = [each for each in findings.problems if each.where != str(row.cell(heading))]
            findings.problem(message, row.cell(heading), hint)


def _rows(workbook: Workbook, table: DefinitionTable) -> Iterator[Row]:
    body = table.table.body
    return (Row(workbook, table, number) for number in range(body.top, body.bottom + 1))
