"""Loops of one shape: those that differ in their arrays and their constants alone, which one native code serves.

On a sheet that steps through time the nodes repeat themselves, row after row. They are cut where they do, so that the
loops of all rows are of one shape, and compiling takes no longer however many rows there are.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.llvm.loop_rules import LoopRule, Operand, is_number
from xlmc.excel.functions import Kind

__all__ = ["LONGEST", "Forms", "cut"]

LONGEST: Final = 250
"""The most nodes of one loop; the time to compile grows faster than the loop."""

_FEWEST: Final = 4
"""Periods that are worth looking for."""

_ROWS: Final = 150
"""The most nodes of a part that has several rows: a longer part takes longer to compile, and runs no faster."""

_TRIED: Final = 3
"""The most frequent gaps between nodes that are alike: one of them is the period, where there is one."""


class Forms:
    """Numbers nodes by what native code does for them.

    Nodes have one number where it does the same but for constants, and reads what lies as many nodes back; or anything
    that lies too far back to be in the same loop.

    Args:
        rules: of the nodes.
        types: what each node gives.
    """

    def __init__(self, rules: Mapping[int, LoopRule], types: Sequence[Kind]) -> None:
        self._rules, self._types = rules, types
        self._known: dict[object, int] = {}

    def of(self, nodes: Sequence[int]) -> tuple[int, ...]:
        """Give the nodes that are computed in this order their numbers."""
        at: dict[int, int] = {}
        result: list[int] = []
        for position, node in enumerate(nodes):
            at[node] = position
            rule = self._rules[node]
            form: list[object] = [rule.emit, rule.makes, rule.absorbs, self._types[node], len(rule.operands)]
            for part in (*rule.operands, *rule.beside):
                if type(part) is Operand:
                    distance = position - at.get(part.node, -LONGEST)
                    form += part.kind, distance if distance < LONGEST else 0
                else:
                    form.append(None if is_number(part) else part)
            result.append(self._known.setdefault(tuple(form), len(self._known)))
        return tuple(result)


def cut(forms: Sequence[int]) -> list[slice]:
    """Nodes of these forms in parts of at most LONGEST; where they repeat themselves, the parts do, too."""
    if len(forms) <= LONGEST:
        return [slice(0, len(forms))]
    start, period, end = _repetition(np.array(forms))
    if not period:
        return _portions(0, len(forms))
    size = max(1, _ROWS // period) * period
    rows = [(at, min(at + size, end)) for at in range(start, end, size)]
    portions = [(0, start), *rows, (end, len(forms))]
    return [portion for first, stop in portions for portion in _portions(first, stop)]


def _portions(first: int, stop: int) -> list[slice]:
    return [slice(at, min(at + LONGEST, stop)) for at in range(first, stop, LONGEST)]


def _repetition(forms: NDArray[np.intp]) -> tuple[int, int, int]:
    """Find the longest repetition of forms: its first node, the length of a period, and the node after its last. The
    period is 0 where they do not repeat themselves, or not often.
    """
    last: dict[int, int] = {}
    gaps: Counter[int] = Counter()
    for position, form in enumerate(forms.tolist()):
        gaps[position - last.get(form, position)] += 1
        last[form] = position
    del gaps[0]
    runs = [(*_longest_run(forms, gap), gap) for gap, _ in gaps.most_common(_TRIED)]
    length, start, period = max(runs, default=(0, 0, 0))
    whole = length // period + 1 if period else 0
    return (start, period, start + whole * period) if whole >= _FEWEST else (0, 0, 0)


def _longest_run(alike: NDArray[np.intp], gap: int) -> tuple[int, int]:
    """How many nodes in a row are like the ones so far behind them, and the first of them."""
    same = np.concatenate([[False], alike[:-gap] == alike[gap:], [False]])
    edges = np.flatnonzero(same[1:] != same[:-1]).reshape(-1, 2)
    if not edges.size:
        return 0, 0
    longest = int(np.argmax(edges[:, 1] - edges[:, 0]))
    start, stop = edges[longest].tolist()
    return stop - start, start
