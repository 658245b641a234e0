"""What a tree computes of whole columns cell by cell, found and changed: the ranges that are exposed in it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from xlmc.address import Area, Cell
from xlmc.evaluation.graph.choices import CHOICES
from xlmc.evaluation.graph.counts import check_count
from xlmc.evaluation.graph.references import REFERENCES, NoReference, areas_of
from xlmc.evaluation.graph.row_numbers import is_numbered
from xlmc.evaluation.graph.scope import Scope
from xlmc.formula import ir
from xlmc.functions import Function
from xlmc.functions.families import function_named
from xlmc.functions.registry import Ranges

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["Change", "exposed", "holds", "is_spared", "referred_areas"]

Change = Callable[[Area], Area]
"""What stands in the place of a range that is cut."""


def referred_areas(lowering: Lowering, tree: ir.Expression, scope: Scope) -> list[Area] | None:
    """What a tree refers to; None where it is no reference, or one that cannot be worked out."""
    if not isinstance(tree, Cell | Area | ir.Binary | ir.Call | ir.Variable):
        return None
    if isinstance(tree, ir.Call) and tree.name in CHOICES:
        check_count(tree.name, tree.arguments)
        if scope.of_array and holds(lowering, tree.arguments[0], scope):
            return None  # a condition of many cells
    try:
        return areas_of(lowering, tree, scope)
    except NoReference:
        return None


def holds(lowering: Lowering, tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree computes something of ranges that are cut, cell by cell."""
    found: list[Area] = []

    def note(area: Area) -> Area:
        found.append(area)
        return area

    exposed(lowering, tree, scope, note)
    return bool(found)


def exposed(lowering: Lowering, tree: ir.Expression, scope: Scope, change: Change) -> ir.Expression:
    """The tree with every cut range that it takes cell by cell changed."""
    match tree:
        case Area():
            return change(tree) if tree.is_cut else tree
        case ir.Unary(_, operand):
            return replace(tree, operand=exposed(lowering, operand, scope, change))
        case ir.Binary(operator) if operator not in (",", ":", " "):
            first, rest = ir.chain(tree)
            built = exposed(lowering, first, scope, change)
            for step, right in rest:
                built = ir.Binary(step, built, exposed(lowering, right, scope, change))
            return ir.marked_as(built, tree)
        case ir.Call(name, arguments) if name in CHOICES and scope.of_array:
            return ir.Call(name, tuple(exposed(lowering, part, scope, change) for part in arguments))
        case ir.Call(name, (test, *branches)) if name in CHOICES:
            return ir.Call(name, (test, *(_exposed_branch(lowering, part, scope, change) for part in branches)))
        case ir.Call(name, (Area() as area,)) if is_numbered(tree):
            return ir.Call(name, (change(area),))
        case ir.Call("INDEX", (computed, ir.Number(0.0), *rest)) if referred_areas(lowering, computed, scope) is None:
            return ir.Call("INDEX", (exposed(lowering, computed, scope.over_arrays(), change), ir.Number(0.0), *rest))
        case ir.Call(name) if name in REFERENCES:
            return _referred(lowering, tree, scope, change)
        case ir.Binary() | ir.Variable():
            return _referred(lowering, tree, scope, change)
        case ir.Call(name, arguments) if (function := function_named(name)) is not None and arguments:
            check_count(name, arguments)
            spared = [is_spared(function, i, scope) or _is_refused(function, i, a) for i, a in enumerate(arguments)]
            parts = zip(arguments, spared, strict=True)
            made = tuple(part if kept else exposed(lowering, part, scope, change) for part, kept in parts)
            return ir.Call(name, made)
        case _:
            return tree


def _exposed_branch(lowering: Lowering, tree: ir.Expression, scope: Scope, change: Change) -> ir.Expression:
    """A branch in a plain formula: a range goes on whole, what is computed takes the cell of a range beside it."""
    goes_on = isinstance(tree, Area | ir.Variable) or (isinstance(tree, ir.Call) and tree.name in CHOICES)
    return exposed(lowering, tree, scope, change) if goes_on else tree


def is_spared(function: Function, position: int, scope: Scope) -> bool:
    """Whether an argument takes a range whole, or the cell of a range beside the formula, rather than cell by cell."""
    if not function.parameters:
        return True
    parameter = function.parameter(position)
    beside = parameter.ranges in (Ranges.BESIDE, Ranges.SINGLE) and not scope.of_array
    return parameter.ranged or beside


def _is_refused(function: Function, position: int, tree: ir.Expression) -> bool:
    """Whether an argument is a range where one cell is wanted."""
    ranged = isinstance(tree, Area) and bool(function.parameters)
    return ranged and function.parameter(position).ranges is Ranges.ONE_CELL


def _referred(lowering: Lowering, tree: ir.Expression, scope: Scope, change: Change) -> ir.Expression:
    areas = referred_areas(lowering, tree, scope)
    return change(areas[0]) if areas is not None and len(areas) == 1 and areas[0].is_cut else tree
