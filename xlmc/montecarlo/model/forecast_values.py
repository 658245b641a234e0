"""Tell which forecasts give texts, and which two values only."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.engine.engine import TEXT_RESULT, Column
from xlmc.engine.graph.graph import Dag
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Select, uses
from xlmc.excel.functions import Kind
from xlmc.excel.functions.values import BLANK, ERROR, LOGICAL, NUMBER, Value

__all__ = ["are_texts", "is_two_valued"]

_KEEP_ONE_AND_ZERO: Final = frozenset({"shown", "u+", "*", "PRODUCT", "MIN", "MAX", "N", "ABS", "INT", "SIGN"})
"""Functions that give 1 or 0 where all their arguments are 1, 0, TRUE or FALSE."""


def are_texts(column: Column) -> bool:
    """Whether there are texts that say something, and no numbers."""
    if column.codes is None or column.texts is None:
        return False
    texts = column.texts[column.codes == TEXT_RESULT]
    return bool(np.all(column.codes > 0)) and any(texts)


def is_two_valued(dag: Dag, node: int) -> bool:
    """Return whether a node gives TRUE and FALSE, or 1 and 0, and nothing else but errors.

    It is a logical; or what `IF`, `CHOOSE` or `IFERROR` choose from there are logicals, constants 1 and 0, and blanks;
    or it is made of such by a function that leaves 1 and 0 as they are, such as `(A1>0)*(B1<1)` and `--(A1>0)`.

    A number that is known before the run, such as a speed that is frozen at 0, is neither.
    """
    if isinstance(dag.nodes[node], Constant) and dag.types[node] is not Kind.LOGICAL:
        return False
    seen, waiting = set[int](), [node]
    while waiting:
        at = waiting.pop()
        if at in seen or dag.types[at] is Kind.LOGICAL:
            continue
        seen.add(at)
        match dag.nodes[at]:
            case Select(_, first, other) | IfErrorNode(first, other):
                waiting += (first, other)
            case Apply(function, arguments) if function.name in _KEEP_ONE_AND_ZERO:
                waiting += arguments
            case Apply(outer, (inside,)) if outer.name == "u-" and _is_negated(dag, inside):
                waiting += uses(dag.nodes[inside])
            case Constant(value) if _is_one_zero_or_error(value):
                pass
            case _:
                return False
    return True


def _is_negated(dag: Dag, node: int) -> bool:
    result = dag.nodes[node]
    return isinstance(result, Apply) and result.function.name == "u-"


def _is_one_zero_or_error(value: Value) -> bool:
    if value.numbers.size != 1:
        return False
    kind = value.kinds.item()
    return kind >= ERROR or (kind in (NUMBER, LOGICAL, BLANK) and value.numbers.item() in (0.0, 1.0))
