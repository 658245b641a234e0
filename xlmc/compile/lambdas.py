"""LET, LAMBDA and the functions that call one: each call is written out while the formula is lowered."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from xlmc.compile.arrays import element, grid, size_of
from xlmc.compile.scope import Closure, Scope, Thunk
from xlmc.errors import FormulaError
from xlmc.formula import ir
from xlmc.functions.budget import ask_for_cells
from xlmc.functions.values import Value, constant

if TYPE_CHECKING:
    from xlmc.compile.lower import Lowering

__all__ = ["LAMBDAS", "lower"]

Arguments = tuple[ir.Expression, ...]

_DEEPEST: Final = 60
"""Calls within calls; Excel stops when its stack is full."""


def lower(lowering: Lowering, tree: ir.Variable | ir.Let | ir.Lambda | ir.Invoke, scope: Scope) -> int:
    """The node of a variable, a LET or a call; a LAMBDA that is not called is Excel's `#CALC!`, refused here."""
    match tree:
        case ir.Variable(name):
            return _variable(lowering, name, scope)
        case ir.Let(bindings, body):
            for name, value in bindings:
                scope = scope.bound(**{name: _bound(value, scope)})
            return lowering.lower(body, scope)
        case ir.Lambda():
            raise FormulaError("a LAMBDA stands here that nothing calls")
        case ir.Invoke(function, arguments):
            found = tuple(_bound(argument, scope) for argument in arguments)
            return _called(lowering, _closure(lowering, function, scope), found, scope)


def _variable(lowering: Lowering, name: str, scope: Scope) -> int:
    found = scope.variables[name]
    if isinstance(found, Closure):
        raise FormulaError("a LAMBDA stands here that nothing calls")
    if isinstance(found, Thunk):
        if scope.array not in found.known:
            within = replace(found.scope, array=scope.array, depth=scope.depth)
            found.known[scope.array] = lowering.lower(found.tree, within)
        return found.known[scope.array]
    return found


def _bound(value: ir.Expression, scope: Scope) -> Thunk | Closure:
    return Closure(value, scope) if isinstance(value, ir.Lambda) else Thunk(value, scope)


def _closure(lowering: Lowering, tree: ir.Expression, scope: Scope) -> Closure:
    if isinstance(tree, ir.Lambda):
        return Closure(tree, scope)
    if isinstance(tree, ir.Variable):
        found = scope.variables.get(tree.name)
        if isinstance(found, Closure):
            return found
        if isinstance(found, Thunk):
            return _closure(lowering, found.tree, found.scope)
    if isinstance(tree, ir.Let):
        for name, value in tree.bindings:
            scope = scope.bound(**{name: _bound(value, scope)})
        return _closure(lowering, tree.body, scope)
    raise FormulaError("what is called here is no LAMBDA")


def _called(lowering: Lowering, closure: Closure, arguments: tuple[int | Thunk | Closure, ...], scope: Scope) -> int:
    parameters = closure.function.parameters
    if len(arguments) != len(parameters):
        raise FormulaError(f"a LAMBDA of {len(parameters)} parameters is given {len(arguments)} arguments")
    if scope.depth >= _DEEPEST:
        raise FormulaError(f"LAMBDAs call each other more than {_DEEPEST} deep")
    lowering.calls.add()
    within = closure.scope.bound(**dict(zip(parameters, arguments, strict=True)))
    return lowering.lower(closure.function.body, replace(within, array=scope.array, depth=scope.depth + 1))


