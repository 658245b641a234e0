"""What follows from cells that cannot be read: the answers that need one are refused, by name.

A filter that needs one decides over all trials, so that then nothing can be run.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import Final

from xlmc.errors import DefinitionError, FormulaError
from xlmc.excel.address import Cell
from xlmc.excel.formula import Graph, Resolver, build_graph, ir
from xlmc.excel.formula.graph import reached
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.cell_references import cell_of_reference, formula_at
from xlmc.montecarlo.definitions.definitions import Assumption, Filter, Forecast
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import as_text, optional_text, rows_of

__all__ = ["REFUSED_CELL", "refused_forecasts", "refused_rows"]

REFUSED_CELL: Final = "Refused cell"
"""The column of the table `xlmc_converted` with the cells that could not be converted."""

_WHY: Final = "Stands in"


def refused_rows(
    workbook: Workbook, tables: Sequence[DefinitionTable], drawn: Container[Cell], findings: Findings
) -> dict[Cell, FormulaError]:
    """Find the cells that a converted workbook still refuses, each with why.

    Args:
        workbook: that was converted.
        tables: that the conversion wrote: its lists of what was found.
        drawn: the cells of assumptions that tables define; a person has defined one that is among them.
        findings: takes mistakes.
    """
    result: dict[Cell, FormulaError] = {}
    for row in rows_of(workbook, tables, (), ("What", "Definition", "Stood in", "Was", _WHY, REFUSED_CELL), findings):
        if not row.filled(REFUSED_CELL):
            continue
        where, content = row.cell(REFUSED_CELL), row.content(REFUSED_CELL)
        with findings.recording():
            text = as_text(content.value) if content.formula is None else formula_at(content.formula, where)
            cell = cell_of_reference(workbook, text, where.sheet, where)
            if cell not in drawn:
                why = optional_text(row, _WHY) or "it could not be converted"
                hint = "Define the cell in the table xlmc_assumptions; or delete the row, and it is a constant"
                result[cell] = FormulaError(why, where=cell, hint=hint)
    return result


def refused_forecasts(
    workbook: Workbook,
    refused: Mapping[Cell, FormulaError],
    rewritten: Mapping[Cell, ir.Expression | FormulaError],
    assumptions: Sequence[Assumption],
    forecasts: Sequence[Forecast],
    filters: Sequence[Filter],
    own: Sequence[Filter],
    findings: Findings,
) -> dict[str, DefinitionError]:
    """Find the forecasts that need a refused cell, by name, each with its error.

    Args:
        workbook: that holds them.
        refused: the cells, each with why.
        rewritten: as in `Definitions`, the refused cells among them.
        assumptions: of the workbook; one whose parameters need a refused cell passes that on.
        forecasts: of the workbook.
        filters: of all forecasts.
        own: filters of some forecasts only, which need what these need.
        findings: takes the filters that need one, and a remark on each that nothing needs.
    """
    parameters = {a.cell: a.cells for a in assumptions if not a.frozen}
    asked = {
        each.name: (each.cell, *(cell for filter_ in own if each.name in filter_.only_for for cell in _cells(filter_)))
        for each in forecasts
    }
    cells_of_filters = {each.name: tuple(_cells(each)) for each in filters}
    kinds = {each.name: "filter" if each.evidence is None else "evidence" for each in filters}
    targets = [cell for cells in (*asked.values(), *cells_of_filters.values(), *parameters.values()) for cell in cells]
    resolver = Resolver(workbook, parameters, strict=False, rewritten=rewritten)
    frozen = frozenset(a.cell for a in assumptions if a.frozen)
    graph = build_graph(resolver, targets, frozenset(parameters), frozen, strict=False)
    reached: set[Cell] = set()

    def fault(what: str, name: str, cells: Iterable[Cell]) -> DefinitionError | None:
        needed = [cell for cell in _upstream(graph, parameters, cells) if cell in refused]
        reached.update(needed)
        if not needed:
            return None
        error = refused[needed[0]]
        return DefinitionError(f"the {what} {name!r} needs {error.where}. {error.message}", hint=error.hint)

    result = {name: error for name, cells in asked.items() if (error := fault("forecast", name, cells))}
    findings.problems += [
        error for name, cells in cells_of_filters.items() if (error := fault(kinds[name], name, cells))
    ]
    for cell in refused:
        if cell not in reached:
            findings.notice(f"no forecast or filter needs this cell: {refused[cell].message}", cell)
    return result


def _cells(filter_: Filter) -> Iterator[Cell]:
    yield filter_.cell
    for limit in (filter_.at_least, filter_.at_most, filter_.above, filter_.below):
        if isinstance(limit, Cell):
            yield limit


def _upstream(graph: Graph, parameters: Mapping[Cell, Sequence[Cell]], cells: Iterable[Cell]) -> Iterator[Cell]:
    """Return the cells and all that they depend on, what the parameters of assumptions depend on among them."""
    return reached(cells, lambda cell: (*parameters.get(cell, ()), *graph.needs.get(cell, ())))
