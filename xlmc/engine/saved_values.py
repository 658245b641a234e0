"""Tell whether the value that Excel saved in a formula's cell is the one that the formula gives."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, TypeGuard

from xlmc.engine.graph.lowering import Lowering
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellValue

__all__ = ["TOLERANCE", "filled_cells", "is_saved_value", "relative_difference", "same_value"]

TOLERANCE: Final = 1e-9
"""Relative difference up to which two numbers match: with 0 nothing but 0 does."""

_PERIODIC: Final = frozenset({"SIN", "COS", "TAN"})
_PI_CUT: Final = 2.0**-65
"""How much of itself, at most, the processor that 32-bit Excel computes with puts an angle wrong, its pi being cut."""


def is_saved_value(lowering: Lowering, cell: Cell, saved: CellValue, got: object) -> bool:
    """Return whether a formula's cell gives what Excel saved there.

    Args:
        lowering: with the cell in it.
        cell: of the formula.
        saved: what Excel saved.
        got: what the formula gives.
    """
    return (
        same_value(saved, got)
        or _is_settled(lowering, cell, saved, got)
        or _is_sine_of_32_bits(lowering, cell, saved, got)
    )


def filled_cells(lowering: Lowering, anchor: Cell) -> Iterator[tuple[Cell, object]]:
    """Yield the other cells that an array formula fills, as far as no formula stands there, with what it gives them."""
    workbook = lowering.graph.workbook
    formula = workbook.content(anchor).formula
    for cell in formula.array.cells() if formula is not None and formula.array is not None else ():
        if cell != anchor and workbook.content(cell).formula is None:
            value = lowering.filled(cell, anchor)
            if value is not None:
                yield cell, value.objects().ravel()[0]


def same_value(saved: CellValue, got: object) -> bool:
    """Return whether two values match; numbers up to `TOLERANCE`."""
    difference = relative_difference(saved, got)
    if difference is not None:
        return difference <= TOLERANCE
    if isinstance(saved, str) and got is None:
        return saved == ""
    return type(saved) is type(got) and saved == got


def relative_difference(saved: object, got: object) -> float | None:
    """Return the difference of two numbers relative to the larger one; None where one is no number."""
    if not _is_number(saved) or not _is_number(got):
        return None
    first, second = float(saved), float(got)
    return abs(first - second) / max(abs(first), abs(second), 5e-324)


def _is_settled(lowering: Lowering, cell: Cell, saved: CellValue, got: object) -> bool:
    """Return whether a cell that Excel computed iteratively changes by less than where Excel stopped."""
    iteration = lowering.graph.workbook.iteration
    if iteration is None or cell not in lowering.graph.circles or not (_is_number(saved) and _is_number(got)):
        return False
    return abs(float(saved) - float(got)) < iteration.change


def _is_sine_of_32_bits(lowering: Lowering, cell: Cell, saved: CellValue, got: object) -> bool:
    """Return whether a formula ends with a sine, cosine or tangent that is off no more than 32-bit Excel's cut pi."""
    step = lowering.last_step(cell)
    if step is None or step[0] not in _PERIODIC or not (_is_number(saved) and _is_number(got)):
        return False
    (angle,) = step[1]
    return abs(float(saved) - float(got)) <= abs(float(angle.numbers[0])) * _PI_CUT


def _is_number(value: object) -> TypeGuard[int | float]:
    return isinstance(value, int | float) and not isinstance(value, bool | ErrorCode)
