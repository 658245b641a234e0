"""Which operation of a formula loses the digits: a division by something near 0, or a difference of near equals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from xlmc.address import Cell
from xlmc.formula import ir
from xlmc.functions.families import function_named
from xlmc.studies.stability.case import Case
from xlmc.studies.stability.trees import factors, terms

__all__ = ["Cancellation", "Division", "cancellation", "divisions", "left_of"]


@dataclass(frozen=True, slots=True)
class Division:
    """A division in a formula by a product of which one factor comes near 0.

    Attributes:
        tree: the quotient.
        factor: below the line.
        place: of the factor.
        least: how small it gets, as a share of the size it usually has, or could have.
        crosses: whether it has either sign among the trials.
    """

    tree: ir.Expression
    factor: ir.Expression
    place: int
    least: float
    crosses: bool


@dataclass(frozen=True, slots=True)
class Cancellation:
    """A sum in a formula that is small beside its terms.

    Attributes:
        tree: the sum.
        left: what is left of its terms in a trial, as a share of them.
    """

    tree: ir.Expression
    left: float


def divisions(case: Case, cell: Cell) -> list[Division]:
    """The divisions of a cell's formula by what varies, the smallest divisor first."""
    found = []
    for tree in case.trees.parts(cell):
        if isinstance(tree, ir.Binary) and tree.operator == "/":
            for factor in factors(tree.right)[0]:
                one = _division(case, cell, tree, factor)
                if one is not None:
                    found.append(one)
    return sorted(found, key=lambda division: division.least)


def _division(case: Case, cell: Cell, tree: ir.Expression, factor: ir.Expression) -> Division | None:
    place = case.trees.place(factor, cell)
    if place is None or place not in case.values or isinstance(factor, ir.Number):
        return None
    values = case.number(place)
    values = values[np.isfinite(values)]
    if not values.size:
        return None
    size = 1.0 if _is_bounded(factor) else float(np.median(np.abs(values))) or float(np.abs(values).max())
    least = float(np.abs(values).min()) / size if size else 0.0
    return Division(tree, factor, place, least, bool(values.min() < 0 < values.max()))


def _is_bounded(tree: ir.Expression) -> bool:
    """Whether it is a sine or its like, which could be as large as 1."""
    row = function_named(tree.name) if isinstance(tree, ir.Call) else None
    return row is not None and row.facts.between == (-1.0, 1.0)


def cancellation(case: Case, cell: Cell, trial: int) -> Cancellation | None:
    """The sum of a cell's formula of which least is left in a trial."""
    found = [
        Cancellation(tree, left_of(case, cell, tree, trial))
        for tree in case.trees.parts(cell)
        if isinstance(tree, ir.Binary) and tree.operator in "+-" and not _is_given(case, tree)
    ]
    return min(found, key=lambda one: one.left, default=None)


def _is_given(case: Case, tree: ir.Expression) -> bool:
    """Whether all terms are assumptions and typed numbers, so that none of them has an error to hand on."""
    inputs = case.lowering.inputs
    return all(isinstance(term, ir.Number) or (isinstance(term, Cell) and term in inputs) for _, term in terms(tree))


def left_of(case: Case, cell: Cell, tree: ir.Expression, trial: int) -> float:
    """What is left of a sum in a trial, as a share of its terms; 1 where it has none."""
    size = sum(_size(case, cell, term, trial) for _, term in terms(tree))
    return _size(case, cell, tree, trial) / size if size > 0 else 1.0


def _size(case: Case, cell: Cell, tree: ir.Expression, trial: int) -> float:
    place = case.trees.place(tree, cell)
    if place is None or place not in case.values:
        return 0.0
    size = abs(float(case.number(place)[trial]))
    return size if np.isfinite(size) else 0.0
