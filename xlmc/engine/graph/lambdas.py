"""LET, LAMBDA and the functions that call one: each call is written out while the formula is lowered."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from xlmc.engine.graph.arrays import element, grid, size_of
from xlmc.engine.graph.called_functions import limits
from xlmc.engine.graph.computed_references import areas_of
from xlmc.engine.graph.graph import MANY
from xlmc.engine.graph.node_values import single
from xlmc.engine.graph.nodes import Apply
from xlmc.engine.graph.recursion import call_recursive
from xlmc.engine.graph.scope import (
    Arguments,
    Callee,
    Closure,
    Fork,
    Native,
    Scope,
    Thunk,
    TooDeepError,
    TreeLowering,
    bind,
    check_depth,
    find_callee,
    is_omitted,
    let_scope,
)
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.budget import ask_for_cells
from xlmc.excel.functions.registry import Cells
from xlmc.excel.functions.values import Value, constant

__all__ = ["LAMBDAS", "NothingCallsError", "lower"]

Trees = tuple[ir.Expression, ...]


class NothingCallsError(FormulaError):
    """A LAMBDA stands where a value is needed."""

    def __init__(self) -> None:
        super().__init__("nothing calls this LAMBDA", hint="call it, as in LAMBDA(x,x+1)(2)")


def lower(
    lowering: TreeLowering, tree: ir.Variable | ir.Let | ir.Lambda | ir.FunctionName | ir.Invoke, scope: Scope
) -> int:
    """Lower a variable, a LET or a call.

    Raises:
        NothingCallsError: it is a LAMBDA that is not called.
    """
    match tree:
        case ir.Variable(name):
            return _variable(lowering, name, scope)
        case ir.Let(_, body):
            return lowering.lower(body, let_scope(tree, scope))
        case ir.Lambda() | ir.FunctionName():
            raise NothingCallsError
        case ir.Invoke(ir.ErrorLiteral(code), _):
            return lowering.error(code)
        case ir.Invoke(function, arguments):
            result = tuple(bind(argument, scope) for argument in arguments)
            return _call(lowering, find_callee(lowering, function, scope), result, scope)


def _variable(lowering: TreeLowering, name: str, scope: Scope) -> int:
    thunk = scope.variables[name]
    if isinstance(thunk, Closure):
        raise NothingCallsError
    if isinstance(thunk, Thunk):
        if scope.taking not in thunk.known:
            thunk.known[scope.taking] = lowering.lower(thunk.tree, thunk.scope.seen_from(scope))
        return thunk.known[scope.taking]
    return thunk


def _call(lowering: TreeLowering, function: Callee, arguments: Arguments, scope: Scope) -> int:
    """Lower a call; another number of arguments than there are parameters is `#VALUE!`."""
    if not _takes(function, len(arguments)):
        return lowering.error(ErrorCode.VALUE)
    match function:
        case Fork(condition, yes, no):
            both = [_call(lowering, branch, arguments, scope) for branch in (yes, no)]
            return lowering.select(condition, both[0], both[1])
        case Native(name):
            names = [f"={position}" for position in range(len(arguments))]
            inner = scope.bound(dict(zip(names, arguments, strict=True)))
            return lowering.lower(ir.Call(name, tuple(ir.Variable(each) for each in names)), inner)
        case Closure():
            return _call_lambda(lowering, function, arguments, scope)


def _call_lambda(lowering: TreeLowering, function: Closure, arguments: Arguments, scope: Scope) -> int:
    """Write a call out, unless the LAMBDA calls itself too deep for that."""
    calls = lowering.lambda_calls
    if calls.is_open(function):
        check_depth(scope)
        return call_recursive(lowering, function, arguments, scope)
    outermost = not calls.is_called(function)
    try:
        with calls.calling(function):
            check_depth(scope)
            lowering.calls.add()
            return lowering.lower(function.function.body, function.inside(arguments, scope))
    except (TooDeepError, RecursionError) as error:
        if not outermost or (isinstance(error, TooDeepError) and function not in error.repeated):
            raise
    return call_recursive(lowering, function, arguments, scope)


def _takes(function: Callee, count: int) -> bool:
    match function:
        case Closure():
            return function.takes(count)
        case Native(name):
            fewest, most = limits(name) or (count, count)
            return fewest <= count <= most
        case Fork():
            return True


def _lower_array(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> int:
    return lowering.lower(tree, scope.over_arrays())


def _call_for_one_value(lowering: TreeLowering, function: Callee, arguments: Arguments, scope: Scope) -> int:
    """Lower a call that must give a single value; an array is `#CALC!`, as Excel has no arrays of arrays."""
    return _one_value(lowering, _call(lowering, function, arguments, scope.over_arrays()))


def _ask_for_calls(lowering: TreeLowering, function: Callee, calls: int) -> None:
    """Ask for all calls of a LAMBDA over an array before the first; a function of Excel does not count."""
    if not isinstance(function, Native):
        lowering.calls.ask_for(calls)


def _one_value(lowering: TreeLowering, node: int) -> int:
    size = lowering.dag.sizes[node]
    if size == MANY:
        return lowering.dag.add(Apply(_ONLY_CELL, (node,)))
    return lowering.first_cell(node) if size in (None, (1, 1)) else lowering.error(ErrorCode.CALC)


_ONLY_CELL: Final = Function("only cell", (Cells,), single, Kind.ANY)


class _Items:
    """The cells of an array that a LAMBDA is called with; those of a range are given as references."""

    def __init__(self, lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> None:
        self._lowering, self._scope = lowering, scope
        self._area = _range_of(lowering, tree, scope)
        self._node = -1
        if self._area is not None:
            self.rows, self.columns = self._area.rows, self._area.columns
        else:
            self._node = _lower_array(lowering, tree, scope)
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


def _range_of(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> Area | None:
    """Return the one range that a tree refers to; None if it is another value, or goes on beyond the filled cells."""
    areas = areas_of(lowering, tree, scope)
    return areas[0] if areas is not None and len(areas) == 1 and not areas[0].is_cut else None


def _item_node(lowering: TreeLowering, item: int | Thunk) -> int:
    return item if isinstance(item, int) else lowering.lower(item.tree, item.scope.over_arrays())


def _map(lowering: TreeLowering, arguments: Trees, scope: Scope) -> int:
    function = find_callee(lowering, arguments[-1], scope)
    arrays = [_Items(lowering, argument, scope) for argument in arguments[:-1]]
    rows, columns = max(array.rows for array in arrays), max(array.columns for array in arrays)
    if not _takes(function, len(arrays)):
        return lowering.error(ErrorCode.VALUE)
    _ask_for_calls(lowering, function, rows * columns)

    def at(r: int, c: int) -> int:
        return _call_for_one_value(lowering, function, tuple(array.at(r, c) for array in arrays), scope)

    return grid(lowering.dag, rows, columns, at)


def _reduce(lowering: TreeLowering, arguments: Trees, scope: Scope) -> int:
    result = _accumulate(lowering, arguments, scope)
    return result if isinstance(result, int) else result[1]


def _scan(lowering: TreeLowering, arguments: Trees, scope: Scope) -> int:
    result = _accumulate(lowering, arguments, scope)
    return result if isinstance(result, int) else result[0]


def _accumulate(lowering: TreeLowering, arguments: Trees, scope: Scope) -> int | tuple[int, int]:
    """Every state, in the shape of the array, and the last one; an error alone where nothing can be called."""
    if len(arguments) == 2:  # the starting value may be left out
        arguments = (ir.Missing(), *arguments)
    function, array = find_callee(lowering, arguments[2], scope), _Items(lowering, arguments[1], scope)
    if not _takes(function, 2):
        return lowering.error(ErrorCode.VALUE)
    _ask_for_calls(lowering, function, array.rows * array.columns - isinstance(arguments[0], ir.Missing))
    state: int | Thunk | Closure = bind(arguments[0], scope)
    states: dict[tuple[int, int], int] = {}
    for r in range(array.rows):
        for c in range(array.columns):
            item = array.at(r, c)
            first = not states and isinstance(arguments[0], ir.Missing)
            node = (
                _item_node(lowering, item) if first else _call(lowering, function, (state, item), scope.over_arrays())
            )
            state = states[r, c] = node
    return grid(lowering.dag, array.rows, array.columns, lambda r, c: _one_value(lowering, states[r, c])), node


def _by(rows: bool) -> Callable[[TreeLowering, Trees, Scope], int]:
    def by(lowering: TreeLowering, arguments: Trees, scope: Scope) -> int:
        function, array = find_callee(lowering, arguments[1], scope), _Items(lowering, arguments[0], scope)
        if not _takes(function, 1):
            return lowering.error(ErrorCode.VALUE)
        _ask_for_calls(lowering, function, array.rows if rows else array.columns)
        if rows:
            return grid(
                lowering.dag,
                array.rows,
                1,
                lambda r, _: _call_for_one_value(lowering, function, (array.row(r),), scope),
            )
        return grid(
            lowering.dag,
            1,
            array.columns,
            lambda _, c: _call_for_one_value(lowering, function, (array.column(c),), scope),
        )

    return by


def _make_array(lowering: TreeLowering, arguments: Trees, scope: Scope) -> int:
    sizes = [_known_size(lowering, argument, scope) for argument in arguments[:2]]
    function = find_callee(lowering, arguments[2], scope)
    wrong = next((size for size in sizes if isinstance(size, ErrorCode)), None)
    if wrong is not None or not _takes(function, 2):
        return lowering.error(wrong or ErrorCode.VALUE)
    rows, columns = (int(size) for size in sizes)
    ask_for_cells(1, rows, columns)
    _ask_for_calls(lowering, function, rows * columns)

    def at(r: int, c: int) -> int:
        return _call_for_one_value(lowering, function, (lowering.number(r + 1.0), lowering.number(c + 1.0)), scope)

    return grid(lowering.dag, rows, columns, at)


def _known_size(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> float | ErrorCode:
    """Read a number of rows or columns; below 1 it is `#VALUE!`."""
    known: Value | None = lowering.lookup_constant(lowering.call("TRUNC", (lowering.lower(tree, scope),)))
    if known is None:
        hint = "SEQUENCE and TAKE take a size that varies"
        raise FormulaError("the size of an array must be a fixed number from 1 up", hint=hint)
    if not known.plain:
        return ErrorCode(int(known.errors[0]))
    return float(known.numbers[0]) if known.numbers[0] >= 1 else ErrorCode.VALUE


def _is_omitted(lowering: TreeLowering, arguments: Trees, scope: Scope) -> int:
    return lowering.dag.constant(constant(is_omitted(arguments[0], scope)))


LAMBDAS: Mapping[str, Callable[[TreeLowering, Trees, Scope], int]] = {
    "MAP": _map,
    "REDUCE": _reduce,
    "SCAN": _scan,
    "BYROW": _by(rows=True),
    "BYCOL": _by(rows=False),
    "MAKEARRAY": _make_array,
    "ISOMITTED": _is_omitted,
}
