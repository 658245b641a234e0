"""An angle from `ATAN(y/x)`: half a turn wrong wherever x is negative."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from xlmc.address import Cell
from xlmc.formula import ir
from xlmc.studies.stability.case import Bools, Case
from xlmc.studies.stability.findings import Finding, Level
from xlmc.studies.stability.guards import guards
from xlmc.studies.stability.momentum import times
from xlmc.studies.stability.rewriting import with_quadrant
from xlmc.studies.stability.trees import factors

__all__ = ["Arctangent", "arctangents", "lost_quadrants"]


@dataclass(frozen=True, slots=True)
class Arctangent:
    """The arctangent of a quotient in a cell's formula.

    Attributes:
        tree: the call of ATAN.
        above, below: the quotient's two parts.
        place, divisor: the nodes of the call and of what stands below the line.
    """

    tree: ir.Call
    above: ir.Expression
    below: ir.Expression
    place: int
    divisor: int


def arctangents(case: Case, cell: Cell) -> Iterator[Arctangent]:
    """The arctangents of quotients in a cell's formula, each once; the quotient may stand in a cell of its own."""
    seen: set[int] = set()
    for part in case.trees.parts(cell):
        if isinstance(part, ir.Call) and part.name == "ATAN" and len(part.arguments) == 1:
            ratio = _quotient(case, part.arguments[0])
            place = case.trees.place(part, cell)
            if ratio is not None and place is not None and place in case.values and place not in seen:
                seen.add(place)
                above, below = ratio
                divisor = case.trees.place(below, cell)
                if divisor is not None and divisor in case.values:
                    yield Arctangent(part, above, below, place, divisor)


def _quotient(case: Case, tree: ir.Expression) -> tuple[ir.Expression, ir.Expression] | None:
    """What stands above and below the line, if there is one below it; None for anything else."""
    while isinstance(tree, Cell) and tree not in case.lowering.inputs:
        if tree not in case.lowering.graph.formulas:
            return None
        tree = case.trees.formula(tree)
    if isinstance(tree, ir.Binary) and tree.operator == "/":
        return tree.left, tree.right
    above, below = factors(tree)
    return (times(*above), below[0]) if len(below) == 1 and above else None


def lost_quadrants(case: Case) -> Iterator[Finding]:
    """The cells that take the arctangent of a quotient whose divisor is negative in some trials.

    Formulas that put it right where the divisor is negative have nothing to mind; see `guards`. So have those that only
    take the tangent of it. One that takes an angle that should be half of what it is cannot be told from others.
    """
    for cell in case.cells:
        for found in arctangents(case, cell):
            negative: Bools = np.asarray(case.number(found.divisor) < 0)
            if negative.any() and case.node[cell] in guards(case, found.place, found.divisor).lost:
                yield _finding(case, cell, found, negative)


def _finding(case: Case, cell: Cell, found: Arctangent, negative: Bools) -> Finding:
    accepted = negative[case.first_accepted :]
    among = accepted if accepted.any() else negative
    share = float(among.mean())
    tree = case.trees.formula(cell)
    divisor = case.trees.text(found.below, cell)
    trials = "accepted trials" if accepted.any() else "trials drawn, none of them accepted"
    how_many = f"in every one of the {trials}" if share == 1.0 else f"in {share:.1%} of the {trials}"
    half = "180°" if any(isinstance(one, ir.Call) and one.name == "DEGREES" for one in case.trees.parts(cell)) else "π"
    better = with_quadrant(tree, found.tree, found.above, found.below)
    return Finding(
        Level.WRONG if accepted.any() else Level.DOUBTFUL,
        "quadrant",
        cell,
        case.trees.title(cell),
        case.trees.written(cell),
        f"{case.trees.text(found.tree, cell)} loses the quadrant: as the direction of a vector it is {half} off "
        f"wherever {divisor} is negative",
        f"{how_many} {divisor} is negative: there the direction is wrong by {half}, and no error is shown",
        () if share == 1.0 else case.where(negative, found.divisor),
        case.trees.offered(better, cell),
        (180.0 if half == "180°" else np.pi) * share / case.scale(cell),
    )
