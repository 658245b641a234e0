"""Functions that take references, not values: they need to know where their arguments are, as ROW or SUBTOTAL."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence

from xlmc.engine.graph.arrays import beside, cell_by_cell, grid
from xlmc.engine.graph.computed_references import (
    REFERENCES,
    NoReference,
    NotYetNeeded,
    areas_of,
    cut,
    many_numbers,
    require,
)
from xlmc.engine.graph.further_cells import beyond, level, refusal
from xlmc.engine.graph.pivot_data import lower_pivot_data
from xlmc.engine.graph.scope import Scope, TreeLowering
from xlmc.engine.graph.totals import without_totals
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell, host_of, quote_sheet
from xlmc.excel.formula import ir
from xlmc.excel.formula.shape import shown_formula
from xlmc.excel.functions.budget import ask_for_reading
from xlmc.excel.functions.registry import row_of
from xlmc.excel.functions.statistical.descriptive import array_values
from xlmc.excel.functions.values import constant

__all__ = ["REFERENCE_FUNCTIONS"]

Arguments = tuple[ir.Expression, ...]


def _value_of(name: str) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        areas = REFERENCES[name](lowering, arguments, scope)
        if areas is None:
            return None
        if len(areas) != 1:
            return lowering.error(ErrorCode.VALUE)
        return lowering.lower(areas[0], scope)

    return lower


def _index(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
    """INDEX; where row or column 0 makes it a whole column or row, a plain formula takes the cell beside it."""
    if REFERENCES["INDEX"](lowering, arguments, scope) is not None:
        return _value_of("INDEX")(lowering, arguments, scope)
    areas = areas_of(lowering, arguments[0], scope.inside())
    if areas is None:
        return None
    if len(areas) > 1:
        return lowering.lower(_by_area(arguments, areas), scope)
    if scope.array or scope.whole or many_numbers(lowering, arguments[1:], scope):
        return None
    node = lowering.call_by_name("INDEX", arguments, scope)
    return beside(lowering.dag, node, scope.cell.row - areas[0].top, scope.cell.column - areas[0].left)


def _by_area(arguments: Arguments, areas: Sequence[Area]) -> ir.Expression:
    """INDEX of several areas, as a choice by its fourth argument, which may vary.

    Of several errors among the numbers it is the first, as where all are known.
    """
    parts = [ir.Call("INDEX", (area, *arguments[1:3])) for area in areas]
    if len(arguments) < 4:
        return parts[0]
    which = ir.Number(0.0) if isinstance(arguments[3], ir.Missing) else arguments[3]
    tree: ir.Expression = ir.ErrorLiteral(ErrorCode.REF)
    for count in range(len(parts), 0, -1):
        below = ir.Binary("<", which, ir.Number(count + 1.0))
        tree = ir.Call("IF", (below, parts[count - 1], tree))
    tree = ir.Call("IF", (ir.Binary("<", which, ir.Number(1.0)), ir.ErrorLiteral(ErrorCode.VALUE), tree))
    wrong = ir.Call("INDEX", (areas[0], *arguments[1:]))
    return ir.Call("IF", (ir.Call("ISERROR", (which,)), wrong, tree))


def _row_or_column(name: str) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        area = _find_area(lowering, arguments, scope)
        whole = area.whole
        if not scope.array or whole.rows == whole.columns == 1:
            return lowering.number(float(area.top if name == "ROW" else area.left))
        ask_for_reading(area.rows if name == "ROW" else 1, area.columns if name == "COLUMN" else 1)
        if area.further_rows if name == "ROW" else area.further_columns:
            raise refusal(name)
        if name == "ROW":
            return grid(lowering.dag, area.rows, 1, lambda r, _: lowering.number(float(area.top + r)))
        return grid(lowering.dag, 1, area.columns, lambda _, c: lowering.number(float(area.left + c)))

    return lower


def _find_area(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> Area:
    """Return the first argument's area; the formula's own cell where there is none."""
    if not arguments or isinstance(arguments[0], ir.Missing):
        cell = host_of(scope.cell)
        return Area(cell.sheet, cell.row, cell.column, cell.row, cell.column)
    areas = areas_of(lowering, arguments[0], scope.pointed_at())
    if areas is None:
        raise FormulaError("a reference is needed here", hint="name a cell or a range")
    return areas[0]


def _count(name: str) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        areas = areas_of(lowering, arguments[0], scope.pointed_at()) if len(arguments) == 1 else None
        if areas is None:
            return None
        counted = {"ROWS": areas[0].whole.rows, "COLUMNS": areas[0].whole.columns, "AREAS": len(areas)}
        return lowering.number(float(counted[name]))

    return lower


def _is_reference(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    try:
        value = areas_of(lowering, arguments[0], scope.pointed_at()) is not None
    except NoReference:
        return lowering.dag.constant(constant(False))
    if not value and _may_be_reference(lowering, arguments[0], scope):
        raise FormulaError("what ISREF is asked about depends on a value that varies", hint="make that value fixed")
    return lowering.dag.constant(constant(value))


def _may_be_reference(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree may give a reference although `areas_of` finds none."""
    match tree:
        case ir.Call("INDEX", arguments):
            return isinstance(arguments[0], Cell | Area)
        case ir.Call("IF" | "CHOOSE", arguments):
            known = lowering.lookup_constant(lowering.first_cell(lowering.lower(arguments[0], scope)))
            return known is None and any(
                isinstance(part, Cell | Area) or _may_be_reference(lowering, part, scope) for part in arguments[1:]
            )
        case _:
            return False


