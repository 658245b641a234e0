"""Filled-down formulas: lowered once, then made again for each cell from the nodes that the cell reads.

How a formula is lowered depends on what it reads only through the constants among its nodes and the types of the
others. Two cells of one stencil that agree in these get nodes of the same pattern.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.engine.graph.choices import CHOICES
from xlmc.engine.graph.graph import Dag, Repeat
from xlmc.engine.graph.lambdas import LAMBDAS
from xlmc.engine.graph.nodes import Apply, Constant, IfErrorNode, Node, Range, Select, uses
from xlmc.engine.graph.reference_functions import REFERENCE_FUNCTIONS
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import Stencil, ir
from xlmc.excel.functions.families import function_named

__all__ = ["FillDownCache"]

_Marks = tuple[object, ...]
"""What decides how a formula is lowered: of each node it reads the constant, or the type."""


@dataclass(frozen=True, slots=True)
class _Pattern:
    """The nodes to make; their slots count the nodes that the cell reads, then `constants`, then earlier steps.

    Attributes:
        folds: of nodes, those that stand for them on the fast path; see `Dag.folded`.
    """

    constants: tuple[int, ...]
    steps: tuple[Repeat, ...]
    result: int
    folds: tuple[tuple[int, int], ...]


class FillDownCache:
    """The patterns of nodes that filled-down formulas are known to get."""

    def __init__(self, dag: Dag) -> None:
        self._dag = dag
        self._known: dict[Stencil, dict[_Marks, _Pattern | None] | None] = {}

    def lower(self, stencil: Stencil, leaves: Sequence[int], lower: Callable[[], int]) -> int:
        """Return the node of a stencil's formula in one cell.

        Args:
            stencil: of the formula.
            leaves: the nodes of the cells it reads, in the order of `Stencil.cells`.
            lower: lowers it the long way.
        """
        patterns = self._known.get(stencil, _UNSEEN)
        if patterns is _UNSEEN:
            self._known[stencil] = patterns = {} if _is_repeatable(stencil.tree) else None
        if patterns is None:
            return lower()
        nodes, types = self._dag.nodes, self._dag.types
        marks = tuple([leaf if type(nodes[leaf]) is Constant else types[leaf] for leaf in leaves])
        if marks in patterns:
            pattern = patterns[marks]
            return lower() if pattern is None else self._follow(pattern, leaves)
        if any(self._dag.sizes[leaf] is not None for leaf in leaves):
            patterns[marks] = None
            return lower()
        node, pattern = self._record(leaves, lower)
        if pattern is not None:
            patterns[marks] = pattern
        return node

    def _follow(self, pattern: _Pattern, leaves: Sequence[int]) -> int:
        local = [*leaves, *pattern.constants]
        self._dag.replay(pattern.steps, local)
        for node, fold in pattern.folds:
            if local[fold] < local[node]:  # else the node was there before
                self._dag.folded.setdefault(local[node], local[fold])
        return local[pattern.result]

    def _record(self, leaves: Sequence[int], lower: Callable[[], int]) -> tuple[int, _Pattern | None]:
        """Return the node, and the pattern of its nodes; None if this cell does not show a pattern."""
        dag = self._dag
        made: list[int] = []
        dag.recording = made
        try:
            node_id = lower()
        finally:
            dag.recording = None
        steps = list(dict.fromkeys(made))
        varying = [leaf for leaf in leaves if not isinstance(dag.nodes[leaf], Constant)]
        if len(set(varying)) < len(varying) or not set(varying).isdisjoint(steps):
            return node_id, None  # two things that are one here need not be one elsewhere
        own = {*leaves, *steps}
        folds = [(step, dag.folded[step]) for step in steps if step in dag.folded]
        used_by_steps = [used for step in steps for used in uses(dag.nodes[step])]
        read = dict.fromkeys(used for used in (*used_by_steps, *(fold for _, fold in folds)) if used not in own)
        known = {node: slot for slot, node in enumerate((*leaves, *read, *steps))}
        if isinstance(dag.nodes[node_id], Constant) or node_id not in known:
            return node_id, None  # folded, or Excel's own value stands in
        if not all(isinstance(dag.nodes[node], Constant) for node in read):
            return node_id, None
        repeats = tuple(self._repeat(step, known) for step in steps)
        slots = tuple((known[step], known[fold]) for step, fold in folds)
        return node_id, _Pattern(tuple(read), repeats, known[node_id], slots)

    def _repeat(self, node_id: int, known: dict[int, int]) -> Repeat:
        node, kind, size = self._dag.nodes[node_id], self._dag.types[node_id], self._dag.sizes[node_id]
        function = node.function if isinstance(node, Apply) else None
        return Repeat(_maker(node), function, tuple(known[used] for used in uses(node)), kind, size)


_UNSEEN: Final[dict[_Marks, _Pattern | None]] = {}


def _maker(node: Node) -> Callable[[tuple[int, ...]], Node]:
    """Return what makes nodes like this one from what they use."""
    match node:
        case Apply(function):
            return lambda used: Apply(function, used)
        case Select():
            return lambda used: Select(*used)
        case IfErrorNode(_, _, only_na):
            return lambda used: IfErrorNode(used[0], used[1], only_na)
        case Range(rows):
            width = len(rows[0])
            return lambda used: Range(tuple(used[i : i + width] for i in range(0, len(used), width)))
        case _:
            raise TypeError(f"{node} is not made of nodes")


_ASKING: Final = {*REFERENCE_FUNCTIONS, *LAMBDAS, "SINGLE"}
"""Functions whose result depends on the cell that they stand in, or on more of a cell than its value."""


def _is_repeatable(tree: ir.Expression) -> bool:
    """Whether the nodes that the tree reads decide alone how it is lowered."""
    match tree:
        case Cell() | ir.Number() | ir.Text() | ir.Logical() | ir.Missing() | ir.ErrorLiteral():
            return True
        case ir.Unary(_, operand):
            return _is_repeatable(operand)
        case ir.Binary(operator) if operator not in (":", " ", ","):
            first, rest = ir.chain(tree)
            return _is_repeatable(first) and all(_is_repeatable(part) for _, part in rest)
        case ir.Call(name, arguments) if name in CHOICES and name not in _ASKING:
            return all(_is_repeatable(part) for part in arguments)
        case ir.Call(name, arguments) if name not in _ASKING:
            function = function_named(name)
            if function is None or function.volatile or not arguments or len(arguments) > function.arity()[1]:
                return False
            ranged = [function.parameter(i).ranged for i in range(len(arguments))]
            pairs = zip(arguments, ranged, strict=True)
            return all((takes and isinstance(part, Area)) or _is_repeatable(part) for part, takes in pairs)
        case _:
            return False
