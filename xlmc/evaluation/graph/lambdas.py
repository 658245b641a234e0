"""LET, LAMBDA and the functions that call one: each call is written out while the formula is lowered."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Final

from xlmc.address import Area, Cell
from xlmc.errors import ErrorCode, FormulaError
from xlmc.evaluation.graph import choices
from xlmc.evaluation.graph.alignment import single
from xlmc.evaluation.graph.arrays import element, grid, size_of
from xlmc.evaluation.graph.callees import Arguments, TooDeepError, bound, callee, check_depth, is_omitted, within
from xlmc.evaluation.graph.counts import limits
from xlmc.evaluation.graph.dag import MANY, Apply
from xlmc.evaluation.graph.references import areas_of
from xlmc.evaluation.graph.scope import Callee, Closure, Fork, Native, Scope, Thunk
from xlmc.formula import ir
from xlmc.functions import Function, Kind
from xlmc.functions.budget import ask_for_cells
from xlmc.functions.registry import Cells
from xlmc.functions.values import Value, constant

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["LAMBDAS", "NothingCallsError", "lower"]

Trees = tuple[ir.Expression, ...]


class NothingCallsError(FormulaError):
    """A LAMBDA stands where a value is needed."""

    def __init__(self) -> None:
        super().__init__("a LAMBDA stands here that nothing calls", hint="call it, as in LAMBDA(x,x+1)(2)")


def lower(
    lowering: Lowering, tree: ir.Variable | ir.Let | ir.Lambda | ir.FunctionName | ir.Invoke, scope: Scope
) -> int:
    """The node of a variable, a LET or a call.

    Raises:
        NothingCallsError: it is a LAMBDA that is not called.
    """
    match tree:
        case ir.Variable(name):
            return _variable(lowering, name, scope)
        case ir.Let(_, body):
            return lowering.lower(body, within(tree, scope))
        case ir.Lambda() | ir.FunctionName():
            raise NothingCallsError
        case ir.Invoke(ir.ErrorLiteral(code), _):
            return lowering.error(code)
        case ir.Invoke(function, arguments):
            found = tuple(bound(argument, scope) for argument in arguments)
            return _called(lowering, callee(lowering, function, scope), found, scope)


def _variable(lowering: Lowering, name: str, scope: Scope) -> int:
    found = scope.variables[name]
    if isinstance(found, Closure):
        raise NothingCallsError
    if isinstance(found, Thunk):
        if scope.taking not in found.known:
            found.known[scope.taking] = lowering.lower(found.tree, found.scope.seen_from(scope))
        return found.known[scope.taking]
    return found


def _called(lowering: Lowering, function: Callee, arguments: Arguments, scope: Scope) -> int:
    """The node of a call; another number of arguments than there are parameters is `#VALUE!`."""
    if not _takes(function, len(arguments)):
        return lowering.error(ErrorCode.VALUE)
    match function:
        case Fork(condition, yes, no):
            both = [_called(lowering, branch, arguments, scope) for branch in (yes, no)]
            return choices.select(lowering, condition, both[0], both[1])
        case Native(name):
            names = [f"={position}" for position in range(len(arguments))]
            inner = scope.bound(dict(zip(names, arguments, strict=True)))
            return lowering.lower(ir.Call(name, tuple(ir.Variable(each) for each in names)), inner)
        case Closure():
            return _called_lambda(lowering, function, arguments, scope)


def _called_lambda(lowering: Lowering, function: Closure, arguments: Arguments, scope: Scope) -> int:
    """A call written out, unless the LAMBDA calls itself too deep for that."""
    recursions = lowering.recursions
    if recursions.is_open(function):
        check_depth(scope)
        return recursions.call(lowering, function, arguments, scope)
    outermost = not recursions.is_called(function)
    try:
        with recursions.calling(function):
            check_depth(scope)
            lowering.calls.add()
            return lowering.lower(function.function.body, function.inside(arguments, scope))
    except (TooDeepError, RecursionError) as error:
        if not outermost or (isinstance(error, TooDeepError) and function not in error.repeated):
            raise
    return recursions.call(lowering, function, arguments, scope)


def _takes(function: Callee, count: int) -> bool:
    match function:
        case Closure():
            return function.takes(count)
        case Native(name):
            fewest, most = limits(name) or (count, count)
            return fewest <= count <= most
        case Fork():
            return True


def _array(lowering: Lowering, tree: ir.Expression, scope: Scope) -> int:
    return lowering.lower(tree, scope.over_arrays())


def _one(lowering: Lowering, function: Callee, arguments: Arguments, scope: Scope) -> int:
    """A call that must give a single value; an array is `#CALC!`, as Excel has no arrays of arrays."""
    return _only(lowering, _called(lowering, function, arguments, scope.over_arrays()))


def _ask_for_calls(lowering: Lowering, function: Callee, calls: int) -> None:
    """Ask for all calls of a LAMBDA over an array before the first; a function of Excel by its name makes none."""
    if not isinstance(function, Native):
        lowering.calls.ask_for(calls)


def _only(lowering: Lowering, place: int) -> int:
    size = lowering.dag.sizes[place]
    if size == MANY:
        return lowering.dag.add(Apply(_ONLY, (place,)))
    return lowering.single(place) if size in (None, (1, 1)) else lowering.error(ErrorCode.CALC)


_ONLY: Final = Function("only cell", (Cells,), single, Kind.ANY)


class _Items:
    """The cells of an array that a LAMBDA is called with: of a range, its cells, so that they know their place."""

    def __init__(self, lowering: Lowering, tree: ir.Expression, scope: Scope) -> None:
        self._lowering, self._scope = lowering, scope
        self._area = _range_of(lowering, tree, scope)
        self._node = -1
        if self._area is not None:
            self.rows, self.columns = self._area.rows, self._area.columns
        else:
            self._node = _array(lowering, tree, scope)
            self.rows, self.columns = size_of(lowering.dag, self._node) or (1, 1)

    def at(self, row: int, column: int) -> int | Thunk:
        """One cell; a single row, column or value repeats, beyond it is `#N/A`."""
        if self._area is None:
            return element(self._lowering.dag, self._node, row, column)
        row, column = (0 if self.rows == 1 else row), (0 if self.columns == 1 else column)
        if row >= self.rows or column >= self.columns:
            return self._lowering.error(ErrorCode.NA)
        return Thunk(Cell(self._area.sheet, self._area.top + row, self._area.left + column), self._scope)

    def row(self, row: int) -> int | Thunk:
        """All cells of a row."""
        return self._part(row, 0, 1, self.columns)

    def column(self, column: int) -> int | Thunk:
        """All cells of a column."""
        return self._part(0, column, self.rows, 1)

    def _part(self, row: int, column: int, rows: int, columns: int) -> int | Thunk:
        if self._area is None:
            dag = self._lowering.dag
            return grid(dag, rows, columns, lambda r, c: element(dag, self._node, row + r, column + c))
        top, left = self._area.top + row, self._area.left + column
        if rows == columns == 1:
            return Thunk(Cell(self._area.sheet, top, left), self._scope)
        return Thunk(Area(self._area.sheet, top, left, top + rows - 1, left + columns - 1), self._scope)


def _range_of(lowering: Lowering, tree: ir.Expression, scope: Scope) -> Area | None:
    """The one range that a tree refers to; None where it is another value, or goes on beyond the filled cells."""
    areas = areas_of(lowering, tree, scope)
    return areas[0] if areas is not None and len(areas) == 1 and not areas[0].is_cut else None


def _value(lowering: Lowering, item: int | Thunk) -> int:
    return item if isinstance(item, int) else lowering.lower(item.tree, item.scope.over_arrays())


def _map(lowering: Lowering, arguments: Trees, scope: Scope) -> int:
    function = callee(lowering, arguments[-1], scope)
    arrays = [_Items(lowering, argument, scope) for argument in arguments[:-1]]
    rows, columns = max(array.rows for array in arrays), max(array.columns for array in arrays)
    if not _takes(function, len(arrays)):
        return lowering.error(ErrorCode.VALUE)
    _ask_for_calls(lowering, function, rows * columns)

    def at(r: int, c: int) -> int:
        return _one(lowering, function, tuple(array.at(r, c) for array in arrays), scope)

    return grid(lowering.dag, rows, columns, at)


def _reduce(lowering: Lowering, arguments: Trees, scope: Scope) -> int:
    found = _accumulated(lowering, arguments, scope)
    return found if isinstance(found, int) else found[1]


def _scan(lowering: Lowering, arguments: Trees, scope: Scope) -> int:
    found = _accumulated(lowering, arguments, scope)
    return found if isinstance(found, int) else found[0]


def _accumulated(lowering: Lowering, arguments: Trees, scope: Scope) -> int | tuple[int, int]:
    """Every state, in the shape of the array, and the last one; an error alone where nothing can be called."""
    if len(arguments) == 2:  # the starting value may be left out
        arguments = (ir.Missing(), *arguments)
    function, array = callee(lowering, arguments[2], scope), _Items(lowering, arguments[1], scope)
    if not _takes(function, 2):
        return lowering.error(ErrorCode.VALUE)
    _ask_for_calls(lowering, function, array.rows * array.columns - isinstance(arguments[0], ir.Missing))
    state: int | Thunk | Closure = bound(arguments[0], scope)
    states: dict[tuple[int, int], int] = {}
    for r in range(array.rows):
        for c in range(array.columns):
            item = array.at(r, c)
            first = not states and isinstance(arguments[0], ir.Missing)
            place = _value(lowering, item) if first else _called(lowering, function, (state, item), scope.over_arrays())
            state = states[r, c] = place
    return grid(lowering.dag, array.rows, array.columns, lambda r, c: _only(lowering, states[r, c])), place


def _by(rows: bool) -> Callable[[Lowering, Trees, Scope], int]:
    def by(lowering: Lowering, arguments: Trees, scope: Scope) -> int:
        function, array = callee(lowering, arguments[1], scope), _Items(lowering, arguments[0], scope)
        if not _takes(function, 1):
            return lowering.error(ErrorCode.VALUE)
        _ask_for_calls(lowering, function, array.rows if rows else array.columns)
        if rows:
            return grid(lowering.dag, array.rows, 1, lambda r, _: _one(lowering, function, (array.row(r),), scope))
        return grid(lowering.dag, 1, array.columns, lambda _, c: _one(lowering, function, (array.column(c),), scope))

    return by


def _make_array(lowering: Lowering, arguments: Trees, scope: Scope) -> int:
    sizes = [_known_size(lowering, argument, scope) for argument in arguments[:2]]
    function = callee(lowering, arguments[2], scope)
    wrong = next((size for size in sizes if isinstance(size, ErrorCode)), None)
    if wrong is not None or not _takes(function, 2):
        return lowering.error(wrong or ErrorCode.VALUE)
    rows, columns = (int(size) for size in sizes)
    ask_for_cells(1, rows, columns)
    _ask_for_calls(lowering, function, rows * columns)

    def at(r: int, c: int) -> int:
        return _one(lowering, function, (lowering.number(r + 1.0), lowering.number(c + 1.0)), scope)

    return grid(lowering.dag, rows, columns, at)


def _known_size(lowering: Lowering, tree: ir.Expression, scope: Scope) -> float | ErrorCode:
    """A number of rows or columns; below 1 it is `#VALUE!`."""
    known: Value | None = lowering.known_single(lowering.call("TRUNC", (lowering.lower(tree, scope),)))
    if known is None:
        hint = "SEQUENCE and TAKE take a size that varies"
        raise FormulaError("the size of an array must be a fixed number from 1 up", hint=hint)
    if not known.plain:
        return ErrorCode(int(known.errors[0]))
    return float(known.numbers[0]) if known.numbers[0] >= 1 else ErrorCode.VALUE


def _is_omitted(lowering: Lowering, arguments: Trees, scope: Scope) -> int:
    return lowering.dag.constant(constant(is_omitted(arguments[0], scope)))


LAMBDAS: Mapping[str, Callable[[Lowering, Trees, Scope], int]] = {
    "MAP": _map,
    "REDUCE": _reduce,
    "SCAN": _scan,
    "BYROW": _by(rows=True),
    "BYCOL": _by(rows=False),
    "MAKEARRAY": _make_array,
    "ISOMITTED": _is_omitted,
}
