"""What a call calls: the LAMBDA, or the function of Excel, that a tree gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.errors import FormulaError
from xlmc.evaluation.graph import choices
from xlmc.evaluation.graph.scope import Callee, Closure, Fork, Native, Scope, Thunk
from xlmc.formula import ir

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["Arguments", "TooDeepError", "bound", "callee", "check_depth", "function_given", "is_omitted", "within"]

Arguments = tuple[int | Thunk | Closure, ...]

_DEEPEST: Final = 60
"""Calls within calls that are written out."""


class TooDeepError(FormulaError):
    """Calls within calls are too many to be written out.

    Attributes:
        repeated: the LAMBDAs among them that call themselves.
    """

    def __init__(self) -> None:
        super().__init__(f"LAMBDAs call each other more than {_DEEPEST} deep", hint="use REDUCE or SCAN")
        self.repeated: set[Closure] = set()


def check_depth(scope: Scope) -> None:
    """Stop calls within calls that go on.

    Raises:
        TooDeepError: they are too many.
    """
    if scope.depth >= _DEEPEST:
        raise TooDeepError


def bound(value: ir.Expression, scope: Scope) -> Thunk | Closure:
    """What a variable stands for that is bound to a tree."""
    return Closure(value, scope) if isinstance(value, ir.Lambda) else Thunk(value, scope)


def within(tree: ir.Let, scope: Scope) -> Scope:
    """The scope of the calculation of a LET."""
    for name, value in tree.bindings:
        scope = scope.defining(name, value) if tree.recursive else scope.bound({name: bound(value, scope)})
    return scope


def callee(lowering: Lowering, tree: ir.Expression, scope: Scope) -> Callee:
    """What a tree gives to be called.

    Raises:
        FormulaError: it gives no function.
    """
    match tree:
        case ir.Lambda():
            return Closure(tree, scope)
        case ir.FunctionName(name):
            return Native(name)
        case ir.Variable(name):
            return _of_variable(lowering, name, scope)
        case ir.Let(_, body):
            return callee(lowering, body, within(tree, scope))
        case ir.Invoke(function, arguments):
            called = callee(lowering, function, scope)
            if isinstance(called, Closure):
                return _given_by(lowering, called, tuple(bound(part, scope) for part in arguments), scope)
        case ir.Call("IF", (condition, yes, no)):
            return _of_if(lowering, lowering.lower(condition, scope), yes, no, scope)
        case ir.Call("CHOOSE", (index, *options)):
            known = lowering.known_single(lowering.lower(index, scope))
            if known is not None and known.plain and 1 <= known.numbers[0] < len(options) + 1:
                return callee(lowering, options[int(known.numbers[0]) - 1], scope)
    raise FormulaError("what is called here is no LAMBDA")


def _of_variable(lowering: Lowering, name: str, scope: Scope) -> Callee:
    found = scope.variables.get(name)
    if isinstance(found, Closure):
        return found
    if isinstance(found, Thunk):
        return _of_thunk(lowering, found)
    raise FormulaError("what is called here is no LAMBDA")


def _of_thunk(lowering: Lowering, thunk: Thunk) -> Callee:
    if thunk.callee is None:
        thunk.callee = callee(lowering, thunk.tree, thunk.scope)
    return thunk.callee


def _given_by(lowering: Lowering, called: Closure, arguments: Arguments, scope: Scope) -> Callee:
    """What a call gives that is called again."""
    if not called.takes(len(arguments)):
        raise FormulaError("a LAMBDA that gives a LAMBDA is given another number of arguments than it has parameters")
    check_depth(scope)
    lowering.calls.add()
    return callee(lowering, called.function.body, called.inside(arguments, scope))


def _of_if(lowering: Lowering, condition: int, yes: ir.Expression, no: ir.Expression, scope: Scope) -> Callee:
    known = choices.decided(lowering, condition)
    if known is not None:
        return callee(lowering, yes if known else no, scope)
    return Fork(condition, callee(lowering, yes, scope), callee(lowering, no, scope))


def function_given(lowering: Lowering, argument: int | Thunk | Closure) -> Callee | None:
    """The function that an argument is; None where it is a value, or that cannot be seen at once."""
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
