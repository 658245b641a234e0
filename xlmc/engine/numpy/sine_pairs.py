"""Angles of which both the sine and the cosine are wanted: the engine computes the two together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply
from xlmc.excel.functions import Kind

__all__ = ["COSINE", "SINE", "sines_with_cosines"]

SINE: Final = "SIN"
COSINE: Final = "COS"


def sines_with_cosines(dag: Dag, nodes: Sequence[int]) -> dict[int, tuple[int, int]]:
    """Find the sines and cosines of angles of which both are wanted: node_id -> (sine, cosine)."""
    result: dict[str, dict[int, int]] = {SINE: {}, COSINE: {}}
    for node_id in nodes:
        node = dag.nodes[node_id]
        if type(node) is Apply and node.function.name in result and dag.types[node.arguments[0]] is Kind.NUMBER:
            result[node.function.name][node.arguments[0]] = node_id
    both = [(result[SINE][angle], result[COSINE][angle]) for angle in result[SINE].keys() & result[COSINE].keys()]
    return {node_id: pair for pair in both for node_id in pair}
