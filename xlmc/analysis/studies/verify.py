"""Recompute a workbook's formulas and compare with the values that Excel saved: an audit, and our conformance test."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Final

from xlmc.engine.graph.lowering import Lowering, lower_until_complete
from xlmc.engine.saved_values import (
    TOLERANCE,
    filled_cells,
    is_saved_value,
    relative_difference,
    same_value,
)
from xlmc.excel.address import Cell
from xlmc.excel.formula import Resolver, build_graph
from xlmc.excel.formula.shape import shown_formula
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.montecarlo.definitions.definitions import Definitions
from xlmc.montecarlo.definitions.in_cells.suspects import holds_call
from xlmc.montecarlo.model.needed import targets_of
from xlmc.montecarlo.number_text import count_text, counted_text

__all__ = ["TOLERANCE", "CellCheck", "Status", "Verification", "verify"]

NOT_COMPARABLE: Final = "draws at random or shows results of a simulation, so there is no one value to compare"


class Status(Enum):
    """What came of a formula cell."""

    MATCHED = "matched"
    DIFFERING = "differing"
    UNSUPPORTED = "unsupported"
    NOT_CACHED = "not cached"
    VOLATILE = "volatile"


@dataclass(frozen=True, slots=True)
class CellCheck:
    """One formula cell; of an array formula the first cell that does not match, if there is one.

    Attributes:
        formula: that of the cell, as Excel shows it: with its `=`.
        expected: what Excel saved.
        got: what xlmc computes; None if it computes nothing.
        reason: why it is unsupported, or cannot be compared.
        anchor: the cell that holds the formula, where that is another.
    """

    cell: Cell
    formula: str
    status: Status
    expected: CellValue
    got: object = None
    reason: str = ""
    anchor: Cell | None = None

    @property
    def difference(self) -> float | None:
        """Relative difference of two numbers; None where one is none."""
        return relative_difference(self.expected, self.got)


@dataclass(frozen=True, slots=True, repr=False)
class Verification:
    """The formula cells of a workbook, checked."""

    cells: tuple[CellCheck, ...]

    def __repr__(self) -> str:
        counts = ", ".join(
            f"{count_text(self.count(status))} {status.value}" for status in Status if self.count(status)
        )
        return f"{counted_text(len(self.cells), 'formula cell')}: {counts or 'nothing to check'}"

    def count(self, status: Status) -> int:
        """How many cells have that status."""
        return sum(cell.status is status for cell in self.cells)

    def of(self, status: Status) -> list[CellCheck]:
        """Return the cells that have that status."""
        return [cell for cell in self.cells if cell.status is status]


def verify(workbook: Workbook, definitions: Definitions | None = None) -> Verification:
    """Recompute formula cells at their base values, each from what Excel saved in the cells it needs.

    Args:
        workbook: to check.
        definitions: checks only what its forecasts and filters need; every formula cell when None.
    """
    wanted = (
        [*workbook.formula_cells()]
        if definitions is None
        else targets_of(definitions.forecasts, (*definitions.filters, *definitions.forecast_filters))
    )
    lowering = _lower(workbook, wanted)
    checked = sorted(wanted if definitions is None else lowering.graph.formulas)
    return Verification(tuple(_check(lowering, cell) for cell in checked if _has_formula(workbook, cell)))


def _lower(workbook: Workbook, wanted: Sequence[Cell]) -> Lowering:
    resolver = Resolver(workbook, strict=False)

    def lower(more: Mapping[Cell, set[Cell]]) -> Lowering:
        return Lowering(build_graph(resolver, wanted, frozenset(), more=more, strict=False), {}, {}, audit=True)

    return lower_until_complete(lower)


def _has_formula(workbook: Workbook, cell: Cell) -> bool:
    return workbook.content(cell).formula is not None


def _check(lowering: Lowering, cell: Cell) -> CellCheck:
    check = _check_cell(lowering, cell)
    others = _filled_by(lowering, cell) if check.status is Status.MATCHED else ()
    return next((result for result in others if result.status is Status.DIFFERING), check)


def _filled_by(lowering: Lowering, anchor: Cell) -> Iterator[CellCheck]:
    """Return the other cells that an array formula fills, as far as Excel saved a value there."""
    workbook = lowering.graph.workbook
    formula = workbook.content(anchor).formula
    for cell, got in filled_cells(lowering, anchor):
        expected = workbook.content(cell).value
        if expected is not None and formula is not None:
            status = Status.MATCHED if same_value(expected, got) else Status.DIFFERING
            yield CellCheck(cell, shown_formula(formula, anchor), status, expected, got, anchor=anchor)


def _check_cell(lowering: Lowering, cell: Cell) -> CellCheck:
    content = lowering.graph.workbook.content(cell)
    text, shown = ("", "") if content.formula is None else (content.formula.text, shown_formula(content.formula, cell))

    def check(status: Status, got: object = None, reason: str = "") -> CellCheck:
        return CellCheck(cell, shown, status, content.value, got, reason)

    if holds_call(text):
        return check(Status.VOLATILE, reason=NOT_COMPARABLE)
    fault = lowering.faults.get(cell)
    if fault is not None:
        return check(Status.UNSUPPORTED, reason=fault.message)
    value = lowering.value(cell)
    if value is None:
        return check(Status.VOLATILE)
    got = value.objects().ravel()[0]
    if content.value is None:
        return check(Status.NOT_CACHED, got)
    same = is_saved_value(lowering, cell, content.value, got)
    return check(Status.MATCHED if same else Status.DIFFERING, got)


def groups(cells: Iterable[CellCheck]) -> list[tuple[str, Sequence[CellCheck]]]:
    """Cells by reason, the most frequent first."""
    result: dict[str, list[CellCheck]] = {}
    for cell in cells:
        result.setdefault(cell.reason, []).append(cell)
    return sorted(result.items(), key=lambda item: -len(item[1]))
