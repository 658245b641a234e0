"""Whether loops save time: what each node costs less, or more, than in the engine `numpy`, by a fixed table.

No clock decides: which engine computes a workbook depends on its formulas alone, and so do its last bits. The figures
are nanoseconds a trial, measured by `benchmarks/node_costs.py` and rounded to the loops' disadvantage. What they leave
out (the size of blocks, what stays in caches) makes loops look worse rather than better.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from typing import Final

from xlmc.engine.engine import Compilable
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, Input, Node, Range, Select
from xlmc.excel.functions import Kind

__all__ = ["loops_pay"]

_SAVED: Final = 0.5
"""What a loop saves for a node that is not in the table below: arithmetic and functions of one number."""

_SAVED_BY: Final = {
    "^": -1.5,
    "EXP": -0.5,
    "LN": 0.0,
    "LOG10": 0.0,
    "ATAN": -0.5,
    "ASIN": -0.5,
    "ACOS": -0.5,
    "ATAN2": -0.5,
    "MAX": 0.0,
    "MIN": 0.0,
}
"""NumPy computes powers, for one, several at a time, too."""

_SAVED_BY_CHOICE: Final = 1.2

_LOST_BY_UFUNC: Final = 5.0
"""Outside of loops, by a function of numbers that NumPy has: its arguments and its result pass through memory."""

_LOST_BY_BODY: Final = 7.0
"""Outside of loops, by any other function: it takes memory of its own, too."""

_SAVED_BY_COMPILED: Final = 100.0
"""By native code for the body of a function: it searches for roots."""

_WITHOUT_COST: Final = (Constant, Input, Range)


def loops_pay(dag: Dag, nodes: Iterable[int], in_loops: Container[int]) -> bool:
    """Whether loops save as much time as what stands between them costs, or nothing does.

    Args:
        dag: of the nodes.
        nodes: that are computed.
        in_loops: those that loops can compute.
    """
    inside, outside = 0.0, 0.0
    for node_id in nodes:
        node = dag.nodes[node_id]
        if isinstance(node, _WITHOUT_COST):
            continue
        if isinstance(node, Apply) and isinstance(node.function.body, Compilable):
            inside += _SAVED_BY_COMPILED
        elif node_id in in_loops:
            inside += _saved(node)
        else:
            outside += _lost(dag, node_id)
    return not outside or inside >= outside


def _saved(node: Node) -> float:
    if isinstance(node, Select):
        return _SAVED_BY_CHOICE
    return _SAVED_BY.get(node.function.name, _SAVED) if isinstance(node, Apply) else 0.0


def _lost(dag: Dag, node_id: int) -> float:
    node = dag.nodes[node_id]
    by_ufunc = isinstance(node, Apply) and node.function.ufunc is not None and node.function.on_numbers
    return _LOST_BY_UFUNC if by_ufunc and dag.types[node_id] is Kind.NUMBER else _LOST_BY_BODY
