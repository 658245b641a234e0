"""A model evaluated with its roundings made at random: the digits that then differ mean nothing.

Every result of a function is off by up to half a unit of its last bit, up or down by chance. Here half of the results,
at random, are moved up or down by one such unit (Vignes 1978, Parker 1997), and so are constants that were computed
while the formulas were compiled. Such evaluations differ from the plain one about as much as that differs from the
exact one. Results of functions that round, compare or choose are not moved. That Excel makes 0 of the last bits of the
sum that a formula ends with is left out, for these bits are looked for.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Final, Protocol

import numpy as np

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.node_values import Ragged, evaluate_node
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Input, Node, Range, Select, uses
from xlmc.excel.functions import Kind
from xlmc.excel.functions.fifteen_digits import SNAP_TO_ZERO
from xlmc.excel.functions.values import ERROR, LOGICAL, Floats, Value

__all__ = [
    "DOUBLE",
    "Graph",
    "OpenedGraph",
    "RandomRounding",
    "closure",
    "evaluate",
    "evaluate_changes",
    "formula_of",
    "numbers_of",
    "open_constants",
    "term_sizes",
]

DOUBLE: Final = 2.0**-53
"""Half a unit of the last bit, as a share of the number."""

_POOL: Final = 1 << 16

_ALL_WHOLE: Final = 2.0**52
"""From here on all doubles are whole, so that a whole number need not be exact."""

_SURELY: Final = 1.001
"""This times half a unit of the last bit, added to a number, gives the next double."""


class Graph(Protocol):
    """Nodes, and what computed constants were computed from: a `Dag`, or less of one."""

    @property
    def nodes(self) -> Sequence[Node]:
        """What each node is."""

    @property
    def origins(self) -> Mapping[int, Node]:
        """Computed constants -> the node that each was computed from."""


@dataclass(frozen=True, slots=True)
class OpenedGraph:
    """A graph in which constants that were computed from large arrays of constants count as typed.

    Attributes:
        nodes, origins: see `Graph`.
        closed: the constants that count as typed.
    """

    nodes: Sequence[Node]
    origins: Mapping[int, Node]
    closed: frozenset[int]


def open_constants(dag: Dag, targets: Collection[int], most: int) -> OpenedGraph:
    """Look into computed constants as far as these are computed from few cells in all.

    Args:
        dag: the nodes.
        targets: what is looked at.
        most: cells that all computed constants read, together. Above it, constants that read the largest arrays count
            as typed, and what only these are computed from is not looked at.
    """
    read = {
        node: max((prod(dag.sizes[part] or (1,)) for part in uses(origin)), default=1)
        for node, origin in dag.origins.items()
    }
    graph, needed = OpenedGraph(dag.nodes, dag.origins, frozenset()), closure(dag, targets)
    largest = max((read[node] for node in needed if node in read), default=1)
    while sum(read[node] for node in needed if node in graph.origins) > most and largest > 1:
        largest //= 4
        origins = {node: origin for node, origin in dag.origins.items() if read[node] <= largest}
        needed = closure(OpenedGraph(dag.nodes, origins, frozenset()), targets)
        graph = OpenedGraph(dag.nodes, origins, frozenset(node for node in needed if read.get(node, 0) > largest))
    return graph


class RandomRounding:
    """Moves every other number up or down at random.

    Args:
        seed: of the directions.
        unit: by how much, as a share of the number.
    """

    def __init__(self, seed: int | Sequence[int], unit: float = DOUBLE) -> None:
        directions = np.array([-1.0, 0.0, 1.0, 0.0])[np.random.default_rng(seed).integers(0, 4, _POOL, np.int8)]
        self._steps = directions * (_SURELY * unit)
        self._next = 0

    def move(self, value: Value, n: int, *, whole_too: bool = False) -> Value:
        """Move numbers up or down; a constant, too, then differs from trial to trial, but not an array of constants.

        Args:
            value: of numbers; another kind of value is left as it is.
            n: how many trials there are.
            whole_too: also move whole numbers, which otherwise count as exact.
        """
        if value.kinds.any():
            return value
        shape = (n if value.shape == (1,) else value.shape[0], *value.shape[1:])
        size = int(np.prod(shape))
        if self._next + size > _POOL:
            self._next = self._next % 1009  # not where it began the last time
        steps = self._steps[self._next : self._next + size] if size <= _POOL // 2 else np.resize(self._steps, size)
        self._next += size
        numbers_ = value.numbers
        moved = numbers_ + numbers_ * steps.reshape(shape)
        if whole_too:
            return Value(moved, value.kinds)
        whole = (numbers_ == np.rint(numbers_)) & (np.abs(numbers_) < _ALL_WHOLE)
        return Value(np.where(whole, numbers_, moved) if whole.any() else moved, value.kinds)


def closure(dag: Graph, targets: Collection[int]) -> list[int]:
    """Return the nodes that the targets need, constants that were computed and their parts among them, parts first."""
    order: list[int] = []
    seen: set[int] = set()
    open_: list[tuple[int, bool]] = [(node, False) for node in targets]
    while open_:
        node, done = open_.pop()
        if done:
            order.append(node)
        elif node not in seen:
            seen.add(node)
            open_.append((node, True))
            open_ += [(part, False) for part in uses(formula_of(dag, node))]
    return order


def formula_of(dag: Graph, node_id: int) -> Node:
    """Return the node; for a computed constant, the node that it was computed from."""
    node = dag.nodes[node_id]
    return dag.origins.get(node_id, node) if isinstance(node, Constant) else node


def evaluate(
    dag: Graph,
    nodes: Sequence[int],
    draws: Mapping[str, Floats],
    rounding: RandomRounding | None = None,
    of_inputs: RandomRounding | None = None,
    keep: Collection[int] | None = None,
) -> dict[int, Value]:
    """Return the values of nodes.

    Args:
        dag: the nodes.
        nodes: which of them, each after those that it needs; see `closure`.
        draws: of every input, `(n,)` each.
        rounding: moves every result; None for plain evaluation.
        of_inputs: moves the draws, and numbers that were typed in where they are calculated with.
        keep: the nodes whose values are wanted, so that the others are dropped once they are read; None for all.
    """
    last = {} if keep is None else {part: node_id for node_id in nodes for part in uses(formula_of(dag, node_id))}
    wanted = frozenset(keep or ())
    values: dict[int, Value] = {}
    n = next((draw.size for draw in draws.values()), 1)
    typed: dict[int, Value] = {}
    if of_inputs is not None:
        constants = ((node_id, dag.nodes[node_id]) for node_id in _find_typed(dag, nodes))
        known = {node_id: node.value for node_id, node in constants if isinstance(node, Constant)}
        typed = {node_id: of_inputs.move(value, n, whole_too=True) for node_id, value in known.items()}
    for node_id in nodes:
        node = formula_of(dag, node_id)
        if isinstance(node, Input):
            drawn = Value.of_numbers(draws[node.name])
            values[node_id] = drawn if of_inputs is None else of_inputs.move(drawn, n, whole_too=True)
        elif isinstance(node, Constant):
            values[node_id] = node.value
        elif isinstance(node, Apply) and node.function.name == SNAP_TO_ZERO.name:
            values[node_id] = values[node.arguments[0]]
        else:
            assert isinstance(node, Apply | Select | IfErrorNode | Range)
            known = {part: typed[part] for part in _measured_arguments(node) if part in typed} if typed else {}
            result = evaluate_node(
                node, {part: known.get(part, values[part]) for part in uses(node)} if known else values
            )
            moves = isinstance(node, Apply) and _rounds(node) and not isinstance(result, Ragged)
            values[node_id] = rounding.move(result, n) if rounding is not None and moves else result
        if last:
            for part in {*uses(node)} - wanted:
                if last[part] == node_id:
                    del values[part]
    return values


def evaluate_changes(
    dag: Graph, nodes: Sequence[int], values: Mapping[int, Value], given: Mapping[int, Value]
) -> dict[int, Value]:
    """Return the nodes that change when some are given other values: these, and all that depend on them.

    Args:
        dag: the nodes.
        nodes: which of them, each after those that it needs; see `closure`.
        values: of all of them, as they are.
        given: node -> another value of it.
    """
    result = dict(given)
    for node_id in nodes:
        node = formula_of(dag, node_id)
        if node_id in given or isinstance(node, Input | Constant) or not any(part in result for part in uses(node)):
            continue
        if isinstance(node, Apply) and node.function.name == SNAP_TO_ZERO.name:
            result[node_id] = result.get(node.arguments[0], values[node.arguments[0]])
        else:
            result[node_id] = evaluate_node(node, {part: result.get(part, values[part]) for part in uses(node)})
    return result


def _find_typed(dag: Graph, nodes: Sequence[int]) -> set[int]:
    """Typed numbers that are calculated with, but not π or small whole numbers, which are no measurements."""
    result: set[int] = set()
    for node in nodes:
        result.update(
            part for part in _measured_arguments(formula_of(dag, node)) if isinstance(formula_of(dag, part), Constant)
        )
    return {node for node in result if not _is_exact(dag.nodes[node])}


def _measured_arguments(node: Node) -> tuple[int, ...]:
    """Return the arguments that are calculated with; of a power only the base, as an exponent is exact."""
    if not isinstance(node, Apply) or not node.function.facts.measures:
        return ()
    return node.arguments[:1] if node.function.name == "^" else node.arguments


def _is_exact(node: Node) -> bool:
    """Whether it is π, or a count or an exponent, and no measurement."""
    if not isinstance(node, Constant):
        return False
    x = float(node.value.numbers.flat[0])
    return x in (np.pi, np.pi / 180, 180 / np.pi) or (node.value.numbers.size == 1 and abs(x) < _COUNTS and x == int(x))


_COUNTS: Final = 100


def term_sizes(dag: Graph, nodes: Sequence[int], values: Mapping[int, Value]) -> dict[int, float]:
    """Node -> the largest number that was added or subtracted on the way to it, in any trial.

    What is smaller than that by many digits, and should be 0, is dust.
    """
    result: dict[int, float] = {}
    for node_id in nodes:
        node = formula_of(dag, node_id)
        parts = uses(node)
        size = max((result[part] for part in parts), default=0.0)
        if isinstance(node, Apply) and node.function.facts.adds:
            sizes = [float(np.abs(values[part].numbers).max(initial=0.0)) for part in parts]
            size = max([size, *(one for one in sizes if np.isfinite(one))])
        result[node_id] = size
    return result


def _rounds(node: Apply) -> bool:
    return node.function.returns is not Kind.LOGICAL and not node.function.facts.unrounded


def numbers_of(value: Value, n: int) -> Floats:
    """Return the numbers of a value, `(n,)`, logicals as 1 and 0, an array's first cell; NaN where there is
    no number.
    """
    if not value.numbers.size:
        return np.full(n, np.nan)
    values = np.where(value.kinds <= LOGICAL, value.numbers, np.nan)
    values = np.where(value.kinds >= ERROR, np.nan, values)
    return np.broadcast_to(values.reshape(values.shape[0], -1)[:, 0], (n,))
