"""A model evaluated with its roundings made at random: what then differs are digits that are not there.

Every result of a function is a little off, by up to half a unit of its last place; which way is chance. Here each is
moved once more, by half a unit up or down at random (Vignes 1978, Parker 1997), and so is each constant that was
computed while the formulas were compiled. The replicas differ from the plain evaluation about as much as that differs
from the exact one. Functions that round, compare or choose give what they give.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final

import numpy as np

from xlmc.compile.dag import Apply, Constant, Dag, Input, Node, Range, Rescue, Select, evaluated, uses
from xlmc.functions import Kind
from xlmc.functions.values import ERROR, LOGICAL, NUMBER, Floats, Value

__all__ = ["DOUBLE", "SINGLE", "closure", "evaluation", "numbers"]

DOUBLE: Final = 2.0**-53
SINGLE: Final = 2.0**-24
"""Half a unit of the last place, as a share of the number."""

_EXACT: Final = frozenset({"u-", "u+", "shown", "ABS", "SIGN", "MIN", "MAX", "LARGE", "SMALL", "INT", "TRUNC", "IF"})


def closure(dag: Dag, targets: Collection[int]) -> list[int]:
    """The nodes that the targets need, constants that were computed and their parts among them, parts first."""
    order: list[int] = []
    seen: set[int] = set()
    open_: list[tuple[int, bool]] = [(place, False) for place in targets]
    while open_:
        place, done = open_.pop()
        if done:
            order.append(place)
        elif place not in seen:
            seen.add(place)
            open_.append((place, True))
            open_ += [(part, False) for part in uses(formula_of(dag, place))]
    return order


def formula_of(dag: Dag, place: int) -> Node:
    """The node; of a computed constant, what computed it."""
    node = dag.nodes[place]
    return dag.origins.get(place, node) if isinstance(node, Constant) else node


def evaluation(
    dag: Dag,
    places: Sequence[int],
    draws: Mapping[str, Floats],
    rounding: np.random.Generator | None = None,
    unit: float = DOUBLE,
) -> dict[int, Value]:
    """The values of nodes.

    Args:
        dag: the nodes.
        places: which of them, each after those that it needs; see `closure`.
        draws: of every input, `(n,)` each.
        rounding: moves every result by `unit` of it, up or down; None for plain evaluation.
        unit: see `rounding`.
    """
    values: dict[int, Value] = {}
    n = next((draw.size for draw in draws.values()), 1)
    for place in places:
        node = formula_of(dag, place)
        if isinstance(node, Input):
            values[place] = Value.of_numbers(draws[node.name])
        elif isinstance(node, Constant):
            values[place] = node.value
        else:
            assert isinstance(node, Apply | Select | Rescue | Range)
            found = evaluated(node, values)
            moves = rounding is not None and isinstance(node, Apply) and _rounds(node)
            values[place] = _moved(found, rounding, unit, n) if rounding is not None and moves else found
    return values


def _rounds(node: Apply) -> bool:
    return node.function.returns is not Kind.LOGICAL and node.function.name not in _EXACT


def _moved(value: Value, rounding: np.random.Generator, unit: float, n: int) -> Value:
    """Each number up or down, but for whole ones, which are exact; a constant, too, differs from trial to trial."""
    if not (value.kinds == NUMBER).all():
        return value
    shape = (max(n, value.shape[0]), *value.shape[1:])
    signs = rounding.integers(0, 2, shape, np.int8) * (2 * unit) - unit
    moved = np.where(value.numbers == np.rint(value.numbers), value.numbers, value.numbers * (1 + signs))
    return Value(moved, value.kinds, value.texts)


def numbers(value: Value, n: int) -> Floats:
    """A single value's numbers, `(n,)`, logicals as 1 and 0; NaN where there is none."""
    found = np.where(value.kinds <= LOGICAL, value.numbers, np.nan)
    found = np.where(value.kinds >= ERROR, np.nan, found)
    return np.broadcast_to(found.reshape(found.shape[0], -1)[:, 0], (n,))
