"""A LAMBDA that calls itself, deeper than calls are written out: it is lowered once, and evaluated call by call.

Its calculation is lowered with parameters of its own. The nodes that depend on them become a `Body`; the others are
computed outside, once, and given to it. A parameter that is given a function, a range or nothing is no value: it is
part of what is lowered, and another such argument makes another body.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

from xlmc.engine.graph.arrays import element, grid, size_of
from xlmc.engine.graph.computed_references import areas_of, join_areas
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Node, Select, in_slots, uses
from xlmc.engine.graph.recursive_calls import Body, SelfCall, Step, call_lambda
from xlmc.engine.graph.scope import (
    Arguments,
    Closure,
    RecursiveLambda,
    Scope,
    Thunk,
    TreeLowering,
    find_function,
    is_omitted,
)
from xlmc.errors import FormulaError
from xlmc.excel.formula import ir
from xlmc.excel.functions import Function, Kind
from xlmc.excel.functions.registry import Cells
from xlmc.excel.functions.values import Value

__all__ = ["DEEPEST", "call_recursive", "placeholder"]

DEEPEST: Final = 16_384
"""Excel's calls within calls are this many, divided by the number of parameters and one; one more is `#NUM!`."""

_MOST_CELLS: Final = 1_000
"""Cells of an array that is given to a LAMBDA that calls itself: each is a parameter of its own."""


@dataclass(frozen=True, slots=True)
class _Given:
    """An argument: the key that decides on the body, the values, and what the parameter stands for in the body."""

    key: object
    values: tuple[int, ...]
    stands_for: Thunk | Closure | None = None


def call_recursive(lowering: TreeLowering, function: Closure, arguments: Arguments, scope: Scope) -> int:
    """Make the node of a call that is not written out.

    Raises:
        FormulaError: it gives an array, or hands on what no body can take.
    """
    calls = lowering.lambda_calls
    left_out = [Thunk(ir.Missing(), function.scope)] * (len(function.function.parameters) - len(arguments))
    given = [_take_argument(lowering, argument, scope) for argument in (*arguments, *left_out)]
    keys = tuple(each.key for each in given)
    key = function, scope.array, keys
    values = tuple(node for each in given for node in each.values)
    value = calls.recursive.get(key)
    if value is None and calls.is_open(function):  # within an IF, ranges may be taken in the other way
        value = calls.recursive.get((function, not scope.array, keys))
    if value is None:
        if calls.any_open and any(each.values and each.key for each in given):
            raise FormulaError("a LAMBDA that calls itself hands on an array", hint="hand on a range and a number")
        if calls.is_open(function):
            raise FormulaError("a LAMBDA calls itself with ranges or functions that change", hint="use REDUCE")
        value = _define(lowering, function, given, key, scope)
    if value.function is None:
        return lowering.dag.add(Apply(value.itself, values))
    return lowering.dag.add(Apply(value.function, (*values, *value.taken)))


def _define(
    lowering: TreeLowering, function: Closure, given: Sequence[_Given], key: object, scope: Scope
) -> RecursiveLambda:
    dag, calls = lowering.dag, lowering.lambda_calls
    parameters = [placeholder(dag) for each in given for _ in each.values]
    value = calls.recursive[key] = RecursiveLambda(parameters, _marker("the LAMBDA itself"))
    try:
        with calls.opening(function):
            inside = function.inside(_bind_parameters(dag, given, parameters), scope)
            result = lowering.lower(function.function.body, inside)
            if dag.sizes[result] is not None:
                raise FormulaError(
                    "a LAMBDA that calls itself gives an array", hint="give single values, or use REDUCE"
                )
    except BaseException:
        del calls.recursive[key]
        raise
    deepest = DEEPEST // (len(given) + 1)
    body, value.taken = _body(dag, value, result, deepest)
    value.function = Function("a LAMBDA that calls itself", (Cells(repeat=True),), partial(call_lambda, body), Kind.ANY)
    return value


def _take_argument(lowering: TreeLowering, argument: int | Thunk | Closure, scope: Scope) -> _Given:
    if isinstance(argument, int):
        return _values(lowering, argument)
    function = find_function(lowering, argument)
    if function is not None:
        return _Given(function, (), argument)
    assert isinstance(argument, Thunk)
    if is_omitted(argument.tree, argument.scope):
        return _Given("left out", (), Thunk(ir.Missing(), argument.scope))
    areas = areas_of(lowering, argument.tree, argument.scope)
    if areas is not None and not (len(areas) == 1 and areas[0].rows == areas[0].columns == 1):
        return _Given(tuple(areas), (), Thunk(join_areas(areas), argument.scope))
    return _values(lowering, lowering.lower(argument.tree, argument.scope.seen_from(scope)))


