"""Filled-down formulas: lowered once, then made again for each cell from the nodes that the cell reads.

How a formula is lowered depends on what it reads only through the constants among its nodes and the types of the
others. Two cells of one stencil that agree in these get nodes of the same pattern: a recipe.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.address import Area, Cell
from xlmc.evaluation.graph.choices import CHOICES
from xlmc.evaluation.graph.dag import Apply, Constant, Dag, Node, Range, Repeat, Rescue, Select, uses
from xlmc.evaluation.graph.lambdas import LAMBDAS
from xlmc.evaluation.graph.places import PLACES
from xlmc.formula import Stencil, ir
from xlmc.functions.families import function_named

__all__ = ["Recipes"]

_Marks = tuple[object, ...]
"""What decides how a formula is lowered: of each node it reads the constant's place, or the type."""


@dataclass(frozen=True, slots=True)
class _Recipe:
    """The nodes to make; their slots count the nodes that the cell reads, then `constants`, then earlier steps."""

    constants: tuple[int, ...]
    steps: tuple[Repeat, ...]
    result: int


class Recipes:
    """The recipes known so far of a graph of nodes."""

    def __init__(self, dag: Dag) -> None:
        self._dag = dag
        self._known: dict[Stencil, dict[_Marks, _Recipe | None] | None] = {}

    def lowered(self, stencil: Stencil, leaves: Sequence[int], lower: Callable[[], int]) -> int:
        """The node of a stencil's formula in one cell.

        Args:
            stencil: of the formula.
            leaves: the nodes of the cells it reads, in the order of `Stencil.cells`.
            lower: lowers it the long way.
        """
        recipes = self._known.get(stencil, _UNSEEN)
        if recipes is _UNSEEN:
            self._known[stencil] = recipes = {} if _is_repeatable(stencil.tree) else None
        if recipes is None:
            return lower()
        nodes, types = self._dag.nodes, self._dag.types
        marks = tuple([leaf if type(nodes[leaf]) is Constant else types[leaf] for leaf in leaves])
        if marks in recipes:
            recipe = recipes[marks]
            return lower() if recipe is None else self._follow(recipe, leaves)
        if any(self._dag.sizes[leaf] is not None for leaf in leaves):
            recipes[marks] = None
            return lower()
        place, recipe = self._noted(leaves, lower)
        if recipe is not None:
            recipes[marks] = recipe
        return place

    def _follow(self, recipe: _Recipe, leaves: Sequence[int]) -> int:
        local = [*leaves, *recipe.constants]
        self._dag.again(recipe.steps, local)
        return local[recipe.result]

    def _noted(self, leaves: Sequence[int], lower: Callable[[], int]) -> tuple[int, _Recipe | None]:
        """The node, and how it came about; None where this cell does not tell."""
        dag = self._dag
        made: list[int] = []
        dag.made = made
        try:
            place = lower()
        finally:
            dag.made = None
        steps = list(dict.fromkeys(made))
        varying = [leaf for leaf in leaves if not isinstance(dag.nodes[leaf], Constant)]
        if len(set(varying)) < len(varying) or not set(varying).isdisjoint(steps):
            return place, None  # two things that are one here need not be one elsewhere
        own = {*leaves, *steps}
        read = dict.fromkeys(used for step in steps for used in uses(dag.nodes[step]) if used not in own)
        known = {node: slot for slot, node in enumerate((*leaves, *read, *steps))}
        if isinstance(dag.nodes[place], Constant) or place not in known:
            return place, None  # folded, or Excel's own value stands in
        if not all(isinstance(dag.nodes[node], Constant) for node in read):
            return place, None
        repeats = tuple(self._repeat(step, known) for step in steps)
        return place, _Recipe(tuple(read), repeats, known[place])

    def _repeat(self, place: int, known: dict[int, int]) -> Repeat:
        node, kind, size = self._dag.nodes[place], self._dag.types[place], self._dag.sizes[place]
        function = node.function if isinstance(node, Apply) else None
        return Repeat(_maker(node), function, tuple(known[used] for used in uses(node)), kind, size)


_UNSEEN: Final[dict[_Marks, _Recipe | None]] = {}


def _maker(node: Node) -> Callable[[tuple[int, ...]], Node]:
    """Makes nodes like this one from what they use."""
    match node:
        case Apply(function):
            return lambda used: Apply(function, used)
        case Select():
            return lambda used: Select(*used)
        case Rescue(_, _, only_na):
            return lambda used: Rescue(used[0], used[1], only_na)
        case Range(rows):
            width = len(rows[0])
            return lambda used: Range(tuple(used[i : i + width] for i in range(0, len(used), width)))
        case _:
            raise TypeError(f"{node} is not made of nodes")


_ASKING: Final = {*PLACES, *LAMBDAS, "SINGLE"}
"""Functions that mind which cell they stand in, or what else a cell holds than its value."""


def _is_repeatable(tree: ir.Expression) -> bool:
    """Whether how the tree is lowered depends on the nodes that it reads alone."""
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
