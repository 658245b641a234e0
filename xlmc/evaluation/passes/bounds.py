"""Bounds of the values of nodes, as far as sums, products and choices tell."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Final

from xlmc.evaluation.graph.dag import Dag
from xlmc.evaluation.graph.nodes import Apply, Constant, Input, Select
from xlmc.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.functions.values import NUMBER

__all__ = ["Bounds", "bounds", "of_constant"]

Bounds = tuple[float, float]
"""The least and the largest number, but for the rounding of the operations that led to them."""

_ANY: Final[Bounds] = (-math.inf, math.inf)


def bounds(dag: Dag, nodes: Iterable[int], inputs: Mapping[str, Bounds]) -> dict[int, Bounds]:
    """The finite bounds among the nodes at `nodes`, which come in order.

    Args:
        dag: of the nodes.
        nodes: those that vary.
        inputs: name of an input -> its bounds, where it has any.
    """
    found: dict[int, Bounds] = {}

    def of(node: int) -> Bounds:
        return found[node] if node in found else of_constant(dag, node) or _ANY

    for node_id in nodes:
        match dag.nodes[node_id]:
            case Input(name):
                between = inputs.get(name, _ANY)
            case Select(_, yes, no):
                between = _around((*of(yes), *of(no)))
            case Apply(function, (first, second)) if function.name in ("+", "-", "*", "/"):
                between = _combine(function.name, of(first), of(second))
            case Apply(function, (result, _)) if function.name == SNAP_TO_ZERO.name:
                between = of(result)
            case Apply(function) if function.facts.result_range is not None:
                between = function.facts.result_range
            case Apply(function, (only,)) if function.name in _OF_ONE:
                between = _OF_ONE[function.name](*of(only))
            case _:
                continue
        if math.isfinite(between[0]) and math.isfinite(between[1]):
            found[node_id] = between
    return found


_OF_ONE: Final[Mapping[str, Callable[[float, float], Bounds]]] = {
    "u-": lambda low, high: (-high, -low),
    "SQRT": lambda low, high: (0.0, max(1.0, high)),  # wide, as the root of a number near 0 makes its rounding large
    "ABS": lambda low, high: (max(low, -high, 0.0), max(-low, high)),
}
"""Function of one number -> its bounds, from those of the number."""


def of_constant(dag: Dag, node_id: int) -> Bounds | None:
    """A constant number as its own lower and upper bound; None of any other node."""
    node = dag.nodes[node_id]
    if isinstance(node, Constant) and dag.sizes[node_id] is None and int(node.value.kinds[0]) == NUMBER:
        number = float(node.value.numbers[0])
        return number, number
    return None


def _combine(operator: str, left: Bounds, right: Bounds) -> Bounds:
    if operator == "+":
        return left[0] + right[0], left[1] + right[1]
    if operator == "-":
        return left[0] - right[1], left[1] - right[0]
    if operator == "/":
        away = right[0] > 0.0 or right[1] < 0.0
        return _combine("*", left, _around((1.0 / right[0], 1.0 / right[1]))) if away else _ANY
    return _around([a * b for a in left for b in right])


def _around(numbers: Iterable[float]) -> Bounds:
    """The smallest bounds that hold all the numbers; where one is NaN, nothing is known."""
    numbers = tuple(numbers)
    return _ANY if any(math.isnan(number) for number in numbers) else (min(numbers), max(numbers))
