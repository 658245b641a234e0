"""A LAMBDA that calls itself deeper than calls are written out: lowered once, and evaluated call by call.

Its calculation is lowered with parameters of its own. What of it depends on them becomes a `Body`; what does not is
worked out outside, once, and given to it. A parameter that is given a function, a range or nothing is no value: it is
part of what is lowered, and another such argument makes another body.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

from xlmc.address import Area
from xlmc.errors import FormulaError
from xlmc.evaluation.graph.arrays import element, grid, size_of
from xlmc.evaluation.graph.callees import Arguments, TooDeepError, function_given, is_omitted
from xlmc.evaluation.graph.dag import Apply, Constant, Dag, Input, Node, Range, Rescue, Select, uses
from xlmc.evaluation.graph.references import areas_of
from xlmc.evaluation.graph.scope import Closure, Scope, Thunk
from xlmc.evaluation.reference.recursive_calls import Again, Body, Step, called
from xlmc.formula import ir
from xlmc.functions import Function, Kind
from xlmc.functions.registry import Cells
from xlmc.functions.values import Value

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["DEEPEST", "Recursions"]

DEEPEST: Final = 16_384
"""Excel's calls within calls are this many, divided by the number of parameters and one; one more is `#NUM!`."""

_MOST_WRITTEN_OUT: Final = 1_000
"""Calls of a LAMBDA by itself within one call that are written out."""

_MOST_CELLS: Final = 1_000
"""Cells of an array that is given to a LAMBDA that calls itself: each is a parameter of its own."""


@dataclass(eq=False, slots=True)
class _Definition:
    """A LAMBDA lowered by itself: its calls within itself, and, once it is known, all others."""

    parameters: list[int]
    again: Function
    function: Function | None = None
    taken: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class _Given:
    """An argument: what decides on the body, the values, and what the parameter stands for in a body."""

    key: object
    values: tuple[int, ...]
    stands_for: Thunk | Closure | None = None


class Recursions:
    """The LAMBDAs of a workbook that are being called, and those that were lowered by themselves."""

    def __init__(self) -> None:
        self._calls: Counter[Closure] = Counter()
        self._made: Counter[Closure] = Counter()
        self._open: Counter[Closure] = Counter()
        self._known: dict[object, _Definition] = {}

    def is_open(self, function: Closure) -> bool:
        """Whether the LAMBDA is being lowered by itself."""
        return self._open[function] > 0

    def is_called(self, function: Closure) -> bool:
        """Whether a call of the LAMBDA is being written out."""
        return self._calls[function] > 0

    @contextmanager
    def calling(self, function: Closure) -> Iterator[None]:
        """A call that is written out."""
        self._calls[function] += 1
        self._made[function] += 1
        try:
            if self._made[function] > _MOST_WRITTEN_OUT:
                raise TooDeepError
            yield
        except TooDeepError as error:
            if self._calls[function] > 1:
                error.repeated.add(function)
            raise
        finally:
            self._calls[function] -= 1
            if not self._calls[function]:
                del self._made[function]

    def call(self, lowering: Lowering, function: Closure, arguments: Arguments, scope: Scope) -> int:
        """The node of a call that is not written out.

        Raises:
            FormulaError: it gives an array, or hands on what no body can take.
        """
        left_out = [Thunk(ir.Missing(), function.scope)] * (len(function.function.parameters) - len(arguments))
        given = [_given(lowering, argument, scope) for argument in (*arguments, *left_out)]
        keys = tuple(each.key for each in given)
        key = function, scope.array, keys
        values = tuple(place for each in given for place in each.values)
        found = self._known.get(key)
        if found is None and self.is_open(function):  # within an IF, ranges may be taken in the other way
            found = self._known.get((function, not scope.array, keys))
        if found is None:
            if any(open_ for open_ in self._open.values()) and any(each.values and each.key for each in given):
                raise FormulaError("a LAMBDA that calls itself hands on an array", hint="hand on a range and a number")
            if self.is_open(function):
                raise FormulaError("a LAMBDA calls itself with ranges or functions that change", hint="use REDUCE")
            found = self._defined(lowering, function, given, key, scope)
        if found.function is None:
            return lowering.dag.add(Apply(found.again, values))
        return lowering.dag.add(Apply(found.function, (*values, *found.taken)))

    def _defined(
        self, lowering: Lowering, function: Closure, given: Sequence[_Given], key: object, scope: Scope
    ) -> _Definition:
        dag = lowering.dag
        parameters = [_placeholder(dag) for each in given for _ in each.values]
        found = self._known[key] = _Definition(parameters, _marker("the LAMBDA itself"))
        self._open[function] += 1
        try:
            inside = function.inside(_bound_to(dag, given, parameters), scope)
            result = lowering.lower(function.function.body, inside)
            if dag.sizes[result] is not None:
                raise FormulaError(
                    "a LAMBDA that calls itself gives an array", hint="give single values, or use REDUCE"
                )
        except BaseException:
            del self._known[key]
            raise
        finally:
            self._open[function] -= 1
        deepest = DEEPEST // (len(given) + 1)
        body, found.taken = _body(dag, found, result, deepest)
        found.function = Function("a LAMBDA that calls itself", (Cells(repeat=True),), partial(called, body), Kind.ANY)
        return found


