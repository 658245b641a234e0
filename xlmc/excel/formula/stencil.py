"""One resolved formula for all the cells that it was filled into: its references move with the cell.

A large book holds few formulas in many cells. What is worked out once for a stencil (its tree, its precedents, how it
is lowered) need not be worked out again for each cell.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final, NamedTuple

from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Area, Cell
from xlmc.excel.formula import ir
from xlmc.excel.formula.precedents import LOOKED_AT

__all__ = ["Stencil", "stencil"]

_MOST_CELLS: Final = 64
"""Cells of the areas of a stencil; formulas that read more are few beside the cells they read."""


class _Spot(NamedTuple):
    """A cell that the formula reads: where it is seen from home, and whether its row and column move (1) or not (0)."""

    sheet: str
    row: int
    row_moves: int
    column: int
    column_moves: int


class Stencil:
    """A formula resolved at `home`, to be seen from other cells of the same sheet.

    Attributes:
        home: the cell it was resolved for.
        tree: what it is there.
    """

    def __init__(self, home: Cell, tree: ir.Expression, moves: list[tuple[Cell | Area, int, int]]) -> None:
        self.home, self.tree = home, tree
        self._moves = {id(target): (down, right) for target, down, right in moves}
        spots = (
            _Spot(cell.sheet, cell.row, down, cell.column, right) for p, down, right in moves for cell in _cells(p)
        )
        self._spots = tuple(dict.fromkeys(spots))
        rows = [spot.row for spot in self._spots if spot.row_moves]
        columns = [spot.column for spot in self._spots if spot.column_moves]
        self._rows = 1 - min(rows, default=MAX_ROW), MAX_ROW - max(rows, default=1)
        self._columns = 1 - min(columns, default=MAX_COLUMN), MAX_COLUMN - max(columns, default=1)

    def fits(self, host: Cell) -> bool:
        """Whether nothing leaves the sheet when the formula stands in `host`."""
        down, right = host.row - self.home.row, host.column - self.home.column
        return self._rows[0] <= down <= self._rows[1] and self._columns[0] <= right <= self._columns[1]

    def cells(self, host: Cell) -> list[Cell]:
        """Return the cells that the formula reads when it stands in `host`, areas cell by cell.

        Each comes once, unless some move and others stay, and they meet.
        """
        down, right = host.row - self.home.row, host.column - self.home.column
        return [
            Cell(sheet, row + down * row_moves, column + right * column_moves)
            for sheet, row, row_moves, column, column_moves in self._spots
        ]

    def at(self, host: Cell) -> ir.Expression:
        """Return the tree when the formula stands in `host`."""
        if host == self.home:
            return self.tree
        down, right = host.row - self.home.row, host.column - self.home.column

        def moved(target: Cell | Area) -> Cell | Area:
            rows, columns = self._moves[id(target)]
            return _shift(target, down * rows, right * columns)

        return _rebuild(self.tree, moved)


def _cells(target: Cell | Area) -> Iterator[Cell]:
    if isinstance(target, Cell):
        yield target
    else:
        yield from target.cells()


def _shift(target: Cell | Area, down: int, right: int) -> Cell | Area:
    if isinstance(target, Cell):
        return Cell(target.sheet, target.row + down, target.column + right)
    ends = target.bottom + down, target.right + right
    return Area(
        target.sheet, target.top + down, target.left + right, *ends, target.further_rows, target.further_columns
    )


def stencil(written: ir.Expression, resolved: ir.Expression, home: Cell) -> Stencil | None:
    """Make the stencil of a formula as written and as resolved at `home`; None if it holds what does not
    simply move.
    """
    before, after = _leaves(written), _leaves(resolved)
    if before is None or after is None or len(before) != len(after):
        return None
    moves: list[tuple[Cell | Area, int, int]] = []
    for reference, target in zip(before, after, strict=True):
        steps = _steps(reference)
        if steps is None or not isinstance(target, Cell | Area):
            return None
        if isinstance(target, Area) and (steps[0] * target.further_rows or steps[1] * target.further_columns):
            return None  # one that moves ends with the last filled cell all the same
        moves.append((target, *steps))
    if sum(p.rows * p.columns for p, _, _ in moves if isinstance(p, Area)) > _MOST_CELLS:
        return None
    if len({id(target) for target, _, _ in moves}) < len(moves):
        return None
    return Stencil(home, resolved, moves)


_Leaf = ir.Reference | Cell | Area


def _leaves(tree: ir.Expression) -> list[_Leaf] | None:
    """Return the references from left to right; None if the tree holds names, binds variables or asks where
    cells are.
    """
    match tree:
        case ir.Reference() | Cell() | Area():
            return [tree]
        case ir.Number() | ir.Text() | ir.Logical() | ir.Missing() | ir.ErrorLiteral():
            return []
        case ir.Unary(_, operand):
            return _leaves(operand)
        case ir.Binary(operator) if operator not in (":", " ", ","):
            first, rest = ir.chain(tree)
            return _join([first, *(part for _, part in rest)])
        case ir.Call(name, arguments) if name not in LOOKED_AT and name not in ("LET", "LAMBDA"):
            return _join(arguments)
        case _:
            return None


def _join(parts: list[ir.Expression] | tuple[ir.Expression, ...]) -> list[_Leaf] | None:
    result: list[_Leaf] = []
    for part in parts:
        leaves = _leaves(part)
        if leaves is None:
            return None
        result += leaves
    return result


def _steps(reference: _Leaf) -> tuple[int, int] | None:
    """Whether row and column move with the host; None if not as a whole."""
    if not isinstance(reference, ir.Reference) or reference.last_sheet is not None:
        return None
    first, last = reference.first, reference.last or reference.first
    if None in (first.row, first.column, last.row, last.column):
        return None
    if (first.row_fixed, first.column_fixed) != (last.row_fixed, last.column_fixed):
        return None
    return int(not first.row_fixed), int(not first.column_fixed)


def _rebuild(tree: ir.Expression, moved: Callable[[Cell | Area], Cell | Area]) -> ir.Expression:
    match tree:
        case Cell() | Area():
            return moved(tree)
        case ir.Unary(_, operand):
            return replace(tree, operand=_rebuild(operand, moved))
        case ir.Binary():
            first, rest = ir.chain(tree)
            built = _rebuild(first, moved)
            for operator, right in rest:
                built = ir.Binary(operator, built, _rebuild(right, moved))
            return ir.marked_as(built, tree)
        case ir.Call(_, arguments):
            return replace(tree, arguments=tuple(_rebuild(part, moved) for part in arguments))
        case _:
            return tree
