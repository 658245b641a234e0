"""Functions whose argument leaves their domain in some trials, or comes close to its edge: roots, powers, overflows."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.analysis.studies.stability.case import Bools, Case, Floats
from xlmc.analysis.studies.stability.digit_findings import Finding, Level
from xlmc.analysis.studies.stability.formula_trees import terms
from xlmc.engine.graph.nodes import Constant
from xlmc.engine.passes.random_rounding import numbers_of
from xlmc.excel.address import Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions.facts import Domain
from xlmc.excel.functions.families import function_named
from xlmc.montecarlo.number_text import number_text, styled_text

__all__ = ["domain_edges"]

_CLOSE: Final = 1e-3
"""A share of the spread of the argument: an argument that comes nearer to the edge is reported."""

_LARGEST: Final = math.log(np.finfo(np.float64).max)
"""The exponent of e beyond which there is no number: 709.78."""

_HYPERBOLIC: Final = _LARGEST + math.log(2.0)

_OVERFLOWS: Final = {
    "EXP": Domain(-math.inf, _LARGEST),
    "SINH": Domain(-_HYPERBOLIC, _HYPERBOLIC),
    "COSH": Domain(-_HYPERBOLIC, _HYPERBOLIC),
}
"""Functions whose value is too large for a number beyond an end."""


@dataclass(frozen=True, slots=True, eq=False)
class _Edge:
    """An argument and the domain that it should stay in.

    Attributes:
        function: what a person calls it.
        argument: a part of the formula; `node` is its node.
        matters: `(n,)` trials in which the domain holds: those with a broken exponent, of a power.
    """

    function: str
    argument: ir.Expression
    node: int
    domain: Domain
    matters: Bools


def domain_edges(case: Case) -> Iterator[Finding]:
    """Return the functions whose argument leaves their domain in some trials, or comes close to its edge."""
    for cell in case.cells:
        for part in case.trees.parts(cell):
            edge = _edge(case, cell, part)
            finding = None if edge is None else _edge_finding(case, cell, edge)
            if finding is not None:
                yield finding


def _edge(case: Case, cell: Cell, part: ir.Expression) -> _Edge | None:
    """Return the domain of a part of a formula; None if it takes any number."""
    every = np.ones(case.n, bool)
    match part:
        case ir.Binary("^", base, exponent):
            return _of_power(case, cell, "a power with a broken exponent", base, exponent)
        case ir.Call("POWER", (base, exponent)):
            return _of_power(case, cell, "POWER with a broken exponent", base, exponent)
        case ir.Call(name, arguments) if arguments and not _is_of_squares(arguments[0]):
            row = function_named(name)
            domain = _OVERFLOWS.get(name) or (None if row is None else row.facts.domain)
            node = None if domain is None else case.trees.node_of(arguments[0], cell)
            if domain is not None and node in case.values:
                return _Edge(name, arguments[0], node, domain, every)
    return None


def _of_power(case: Case, cell: Cell, name: str, base: ir.Expression, exponent: ir.Expression) -> _Edge | None:
    """Return the domain of the base of a power: 0 and above in the trials whose exponent is no whole number."""
    node, powers = case.trees.node_of(base, cell), _numbers(case, cell, exponent)
    if node not in case.values or powers is None or _is_of_squares(base):
        return None
    broken = np.isfinite(powers) & (powers != np.rint(powers))
    return _Edge(name, base, node, Domain(0.0), np.asarray(broken)) if broken.any() else None


def _numbers(case: Case, cell: Cell, tree: ir.Expression) -> Floats | None:
    """Return the numbers of a part of a formula, `(n,)`; None if it has none."""
    node = case.trees.node_of(tree, cell)
    if node is None:
        return None
    formula = case.dag.nodes[node]
    if isinstance(formula, Constant):
        return np.broadcast_to(numbers_of(formula.value, case.n), (case.n,))
    return case.number(node) if node in case.values else None


def _is_of_squares(argument: ir.Expression) -> bool:
    """Whether it is a sum of squares, which cannot be negative."""
    return all(
        sign > 0 and isinstance(term, ir.Binary) and (term.operator == "^" and term.right == ir.Number(2.0))
        for sign, term in terms(argument)
    )


def _edge_finding(case: Case, cell: Cell, edge: _Edge) -> Finding | None:
    low, high, every = edge.domain.low, edge.domain.high, case.number(edge.node)
    drawn = edge.matters & np.isfinite(every)
    drawn[: case.special] = False
    x = every[drawn]
    if not x.size or x.min() == x.max():
        return None
    outside = edge.matters & ((every < low) | (every > high))
    argument = case.trees.text(edge.argument, cell)
    takes = f"{edge.function} takes {_in_words(edge.domain)}, and {argument}"
    share = float(outside[case.special :].mean())
    if share:
        what, effect = (
            f"{takes} goes to {number_text(_extreme(x, low, high), 4)}",
            f"the cell is an error in {styled_text(share, '.2%')} of the trials",
        )
        return _finding(case, cell, edge, Level.DOUBTFUL, what, effect, outside, share)
    distance = np.minimum(x - low, high - x)
    spread = float(x.max() - x.min())
    if distance.min() > _CLOSE * spread or edge.function in _OVERFLOWS:
        return None
    near = edge.matters & (np.minimum(every - low, high - every) <= 10 * _CLOSE * spread)
    what = f"{takes} comes as near as {number_text(distance.min(), 2)} to that edge"
    effect = "close to it the function is steep, and a trial beyond it is an error"
    return _finding(case, cell, edge, Level.NOTE, what, effect, near, float(distance.min() / spread))


def _in_words(domain: Domain) -> str:
    """`0 or more`, `above 0`, `-1 to 1`, `709.8 or less`."""
    if math.isinf(domain.low):
        return f"{number_text(domain.high, 4)} or less"
    if not domain.with_ends:
        return f"above {number_text(domain.low)}"
    return (
        f"{number_text(domain.low)} or more"
        if math.isinf(domain.high)
        else f"{number_text(domain.low, 4)} to {number_text(domain.high, 4)}"
    )


def _finding(
    case: Case, cell: Cell, edge: _Edge, level: Level, what: str, effect: str, where: Bools, size: float
) -> Finding:
    title, formula = case.trees.title(cell), case.trees.written_formula(cell)
    ranges = case.where(np.asarray(where), edge.node)
    return Finding(level, "edge", cell, title, formula, what, effect, ranges, None, size)


def _extreme(x: Floats, low: float, high: float) -> float:
    return float(x.min() if low - x.min() > x.max() - high else x.max())
