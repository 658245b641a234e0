"""What a call calls: the LAMBDA, or the function of Excel, that a tree gives."""

from __future__ import annotations

from xlmc.engine.graph.lowering import (
    DEEPEST_CALLS,
    Callee,
    Closure,
    Fork,
    Native,
    Scope,
    Thunk,
    TooDeepError,
    TreeLowering,
)
from xlmc.errors import FormulaError
from xlmc.excel.formula import ir

__all__ = ["Arguments", "bind", "check_depth", "find_callee", "find_function", "is_omitted", "let_scope"]

Arguments = tuple[int | Thunk | Closure, ...]


def check_depth(scope: Scope) -> None:
    """Refuse calls within calls that do not end.

    Raises:
        TooDeepError: they are too many.
    """
    if scope.depth >= DEEPEST_CALLS:
        raise TooDeepError


def bind(value: ir.Expression, scope: Scope) -> Thunk | Closure:
    """What a variable bound to a tree stands for."""
    return Closure(value, scope) if isinstance(value, ir.Lambda) else Thunk(value, scope)


def let_scope(tree: ir.Let, scope: Scope) -> Scope:
    """The scope in which a LET calculates its result."""
    for name, value in tree.bindings:
        scope = scope.defining(name, value) if tree.recursive else scope.bound({name: bind(value, scope)})
    return scope


def find_callee(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> Callee:
    """The function that a tree gives.

    Raises:
        FormulaError: it gives none.
    """
    match tree:
        case ir.Lambda():
            return Closure(tree, scope)
        case ir.FunctionName(name):
            return Native(name)
        case ir.Variable(name):
            return _of_variable(lowering, name, scope)
        case ir.Let(_, body):
            return find_callee(lowering, body, let_scope(tree, scope))
        case ir.Invoke(function, arguments):
            called = find_callee(lowering, function, scope)
            if isinstance(called, Closure):
                return _find_result(lowering, called, tuple(bind(part, scope) for part in arguments), scope)
        case ir.Call("IF", (condition, yes, no)):
            return _of_if(lowering, lowering.lower(condition, scope), yes, no, scope)
        case ir.Call("CHOOSE", (index, *options)):
            known = lowering.lookup_constant(lowering.lower(index, scope))
            if known is not None and known.plain and 1 <= known.numbers[0] < len(options) + 1:
                return find_callee(lowering, options[int(known.numbers[0]) - 1], scope)
    raise FormulaError("what is called here is no LAMBDA")


def _of_variable(lowering: TreeLowering, name: str, scope: Scope) -> Callee:
    found = scope.variables.get(name)
    if isinstance(found, Closure):
        return found
    if isinstance(found, Thunk):
        return _of_thunk(lowering, found)
    raise FormulaError("what is called here is no LAMBDA")


def _of_thunk(lowering: TreeLowering, thunk: Thunk) -> Callee:
    if thunk.callee is None:
        thunk.callee = find_callee(lowering, thunk.tree, thunk.scope)
    return thunk.callee


def _find_result(lowering: TreeLowering, called: Closure, arguments: Arguments, scope: Scope) -> Callee:
    """The function that a call gives, which is called in turn."""
    if not called.takes(len(arguments)):
        raise FormulaError("a LAMBDA that gives a LAMBDA is given another number of arguments than it has parameters")
    check_depth(scope)
    lowering.calls.add()
    return find_callee(lowering, called.function.body, called.inside(arguments, scope))


def _of_if(lowering: TreeLowering, condition: int, yes: ir.Expression, no: ir.Expression, scope: Scope) -> Callee:
    known = lowering.lookup_condition(condition)
    if known is not None:
        return find_callee(lowering, yes if known else no, scope)
    return Fork(condition, find_callee(lowering, yes, scope), find_callee(lowering, no, scope))


def find_function(lowering: TreeLowering, argument: int | Thunk | Closure) -> Callee | None:
    """The function that an argument is; None where it is a value, or where its tree does not show it."""
    while isinstance(argument, Thunk):
        match argument.tree:
            case ir.Variable(name):
                argument = argument.scope.variables.get(name, -1)
            case ir.Let(_, ir.Variable(), True) | ir.FunctionName():
                return _of_thunk(lowering, argument)
            case _:
                return None
    return argument if isinstance(argument, Closure) else None


def is_omitted(tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree is a parameter for which nothing was given, here or further out."""
    while isinstance(tree, ir.Variable):
        found = scope.variables.get(tree.name)
        if not isinstance(found, Thunk):
            return False
        tree, scope = found.tree, found.scope
    return isinstance(tree, ir.Missing)
