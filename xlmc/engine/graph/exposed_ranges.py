"""Finds and changes the ranges that are exposed in a tree: whole columns of which it computes something cell by cell.

In the further rows, which are empty, only `ROW(A:A)` differs from row to row. A tree that is a constant times ROW plus
a constant there, as `(A:A="x")*ROW(A:A)` is, has its largest and smallest value in the first or the last of these rows,
and its mean is half of the sum of the two.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from xlmc.engine.graph.called_functions import check_count
from xlmc.engine.graph.choices import CHOICES
from xlmc.engine.graph.computed_references import REFERENCES, NoReference, areas_of
from xlmc.engine.graph.scope import Scope, TreeLowering
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions import Function
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.registry import Ranges

__all__ = ["CURVED", "Change", "change_exposed", "degree", "find_areas", "has_exposed", "is_numbered", "is_spared"]

Change = Callable[[Area], Area]
"""Gives what stands for a range that is cut."""

CURVED = 2
"""The degree of a tree that is not the same in each row and does not rise by the same from row to row."""

Taken = Callable[[ir.Call], Sequence[ir.Expression]]
"""The arguments of a call that are taken cell by cell."""


def find_areas(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> list[Area] | None:
    """Return the areas that a tree refers to; None if it is no reference, or one that gives an error."""
    if not isinstance(tree, Cell | Area | ir.Binary | ir.Call | ir.Variable):
        return None
    if isinstance(tree, ir.Call) and tree.name in CHOICES:
        check_count(tree.name, tree.arguments)
        if scope.of_array and has_exposed(lowering, tree.arguments[0], scope):
            return None  # a condition of many cells
    try:
        return areas_of(lowering, tree, scope)
    except NoReference:
        return None


def has_exposed(lowering: TreeLowering, tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree computes something of ranges that are cut, cell by cell."""
    areas: list[Area] = []

    def note(area: Area) -> Area:
        areas.append(area)
        return area

    change_exposed(lowering, tree, scope, note)
    return bool(areas)


def change_exposed(lowering: TreeLowering, tree: ir.Expression, scope: Scope, change: Change) -> ir.Expression:
    """Return the tree with every cut range that it takes cell by cell changed."""
    match tree:
        case Area():
            return change(tree) if tree.is_cut else tree
        case ir.Unary(_, operand):
            return replace(tree, operand=change_exposed(lowering, operand, scope, change))
        case ir.Binary(operator) if operator not in (",", ":", " "):
            first, rest = ir.chain(tree)
            built = change_exposed(lowering, first, scope, change)
            for step, right in rest:
                built = ir.Binary(step, built, change_exposed(lowering, right, scope, change))
            return ir.marked_as(built, tree)
        case ir.Call(name, arguments) if name in CHOICES and scope.of_array:
            return ir.Call(name, tuple(change_exposed(lowering, part, scope, change) for part in arguments))
        case ir.Call(name, (test, *branches)) if name in CHOICES:
            return ir.Call(name, (test, *(_change_branch(lowering, part, scope, change) for part in branches)))
        case ir.Call(name, (Area() as area,)) if is_numbered(tree):
            return ir.Call(name, (change(area),))
        case ir.Call("INDEX", (computed, ir.Number(0.0), *rest)) if find_areas(lowering, computed, scope) is None:
            return ir.Call(
                "INDEX", (change_exposed(lowering, computed, scope.over_arrays(), change), ir.Number(0.0), *rest)
            )
        case ir.Call(name) if name in REFERENCES:
            return _change_referred(lowering, tree, scope, change)
        case ir.Binary() | ir.Variable():
            return _change_referred(lowering, tree, scope, change)
        case ir.Call(name, arguments) if (function := function_named(name)) is not None and arguments:
            check_count(name, arguments)
            spared = [is_spared(function, i, scope) or _is_refused(function, i, a) for i, a in enumerate(arguments)]
            parts = zip(arguments, spared, strict=True)
            made = tuple(
                part if unchanged else change_exposed(lowering, part, scope, change) for part, unchanged in parts
            )
            return ir.Call(name, made)
        case _:
            return tree


def _change_branch(lowering: TreeLowering, tree: ir.Expression, scope: Scope, change: Change) -> ir.Expression:
    """Change a branch in a plain formula: a range stays whole; a computed branch takes the cell beside the formula."""
    goes_on = isinstance(tree, Area | ir.Variable) or (isinstance(tree, ir.Call) and tree.name in CHOICES)
    return change_exposed(lowering, tree, scope, change) if goes_on else tree


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


def _change_referred(lowering: TreeLowering, tree: ir.Expression, scope: Scope, change: Change) -> ir.Expression:
    areas = find_areas(lowering, tree, scope)
    return change(areas[0]) if areas is not None and len(areas) == 1 and areas[0].is_cut else tree


def is_numbered(tree: ir.Expression) -> bool:
    """Whether a tree is the row numbers of a whole column, or the column numbers of a whole row."""
    match tree:
        case ir.Call("ROW", (Area() as area,)):
            return area.further_rows > 0
        case ir.Call("COLUMN", (Area() as area,)):
            return area.further_columns > 0
        case _:
            return False


def degree(tree: ir.Expression, taken: Taken) -> int:
    """0 where a tree has no row numbers, 1 where it rises by the same from row to row, else `CURVED`."""

    def of(part: ir.Expression) -> int:
        return degree(part, taken)

    if is_numbered(tree):
        return 1
    match tree:
        case ir.Unary(_, operand):
            return of(operand)
        case ir.Binary("+" | "-", left, right):
            return max(of(left), of(right))
        case ir.Binary("*", left, right):
            return min(of(left) + of(right), CURVED)
        case ir.Binary("/", left, right):
            return CURVED if of(right) else of(left)
        case ir.Binary(_, left, right):
            return CURVED if of(left) or of(right) else 0
        case ir.Call("IF", (test, *branches)):
            return CURVED if of(test) else max(map(of, branches), default=0)
        case ir.Call():
            return CURVED if any(map(of, taken(tree))) else 0
        case _:
            return 0
