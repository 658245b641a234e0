"""Values of many cells while a formula is lowered: cells picked out of them, functions applied cell by cell.

An array that varies is kept as a `Range` of single nodes wherever its size is known, so that array formulas run on the
fast path like any other.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode, FormulaError
from xlmc.evaluation.graph.dag import MANY, Constant, Dag, Range, Select
from xlmc.evaluation.graph.dag import Apply as ApplyNode
from xlmc.evaluation.graph.either import parts_of
from xlmc.functions import Function, Kind
from xlmc.functions.registry import Cells
from xlmc.functions.values import Value, constant

__all__ = ["beside", "cell_by_cell", "element", "grid", "size_of", "spread"]

LARGEST: Final = 10_000
"""Cells of a varying array that are made nodes of their own; a larger one is computed as a whole."""


def size_of(dag: Dag, place: int) -> tuple[int, int] | None:
    """Rows and columns of a value of many cells; None for a single one.

    Raises:
        FormulaError: the size is not known before the run.
    """
    size = dag.sizes[place]
    if size == MANY:
        raise FormulaError("the size of an array is known only during the run", hint="give it a fixed number of rows")
    return None if size is None else (size[0], size[1])


def element(dag: Dag, place: int, row: int, column: int) -> int:
    """The node of one cell of a value, counted from 0; a single row, column or value repeats, beyond it is `#N/A`."""
    node, size = dag.nodes[place], dag.sizes[place]
    if size is None:
        return place
    if size != MANY:
        row, column = (0 if size[0] == 1 else row), (0 if size[1] == 1 else column)
        if row >= size[0] or column >= size[1]:
            return dag.constant(constant(ErrorCode.NA))
    if isinstance(node, Range):
        return node.rows[row][column]
    if isinstance(node, Constant):
        return dag.constant(_picked(node.value, row, column))
    chosen = parts_of(dag, place)
    if chosen is not None:
        return dag.add(Select(chosen[0], *(element(dag, part, row, column) for part in chosen[1:])))
    return dag.add(ApplyNode(_picker(row, column), (place,)))


@cache
def _picker(row: int, column: int) -> Function:
    return Function(f"cell {row},{column}", (Cells,), partial(_picked, row=row, column=column), Kind.ANY)


def _picked(value: Value, row: int, column: int) -> Value:
    """(n, r, c) -> (n,); as `element` for a size that is found out only now."""
    if value.numbers.ndim == 1:
        return value
    _, rows, columns = value.shape
    row, column = (0 if rows == 1 else row), (0 if columns == 1 else column)
    if row >= rows or column >= columns:
        return constant(ErrorCode.NA)
    parts = [None if a is None else np.broadcast_to(a, value.shape)[:, row, column] for a in value.arrays()]
    return Value(parts[0], parts[1], parts[2])  # type: ignore[arg-type]  # only texts may be None


def beside(dag: Dag, place: int, row: int, column: int) -> int:
    """The node of a single value of what may be a whole column or row of a range: its cell beside the formula.

    Args:
        dag: of the nodes.
        place: a cell, column, row or all of a range.
        row: the formula's, counted from the first cell of the range.
        column: likewise.
    """
    return place if dag.sizes[place] is None else dag.add(ApplyNode(_picker_beside(row, column), (place,)))


@cache
def _picker_beside(row: int, column: int) -> Function:
    body = partial(_picked_beside, row=row, column=column)
    return Function(f"cell beside {row},{column}", (Cells,), body, Kind.ANY)


def _picked_beside(value: Value, row: int, column: int) -> Value:
    """(n, r, c) -> (n,)."""
    rows, columns = value.shape[1:] or (1, 1)
    at = (0 if rows == 1 else row), (0 if columns == 1 else column)
    if (rows > 1 and columns > 1) or not (0 <= at[0] < rows and 0 <= at[1] < columns):
        return constant(ErrorCode.VALUE)
    return _picked(value, *at)


def grid(dag: Dag, rows: int, columns: int, at: Callable[[int, int], int]) -> int:
    """The node of an array made of single nodes."""
    return dag.add(Range(tuple(tuple(at(r, c) for c in range(columns)) for r in range(rows))))


def spread(dag: Dag, function: Function, loose: tuple[int, ...], apply: Callable[[tuple[int, ...]], int]) -> int | None:
    """`cell_by_cell` of a function's arguments of single values, as far as it goes for that function.

    One that makes an array of a size that these decide makes one for each cell, also where all are constant. INDEX of
    row or column 0, which gives whole columns or rows, does so for all cells at once; where 0 is one of many numbers,
    each cell is looked up on its own.
    """
    shaping = function.facts.sized_by_numbers
    if function.name == "INDEX":
        zeros = [place for place in loose if _has_zero(dag, place)]
        if any(dag.sizes[place] is None for place in zeros):
            return None
        shaping = bool(zeros)
    return cell_by_cell(dag, loose, apply, constants=shaping)


def _has_zero(dag: Dag, place: int) -> bool:
    """Whether any cell of it is known to count as 0 where whole numbers are wanted."""
    node = dag.nodes[place]
    if not isinstance(node, Constant):
        return False
    numbers, errors = node.value.to_numbers()
    return bool(np.any((np.abs(numbers) < 1) & (errors == 0)))


def cell_by_cell(
    dag: Dag, places: tuple[int, ...], apply: Callable[[tuple[int, ...]], int], *, constants: bool = False
) -> int | None:
    """The array of what `apply` makes of the cells of each of `places`; None where that is not worth it.

    Nothing is gained for constants, which are computed at once unless `constants` is set, and nothing possible for
    unknown sizes. Where sizes do not fit each other, what has no partner is `#N/A`.

    Raises:
        FormulaError: `constants` is set, and there are too many cells.
    """
    sizes = [size for place in places if (size := dag.sizes[place]) is not None]
    if not sizes or MANY in sizes:
        return None
    rows, columns = max(size[0] for size in sizes), max(size[1] for size in sizes)
    fit = all(size[0] in (1, rows) and size[1] in (1, columns) for size in sizes)
    constant_ = all(isinstance(dag.nodes[place], Constant) for place in places)
    if constants and rows * columns > LARGEST:
        raise FormulaError(f"{rows * columns:,} cells would each make an array", hint="give a single number for them")
    if fit and ((constant_ and not constants) or rows * columns > LARGEST):
        return None
    return grid(dag, rows, columns, lambda r, c: apply(tuple(element(dag, place, r, c) for place in places)))
