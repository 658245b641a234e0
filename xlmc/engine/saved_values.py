"""Tell whether the value that Excel saved in a formula's cell is the one that the formula gives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final, TypeGuard

from xlmc.engine.graph.arrays import size_of
from xlmc.engine.graph.lowering import Lowering
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellValue, Workbook

__all__ = ["TOLERANCE", "array_of", "faults_of", "filled_cells", "is_saved_value", "relative_difference", "same_value"]

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
        or _is_logical_of_libreoffice(lowering, saved, got)
        or _is_within_the_change(lowering, cell, saved, got)
        or _is_sine_of_32_bits(lowering, cell, saved, got)
    )


def faults_of(lowering: Lowering, unknown: str) -> dict[Cell, str]:
    """Return the formulas that have no value of their own -> why.

    Args:
        lowering: with the formulas in it.
        unknown: why one that can be computed has no value.
    """
    result: dict[Cell, str] = {}
    for cell in lowering.graph.formulas:
        formula = lowering.graph.workbook.content(cell).formula
        if cell in lowering.faults:
            result[cell] = lowering.faults[cell].message
        elif lowering.value(cell) is None:
            result[cell] = unknown
        elif formula is not None and formula.dynamic and formula.array is not None:
            size = size_of(lowering.dag, lowering.array(cell)) or (1, 1)
            if size != (formula.array.rows, formula.array.columns):
                result[cell] = "the formula spills into another area than when the file was saved"
    return result


def array_of(workbook: Workbook, cell: Cell) -> Iterable[Cell]:
    """Return the cells that the array formula of a cell fills, its own among them; none if it has no such formula."""
    formula = workbook.content(cell).formula
    return () if formula is None or formula.array is None else formula.array.cells()


def filled_cells(lowering: Lowering, anchor: Cell) -> Iterator[tuple[Cell, object]]:
    """Yield the other cells that an array formula fills, as far as no formula stands there, with what it gives them."""
    workbook = lowering.graph.workbook
    for cell in array_of(workbook, anchor):
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


def _is_logical_of_libreoffice(lowering: Lowering, saved: CellValue, got: object) -> bool:
    """Return whether a formula gives the logical that LibreOffice, which has no logicals, saved as 1 or 0."""
    return lowering.graph.workbook.libreoffice and isinstance(got, bool) and _is_number(saved) and saved == got


def _is_within_the_change(lowering: Lowering, cell: Cell, saved: CellValue, got: object) -> bool:
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