def _given(lowering: Lowering, argument: int | Thunk | Closure, scope: Scope) -> _Given:
    if isinstance(argument, int):
        return _values(lowering, argument)
    function = function_given(lowering, argument)
    if function is not None:
        return _Given(function, (), argument)
    assert isinstance(argument, Thunk)
    if is_omitted(argument.tree, argument.scope):
        return _Given("left out", (), Thunk(ir.Missing(), argument.scope))
    areas = areas_of(lowering, argument.tree, argument.scope)
    if areas is not None and not (len(areas) == 1 and areas[0].rows == areas[0].columns == 1):
        return _Given(tuple(areas), (), Thunk(_joined(areas), argument.scope))
    return _values(lowering, lowering.lower(argument.tree, argument.scope.seen_from(scope)))


def _joined(areas: Sequence[Area]) -> ir.Expression:
    joined: ir.Expression = areas[0]
    for area in areas[1:]:
        joined = ir.Binary(",", joined, area)
    return joined


def _values(lowering: Lowering, place: int) -> _Given:
    size = size_of(lowering.dag, place)
    if size is None:
        return _Given(None, (place,))
    rows, columns = size
    if rows * columns > _MOST_CELLS:
        raise FormulaError(
            f"an array of {rows * columns:,} cells is given to a LAMBDA that calls itself; it takes {_MOST_CELLS:,}",
            hint="use REDUCE, or give it the range and a number",
        )
    return _Given(size, tuple(element(lowering.dag, place, r, c) for r in range(rows) for c in range(columns)))


def _bound_to(dag: Dag, given: Sequence[_Given], parameters: Sequence[int]) -> list[int | Thunk | Closure]:
    """What the parameters stand for in the body."""
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


def _placeholder(dag: Dag) -> int:
    return dag.add(Apply(_marker("a parameter"), ()))


def _marker(name: str) -> Function:
    """Stands for what has no value while it is lowered: `volatile`, so that it is not taken for a constant."""
    return Function(name, (Cells(repeat=True),), _never, Kind.ANY, volatile=True)


def _never(*_: Value) -> Value:
    raise FormulaError("two LAMBDAs that call themselves are within each other", hint="use REDUCE for one of them")


def _body(dag: Dag, definition: _Definition, result: int, deepest: int) -> tuple[Body, tuple[int, ...]]:
    """The body, and the nodes that it takes from outside."""
    steps = _dependent(dag, definition, result)
    parameters = definition.parameters
    read = dict.fromkeys(used for place in [*steps, result] for used in (place, *uses(dag.nodes[place])))
    outer = [place for place in read if place not in steps and place not in parameters]
    taken = tuple(place for place in outer if not isinstance(dag.nodes[place], Constant))
    constants = [place for place in outer if isinstance(dag.nodes[place], Constant)]
    slots = {place: slot for slot, place in enumerate((*parameters, *taken, *constants, *steps))}
    values = {slots[place]: node.value for place in constants if isinstance(node := dag.nodes[place], Constant)}
    made = {slots[place]: _step(dag.nodes[place], definition.again, slots) for place in steps}
    last = _last(made, slots[result])
    return Body(len(parameters), len(taken), values, made, slots[result], last, deepest), taken


def _last(steps: Mapping[int, Step], result: int) -> frozenset[int]:
    """The calls of itself that end the calculation, and the `IF`s on the way to them."""
    used = Counter(slot for step in steps.values() for slot in _uses(step))
    way, waiting = list[int](), [result]
    while waiting:
        slot = waiting.pop()
        step = steps.get(slot)
        if used[slot] > (slot != result):
            continue
        if isinstance(step, Select):
            waiting += [step.yes, step.no]
        if isinstance(step, Select | Again):
            way.append(slot)
    found = set[int]()
    for slot in reversed(way):  # an `IF` comes before what it leads to
        step = steps[slot]
        if isinstance(step, Again) or (isinstance(step, Select) and not found.isdisjoint((step.yes, step.no))):
            found.add(slot)
    return frozenset(found)


def _uses(step: Step) -> tuple[int, ...]:
    return step.arguments if isinstance(step, Again) else uses(step)


def _dependent(dag: Dag, definition: _Definition, result: int) -> list[int]:
    """The nodes that the result needs and that depend on the parameters or call the LAMBDA itself, in order."""
    needed = dag.upstream([result])
    found = set(definition.parameters)
    for place in needed:
        node = dag.nodes[place]
        itself = isinstance(node, Apply) and node.function is definition.again
        if itself or not found.isdisjoint(uses(node)):
            found.add(place)
    return [place for place in needed if place in found and place not in definition.parameters]


def _step(node: Node, again: Function, slots: dict[int, int]) -> Step:
    """A node whose parts are slots."""
    match node:
        case Apply(function, arguments):
            used = tuple(slots[place] for place in arguments)
            return Again(used) if function is again else Apply(function, used)
        case Select(condition, yes, no):
            return Select(slots[condition], slots[yes], slots[no])
        case Rescue(value, instead, only_na):
            return Rescue(slots[value], slots[instead], only_na)
        case Range(rows):
            return Range(tuple(tuple(slots[place] for place in row) for row in rows))
        case Constant() | Input():
            raise TypeError(f"{node} depends on nothing")
