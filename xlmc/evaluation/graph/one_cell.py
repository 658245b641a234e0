"""Arguments that want one cell: a range of several is `#VALUE!` there, even where others are taken cell by cell."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from xlmc.address import Area
from xlmc.errors import ErrorCode
from xlmc.evaluation.graph.counts import check_count
from xlmc.evaluation.graph.references import REFERENCES, NoReference, areas_of
from xlmc.evaluation.graph.scope import Scope
from xlmc.formula import ir

if TYPE_CHECKING:
    from xlmc.evaluation.graph.lower import Lowering

__all__ = ["of_one_cell"]

_VALUE: Final = ir.ErrorLiteral(ErrorCode.VALUE)
_CHOICES: Final = ("IF", "CHOOSE")


def of_one_cell(lowering: Lowering, tree: ir.Expression, scope: Scope) -> ir.Expression:
    """The argument with `#VALUE!` for every range of several cells that it may come to; arrays are as they were.

    Args:
        lowering: of the workbook.
        tree: the argument.
        scope: of the argument.
    """
    match tree:
        case ir.Call(name, (test, *branches)) if name in _CHOICES:
            check_count(name, tree.arguments)
            if lowering.dag.sizes[lowering.lower(test, scope.inside())] is not None:
                return tree  # a condition of many cells gives an array
            return ir.Call(name, (test, *(of_one_cell(lowering, part, scope) for part in branches)))
        case Area() | ir.Binary(",") | ir.Binary(":") | ir.Binary(" ") | ir.Variable():
            return _VALUE if _is_several(lowering, tree, scope) else tree
        case ir.Call(name) if name in REFERENCES:
            return _VALUE if _is_several(lowering, tree, replace(scope, of_array=False, around=False)) else tree
        case _:
            return tree


def _is_several(lowering: Lowering, tree: ir.Expression, scope: Scope) -> bool:
    """Whether a tree refers to more cells than one."""
    try:
        areas = areas_of(lowering, tree, scope)
    except NoReference:
        return False
    return areas is not None and sum(area.whole.rows * area.whole.columns for area in areas) > 1
