"""Tell which forecasts give texts, and which two values only."""

from __future__ import annotations

import numpy as np

from xlmc.engine.engine import TEXT_RESULT, Column
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Constant, Select
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import Value

__all__ = ["are_texts", "is_two_valued"]


def are_texts(column: Column) -> bool:
    """Whether there are texts that say something, and no numbers."""
    if column.codes is None or column.texts is None:
        return False
    texts = column.texts[column.codes == TEXT_RESULT]
    return bool(np.all(column.codes > 0)) and any(texts)


def is_two_valued(dag: Dag, node: int) -> bool:
    """Return whether a node is a logical, or what `IF` chooses there from are logicals and constants 1 and 0.

    A number that is known before the run, such as a speed that is held at 0, is neither.
    """
    seen, waiting = set[int](), [node]
    if isinstance(dag.nodes[node], Constant) and dag.types[node] is Kind.NUMBER:
        return False
    while waiting:
        at = waiting.pop()
        found = dag.nodes[at]
        if at in seen or dag.types[at] is Kind.LOGICAL:
            continue
        seen.add(at)
        if isinstance(found, Select):
            waiting += [found.yes, found.no]
        elif not (isinstance(found, Constant) and dag.types[at] is Kind.NUMBER and _is_one_or_zero(found.value)):
            return False
    return True


def _is_one_or_zero(value: Value) -> bool:
    return value.numbers.size == 1 and value.numbers.item() in (0.0, 1.0)