def _values(lowering: TreeLowering, node: int) -> _Given:
    size = size_of(lowering.dag, node)
    if size is None:
        return _Given(None, (node,))
    rows, columns = size
    if rows * columns > _MOST_CELLS:
        raise FormulaError(
            f"an array of {rows * columns:,} cells is given to a LAMBDA that calls itself; it takes {_MOST_CELLS:,}",
            hint="use REDUCE, or give it the range and a number",
        )
    return _Given(size, tuple(element(lowering.dag, node, r, c) for r in range(rows) for c in range(columns)))


def _bind_parameters(dag: Dag, given: Sequence[_Given], parameters: Sequence[int]) -> list[int | Thunk | Closure]:
    """Return what the parameters stand for in the body."""
    bound: list[int | Thunk | Closure] = []
    left = iter(parameters)
    for each in given:
        own = [next(left) for _ in each.values]
        if each.stands_for is not None:
            bound.append(each.stands_for)
        elif isinstance(each.key, tuple):
            rows, columns = each.key
            bound.append(grid(dag, rows, columns, lambda r, c, own=own, columns=columns: own[r * columns + c]))  # type: ignore[misc]
        else:
            bound.append(own[0])
    return bound


def placeholder(dag: Dag) -> int:
    """Make a node that stands for a value which is given later."""
    return dag.add(Apply(_marker("a parameter"), ()))


def _marker(name: str) -> Function:
    """Make a function that stands for what has no value while it is lowered; `volatile`, so that it is no constant."""
    return Function(name, (Cells(repeat=True),), _never, Kind.ANY, volatile=True)


def _never(*_: Value) -> Value:
    raise FormulaError("two LAMBDAs that call themselves are within each other", hint="use REDUCE for one of them")


def _body(dag: Dag, definition: RecursiveLambda, result: int, deepest: int) -> tuple[Body, tuple[int, ...]]:
    """Lower the body, and find the nodes that it takes from outside."""
    steps = _find_dependent(dag, definition, result)
    parameters = definition.parameters
    read = dict.fromkeys(used for node_id in [*steps, result] for used in (node_id, *uses(dag.nodes[node_id])))
    outer = [node_id for node_id in read if node_id not in steps and node_id not in parameters]
    taken = tuple(node_id for node_id in outer if not isinstance(dag.nodes[node_id], Constant))
    constants = [node_id for node_id in outer if isinstance(dag.nodes[node_id], Constant)]
    slots = {node_id: slot for slot, node_id in enumerate((*parameters, *taken, *constants, *steps))}
    values = {slots[node_id]: node.value for node_id in constants if isinstance(node := dag.nodes[node_id], Constant)}
    made = {slots[node_id]: _step(dag.nodes[node_id], definition.itself, slots) for node_id in steps}
    last = _find_last_calls(made, slots[result])
    return Body(len(parameters), len(taken), values, made, slots[result], last, deepest), taken


def _find_last_calls(steps: Mapping[int, Step], result: int) -> frozenset[int]:
    """Find the calls of itself that end the calculation, and the `IF`s on the way to them."""
    used = Counter(slot for step in steps.values() for slot in _uses(step))
    path, waiting = list[int](), [result]
    while waiting:
        slot = waiting.pop()
        step = steps.get(slot)
        if used[slot] > (slot != result):
            continue
        if isinstance(step, Select):
            waiting += [step.yes, step.no]
        if isinstance(step, Select | SelfCall):
            path.append(slot)
    results = set[int]()
    for slot in reversed(path):  # an `IF` comes before what it leads to
        step = steps[slot]
        if isinstance(step, SelfCall) or (isinstance(step, Select) and not results.isdisjoint((step.yes, step.no))):
            results.add(slot)
    return frozenset(results)


def _uses(step: Step) -> tuple[int, ...]:
    return step.arguments if isinstance(step, SelfCall) else uses(step)


def _find_dependent(dag: Dag, definition: RecursiveLambda, result: int) -> list[int]:
    """Return the nodes that the result needs and that depend on the parameters or call the LAMBDA itself, in order."""
    needed = dag.upstream([result])
    results = set(definition.parameters)
    for node_id in needed:
        node = dag.nodes[node_id]
        itself = isinstance(node, Apply) and node.function is definition.itself
        if itself or not results.isdisjoint(uses(node)):
            results.add(node_id)
    return [node_id for node_id in needed if node_id in results and node_id not in definition.parameters]


def _step(node: Node, itself: Function, slots: dict[int, int]) -> Step:
    """Return a node whose parts are slots."""
    step = in_slots(node, slots)
    return SelfCall(step.arguments) if isinstance(step, Apply) and step.function is itself else step
