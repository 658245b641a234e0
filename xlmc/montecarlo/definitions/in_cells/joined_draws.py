"""Draws in cells that are not independent: rows of a matrix, places in a copula, and @RISK's older pairs.

`RiskIndepC("x")` is the draw that others depend on, and `RiskDepC("x", 0.8)` one that does. Two that depend on the same
one are as correlated as that makes them, each being independent of the other where the first is known: with normal
scores of correlation a and b with the first, they have a·b.

A copula's range says what it is: the word Gaussian, t, Clayton, Gumbel or Frank, for the last three also with R, RX or
RY behind it, and beside `Theta` or `Degrees of freedom` the number. For Gaussian and t a square matrix of the
correlations of the underlying normals or t variables stands in the range, its diagonal 1.

Source: @RISK's manual, RiskCorrmat, RiskCopula, RiskDepC, RiskIndepC and "Copula Types".
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, pairwise
from types import NoneType
from typing import Final

from xlmc.errors import DefinitionError, ErrorCode
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions import Assumption, Copula, Correlation, Parameter
from xlmc.montecarlo.definitions.in_cells.adjustment_weights import weight_of, weights_of_matrices
from xlmc.montecarlo.definitions.in_cells.call_draws import MatrixRow
from xlmc.montecarlo.definitions.in_cells.reading import CellDraw
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.table_rows import as_text, number_in
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.spelling import plain
from xlmc.montecarlo.number_text import number_text

__all__ = ["in_cell_copulas", "in_cell_correlations"]

_Row = tuple[Assumption, MatrixRow]
_Draws = Mapping[str, CellDraw]

_KINDS: Final = {
    "gaussian": "Gaussian",
    "normal": "Gaussian",
    "t": "t",
    "studentt": "t",
    "student": "t",
    "student'st": "t",
    "clayton": "Clayton",
    "gumbel": "Gumbel",
    "frank": "Frank",
}
_REFLECTIONS: Final = {"": "", "r": "R", "rx": "RX", "ry": "RY"}
_THETA: Final = ("theta", "parameter", "alpha")
_DEGREES: Final = ("degreesoffreedom", "df", "nu", "degrees", "v")
_LEAST: Final = {"Clayton": 0.0, "Gumbel": 1.0, "Frank": 0.0}


def in_cell_correlations(
    workbook: Workbook,
    assumptions: Sequence[Assumption],
    draws: _Draws,
    rows: Iterable[Correlation],
    findings: Findings,
) -> list[Correlation]:
    """Return the correlations between draws that name rows of one matrix, or one partner; of 0 only weighted ones.

    Args:
        workbook: holds the matrices.
        assumptions: drawn in cells.
        draws: name of an assumption -> what its call says.
        rows: the correlations of tables, which may be about other pairs only.
        findings: takes mistakes.
    """
    taken = {frozenset((row.first, row.second)): row for row in rows}
    result: list[Correlation | None] = []
    groups = _groups(assumptions, draws, "matrix")
    weights = findings.attempt(weights_of_matrices, workbook, {row.area for group in groups for _, row in group}) or {}
    compared: set[Cell] = set()
    for first, second in (pair for group in groups for pair in _pairs(group, findings)):
        row = taken.get(frozenset((first[0].name, second[0].name)))
        if row is not None:
            message = f"{row.first!r} and {row.second!r} are correlated by this row and by the matrix {first[1].area}"
            findings.problem(message, row.row, "Keep one of them")
            continue
        correlation = findings.attempt(_correlation, workbook, weights, first, second)
        result.append(correlation)
        if correlation is not None and correlation.row not in compared:
            compared.add(correlation.row)
            _compare_halves(workbook, first[1].area, correlation.row, findings)
    result += _partners(assumptions, draws, findings)
    return [each for each in result if each is not None and (each.value != 0 or each.weight)]


def _groups(assumptions: Iterable[Assumption], draws: _Draws, which: str) -> list[list[_Row]]:
    """Return the draws that are not frozen and belong together, by area and instance."""
    groups: dict[tuple[Area, str], list[_Row]] = {}
    for assumption in assumptions:
        draw = draws.get(assumption.name)
        row = None if draw is None else getattr(draw.properties, which)
        if row is not None and not assumption.frozen:
            groups.setdefault((row.area, row.instance), []).append((assumption, row))
    return list(groups.values())


def _pairs(group: list[_Row], findings: Findings) -> Iterator[tuple[_Row, _Row]]:
    for first, second in combinations(group, 2):
        if first[1].position == second[1].position:
            message = f"{first[0].name!r} and {second[0].name!r} have the same row of the matrix {first[1].area}"
            hint = "Give each draw its own position, or its own instance of the matrix"
            findings.problem(message, second[0].row, hint)
        else:
            yield first, second


def _compare_halves(workbook: Workbook, area: Area, used: Cell, findings: Findings) -> None:
    """Tell of a number that differs from the one across the diagonal of its matrix, which is used."""
    across = Cell(area.sheet, area.top + used.column - area.left, area.left + used.row - area.top)
    number, other = (workbook.content(cell).value for cell in (used, across))
    if not isinstance(number, int | float) or isinstance(other, bool | NoneType) or workbook.content(across).is_blank:
        return
    if isinstance(other, int | float) and not isinstance(other, ErrorCode):
        if math.isclose(number, other, rel_tol=1e-12, abs_tol=1e-12):
            return
        shown = show(other)
    else:
        shown = repr(as_text(other))
    findings.notice(
        f"the halves of the matrix {area} contradict each other: "
        f"{used} is {show(number)}, and {across} is {shown}; "
        f"{used}, below the diagonal, is used. Make them equal, or clear one of them",
        across,
    )


def _correlation(workbook: Workbook, weights: Mapping[Area, Area], first: _Row, second: _Row) -> Correlation:
    """Return the number below the diagonal; the one above where that cell is blank.

    Raises:
        DefinitionError: neither holds a number from -1 to 1, or its weight is none.
    """
    area, (upper, lower) = first[1].area, sorted((first[1].position, second[1].position))
    below, above = (
        Cell(area.sheet, area.top + row - 1, area.left + column - 1) for row, column in ((lower, upper), (upper, lower))
    )
    cell = above if workbook.content(below).is_blank else below
    content = workbook.content(cell)
    if content.is_blank:
        hint = "Fill it in, or the one beside it across the diagonal"
        raise DefinitionError("The cell of a rank correlation is blank", where=below, hint=hint)
    weight = weight_of(workbook, weights, area, lower, upper)
    if content.formula is not None and content.value is None:
        return Correlation(first[0].name, second[0].name, cell, cell, weight)
    value = number_in("The matrix of rank correlations", content, cell)
    _refuse_outside(value, cell)
    computed = content.formula is not None
    return Correlation(first[0].name, second[0].name, cell if computed else value, cell, weight)


def _refuse_outside(value: float, where: Cell) -> None:
    if not -1 <= value <= 1:
        message = f"Correlation ({show(value)}) must lie between -1 and 1"
        raise DefinitionError(message, where=where, hint="Type a rank correlation from -1 to 1")


def _partners(assumptions: Sequence[Assumption], draws: _Draws, findings: Findings) -> Iterator[Correlation]:
    """Return the correlations by `RiskIndepC` and `RiskDepC`."""
    groups: dict[str, list[tuple[Assumption, Parameter | None]]] = {}
    for assumption in assumptions:
        draw = draws.get(assumption.name)
        partner = None if draw is None else draw.properties.partner
        if draw is not None and partner is not None and not assumption.frozen:
            groups.setdefault(partner.name, []).append((assumption, draw.coefficient))
    for name, group in groups.items():
        first = [a for a, coefficient in group if coefficient is None]
        if len(first) != 1:
            message = f"RiskIndepC({name!r}) stands in {len(first)} draws that vary, and must stand in one"
            hint = f'give it to the draw that the others depend on, and RiskDepC("{name}", r) to these'
            findings.problem(message, (first or [a for a, _ in group])[-1].row, hint)
            continue
        others = [(a, value) for a, value in group if value is not None]
        for assumption, value in others:
            if isinstance(value, float):
                findings.attempt(_refuse_outside, value, assumption.row)
            yield Correlation(first[0].name, assumption.name, value, assumption.row)
        for (one, a), (other, b) in combinations(others, 2):
            if isinstance(a, float) and isinstance(b, float):
                yield Correlation(one.name, other.name, _implied(a, b), other.row)
            else:
                message = f"two draws depend on RiskIndepC({name!r}), and a coefficient is computed by a formula"
                findings.problem(message, other.row, "type the coefficients as numbers, or use RiskCorrmat")


def _implied(first: float, second: float) -> float:
    """Return the rank correlation of two that have these with a third, and no other connection."""
    scores = 4 * math.sin(math.pi / 6 * first) * math.sin(math.pi / 6 * second)
    return 6 / math.pi * math.asin(scores / 2)


def in_cell_copulas(
    workbook: Workbook,
    assumptions: Sequence[Assumption],
    draws: _Draws,
    correlations: Iterable[Correlation],
    findings: Findings,
) -> tuple[Copula, ...]:
    """Return the copulas that join draws in cells.

    Args:
        workbook: holds their ranges.
        assumptions: drawn in cells.
        draws: name of an assumption -> what its call says.
        correlations: of any assumptions; none of them may be in a copula, too.
        findings: takes mistakes.
    """
    correlated = {name: row for row in correlations for name in (row.first, row.second)}
    result = []
    for group in _groups(assumptions, draws, "copula"):
        group.sort(key=lambda each: each[1].position)
        both = next((a for a, _ in group if a.name in correlated), None)
        twice = next((b for a, b in pairwise(group) if a[1].position == b[1].position), None)
        if both is not None:
            message = f"{both.name!r} is joined by a copula, and correlated in another way, too"
            findings.problem(message, both.row, "Keep one of the two")
        elif twice is not None:
            message = f"{twice[0].name!r} has a position of the copula {twice[1].area} that another draw has"
            findings.problem(message, twice[0].row, "Give each draw its own position, or its own instance")
        elif len(group) > 1:
            result.append(findings.attempt(_copula, workbook, group, findings))
    return tuple(each for each in result if each is not None)


def _copula(workbook: Workbook, group: Sequence[_Row], findings: Findings) -> Copula:
    """Read what the range says.

    Raises:
        DefinitionError: it does not say which copula it is, or its numbers are none of it.
    """
    area = group[0][1].area
    grid = {cell: workbook.content(cell).value for cell in area.cells()}
    where, (kind, reflection) = _kind(grid, area)
    names = tuple(a.name for a, _ in group)
    positions = [row.position for _, row in group]
    if kind in _LEAST:
        theta = _beside(workbook, grid, area, _THETA)
        if theta is None:
            hint = "write Theta into a cell of the range, and its number into the cell right of it"
            raise DefinitionError(f"The copula {area} has no Theta", where=where, hint=hint)
        least = _LEAST[kind]
        good = theta >= 1 if kind == "Gumbel" else theta > 0 or (kind == "Frank" and len(names) == 2 and theta < 0)
        if not good or abs(theta) > _MOST_THETA:
            above = "at least" if kind == "Gumbel" else "above"
            message = (
                f"Theta ({show(theta)}) of {kind} must be {above} {number_text(least)}, and at "
                f"most {number_text(_MOST_THETA)}"
            )
            raise DefinitionError(message, where=where, hint="Correct the number")
        return Copula(kind, names, where, theta, turned=_turned(kind, reflection, positions, where))
    degrees = _beside(workbook, grid, area, _DEGREES) if kind == "t" else None
    if kind == "t" and (degrees is None or not 0.1 <= degrees <= 1e6):
        hint = "write Degrees of freedom into a cell of the range, and a number from 0.1 up into the cell right of it"
        raise DefinitionError(f"The copula {area} has no degrees of freedom", where=where, hint=hint)
    matrix = _matrix(workbook, area, max(positions), where, findings)
    chosen = tuple(tuple(matrix[i - 1][j - 1] for j in positions) for i in positions)
    return Copula(kind, names, where, degrees, chosen)


_MOST_THETA: Final = 500.0


def _kind(grid: Mapping[Cell, object], area: Area) -> tuple[Cell, tuple[str, str]]:
    """Return the cell that names the copula; its kind and reflection."""
    for cell, value in grid.items():
        text = plain(value) if isinstance(value, str) else ""
        for word, kind in _KINDS.items():
            rest = text.removeprefix(word).removesuffix("copula")
            if text.startswith(word) and rest in _REFLECTIONS:
                return cell, (kind, _REFLECTIONS[rest])
    hint = "write Gaussian, t, Clayton, Gumbel or Frank into a cell of the range, the last three also with R, RX or RY"
    raise DefinitionError(f"The range {area} does not say which copula it is", where=next(iter(grid)), hint=hint)


def _turned(kind: str, reflection: str, positions: Sequence[int], where: Cell) -> tuple[bool, ...]:
    """Which variables are turned over: all for R, the first for RX, the second for RY.

    Raises:
        DefinitionError: more than two variables are joined, and only some would be turned over.
    """
    if reflection in ("RX", "RY") and (len(positions) > 2 or max(positions) > 2):
        message = f"{kind}{reflection} turns one of two variables over, and this copula joins {max(positions)}"
        raise DefinitionError(message, where=where, hint=f"Use {kind} or {kind}R")
    first, second = reflection in ("R", "RX"), reflection in ("R", "RY")
    return (first, second, *[first] * (len(positions) - 2))


def _beside(workbook: Workbook, grid: Mapping[Cell, object], area: Area, labels: Sequence[str]) -> float | None:
    """Return the number right of the first of these words, or below it."""
    for cell, value in grid.items():
        if isinstance(value, str) and plain(value).rstrip(":") in labels:
            for other in (Cell(cell.sheet, cell.row, cell.column + 1), Cell(cell.sheet, cell.row + 1, cell.column)):
                content = workbook.content(other)
                if other in area and not content.is_blank and not isinstance(content.value, str):
                    return number_in("The parameter of the copula", content, other)
    return None


def _matrix(workbook: Workbook, area: Area, least: int, where: Cell, findings: Findings) -> list[list[float]]:
    """Return the largest square block of the range with a diagonal of 1, of which one half may be blank.

    Raises:
        DefinitionError: there is none that has a row for each draw.
    """
    rows = [
        [workbook.content(Cell(area.sheet, r, c)) for c in range(area.left, area.right + 1)]
        for r in range(area.top, area.bottom + 1)
    ]
    best: list[list[float]] = []
    used: list[Cell] = []
    square = area
    for top in range(len(rows)):
        for left in range(len(rows[0])):
            size = 0
            while top + size < len(rows) and left + size < len(rows[0]) and rows[top + size][left + size].value == 1:
                size += 1
            if size > len(best):
                best, used = [[1.0] * size for _ in range(size)], []
                first, corner = area.top + top, area.left + left
                square = Area(area.sheet, first, corner, first + size - 1, corner + size - 1)
                for i, j in combinations(range(size), 2):
                    low, high = rows[top + j][left + i], rows[top + i][left + j]
                    content, cell_row, cell_column = (low, j, i) if not low.is_blank else (high, i, j)
                    cell = Cell(area.sheet, area.top + top + cell_row, area.left + left + cell_column)
                    if content.is_blank:
                        hint = "Fill it in, or the one beside it across the diagonal"
                        raise DefinitionError("The cell of a correlation is blank", where=cell, hint=hint)
                    value = number_in("The matrix of the copula", content, cell)
                    _refuse_outside(value, cell)
                    best[i][j] = best[j][i] = value
                    used.append(cell)
    if len(best) < least:
        message = f"The copula {area} has no matrix with {least} rows, with 1 along its diagonal"
        raise DefinitionError(message, where=where, hint="Put the correlations into the range, a row for each draw")
    for cell in used:
        _compare_halves(workbook, square, cell, findings)
    return best
