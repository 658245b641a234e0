"""Bounds of the values of nodes, as far as sums, products, choices and a few functions tell."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Final

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Input, Select
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.excel.functions.lookup.search_and_pick import CELL_AT
from xlmc.excel.functions.values import NUMBER

__all__ = ["Bounds", "NodeBounds"]

Bounds = tuple[float, float]
"""The least and the largest number, but for the rounding of the operations that led to them; one may be infinite."""

_ANY: Final[Bounds] = (-math.inf, math.inf)


class NodeBounds:
    """The bounds of the nodes of a graph. They are worked out when somebody asks, in the order of the nodes.

    Args:
        dag: of the nodes; it may grow.
        inputs: name of an input -> its bounds, where it has any. Without them only constants are known.
    """

    def __init__(self, dag: Dag, inputs: Mapping[str, Bounds]) -> None:
        self._dag, self._inputs = dag, inputs
        self._bounds: list[Bounds] = []

    def of(self, node: int) -> Bounds | None:
        """Return the bounds of a node; None if they are not known."""
        if not self._inputs:
            return _of_constant(self._dag, node)
        while len(self._bounds) <= node:
            low, high = self._next()
            self._bounds.append((low, high) if low < math.inf and high > -math.inf else _ANY)  # not of overflows, NaNs
        return None if self._bounds[node] == _ANY else self._bounds[node]

    def _next(self) -> Bounds:
        """Bound the first node that has no bounds yet, from the bounds of the nodes before it."""
        node_id, results = len(self._bounds), self._bounds
        match self._dag.nodes[node_id]:
            case Input(name):
                return self._inputs.get(name, _ANY)
            case Select(_, yes, no):
                return _around((*results[yes], *results[no]))
            case Apply(function, (first, second)) if function.name in ("+", "-", "*", "/"):
                return _combine(function.name, results[first], results[second])
            case Apply(function, (result, _)) if function.name == SNAP_TO_ZERO.name:
                return results[result]
            case Apply(function, (cells, _)) if function.name == CELL_AT.name:
                return results[cells]
            case Apply(function, arguments) if function.name in _OF_SETS:
                lows, highs = zip(*(results[argument] for argument in arguments), strict=True)
                return _OF_SETS[function.name](lows), _OF_SETS[function.name](highs)
            case Apply(function) if function.facts.result_range is not None:
                return function.facts.result_range
            case Apply(function, (only,)) if function.name in _OF_ONE:
                return _OF_ONE[function.name](*results[only])
        return _of_constant(self._dag, node_id) or _ANY


_OF_ONE: Final[Mapping[str, Callable[[float, float], Bounds]]] = {
    "u-": lambda low, high: (-high, -low),
    "SQRT": lambda low, high: (0.0, max(1.0, high)),  # wide, as the root of a number near 0 makes its rounding large
    "ABS": lambda low, high: (max(low, -high, 0.0), max(-low, high)),
    "EXP": lambda _low, high: (0.0, 2.0 * math.exp(high) if high < 700.0 else math.inf),  # wide, as it widens errors
}
"""Function of one number -> its bounds, from those of the number."""

_OF_SETS: Final[Mapping[str, Callable[[Iterable[float]], float]]] = {"MAX": max, "MIN": min}
"""Function of many numbers -> what its bounds are of theirs. An argument of which nothing is known may be a range."""


def _of_constant(dag: Dag, node_id: int) -> Bounds | None:
    """Return the least and the largest of constant numbers, those of a cell or of a range; None of any other node."""
    node = dag.nodes[node_id]
    if not isinstance(node, Constant):
        return None
    numbers, kinds = node.value.numbers, node.value.kinds
    if dag.sizes[node_id] is None:
        return (float(numbers[0]), float(numbers[0])) if int(kinds[0]) == NUMBER else None
    return (float(numbers.min()), float(numbers.max())) if numbers.size and (kinds == NUMBER).all() else None


def _combine(operator: str, left: Bounds, right: Bounds) -> Bounds:
    if operator == "+":
        return left[0] + right[0], left[1] + right[1]
    if operator == "-":
        return left[0] - right[1], left[1] - right[0]
    if operator == "/":
        away = right[0] > 0.0 or right[1] < 0.0
        return _combine("*", left, _around((1.0 / right[0], 1.0 / right[1]))) if away else _ANY
    return _around([_multiply(a, b) for a in left for b in right])


def _multiply(a: float, b: float) -> float:
    """Multiply two bounds: the product of 0 and any number is 0."""
    return 0.0 if a == 0.0 or b == 0.0 else a * b


def _around(numbers: Iterable[float]) -> Bounds:
    """Return the smallest bounds that hold all the numbers; where one is NaN, nothing is known."""
    numbers = tuple(numbers)
    return _ANY if any(math.isnan(number) for number in numbers) else (min(numbers), max(numbers))
