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
from xlmc.functions.values import ERROR, LOGICAL, Floats, Value

__all__ = ["DOUBLE", "SINGLE", "Jitter", "closure", "evaluation", "formula_of", "numbers"]

DOUBLE: Final = 2.0**-53
SINGLE: Final = 2.0**-24
"""Half a unit of the last place, as a share of the number."""

_EXACT: Final = frozenset({"u-", "u+", "shown", "ABS", "SIGN", "MIN", "MAX", "LARGE", "SMALL", "INT", "TRUNC", "IF"})


_POOL: Final = 1 << 16


class Jitter:
    """Moves numbers up or down at random.

    Args:
        seed: of which way.
        unit: by how much, as a share of the number.
    """

    def __init__(self, seed: int | Sequence[int], unit: float = DOUBLE) -> None:
        ways = np.random.default_rng(seed).integers(0, 2, _POOL, np.int8)
        self._factors = 1.0 + (ways * (2 * unit) - unit)
        self._next = 0

    def moved(self, value: Value, n: int) -> Value:
        """Each number up or down, but for whole ones, which are exact; a constant, too, differs from trial to trial."""
        if value.kinds.any():
            return value
        shape = (max(n, value.shape[0]), *value.shape[1:])
        size = int(np.prod(shape))
        if self._next + size > _POOL:
            self._next = self._next % 1009  # another start than the last time
        factors = self._factors[self._next : self._next + size] if size <= _POOL // 2 else self._many(size)
        self._next += size
        numbers_ = value.numbers
        moved = numbers_ * factors.reshape(shape)
        whole = numbers_ == np.rint(numbers_)
        return Value(np.where(whole, numbers_, moved) if whole.any() else moved, value.kinds)

    def _many(self, size: int) -> Floats:
        return np.resize(self._factors, size)


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
    jitter: Jitter | None = None,
) -> dict[int, Value]:
    """The values of nodes.

    Args:
        dag: the nodes.
        places: which of them, each after those that it needs; see `closure`.
        draws: of every input, `(n,)` each.
        jitter: moves every result; None for plain evaluation.
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
            moves = jitter is not None and isinstance(node, Apply) and _rounds(node)
            values[place] = jitter.moved(found, n) if jitter is not None and moves else found
    return values


def _rounds(node: Apply) -> bool:
    return node.function.returns is not Kind.LOGICAL and node.function.name not in _EXACT


def numbers(value: Value, n: int) -> Floats:
    """A single value's numbers, `(n,)`, logicals as 1 and 0; NaN where there is none."""
    found = np.where(value.kinds <= LOGICAL, value.numbers, np.nan)
    found = np.where(value.kinds >= ERROR, np.nan, found)
    return np.broadcast_to(found.reshape(found.shape[0], -1)[:, 0], (n,))
