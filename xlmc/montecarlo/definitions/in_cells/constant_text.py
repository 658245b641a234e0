"""The text that an expression of constants gives: `RiskName(C1&" cost")`."""

from __future__ import annotations

from collections.abc import Mapping

from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.formula import Resolver, build_graph, ir
from xlmc.excel.formula.precedents import references
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.tables.table_rows import as_text

__all__ = ["constant_text"]


def constant_text(workbook: Workbook, tree: ir.Expression, host: Cell) -> str:
    """Return the text, or a number as a text; empty where it is none, or depends on what is drawn.

    Args:
        workbook: whose cells it names; of formulas among them the values that Excel saved hold, where there are any.
        tree: resolved.
        host: the cell that it stands in.
    """
    match tree:
        case ir.Text() | ir.Number():
            return as_text(tree.value)
        case Cell() if workbook.content(tree).formula is None or workbook.content(tree).value is not None:
            return as_text(workbook.content(tree).value)
    site = InFormula.of(host, "text")
    named = [read for read in references(tree) if isinstance(read, Cell)]
    if any(isinstance(each, InFormula) for each in named):
        return ""
    saved = {cell: workbook.content(cell) for cell in named}
    given = frozenset(cell for cell, each in saved.items() if each.formula is not None and each.value is not None)
    resolver = Resolver(workbook, strict=False, rewritten={site: tree})

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        graph = build_graph(resolver, [site], frozenset(), given, more=more, strict=False)
        return Lowering(graph, {}, {cell: saved[cell].value for cell in graph.reached})  # type: ignore[misc]  # texts, too

    try:
        lowering = lower_until_complete(lower)
    except FormulaError:
        return ""
    values = None if site in lowering.faults else lowering.value(site)
    value = None if values is None else values.objects().ravel()[0]
    return as_text(value) if isinstance(value, str | int | float) and not isinstance(value, ErrorCode) else ""
