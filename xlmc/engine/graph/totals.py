"""SUBTOTAL and AGGREGATE: which cells they leave out of ranges, and what they give for an array of ranks."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from typing import Final

from xlmc.engine.graph.arrays import cell_by_cell
from xlmc.engine.graph.computed_references import areas_of
from xlmc.engine.graph.nodes import Range
from xlmc.engine.graph.scope import Scope, TreeLowering
from xlmc.errors import ErrorCode, FormulaError
from xlmc.excel.address import Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.functions import Function
from xlmc.excel.functions.budget import ask_for_reading
from xlmc.excel.functions.families import function_named
from xlmc.excel.functions.math.subtotal import Skips, aggregate_skips, subtotal_skips
from xlmc.excel.functions.values import constant

__all__ = ["without_totals"]

Arguments = tuple[ir.Expression, ...]


def without_totals(name: str) -> Callable[[TreeLowering, Arguments, Scope], int | None]:
    """SUBTOTAL and AGGREGATE leave out cells that are such totals themselves."""
    first = 1 if name == "SUBTOTAL" else 2

    def lower(lowering: TreeLowering, arguments: Arguments, scope: Scope) -> int | None:
        function = function_named(name)
        if function is None or len(arguments) <= first:
            return None
        result = [lowering.lower(argument, scope) for argument in arguments[:first]]
        skipped = _find_skips(lowering, name, result)
        nested = name == "SUBTOTAL" or (None if skipped is None else skipped.nested)
        ranked = name == "AGGREGATE" and _is_ranked(lowering, result[0])
        for position, argument in enumerate(arguments[first:]):
            if name == "SUBTOTAL" and isinstance(argument, ir.ErrorLiteral):
                return lowering.error(argument.code)
            is_rank = ranked and position == 1
            areas = None if is_rank else areas_of(lowering, argument, scope)
            if areas is None:
                result.append(lowering.lower(argument, scope.over_arrays()))
            elif ranked and len(areas) > 1:
                return lowering.error(ErrorCode.VALUE)
            else:
                result += [_range_that_counts(lowering, area, skipped, nested) for area in areas]
        by_rank = len(result) == 4 and name == "AGGREGATE" and lowering.dag.sizes[result[3]] not in (None, (1, 1))
        return _apply_to_ranks(lowering, function, result) if by_rank else lowering.apply(function, tuple(result))

    return lower


_OF_A_RANK: Final = range(14, 20)
"""The numbers of AGGREGATE's functions, such as LARGE, that take a rank behind their array."""

_TYPE: Final = "type the numbers that say what is left out"


def _is_ranked(lowering: TreeLowering, number: int) -> bool | None:
    """Whether AGGREGATE's function takes a rank; None if it varies."""
    known = lowering.lookup_constant(number)
    return int(known.numbers[0]) in _OF_A_RANK if known is not None and known.plain else None


def _apply_to_ranks(lowering: TreeLowering, function: Function, result: Sequence[int]) -> int:
    """AGGREGATE of a range and many cells: where these are ranks, one result for each of them."""
    ranked = _is_ranked(lowering, result[0])
    if ranked is None:
        return lowering.apply(_mark_spilling(function), tuple(result))
    if not ranked:
        return lowering.apply(function, tuple(result))
    cells = cell_by_cell(
        lowering.dag, (result[3],), lambda rank: lowering.apply(function, (*result[:3], *rank)), constants=True
    )
    return lowering.apply(_mark_spilling(function), tuple(result)) if cells is None else cells


@cache
def _mark_spilling(function: Function) -> Function:
    """Mark the function as one that may give many cells."""
    return replace(function, facts=replace(function.facts, spills=True))


_TOTAL = re.compile(r"\b(SUBTOTAL|AGGREGATE)\(", re.IGNORECASE)


def _find_skips(lowering: TreeLowering, name: str, options: list[int]) -> Skips | None:
    """Which cells are left out of ranges; None if that varies."""
    known = [lowering.lookup_constant(option) for option in options]
    numbers = [int(value.numbers[0]) if value is not None and value.plain else None for value in known]
    if numbers[-1] is None:
        return None
    return subtotal_skips(numbers[-1]) if name == "SUBTOTAL" else aggregate_skips(numbers[-1])


def _hidden_rows(lowering: TreeLowering, area: Area, skips: Skips | None) -> frozenset[int]:
    """Return the rows of an area that a total leaves out because they are hidden.

    Raises:
        FormulaError: some are hidden, and whether they are left out varies.
    """
    sheet = lowering.graph.workbook.sheet_of(area)
    rows = frozenset[int]() if sheet is None else sheet.hidden_rows & frozenset(range(area.top, area.bottom + 1))
    if sheet is None or not rows:
        return frozenset()
    if skips is None:
        raise FormulaError("rows of the range are hidden, and whether the total leaves them out varies", hint=_TYPE)
    if skips.hidden:
        return rows
    return rows & lowering.graph.workbook.filtered_rows(sheet) if skips.filtered else frozenset()


def _range_that_counts(lowering: TreeLowering, area: Area, skips: Skips | None, nested: bool | None) -> int:
    """Return the cells of an area that count; `nested` is whether totals are left out, None if that varies.

    Raises:
        FormulaError: a cell is hidden, or such a total, and whether it is left out varies.
    """
    ask_for_reading(area.rows, area.columns)  # further cells of a whole column are empty
    hidden_rows = _hidden_rows(lowering, area, skips)

    def node(cell: Cell) -> int:
        total = nested is not False and _TOTAL.search(lowering.graph.text(cell)) is not None
        if total and nested is None:
            raise FormulaError(f"{cell} is a total itself, and whether AGGREGATE leaves it out varies", hint=_TYPE)
        return lowering.dag.constant(constant(None)) if total or cell.row in hidden_rows else lowering.cell(cell)

    rows, columns = range(area.top, area.bottom + 1), range(area.left, area.right + 1)
    return lowering.dag.add(Range(tuple(tuple(node(Cell(area.sheet, r, c)) for c in columns) for r in rows)))
