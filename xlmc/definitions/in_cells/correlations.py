"""Rank correlations of draws in cells, from the matrices that `RiskCorrmat` names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations

from xlmc.address import Area, Cell
from xlmc.definitions.findings import Findings
from xlmc.definitions.in_cells.draws import MatrixPlace
from xlmc.definitions.model import Assumption, Correlation
from xlmc.definitions.tables.fields import number_in
from xlmc.definitions.tables.tables import is_blank
from xlmc.distributions.base import show
from xlmc.errors import DefinitionError
from xlmc.workbook.model import Workbook

__all__ = ["in_cell_correlations"]

_Row = tuple[Assumption, MatrixPlace]


def in_cell_correlations(
    workbook: Workbook,
    assumptions: Iterable[Assumption],
    matrices: Mapping[str, MatrixPlace],
    rows: Iterable[Correlation],
    findings: Findings,
) -> list[Correlation]:
    """The correlations between draws that name rows of one matrix, in one instance of it; those of 0 left out.

    Args:
        workbook: holds the matrices.
        assumptions: drawn in cells.
        matrices: name of an assumption -> its row in a matrix.
        rows: the correlations of tables, which may be about other pairs only.
        findings: takes mistakes.
    """
    groups: dict[tuple[Area, str], list[_Row]] = {}
    for assumption in assumptions:
        place = matrices.get(assumption.name)
        if place is not None and not assumption.frozen:
            groups.setdefault((place.area, place.instance), []).append((assumption, place))
    taken = {frozenset((row.first, row.second)): row for row in rows}
    found = []
    for first, second in (pair for group in groups.values() for pair in _pairs(group, findings)):
        row = taken.get(frozenset((first[0].name, second[0].name)))
        if row is not None:
            message = f"{row.first!r} and {row.second!r} are correlated by this row and by the matrix {first[1].area}"
            findings.problem(message, row.row, "Keep one of them")
            continue
        found.append(findings.attempt(_correlation, workbook, first, second))
    return [each for each in found if each is not None and each.value != 0]


def _pairs(group: list[_Row], findings: Findings) -> Iterator[tuple[_Row, _Row]]:
    for first, second in combinations(group, 2):
        if first[1].position == second[1].position:
            message = f"{first[0].name!r} and {second[0].name!r} have the same row of the matrix {first[1].area}"
            hint = "Give each draw its own position, or its own instance of the matrix"
            findings.problem(message, second[0].row, hint)
        else:
            yield first, second


def _correlation(workbook: Workbook, first: _Row, second: _Row) -> Correlation:
    """The number below the diagonal; the one above where that cell is blank.

    Raises:
        DefinitionError: neither holds a number from -1 to 1.
    """
    area, (upper, lower) = first[1].area, sorted((first[1].position, second[1].position))
    below, above = (
        Cell(area.sheet, area.top + row - 1, area.left + column - 1) for row, column in ((lower, upper), (upper, lower))
    )
    cell = above if is_blank(workbook.content(below)) else below
    content = workbook.content(cell)
    if is_blank(content):
        hint = "Fill it in, or the one beside it across the diagonal"
        raise DefinitionError("The cell of a rank correlation is blank", where=below, hint=hint)
    value = number_in("The matrix of rank correlations", content, cell)
    if not -1 <= value <= 1:
        message = f"Correlation ({show(value)}) must lie between -1 and 1"
        raise DefinitionError(message, where=cell, hint="Type a rank correlation from -1 to 1")
    return Correlation(first[0].name, second[0].name, value, cell)
