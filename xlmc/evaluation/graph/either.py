"""A choice between values of different sizes: `IF(x>0,A1:A3,5)` is three cells in one trial and one in another.

Such a choice is a node of its own. A function of it becomes the same choice between the function's two results, which
for `SUM` and its like are single values again and run on the fast path; only what is left of it is computed trial by
trial.
"""

from __future__ import annotations

from collections.abc import Callable
from math import prod
from typing import Final

import numpy as np

from xlmc.evaluation.graph.dag import MANY, Apply, Dag
from xlmc.functions import Function, Kind
from xlmc.functions.facts import Facts
from xlmc.functions.registry import Anything, Cells
from xlmc.functions.values import ShapeVaries, Value

__all__ = ["MOST_WAYS", "differ", "either", "parts_of", "shared_out"]

MOST_WAYS: Final = 256
"""In how many ways choices may come out together in the arguments of a function that is still shared out."""


def _either(condition: Value, yes: Value, no: Value) -> Value:
    """One of two values whole, or the condition's error: (n,) and values of any size.

    Raises:
        ShapeVaries: not all trials choose alike, so that their results may differ in size.
    """
    truth, errors = condition.to_logicals()
    outcome = np.unique(np.where(np.broadcast_to(errors, condition.shape) > 0, 2, truth))
    if outcome.size > 1:
        raise ShapeVaries
    if outcome[0] == 2:
        return Value.of_errors(np.broadcast_to(errors, condition.shape))
    return yes if outcome[0] else no


_EITHER: Final = Function("one of two sizes", (Anything, Cells, Cells), _either, Kind.ANY, facts=Facts(spills=True))


def differ(dag: Dag, condition: int, yes: int, no: int) -> bool:
    """Whether a single condition chooses between values of different, or of unknown, sizes."""
    sizes = dag.sizes[yes], dag.sizes[no]
    return dag.sizes[condition] is None and (sizes[0] != sizes[1] or MANY in sizes)


def either(dag: Dag, condition: int, yes: int, no: int) -> int:
    """The node of such a choice."""
    return dag.add(Apply(_EITHER, (condition, yes, no)))


def parts_of(dag: Dag, place: int) -> tuple[int, int, int] | None:
    """The condition and the two values of such a choice; None for any other node."""
    node = dag.nodes[place]
    if not isinstance(node, Apply) or node.function is not _EITHER:
        return None
    condition, yes, no = node.arguments
    return condition, yes, no


def _ways(dag: Dag, place: int) -> int:
    """In how many ways choices within each other come out, counted up to `MOST_WAYS` and a little beyond."""
    parts, ways = parts_of(dag, place), 1
    while parts is not None and ways <= MOST_WAYS:
        ways += 1 + _ways(dag, parts[1])
        parts = parts_of(dag, parts[2])
    return ways


def shared_out(
    dag: Dag,
    arguments: tuple[int, ...],
    made: Callable[[tuple[int, ...]], int],
    is_error: Callable[[int], int],
    select: Callable[[int, int, int], int],
) -> int | None:
    """The choice between what `made` makes of the arguments, the first choice among them made both ways.

    None where there is no such choice, or too many of them. A condition that is an error stands for its argument.
    """
    for position, place in enumerate(arguments):
        parts = parts_of(dag, place)
        if parts is not None and prod(_ways(dag, each) for each in arguments) <= MOST_WAYS:
            before, after = arguments[:position], arguments[position + 1 :]
            wrong, yes, no = (made((*before, part, *after)) for part in parts)
            return select(is_error(parts[0]), wrong, select(parts[0], yes, no))
    return None
