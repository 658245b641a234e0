"""The cells that a dynamic array fills: as many as it gives in a trial, and no others.

An array formula that was entered with Ctrl-Shift-Enter fills all of its range: a single row, column or value repeats,
and the rest is `#N/A`. What a dynamic array does not fill is blank. In the file stands how much it filled when Excel
saved it. Where it may fill more, formulas that name the cells beyond would see blank ones; they are refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache, partial

from xlmc.engine.graph.arrays import element, pick
from xlmc.engine.graph.graph import MANY, Dag
from xlmc.engine.graph.nodes import Apply
from xlmc.errors import FormulaError
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell
from xlmc.excel.formula import Graph
from xlmc.excel.formula.areas import as_area, combine
from xlmc.excel.formula.precedents import references
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.logical import zero_if_blank
from xlmc.excel.functions.registry import Cells
from xlmc.excel.functions.values import Value, constant

__all__ = ["refuse_cells_beyond", "spilled_cell", "unneeded_arrays"]


def spilled_cell(dag: Dag, node: int, row: int, column: int) -> int | None:
    """Return the node of what a dynamic array gives one cell, counted from 0 from its own; None if it never
    fills it.
    """
    size = dag.sizes[node] or (1, 1)
    if size == MANY:
        return dag.add(Apply(_picker(row, column), (node,)))
    return element(dag, node, row, column) if row < size[0] and column < size[1] else None


@cache
def _picker(row: int, column: int) -> Function:
    return Function(f"spilled cell {row},{column}", (Cells,), partial(_pick, row=row, column=column), Kind.ANY)


def _pick(value: Value, row: int, column: int) -> Value:
    """(n, r, c) -> (n,); a cell that is filled with an empty value shows 0."""
    rows, columns = value.shape[1:] or (1, 1)
    return zero_if_blank(pick(value, row, column)) if row < rows and column < columns else constant(None)


def refuse_cells_beyond(graph: Graph, dag: Dag, arrays: Mapping[Cell, int], ranges: Iterable[Area]) -> None:
    """Refuse formulas that name cells which a dynamic array may fill, and did not when Excel saved it.

    Args:
        graph: the needed cells.
        dag: of the nodes.
        arrays: formula cell -> the node of all that its formula gives.
        ranges: those that formulas read, also by OFFSET and INDIRECT.

    Raises:
        FormulaError: a formula names some.
    """
    many = ((cell, size) for cell, node in arrays.items() if (size := dag.sizes[node]) is not None)
    growing = [result for cell, size in many if (result := _growing(graph, cell, *size)) is not None]
    if not growing:
        return
    for cell, tree in graph.formulas.items():
        for named in references(tree):
            for anchor, saved, possible in growing:
                if cell != anchor and _names_more(named, saved, possible):
                    filled = f"the {saved.a1} that it filled when the file was saved"
                    message = f"the formula names cells that the dynamic array in {anchor} may fill, beyond {filled}"
                    hint = f"name what it fills, whatever its size, by {anchor.a1}#"
                    raise FormulaError(message, where=cell, hint=hint, text=graph.text(cell))

    for area in ranges:
        for anchor, saved, possible in growing:
            if _names_more(area, saved, possible):
                message = f"this dynamic array may fill more than the {saved.a1} that it filled when the file was saved"
                raise FormulaError(
                    f"{message}, and a formula reads {area.a1} by OFFSET or INDIRECT",
                    where=anchor,
                    hint=f"read there what it fills, whatever its size, by {anchor.a1}#",
                    text=graph.text(anchor),
                )


def unneeded_arrays(graph: Graph, sheets: Iterable[str], ranges: Iterable[Area]) -> list[Cell]:
    """Return the dynamic arrays that no formula needs, but which formulas would see if they filled more than in the
    file.

    Args:
        graph: the needed cells.
        sheets: those that formulas read.
        ranges: those that formulas read, also by OFFSET and INDIRECT.
    """
    cells = [cell for sheet in sheets for cell in _unneeded_on(graph, sheet)]
    growing = [result for cell in cells if (result := _growing(graph, cell, *MANY)) is not None]
    if not growing:
        return []
    named = {*ranges, *(named for tree in graph.formulas.values() for named in references(tree))}
    return [anchor for anchor, *areas in growing if any(_names_more(each, *areas) for each in named)]


def _unneeded_on(graph: Graph, sheet: str) -> Iterator[Cell]:
    result = graph.workbook.sheets.get(sheet)
    for at, content in () if result is None else result.cells.items():
        if content.formula is not None and content.formula.dynamic and Cell(sheet, *at) not in graph.formulas:
            yield Cell(sheet, *at)


def _growing(graph: Graph, cell: Cell, rows: int, columns: int) -> tuple[Cell, Area, Area] | None:
    """Return the cell of a dynamic array that may fill more than the file says, what it filled, and what it may fill.

    Where its size varies, it may fill the blank cells below, or right of a single row of several cells.
    """
    formula = graph.workbook.content(cell).formula
    if formula is None or not formula.dynamic:
        return None
    saved = formula.array or as_area(cell)
    bottom, right = max(cell.row + rows - 1, saved.bottom), max(cell.column + columns - 1, saved.right)
    if (rows, columns) == MANY:
        bottom, right = saved.bottom, saved.right
        sheet = graph.workbook.sheets[cell.sheet]
        if saved.rows == 1 and saved.columns > 1:
            right = min((c for r, c in sheet.cells if r == saved.top and c > right), default=MAX_COLUMN + 1) - 1
        else:
            beside = range(saved.left, saved.right + 1)
            bottom = min((r for r, c in sheet.cells if r > bottom and c in beside), default=MAX_ROW + 1) - 1
    possible = Area(cell.sheet, saved.top, saved.left, bottom, right)
    return None if possible == saved.whole else (cell, saved, possible)


def _names_more(named: Cell | Area, saved: Area, possible: Area) -> bool:
    """Whether a reference names some of the cells that are possible, and not only those that were saved."""
    common = combine(" ", named, possible)
    if not isinstance(common, Cell | Area):
        return False
    area = as_area(common)
    return area.bottom > saved.bottom or area.right > saved.right