def _of_first_cell(name: str) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    """N and T of a reference take its first cell; of an array they take all."""

    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        areas = areas_of(lowering, arguments[0], scope)
        if areas is None:
            return lowering.call(name, (lowering.whole(arguments[0], scope)[0],))
        first = areas[0]
        return lowering.call(name, (lowering.cell(Cell(first.sheet, first.top, first.left)),))

    return lower


def _of_formula(lowering: TreeLowering, arguments: Arguments, scope: Scope, of: Callable[[str | None], object]) -> int:
    """Apply `of` to the formula of the first cell, as Excel shows it."""
    area = _find_area(lowering, arguments, scope)
    cell = Cell(area.sheet, area.top, area.left)
    formula = lowering.graph.workbook.content(cell).formula
    return lowering.dag.constant(constant(of(None if formula is None else shown_formula(formula, cell))))


def _is_formula(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    return _of_formula(lowering, arguments, scope, lambda text: text is not None)


def _formula_text(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    return _of_formula(lowering, arguments, scope, lambda text: ErrorCode.NA if text is None else text)


def _sheet(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    """SHEET of a reference, or of a sheet's name."""
    tabs = [name.casefold() for name in lowering.graph.workbook.sheets]
    name = _sheet_name(lowering, arguments, scope).casefold()
    return lowering.number(float(tabs.index(name) + 1)) if name in tabs else lowering.error(ErrorCode.NA)


def _sheet_name(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> str:
    if arguments and areas_of(lowering, arguments[0], scope.pointed_at()) is None:
        known = lowering.lookup_constant(lowering.lower(arguments[0], scope))
        if known is None:
            raise FormulaError(
                "SHEET needs a reference, or the name of a sheet that does not vary", hint="name one of its cells"
            )
        return str(known.to_texts()[0][0])
    return _find_area(lowering, arguments, scope).sheet


def _sheets(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
    if arguments:
        areas = areas_of(lowering, arguments[0], scope.pointed_at())
        return None if areas is None else lowering.number(float(len({area.sheet for area in areas})))
    return lowering.number(float(len(lowering.graph.workbook.sheets)))


def _cell(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    known = lowering.lookup_constant(lowering.lower(arguments[0], scope))
    if known is None:
        raise FormulaError("the first argument of CELL must not vary", hint="type it")
    what = str(known.to_texts()[0][0]).casefold()
    area = _find_area(lowering, arguments[1:], scope)
    cell = Cell(area.sheet, area.top, area.left)
    if what in ("contents", "type"):
        if lowering.awaits(cell):
            raise NotYetNeeded([cell])
        return lowering.zero_if_blank(lowering.cell(cell)) if what == "contents" else _cell_type(lowering, cell, scope)
    if what not in _OF_ADDRESS:
        known_texts = ", ".join(("contents", "type", *_OF_ADDRESS))
        raise FormulaError(f"CELL({what!r}) is not supported", hint=f"xlmc knows {known_texts}")
    return lowering.dag.constant(constant(_OF_ADDRESS[what](cell, lowering, host_of(scope.cell))))


def _cell_type(lowering: TreeLowering, cell: Cell, scope: Scope) -> int:
    """`b` of a blank cell, `l` of a text, `v` of anything else."""
    otherwise = ir.Call("IF", (ir.Call("ISTEXT", (cell,)), ir.Text("l"), ir.Text("v")))
    return lowering.lower(ir.Call("IF", (ir.Call("ISBLANK", (cell,)), ir.Text("b"), otherwise)), scope)


def _absolute(cell: Cell, lowering: TreeLowering, host: Cell) -> str:
    column, row = re.fullmatch(r"([A-Z]+)(\d+)", cell.a1).groups()  # type: ignore[union-attr]  # it is an address
    address = f"${column}${row}"
    if cell.sheet == host.sheet:
        return address
    book = "" if cell.sheet.startswith("[") else f"[{lowering.graph.workbook.name}]"
    return f"{quote_sheet(book + cell.sheet)}!{address}"


def _file_name(cell: Cell, lowering: TreeLowering, host: Cell) -> str:
    """Return the file name without a folder, so that a run does not depend on where it is made."""
    return f"[{lowering.graph.workbook.name}]{cell.sheet}"


_OF_ADDRESS: Mapping[str, Callable[[Cell, TreeLowering, Cell], float | str]] = {
    "row": lambda cell, lowering, host: float(cell.row),
    "col": lambda cell, lowering, host: float(cell.column),
    "address": _absolute,
    "filename": _file_name,
}
"""What CELL tells of a cell's address, whatever the cell holds."""


def _spill(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int:
    """`A1#`: the cells that the dynamic array in A1 fills; where their number varies, all that it gives in a trial."""
    areas = REFERENCES["ANCHORARRAY"](lowering, arguments, scope)
    if areas is not None:
        return lowering.lower(areas[0], scope)
    area = require(lowering, _find_area(lowering, arguments, scope))
    return lowering.spill(Cell(area.sheet, area.top, area.left))


def _sum_beside(name: str) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    """SUMIF and AVERAGEIF take as much of the third argument as the first has rows and columns."""

    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        if len(arguments) != 3:
            return None
        tested, summed = (areas_of(lowering, arguments[i], scope) for i in (0, 2))
        if tested is None or summed is None or len(tested) != 1 or len(summed) != 1:
            return None
        a, size = summed[0].whole, tested[0].whole
        if not tested[0].is_cut and a.rows == size.rows and a.columns == size.columns:
            return None
        bottom, right = min(MAX_ROW, a.top + size.rows - 1), min(MAX_COLUMN, a.left + size.columns - 1)
        beside = cut(lowering, Area(a.sheet, a.top, a.left, bottom, right))
        rows, columns = max(tested[0].rows, beside.rows), max(tested[0].columns, beside.columns)
        parts = [
            require(lowering, Area(b.sheet, b.top, b.left, b.top + rows - 1, b.left + columns - 1))
            for b in (tested[0], beside)
        ]
        return lowering.lower(ir.Call(name, (parts[0], arguments[1], parts[1])), scope)

    return lower


def _count_if(name: str) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    """COUNTIF of a whole column: count the cells up to the last filled one; one further cell counts for all others."""

    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        result = {i: areas_of(lowering, arguments[i], scope) for i in range(0, len(arguments), 2)}
        areas = {i: parts for i, parts in result.items() if parts is not None and len(parts) == 1}
        if len(areas) < len(result) or not any(area.is_cut for (area,) in areas.values()):
            return None
        even = {i: area for i, (area,) in level(areas).items()}
        node = _call_with_areas(lowering, name, arguments, {i: area.filled for i, area in even.items()}, scope)
        first = even[0]
        further = first.whole.rows * first.whole.columns - first.rows * first.columns
        same = {(area.whole.rows, area.whole.columns) for area in even.values()}
        if len(same) > 1 or not further:
            return node
        one = _call_with_areas(lowering, name, arguments, {i: beyond(area) for i, area in even.items()}, scope)
        return lowering.call("+", (node, lowering.call("*", (one, lowering.number(float(further))))))

    return lower


def _call_with_areas(
    lowering: TreeLowering, name: str, arguments: Arguments, areas: Mapping[int, Area], scope: Scope
) -> int:
    """Return the call with other areas in some of its arguments."""
    parts = [require(lowering, areas[i]) if i in areas else argument for i, argument in enumerate(arguments)]
    return lowering.lower(ir.Call(name, tuple(parts)), scope)


def _of_all_values(name: str, count_texts: bool = False) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    """AVERAGEA and its like: an array that is no range loses what they do not count there."""

    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        plain = [not _is_array(lowering, argument, scope) for argument in arguments]
        if all(plain):
            return None
        result: list[int] = []
        for argument, is_plain in zip(arguments, plain, strict=True):
            if is_plain:
                result += lowering.whole(argument, scope.inside())
            else:
                result.append(_values_of_array(lowering, lowering.lower(argument, scope.over_arrays()), count_texts))
        return lowering.apply(row_of(name), tuple(result))

    return lower


def _values_of_array(lowering: TreeLowering, node: int, count_texts: bool) -> int:
    one = array_values(count_texts)
    cells = cell_by_cell(lowering.dag, (node,), lambda cell: lowering.apply(one, cell), constants=True)
    return lowering.apply(array_values(count_texts, spills=True), (node,)) if cells is None else cells


def _is_array(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> bool:
    """Whether an argument is an array, and not a reference."""
    if isinstance(tree, Cell | Area) or areas_of(lowering, tree, scope.inside()) is not None:
        return False
    return isinstance(tree, ir.Array) or (scope.array and lowering.dag.sizes[lowering.lower(tree, scope)] is not None)


def _blanks(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
    """COUNTBLANK, also of the cells beyond the last filled one."""
    areas = areas_of(lowering, arguments[0], scope)
    if areas is None or len(areas) != 1 or not areas[0].is_cut:
        return None
    (area,) = areas
    node = lowering.lower(ir.Call("COUNTBLANK", (require(lowering, area.filled),)), scope)
    further = area.whole.rows * area.whole.columns - area.rows * area.columns
    return lowering.call("+", (node, lowering.number(float(further))))


REFERENCE_FUNCTIONS: Mapping[str, Callable[[TreeLowering, Arguments, Scope], int | None]] = {
    "OFFSET": _value_of("OFFSET"),
    "INDIRECT": _value_of("INDIRECT"),
    "INDEX": _index,
    "ROW": _row_or_column("ROW"),
    "COLUMN": _row_or_column("COLUMN"),
    "ROWS": _count("ROWS"),
    "COLUMNS": _count("COLUMNS"),
    "AREAS": _count("AREAS"),
    "COUNTBLANK": _blanks,
    "COUNTIF": _count_if("COUNTIF"),
    "COUNTIFS": _count_if("COUNTIFS"),
    "SUMIF": _sum_beside("SUMIF"),
    "AVERAGEIF": _sum_beside("AVERAGEIF"),
    "N": _of_first_cell("N"),
    "T": _of_first_cell("T"),
    "ISREF": _is_reference,
    "ISFORMULA": _is_formula,
    "FORMULATEXT": _formula_text,
    "GETPIVOTDATA": lower_pivot_data,
    "SHEET": _sheet,
    "SHEETS": _sheets,
    "CELL": _cell,
    "ANCHORARRAY": _spill,
    "AVERAGEA": _of_all_values("AVERAGEA", count_texts=True),
    "MAXA": _of_all_values("MAXA"),
    "MINA": _of_all_values("MINA"),
    "VARA": _of_all_values("VARA"),
    "VARPA": _of_all_values("VARPA"),
    "STDEVA": _of_all_values("STDEVA"),
    "STDEVPA": _of_all_values("STDEVPA"),
    "SUBTOTAL": without_totals("SUBTOTAL"),
    "AGGREGATE": without_totals("AGGREGATE"),
}
