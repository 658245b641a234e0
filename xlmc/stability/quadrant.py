"""An angle from `ATAN(y/x)`: half a turn wrong wherever x is negative."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from xlmc.address import Cell
from xlmc.compile.dag import Apply
from xlmc.formula import ir
from xlmc.stability.case import Bools, Case
from xlmc.stability.findings import Finding, Level
from xlmc.stability.rewriting import with_quadrant

__all__ = ["lost_quadrants"]


def lost_quadrants(case: Case) -> Iterator[Finding]:
    """The cells that take the arctangent of a quotient whose divisor is negative in some trials.

    A formula that looks at the sign of the divisor is taken to mind the quadrant itself. So is one that only takes the
    tangent, sine or cosine of half of what it should be: there is no telling.
    """
    for cell in case.cells:
        for part in case.trees.parts(cell):
            if isinstance(part, ir.Call) and part.name == "ATAN" and len(part.arguments) == 1:
                ratio = part.arguments[0]
                if isinstance(ratio, ir.Binary) and ratio.operator == "/":
                    yield from _finding(case, cell, part, ratio)


def _finding(case: Case, cell: Cell, part: ir.Call, ratio: ir.Binary) -> Iterator[Finding]:
    place = case.trees.place(ratio.right, cell)
    if place is None or place not in case.values or _is_asked_about(case, place):
        return
    x = case.number(place)
    negative: Bools = np.asarray(x < 0)
    if not negative.any():
        return
    accepted = negative[case.first_accepted :]
    among = accepted if accepted.any() else negative
    share = float(among.mean())
    tree = case.lowering.graph.formulas[cell]
    divisor = case.trees.text(ratio.right, cell)
    trials = "accepted trials" if accepted.any() else "trials drawn, none of them accepted"
    how_many = f"in every one of the {trials}" if share == 1.0 else f"in {share:.1%} of the {trials}"
    half = "180°" if any(isinstance(one, ir.Call) and one.name == "DEGREES" for one in case.trees.parts(cell)) else "π"
    yield Finding(
        Level.WRONG if accepted.any() else Level.DOUBTFUL,
        "quadrant",
        cell,
        case.trees.title(cell),
        case.trees.written(cell),
        f"{case.trees.text(part, cell)} loses the quadrant: as the direction of a vector it is {half} off wherever "
        f"{divisor} is negative",
        f"{how_many} {divisor} is negative: there the direction is wrong by {half}, and no error is shown",
        () if share == 1.0 else case.where(negative),
        f"={case.trees.text(with_quadrant(tree, part), cell)}",
        (180.0 if half == "180°" else np.pi) * share / case.scale(cell),
    )


def _is_asked_about(case: Case, place: int) -> bool:
    """Whether some formula compares the divisor with something."""
    nodes = (case.dag.nodes[one] for one in case.places)
    return any(
        isinstance(node, Apply) and node.function.name in ("<", "<=", ">", ">=", "SIGN") and place in node.arguments
        for node in nodes
    )
