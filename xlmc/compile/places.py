"""References that are worked out while a formula is lowered: OFFSET, INDIRECT, INDEX, and what asks where a cell is.

Their arguments must be known by then. What they lead to may lie outside the graph of needed cells, which cannot know it
beforehand; `NotYetNeeded` then asks for a wider graph.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from xlmc.address import MAX_COLUMN, MAX_ROW, Area, Cell
from xlmc.compile import choices
from xlmc.compile.arrays import grid
from xlmc.compile.dag import Range
from xlmc.compile.scope import Scope, Thunk
from xlmc.errors import ErrorCode, FormulaError
from xlmc.formula import ir, parse
from xlmc.functions.values import constant

if TYPE_CHECKING:
    from xlmc.compile.lower import Lowering

__all__ = ["PLACES", "NotYetNeeded", "areas_of"]

Arguments = tuple[ir.Expression, ...]

_R1C1: Final = re.compile(r"(?:(?P<sheet>.+)!)?R(?P<r>\[-?\d+\]|\d+)?C(?P<c>\[-?\d+\]|\d+)?", re.IGNORECASE)


class NotYetNeeded(Exception):  # noqa: N818 - it asks for more; nothing is wrong
    """A reference leads to cells that the graph does not hold yet."""

    def __init__(self, cells: Iterable[Cell]) -> None:
        super().__init__()
        self.cells = frozenset(cells)


def areas_of(lowering: Lowering, tree: ir.Expression, scope: Scope) -> list[Area] | None:
    """The areas that a tree refers to; None where it is no reference.

    Raises:
        NotYetNeeded: see the class.
        FormulaError: the reference depends on what varies.
    """
    match tree:
        case Cell(sheet, row, column):
            return [Area(sheet, row, column, row, column)]
        case Area():
            return [tree]
        case ir.Binary(",", _, _):
            return _union(lowering, tree, scope)
        case ir.Binary(":" | " " as operator, left, right):
            return _combined(lowering, operator, left, right, scope)
        case ir.Call(name, arguments) if name in _REFERENCES:
            return _REFERENCES[name](lowering, arguments, scope)
        case ir.Variable(name):
            bound = scope.variables.get(name)
            return areas_of(lowering, bound.tree, bound.scope) if isinstance(bound, Thunk) else None
        case _:
            return None


def _union(lowering: Lowering, tree: ir.Binary, scope: Scope) -> list[Area] | None:
    first, rest = ir.chain(tree)
    found = [areas_of(lowering, part, scope) for part in (first, *(part for _, part in rest))]
    return None if any(areas is None for areas in found) else [area for areas in found for area in areas or ()]


def _combined(
    lowering: Lowering, operator: str, left: ir.Expression, right: ir.Expression, scope: Scope
) -> list[Area] | None:
    a, b = areas_of(lowering, left, scope), areas_of(lowering, right, scope)
    if a is None or b is None or len(a) != 1 or len(b) != 1 or a[0].sheet != b[0].sheet:
        raise FormulaError(f"the two sides of {operator!r} are not areas of one sheet")
    tops, lefts = (a[0].top, b[0].top), (a[0].left, b[0].left)
    bottoms, rights = (a[0].bottom, b[0].bottom), (a[0].right, b[0].right)
    if operator == " ":
        return [Area(a[0].sheet, max(tops), max(lefts), min(bottoms), min(rights))]
    return [_needed(lowering, Area(a[0].sheet, min(tops), min(lefts), max(bottoms), max(rights)))]


def _needed(lowering: Lowering, area: Area) -> Area:
    """The area, once everything in it is lowered."""
    missing = [cell for cell in area.cells() if lowering.awaits(cell)]
    if missing:
        raise NotYetNeeded(missing)
    return area


class _OffTheSheet(Exception):  # noqa: N818 - `#REF!`, as a value
    """A reference that leads off the sheet."""


def _whole_number(lowering: Lowering, tree: ir.Expression, scope: Scope, function: str) -> int | None:
    """A known argument, cut to a whole number; None where it is left out."""
    if isinstance(tree, ir.Missing):
        return None
    known = lowering.known_single(lowering.single(lowering.lower(tree, scope)))
    if known is None:
        hint = "INDEX or a lookup function does the same with arguments that vary"
        raise FormulaError(f"{function} depends on a value that varies; where it leads must be fixed", hint=hint)
    numbers, errors = known.to_numbers()
    if errors.any():
        raise _OffTheSheet
    return int(numbers[0])


def _offset(lowering: Lowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    if not 3 <= len(arguments) <= 5:
        raise FormulaError(f"OFFSET has {len(arguments)} arguments; it takes 3 to 5")
    base = areas_of(lowering, arguments[0], scope)
    if base is None or len(base) != 1:
        raise FormulaError("OFFSET starts from a reference to one area")
    numbers = [_whole_number(lowering, argument, scope, "OFFSET") for argument in arguments[1:]]
    down, right = (numbers[0] or 0), (numbers[1] or 0)
    height = numbers[2] if len(numbers) > 2 and numbers[2] is not None else base[0].rows
    width = numbers[3] if len(numbers) > 3 and numbers[3] is not None else base[0].columns
    top, left = base[0].top + down, base[0].left + right
    if not height or not width:
        raise _OffTheSheet
    rows, columns = _span(top, height), _span(left, width)
    return [_needed(lowering, _on_the_sheet(Area(base[0].sheet, rows[0], columns[0], rows[1], columns[1])))]


def _span(start: int, count: int) -> tuple[int, int]:
    """First and last; a negative count goes backwards."""
    end = start + count - (1 if count > 0 else -1)
    return min(start, end), max(start, end)


def _on_the_sheet(area: Area) -> Area:
    if area.top < 1 or area.left < 1 or area.bottom > MAX_ROW or area.right > MAX_COLUMN:
        raise _OffTheSheet
    return area


def _indirect(lowering: Lowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    known = lowering.known_single(lowering.single(lowering.lower(arguments[0], scope)))
    if known is None:
        raise FormulaError("INDIRECT depends on a value that varies; where it leads must be fixed")
    texts, errors = known.to_texts()
    if errors.any():
        raise _OffTheSheet
    a1 = len(arguments) < 2 or choices.decided(lowering, lowering.lower(arguments[1], scope))
    tree = _read(lowering, str(texts[0])) if a1 else _read_r1c1(str(texts[0]), scope.cell)
    found = None if tree is None else _resolved(lowering, tree, scope)
    if found is None:
        raise _OffTheSheet
    return [_needed(lowering, area) for area in found]


def _read(lowering: Lowering, text: str) -> ir.Expression | None:
    try:
        return parse(text)
    except FormulaError:
        return None


def _resolved(lowering: Lowering, tree: ir.Expression, scope: Scope) -> list[Area] | None:
    """What a text refers to; None where it is no reference."""
    try:
        return areas_of(lowering, lowering.resolver.tree(tree, scope.cell), scope)
    except FormulaError:
        return None


def _read_r1c1(text: str, host: Cell) -> ir.Expression | None:
    found = _R1C1.fullmatch(text.strip())
    if found is None:
        return None
    row, column = _step(found["r"], host.row), _step(found["c"], host.column)
    return ir.Reference(ir.Corner(row, column, True, True), sheet=found["sheet"] and found["sheet"].strip("'"))


def _step(text: str | None, base: int) -> int:
    if text is None:
        return base
    return base + int(text[1:-1]) if text.startswith("[") else int(text)


def _index(lowering: Lowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    """INDEX of a reference at a known place; None leaves it to the function of values."""
    if not 2 <= len(arguments) <= 4:
        raise FormulaError(f"INDEX has {len(arguments)} arguments; it takes 2 to 4")
    areas = areas_of(lowering, arguments[0], scope)
    try:
        numbers = [_whole_number(lowering, argument, scope, "INDEX") or 0 for argument in arguments[1:]]
    except FormulaError:
        return None
    if areas is None or scope.array:
        return None
    which = numbers[2] if len(numbers) > 2 else 1
    if not 1 <= which <= len(areas):
        raise _OffTheSheet
    area = areas[which - 1]
    row, column = (numbers[0], numbers[1]) if len(numbers) > 1 else (numbers[0], 0 if area.columns > 1 else 1)
    if len(numbers) == 1 and area.rows == 1:
        row, column = 1, numbers[0]
    if row < 0 or column < 0 or row > area.rows or column > area.columns:
        raise _OffTheSheet
    top, bottom = (area.top, area.bottom) if row == 0 else (area.top + row - 1,) * 2
    left, right = (area.left, area.right) if column == 0 else (area.left + column - 1,) * 2
    return [_needed(lowering, Area(area.sheet, top, left, bottom, right))]


def _chosen(lowering: Lowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    """IF and CHOOSE of references, the choice being known."""
    if not any(isinstance(part, Cell | Area | ir.Call) for part in arguments[1:]):
        return None
    known = lowering.known_single(lowering.single(lowering.lower(arguments[0], scope)))
    if known is None or not known.plain:
        return None
    place = int(known.numbers[0])
    return areas_of(lowering, arguments[place], scope) if 0 < place < len(arguments) else None


def _either(lowering: Lowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    condition = choices.decided(lowering, lowering.lower(arguments[0], scope)) if len(arguments) > 1 else None
    if condition is None or (not condition and len(arguments) < 3):
        return None
    return areas_of(lowering, arguments[1 if condition else 2], scope)


_REFERENCES: Mapping[str, Callable[[Lowering, Arguments, Scope], list[Area] | None]] = {
    "OFFSET": _offset,
    "INDIRECT": _indirect,
    "INDEX": _index,
    "IF": _either,
    "CHOOSE": _chosen,
}


def _value_of(name: str) -> Callable[[Lowering, Arguments, Scope], int | None]:
    def lower(lowering: Lowering, arguments: Arguments, scope: Scope) -> int | None:
        try:
            areas = _REFERENCES[name](lowering, arguments, scope)
        except _OffTheSheet:
            return lowering.error(ErrorCode.REF)
        if areas is None:
            return None
        if len(areas) != 1:
            return lowering.error(ErrorCode.VALUE)
        return lowering.lower(areas[0], scope)

    return lower


def _row_or_column(name: str) -> Callable[[Lowering, Arguments, Scope], int | None]:
    def lower(lowering: Lowering, arguments: Arguments, scope: Scope) -> int | None:
        place = _referred(lowering, arguments, scope)
        if not scope.array or place.rows == place.columns == 1:
            return lowering.number(float(place.top if name == "ROW" else place.left))
        if name == "ROW":
            return grid(lowering.dag, place.rows, 1, lambda r, _: lowering.number(float(place.top + r)))
        return grid(lowering.dag, 1, place.columns, lambda _, c: lowering.number(float(place.left + c)))

    return lower


def _referred(lowering: Lowering, arguments: Arguments, scope: Scope) -> Area:
    """The first argument's area; the formula's own cell where there is none."""
    if not arguments or isinstance(arguments[0], ir.Missing):
        cell = scope.cell
        return Area(cell.sheet, cell.row, cell.column, cell.row, cell.column)
    areas = areas_of(lowering, arguments[0], scope)
    if areas is None:
        raise FormulaError("a reference is needed here")
    return areas[0]


def _count(name: str) -> Callable[[Lowering, Arguments, Scope], int | None]:
    def lower(lowering: Lowering, arguments: Arguments, scope: Scope) -> int | None:
        areas = areas_of(lowering, arguments[0], scope) if len(arguments) == 1 else None
        if areas is None:
            return None
        counted = {"ROWS": areas[0].rows, "COLUMNS": areas[0].columns, "AREAS": len(areas)}
        return lowering.number(float(counted[name]))

    return lower


def _is_reference(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    try:
        found = areas_of(lowering, arguments[0], scope) is not None
    except _OffTheSheet:
        found = False
    return lowering.dag.constant(constant(found))


def _formula(lowering: Lowering, arguments: Arguments, scope: Scope, of: Callable[[str | None], object]) -> int:
    area = _referred(lowering, arguments, scope)
    formula = lowering.graph.workbook.content(Cell(area.sheet, area.top, area.left)).formula
    return lowering.dag.constant(constant(of(None if formula is None else formula.text)))


def _is_formula(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    return _formula(lowering, arguments, scope, lambda text: text is not None)


def _formula_text(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    return _formula(lowering, arguments, scope, lambda text: ErrorCode.NA if text is None else f"={text}")


def _sheet(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    tabs = list(lowering.graph.workbook.sheets)
    return lowering.number(float(tabs.index(_referred(lowering, arguments, scope).sheet) + 1))


def _sheets(lowering: Lowering, arguments: Arguments, scope: Scope) -> int | None:
    if arguments:
        areas = areas_of(lowering, arguments[0], scope)
        return None if areas is None else lowering.number(float(len({area.sheet for area in areas})))
    return lowering.number(float(len(lowering.graph.workbook.sheets)))


def _cell(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    known = lowering.known_single(lowering.lower(arguments[0], scope))
    what = "" if known is None else str(known.to_texts()[0][0]).casefold()
    area = _referred(lowering, arguments[1:], scope)
    cell = Cell(area.sheet, area.top, area.left)
    if what == "row":
        return lowering.number(float(cell.row))
    if what == "col":
        return lowering.number(float(cell.column))
    if what == "contents":
        if lowering.awaits(cell):
            raise NotYetNeeded([cell])
        return lowering.zero_if_blank(lowering.cell(cell))
    if what == "address":
        column, row = re.fullmatch(r"([A-Z]+)(\d+)", cell.a1).groups()  # type: ignore[union-attr]  # it is an address
        return lowering.dag.constant(constant(f"${column}${row}"))
    raise FormulaError(f"CELL({what!r}) is not supported")


def _spilled(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    """`A1#`: all that the array formula in A1 gives."""
    area = _referred(lowering, arguments, scope)
    return lowering.array(Cell(area.sheet, area.top, area.left))


def _without_subtotals(name: str) -> Callable[[Lowering, Arguments, Scope], int | None]:
    """SUBTOTAL and AGGREGATE leave out cells that are such totals themselves."""
    first = 1 if name == "SUBTOTAL" else 2

    def lower(lowering: Lowering, arguments: Arguments, scope: Scope) -> int | None:
        from xlmc.compile.dag import Apply
        from xlmc.functions import function_named

        function = function_named(name)
        if function is None or len(arguments) <= first:
            return None
        found = [lowering.lower(argument, scope) for argument in arguments[:first]]
        for argument in arguments[first:]:
            areas = areas_of(lowering, argument, scope)
            if areas is None:
                found.append(lowering.lower(argument, scope.over_arrays()))
            else:
                skipped = _skipped(lowering, name, found)
                found += [_left_in(lowering, area, skipped) for area in areas]
        return lowering.dag.add(Apply(function, tuple(found)))

    return lower


_TOTAL = re.compile(r"\b(SUBTOTAL|AGGREGATE)\(", re.IGNORECASE)


def _skipped(lowering: Lowering, name: str, options: list[int]) -> tuple[bool, bool]:
    """Whether totals within the range are left out, and whether hidden rows are."""
    known = [lowering.known_single(option) for option in options]
    numbers = [int(value.numbers[0]) if value is not None and value.plain else 0 for value in known]
    if name == "SUBTOTAL":
        return True, numbers[0] > 100
    return numbers[1] < 4, numbers[1] in (1, 3, 5, 7)


def _left_in(lowering: Lowering, area: Area, skipped: tuple[bool, bool]) -> int:
    totals, hidden = skipped
    hidden_rows = lowering.graph.workbook.sheets[area.sheet].hidden_rows if hidden else frozenset()

    def node(cell: Cell) -> int:
        if cell.row in hidden_rows or (totals and _TOTAL.search(lowering.graph.text(cell))):
            return lowering.dag.constant(constant(None))
        return lowering.cell(cell)

    rows, columns = range(area.top, area.bottom + 1), range(area.left, area.right + 1)
    return lowering.dag.add(Range(tuple(tuple(node(Cell(area.sheet, r, c)) for c in columns) for r in rows)))


def _summed_beside(name: str) -> Callable[[Lowering, Arguments, Scope], int | None]:
    """SUMIF and AVERAGEIF take as much of the third argument as the first has rows and columns."""

    def lower(lowering: Lowering, arguments: Arguments, scope: Scope) -> int | None:
        if len(arguments) != 3:
            return None
        tested, summed = (areas_of(lowering, arguments[i], scope) for i in (0, 2))
        if tested is None or summed is None or len(tested) != 1 or len(summed) != 1:
            return None
        same = summed[0].rows == tested[0].rows and summed[0].columns == tested[0].columns
        if same:
            return None
        a, size = summed[0], tested[0]
        wider = _needed(lowering, Area(a.sheet, a.top, a.left, a.top + size.rows - 1, a.left + size.columns - 1))
        return lowering.lower(ir.Call(name, (arguments[0], arguments[1], wider)), scope)

    return lower


def _levelled(name: str) -> Callable[[Lowering, Arguments, Scope], int | None]:
    """Whole columns of different sheets end where the longest does; the criteria stand in every other place."""

    def lower(lowering: Lowering, arguments: Arguments, scope: Scope) -> int | None:
        first = 0 if name == "COUNTIFS" else 1
        ranges = [i for i in range(len(arguments)) if i < first or (i - first) % 2 == 0]
        areas = {i: part for i in ranges if isinstance(part := arguments[i], Area) and part.top == 1}
        longest = max((area.bottom for area in areas.values()), default=0)
        if len(areas) < len(ranges) or all(area.bottom == longest for area in areas.values()):
            return None
        longer = [replace(areas[i], bottom=longest) if i in areas else argument for i, argument in enumerate(arguments)]
        return lowering.lower(ir.Call(name, tuple(longer)), scope)

    return lower


PLACES: Mapping[str, Callable[[Lowering, Arguments, Scope], int | None]] = {
    "OFFSET": _value_of("OFFSET"),
    "INDIRECT": _value_of("INDIRECT"),
    "INDEX": _value_of("INDEX"),
    "ROW": _row_or_column("ROW"),
    "COLUMN": _row_or_column("COLUMN"),
    "ROWS": _count("ROWS"),
    "COLUMNS": _count("COLUMNS"),
    "AREAS": _count("AREAS"),
    **{name: _levelled(name) for name in ("SUMIFS", "COUNTIFS", "AVERAGEIFS", "MAXIFS", "MINIFS")},
    "SUMIF": _summed_beside("SUMIF"),
    "AVERAGEIF": _summed_beside("AVERAGEIF"),
    "ISREF": _is_reference,
    "ISFORMULA": _is_formula,
    "FORMULATEXT": _formula_text,
    "SHEET": _sheet,
    "SHEETS": _sheets,
    "CELL": _cell,
    "ANCHORARRAY": _spilled,
    "SUBTOTAL": _without_subtotals("SUBTOTAL"),
    "AGGREGATE": _without_subtotals("AGGREGATE"),
}
