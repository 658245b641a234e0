"""GETPIVOTDATA: the cell of a pivot table that shows a value of some items, as it was last refreshed.

Excel refreshes a pivot table when a person asks for it, not when it calculates. So its cells are constants, and one
whose source varies is refused: a run cannot refresh it. Items may vary; fields and the pivot table may not.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from xlmc.engine.graph.computed_references import REFERENCES, NoReference, NotYetNeeded, areas_of
from xlmc.engine.graph.scope import Scope, TreeLowering
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.pivot_items import PivotTable, items_named, names_of, position_of

__all__ = ["lower_pivot_data"]

Arguments = tuple[ir.Expression, ...]
_Chosen = Mapping[int, int]
"""Field -> item."""

_NOTHING: Final = ir.ErrorLiteral(ErrorCode.REF)
_MOST_CHOICES: Final = 4_000
_AT_ONCE: Final = 200
"""Arguments of all the SWITCHes among items that vary, and of one."""


def lower_pivot_data(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    """Lower GETPIVOTDATA(data field, cell of the pivot table, field, item, …).

    Raises:
        FormulaError: the pivot table, the data field or a field varies, or is not as it must be.
        NotYetNeeded: see the class.
    """
    pivot = _pivot_at(lowering, arguments, scope)
    _refuse_varying_source(lowering, pivot, scope)
    data = position_of(pivot.data, _text(lowering, arguments[0], scope))
    if data is None:
        return lowering.error(ErrorCode.REF)
    pairs: list[tuple[int, ir.Expression]] = []
    for name, item in zip(arguments[2::2], arguments[3::2], strict=True):
        field = position_of([each.names for each in pivot.fields], _text(lowering, name, scope))
        if field is None:
            return lowering.error(ErrorCode.REF)
        pairs.append((field, item))
    tree = _Choice(lowering, pivot, data, scope).tree(pairs, {})
    missing = [tree] if isinstance(tree, Cell) and lowering.awaits(tree) else []
    if missing:
        raise NotYetNeeded(missing)
    return lowering.lower(tree, scope)


def _pivot_at(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> PivotTable:
    areas = areas_of(lowering, arguments[1], scope.pointed_at())
    if areas is None or len(areas) != 1:
        raise FormulaError("GETPIVOTDATA needs a cell of a pivot table", hint="give it the cell in which that begins")
    if len(arguments) % 2:
        raise FormulaError("GETPIVOTDATA has a field without an item", hint="give fields and items in pairs")
    first = Cell(areas[0].sheet, areas[0].top, areas[0].left)
    pivot_table = next((pivot for pivot in lowering.graph.workbook.pivots if first in pivot.area), None)
    if pivot_table is None:
        hint = "name a cell of a pivot table in this workbook, or save it once with Excel"
        raise FormulaError(f"no pivot table that can be read stands at {first}", hint=hint)
    return pivot_table


def _refuse_varying_source(lowering: TreeLowering, pivot: PivotTable, scope: Scope) -> None:
    """Refuse a pivot table that is made from cells which vary."""
    sources = _sources(lowering, pivot, scope)
    sheets = lowering.graph.workbook.sheets
    formulas = [
        cell
        for area in sources
        for (row, column), content in sheets[area.sheet].cells.items()
        if content.formula is not None and (cell := Cell(area.sheet, row, column)) in area
    ]
    inputs = [cell for cell in lowering.resolver.inputs if any(cell in area for area in sources)]
    if not inputs and (missing := [cell for cell in formulas if lowering.awaits(cell)]):
        raise NotYetNeeded(missing)
    varying = inputs or [cell for cell in formulas if lowering.lookup_constant(lowering.cell(cell)) is None]
    if varying:
        hint = "compute the value by SUMIFS from the source: Excel refreshes pivot tables by hand only"
        raise FormulaError(f"the pivot table is made from a cell that varies ({varying[0]})", hint=hint)


def _sources(lowering: TreeLowering, pivot: PivotTable, scope: Scope) -> Sequence[Area]:
    if pivot.source is None:
        return ()
    table = lowering.graph.workbook.table_named(pivot.source)
    if table is not None:
        return (table.body,)
    try:
        return REFERENCES["INDIRECT"](lowering, (ir.Text(pivot.source),), scope.pointed_at()) or ()
    except NoReference:
        return ()


def _text(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> str:
    known = lowering.lookup_constant(lowering.first_cell(lowering.lower(tree, scope.inside())))
    if known is None:
        raise FormulaError("GETPIVOTDATA depends on a field that varies", hint="only items may vary: type the field")
    return str(known.to_texts()[0][0])


class _Choice:
    """The cell that shows what is asked for; where items vary, a choice among cells."""

    def __init__(self, lowering: TreeLowering, pivot: PivotTable, data: int, scope: Scope) -> None:
        self._lowering, self._pivot, self._data, self._scope = lowering, pivot, data, scope
        self._made = 0

    def tree(self, pairs: Sequence[tuple[int, ir.Expression]], chosen: _Chosen) -> ir.Expression:
        """Return the tree of the value, once the other items are chosen, too."""
        if not pairs:
            return self._cell(chosen)
        (field, tree), *rest = pairs
        known = self._lowering.lookup_constant(
            self._lowering.first_cell(self._lowering.lower(tree, self._scope.inside()))
        )
        if known is None:
            return self._varying(field, tree, rest, chosen)
        asked = known.objects().ravel()[0]
        if isinstance(asked, ErrorCode):
            return ir.ErrorLiteral(asked)
        items = items_named(self._pivot.fields[field], asked)
        result = [self.tree(rest, {**chosen, field: item}) for item in items]
        return next((each for each in result if each != _NOTHING), _NOTHING)

    def _varying(
        self, field: int, tree: ir.Expression, rest: Sequence[tuple[int, ir.Expression]], chosen: _Chosen
    ) -> ir.Expression:
        described = self._pivot.fields[field]
        choices: list[ir.Expression] = []
        for item in range(len(described.items)):
            value = self.tree(rest, {**chosen, field: item})
            for name in names_of(described, item) if value != _NOTHING else ():
                choices += (name, value)
        self._made += len(choices)
        if self._made > _MOST_CHOICES:
            raise FormulaError("GETPIVOTDATA has too many items to choose among", hint="type one of them")
        expression: ir.Expression = _NOTHING
        for start in range(0, len(choices), _AT_ONCE):
            expression = ir.Call("SWITCH", (tree, *choices[start : start + _AT_ONCE], expression))
        return expression

    def _cell(self, chosen: _Chosen) -> ir.Expression:
        """Return the cell that shows these items, or, alone, these and others; otherwise `#REF!`.

        Raises:
            FormulaError: it is empty; what Excel makes of that is not known.
        """
        filters = self._pivot.filters
        if any(filters[field] != item for field, item in chosen.items() if field in filters):
            return _NOTHING
        shown = frozenset((field, item) for field, item in chosen.items() if field not in filters)
        exact = self._filled(self._pivot.cells.get((self._data, shown), ()))
        if exact:
            return exact[0]
        wider = [self._filled(cells) for cells in self._pivot.cells_with(self._data, shown)]
        filled = [cell for cells in wider for cell in cells]
        if (self._data, shown) in self._pivot.cells and not filled:
            hint = "let the pivot table show 0 for empty cells, or compute the value by SUMIFS"
            raise FormulaError("the cell of the pivot table that GETPIVOTDATA asks for is empty", hint=hint)
        return filled[0] if len(filled) == 1 else _NOTHING

    def _filled(self, cells: Iterable[Cell]) -> list[Cell]:
        return [cell for cell in cells if not self._lowering.graph.workbook.content(cell).is_blank]