def _map(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    closure = _closure(lowering, arguments[-1], scope)
    arrays = [_array(lowering, argument, scope) for argument in arguments[:-1]]
    sizes = [size_of(lowering.dag, array) or (1, 1) for array in arrays]
    rows, columns = max(size[0] for size in sizes), max(size[1] for size in sizes)

    def at(r: int, c: int) -> int:
        picked = tuple(element(lowering.dag, array, r, c) for array in arrays)
        return _one(lowering, closure, picked, scope)

    return grid(lowering.dag, rows, columns, at)


def _array(lowering: Lowering, tree: ir.Expression, scope: Scope) -> int:
    return lowering.lower(tree, scope.over_arrays())


def _one(lowering: Lowering, closure: Closure, arguments: tuple[int, ...], scope: Scope) -> int:
    """A call that must give a single value."""
    place = _called(lowering, closure, arguments, scope.over_arrays())
    if lowering.dag.sizes[place] not in (None, (1, 1)):
        raise FormulaError("a LAMBDA gives an array where a single value is wanted")
    return lowering.single(place)


def _reduce(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    return _accumulated(lowering, arguments, scope)[1]


def _scan(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    return _accumulated(lowering, arguments, scope)[0]


def _accumulated(lowering: Lowering, arguments: Arguments, scope: Scope) -> tuple[int, int]:
    """Every state, in the shape of the array, and the last one."""
    if len(arguments) == 2:  # the starting value may be left out
        arguments = (ir.Missing(), *arguments)
    closure, array = _closure(lowering, arguments[2], scope), _array(lowering, arguments[1], scope)
    rows, columns = size_of(lowering.dag, array) or (1, 1)
    state = lowering.lower(arguments[0], scope)
    states: dict[tuple[int, int], int] = {}
    for r in range(rows):
        for c in range(columns):
            item = element(lowering.dag, array, r, c)
            first = not states and isinstance(arguments[0], ir.Missing)
            state = item if first else _called(lowering, closure, (state, item), scope.over_arrays())
            states[r, c] = state
    return grid(lowering.dag, rows, columns, lambda r, c: lowering.single(states[r, c])), state


def _by(rows: bool) -> Callable[[Lowering, Arguments, Scope], int]:
    def by(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
        closure, array = _closure(lowering, arguments[1], scope), _array(lowering, arguments[0], scope)
        height, width = size_of(lowering.dag, array) or (1, 1)

        def line(index: int) -> int:
            if rows:
                return grid(lowering.dag, 1, width, lambda _, c: element(lowering.dag, array, index, c))
            return grid(lowering.dag, height, 1, lambda r, _: element(lowering.dag, array, r, index))

        if rows:
            return grid(lowering.dag, height, 1, lambda r, _: _one(lowering, closure, (line(r),), scope))
        return grid(lowering.dag, 1, width, lambda _, c: _one(lowering, closure, (line(c),), scope))

    return by


def _make_array(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    rows, columns = (_known_size(lowering, argument, scope) for argument in arguments[:2])
    ask_for_cells(1, rows, columns)
    closure = _closure(lowering, arguments[2], scope)

    def at(r: int, c: int) -> int:
        return _one(lowering, closure, (lowering.number(r + 1.0), lowering.number(c + 1.0)), scope)

    return grid(lowering.dag, rows, columns, at)


def _known_size(lowering: Lowering, tree: ir.Expression, scope: Scope) -> int:
    known: Value | None = lowering.known_single(lowering.lower(tree, scope))
    if known is None or not known.plain or known.numbers[0] < 1:
        raise FormulaError("the size of an array must be a fixed number from 1 up")
    return int(known.numbers[0])


def _is_omitted(lowering: Lowering, arguments: Arguments, scope: Scope) -> int:
    bound = scope.variables.get(arguments[0].name) if isinstance(arguments[0], ir.Variable) else None
    return lowering.dag.constant(constant(isinstance(bound, Thunk) and isinstance(bound.tree, ir.Missing)))


LAMBDAS: Mapping[str, Callable[[Lowering, Arguments, Scope], int]] = {
    "MAP": _map,
    "REDUCE": _reduce,
    "SCAN": _scan,
    "BYROW": _by(rows=True),
    "BYCOL": _by(rows=False),
    "MAKEARRAY": _make_array,
    "ISOMITTED": _is_omitted,
}
