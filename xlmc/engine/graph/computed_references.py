"""References that are worked out while a formula is lowered: OFFSET, INDIRECT, INDEX, and choices between references.

Their arguments must be known by then. What they lead to may lie outside the graph of needed cells, which cannot know it
beforehand; `NotYetNeeded` then asks for a wider graph.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from xlmc.engine.graph.called_functions import check_count
from xlmc.engine.graph.scope import Scope, Thunk, TreeLowering
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell, host_of
from xlmc.excel.formula import ir
from xlmc.excel.formula.indirect_text import read_a1, read_r1c1
from xlmc.excel.functions.budget import ask_for_reading
from xlmc.excel.functions.values import Codes

__all__ = [
    "REFERENCES",
    "NoReference",
    "NotYetNeeded",
    "areas_of",
    "cut",
    "join_areas",
    "many_numbers",
    "of_one_cell",
    "require",
]

Arguments = tuple[ir.Expression, ...]

_NOT_ONE_CELL: Final = ir.ErrorLiteral(ErrorCode.VALUE)
_CHOOSING: Final = ("IF", "CHOOSE")
_INSTEAD: Final = "INDEX or a lookup function does the same with arguments that vary"


class NotYetNeeded(Exception):  # noqa: N818 - it asks for more; nothing is wrong
    """A reference leads to cells that the graph does not hold yet."""

    def __init__(self, cells: Iterable[Cell]) -> None:
        super().__init__()
        self.cells = frozenset(cells)


def areas_of(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> list[Area] | None:
    """Return the areas that a tree refers to; None if it is no reference.

    Raises:
        NotYetNeeded, NoReference: see the classes.
        FormulaError: the reference depends on a value that varies.
    """
    match tree:
        case Cell(sheet, row, column):
            return [Area(sheet, row, column, row, column)]
        case Area():
            return [tree]
        case ir.Binary(",", _, _):
            return _union(lowering, tree, scope)
        case ir.Binary(":" | " " as operator, left, right):
            return _combine(lowering, operator, left, right, scope)
        case ir.Call(name, arguments) if name in REFERENCES:
            check_count(name, arguments)
            return REFERENCES[name](lowering, arguments, scope)
        case ir.Variable(name):
            bound = scope.variables.get(name)
            return areas_of(lowering, bound.tree, bound.scope) if isinstance(bound, Thunk) else None
        case _:
            return None


def _union(lowering: TreeLowering, tree: ir.Binary, scope: Scope) -> list[Area] | None:
    first, rest = ir.chain(tree)
    result = [areas_of(lowering, part, scope) for part in (first, *(part for _, part in rest))]
    return None if any(areas is None for areas in result) else [area for areas in result for area in areas or ()]


def join_areas(areas: Sequence[Area]) -> ir.Expression:
    """Join areas by commas."""
    tree: ir.Expression = areas[0]
    for area in areas[1:]:
        tree = ir.Binary(",", tree, area)
    return tree


def _combine(
    lowering: TreeLowering, operator: str, left: ir.Expression, right: ir.Expression, scope: Scope
) -> list[Area] | None:
    result = _end(lowering, left, scope.pointed_at()), _end(lowering, right, scope.pointed_at())
    if operator == ":" and any(_may_be_picked(part, areas) for part, areas in zip((left, right), result, strict=True)):
        hint = "TAKE and DROP give as much of a range as a value that varies says"
        raise FormulaError("an end of a range must be fixed: no value that varies may change it", hint=hint)
    a, b = ([area.whole for area in areas] if areas else [] for areas in result)
    if len(a) != 1 or len(b) != 1 or a[0].sheet != b[0].sheet:
        raise FormulaError(
            f"the two sides of {operator!r} are not areas of one sheet",
            hint="give each side one range of the same sheet",
        )
    tops, lefts = (a[0].top, b[0].top), (a[0].left, b[0].left)
    bottoms, rights = (a[0].bottom, b[0].bottom), (a[0].right, b[0].right)
    if operator == " ":
        shared = _intersect(Area(a[0].sheet, max(tops), max(lefts), min(bottoms), min(rights)))
        return [_led_to(lowering, shared, scope)]
    return [_led_to(lowering, Area(a[0].sheet, min(tops), min(lefts), max(bottoms), max(rights)), scope)]


def _end(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> list[Area] | None:
    """Return the areas that one side refers to; INDEX of single numbers refers to a cell in array formulas, too."""
    if scope.array and isinstance(tree, ir.Call) and tree.name == "INDEX":
        numbers = [number for number in tree.arguments[1:] if not isinstance(number, ir.Missing)]
        if all(lowering.dag.sizes[lowering.lower(number, scope.inside())] is None for number in numbers):
            scope = replace(scope, of_array=False, around=False)
    return areas_of(lowering, tree, scope)


def _may_be_picked(end: ir.Expression, areas: list[Area] | None) -> bool:
    """Whether an end of a range is picked by a function, and may vary."""
    return areas is None and isinstance(end, ir.Call) and end.name in REFERENCES


def _intersect(area: Area) -> Area:
    """Intersect two areas."""
    if area.top > area.bottom or area.left > area.right:
        raise NoReference(ErrorCode.NULL)
    return area


def cut(lowering: TreeLowering, area: Area) -> Area:
    """Return the area, up to the last filled cell where it goes on far beyond it, once everything in it is lowered."""
    return require(lowering, lowering.resolver.to_the_last_cell(area.whole))


def _led_to(lowering: TreeLowering, area: Area, scope: Scope) -> Area:
    """Return what a reference leads to: as `cut` gives it, but where only its place counts."""
    return lowering.resolver.to_the_last_cell(area.whole) if scope.pointing else cut(lowering, area)


def require(lowering: TreeLowering, area: Area) -> Area:
    """Return the area, once everything in it is lowered."""
    ask_for_reading(area.rows, area.columns)
    missing = lowering.awaited(area)
    if missing:
        raise NotYetNeeded(missing)
    return area


class NoReference(Exception):  # noqa: N818 - it is Excel's error, as a value
    """What should lead to cells is an error: `#REF!` off the sheet, or that of an argument.

    Attributes:
        code: the error.
    """

    def __init__(self, code: ErrorCode = ErrorCode.REF) -> None:
        super().__init__(code)
        self.code = code


def _stop_at_error(errors: Codes) -> None:
    """Pass on the error of an argument that is one."""
    if errors.any():
        raise NoReference(ErrorCode(int(errors.flat[0])))


def _whole_number(lowering: TreeLowering, tree: ir.Expression, scope: Scope, function: str) -> int | None:
    """Return a known argument, cut to a whole number; None if it is left out."""
    number = _known_number(lowering, tree, scope, function)
    return None if number is None else int(number)


def _known_number(lowering: TreeLowering, tree: ir.Expression, scope: Scope, function: str) -> float | None:
    """Return a known argument; None if it is left out."""
    if isinstance(tree, ir.Missing):
        return None
    node = lowering.lower(tree, scope.inside())
    if lowering.dag.sizes[node] not in (None, (1, 1)) and scope.array:
        raise FormulaError(f"{function} leads to several ranges at once", hint="give it single values")
    known = lowering.lookup_constant(lowering.first_cell(node))
    if known is None:
        raise FormulaError(f"{function} depends on a value that varies; where it leads must be fixed", hint=_INSTEAD)
    numbers, errors = known.to_numbers()
    _stop_at_error(errors)
    return float(numbers[0])


def _offset(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    base = areas_of(lowering, arguments[0], scope.pointed_at())
    if base is None or len(base) != 1:
        raise FormulaError("OFFSET starts from a reference to one area", hint="name one range")
    numbers = [_known_number(lowering, argument, scope, "OFFSET") for argument in arguments[1:]]
    down, right = int(numbers[0] or 0), int(numbers[1] or 0)
    height = numbers[2] if len(numbers) > 2 and numbers[2] is not None else base[0].whole.rows
    width = numbers[3] if len(numbers) > 3 and numbers[3] is not None else base[0].whole.columns
    top, left = base[0].top + down, base[0].left + right
    if not height or not width:
        raise NoReference
    rows, columns = _span(top, height), _span(left, width)
    reached = _on_the_sheet(Area(base[0].sheet, rows[0], columns[0], rows[1], columns[1]))
    return [_led_to(lowering, reached, scope)]


def _span(start: int, count: float) -> tuple[int, int]:
    """First and last; a negative count goes backwards.

    Excel cuts the count to a whole number, but looks at its sign first: 0.9 goes one back, and -0.9 one on.
    """
    end = start + int(count) - (1 if count > 0 else -1)
    return min(start, end), max(start, end)


def _on_the_sheet(area: Area) -> Area:
    if area.top < 1 or area.left < 1 or area.bottom > MAX_ROW or area.right > MAX_COLUMN:
        raise NoReference
    return area


def _indirect(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    known = lowering.lookup_constant(lowering.first_cell(lowering.lower(arguments[0], scope.inside())))
    if known is None:
        raise FormulaError("INDIRECT depends on a value that varies; where it leads must be fixed", hint=_INSTEAD)
    texts, errors = known.to_texts()
    _stop_at_error(errors)
    a1 = len(arguments) < 2 or _is_true(lowering, arguments[1], scope)
    tree = read_a1(str(texts[0])) if a1 else read_r1c1(str(texts[0]), scope.cell)
    over_sheets = isinstance(tree, ir.Reference) and tree.last_sheet is not None  # which Excel does not read from texts
    areas = None if tree is None or over_sheets else _resolve(lowering, tree, scope)
    if areas is None:
        raise NoReference
    return areas if scope.pointing else [require(lowering, area) for area in areas]


def _is_true(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> bool:
    """Return a known logical argument."""
    known = lowering.lookup_constant(lowering.first_cell(lowering.lower(tree, scope.inside())))
    if known is None:
        raise FormulaError("whether INDIRECT reads A1 or R1C1 must not vary", hint="type TRUE or FALSE")
    logicals, errors = known.to_logicals()
    _stop_at_error(errors)
    return bool(logicals[0])


def _resolve(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> list[Area] | None:
    """Return what a text refers to; None if it is no reference."""
    try:
        return areas_of(lowering, lowering.resolver.tree(tree, host_of(scope.cell)), scope)
    except FormulaError:
        return None


def many_numbers(lowering: TreeLowering, numbers: Arguments, scope: Scope) -> bool:
    """Whether INDEX is given several numbers at once; of numbers in braces a plain formula takes the first."""
    computed = [tree for tree in numbers if not isinstance(tree, ir.Array | ir.Missing)]
    return any(lowering.dag.sizes[lowering.lower(tree, scope.plainly())] is not None for tree in computed)


def _index(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    """INDEX of a reference of a known row and column; None leaves it to the function of values.

    Raises:
        NoReference: the cell lies outside, or one number is given for several rows and columns: what is a row of an
            array is `#REF!` of a reference.
    """
    areas = areas_of(lowering, arguments[0], scope.pointed_at())
    if areas and len(arguments) == 2 and areas[0].whole.rows > 1 and areas[0].whole.columns > 1:
        raise NoReference
    if areas is None or scope.array or many_numbers(lowering, arguments[1:], scope):
        return None
    try:
        plain = scope.plainly()
        numbers = [_whole_number(lowering, argument, plain, "INDEX") or 0 for argument in arguments[1:]]
    except FormulaError:
        return None
    which = numbers[2] if len(numbers) > 2 else 1
    if any(number < 0 for number in numbers) or which == 0:
        raise NoReference(ErrorCode.VALUE)
    if which > len(areas):
        raise NoReference
    area = areas[which - 1].whole
    if len(numbers) == 1:
        row, column = (1, numbers[0]) if area.rows == 1 else (numbers[0], 1)
    else:
        row, column = numbers[:2]
    if row > area.rows or column > area.columns:
        raise NoReference
    top, bottom = (area.top, area.bottom) if row == 0 else (area.top + row - 1,) * 2
    left, right = (area.left, area.right) if column == 0 else (area.left + column - 1,) * 2
    return [_led_to(lowering, Area(area.sheet, top, left, bottom, right), scope)]


def _choose(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    """CHOOSE of references; None if the choice is not known."""
    if not any(isinstance(part, Cell | Area | ir.Call) for part in arguments[1:]):
        return None
    known = lowering.lookup_constant(lowering.lower(arguments[0], scope.plainly()))
    if known is None or not known.plain:
        return None
    which = int(known.numbers[0])
    return areas_of(lowering, arguments[which], scope.branch()) if 0 < which < len(arguments) else None


def _if(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    node = lowering.lower(arguments[0], scope.plainly()) if len(arguments) > 1 else None
    condition = None if node is None else lowering.lookup_condition(node)
    if condition is None or (not condition and len(arguments) < 3):
        return None
    return areas_of(lowering, arguments[1 if condition else 2], scope.branch())


def _spill(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> list[Area] | None:
    """`A1#`: the range that the file declares for the dynamic array in A1; None if its size varies, or is another,
    or where the file holds none of its values.

    Raises:
        NoReference: nothing spills from there.
    """
    areas = areas_of(lowering, arguments[0], scope)
    if not areas:
        raise NoReference
    cell = Cell(areas[0].sheet, areas[0].top, areas[0].left)
    formula = lowering.graph.workbook.content(cell).formula
    if formula is None or not formula.dynamic or formula.array is None:
        raise NoReference
    size = lowering.dag.sizes[lowering.array(cell)] or (1, 1)
    declared = formula.array.rows, formula.array.columns
    in_file = all(lowering.graph.workbook.content(cell).value is not None for cell in formula.array.cells())
    taken = in_file and (size == declared or lowering.is_saved(cell))
    return [require(lowering, formula.array)] if taken else None


REFERENCES: Mapping[str, Callable[[TreeLowering, Arguments, Scope], list[Area] | None]] = {
    "OFFSET": _offset,
    "INDIRECT": _indirect,
    "INDEX": _index,
    "IF": _if,
    "CHOOSE": _choose,
    "ANCHORARRAY": _spill,
}


def of_one_cell(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> ir.Expression:
    """Return the argument with `#VALUE!` for every range of several cells that it may give; arrays stay as they are.

    Args:
        lowering: of the workbook.
        tree: the argument.
        scope: of the argument.
    """
    match tree:
        case ir.Call(name, (test, *branches)) if name in _CHOOSING:
            check_count(name, tree.arguments)
            if lowering.dag.sizes[lowering.lower(test, scope.inside())] is not None:
                return tree  # a condition of many cells gives an array
            return ir.Call(name, (test, *(of_one_cell(lowering, part, scope) for part in branches)))
        case Area() | ir.Binary(",") | ir.Binary(":") | ir.Binary(" ") | ir.Variable():
            return _NOT_ONE_CELL if _is_many_cells(lowering, tree, scope) else tree
        case ir.Call(name) if name in REFERENCES:
            return (
                _NOT_ONE_CELL if _is_many_cells(lowering, tree, replace(scope, of_array=False, around=False)) else tree
            )
        case _:
            return tree


def _is_many_cells(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree refers to more cells than one."""
    try:
        areas = areas_of(lowering, tree, scope)
    except NoReference:
        return False
    return areas is not None and sum(area.whole.rows * area.whole.columns for area in areas) > 1
