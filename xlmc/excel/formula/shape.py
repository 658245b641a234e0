"""A formula's text for another cell: its shape, which cells filled down have in common, and how Excel shows it.

In the shape every relative reference is written as a distance from the formula's own cell. A column of formulas filled
down has one shape, and is parsed once. Excel shows the text without the prefixes that only the file has.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from xlmc.excel.address import MAX_COLUMN, MAX_ROW, Cell, column_letters, column_number
from xlmc.excel.formula import ir
from xlmc.excel.formula.parse import parse_cell
from xlmc.excel.formula.stencil import Stencil
from xlmc.excel.workbook.workbook import Formula

__all__ = ["Shapes", "shape_of", "shown_formula", "text_at"]

_TOKEN = re.compile(
    r'"(?:[^"]|"")*"'  # a text
    r"|'(?:[^']|'')*'"  # a sheet's name
    r"|\[(?:'.|[^\[\]']|\[(?:'.|[^\[\]'])*\])*\]"  # a table's columns, another book
    r"|(?<![\w.$\\?:!])[^\W\d][\w.]*:[^\W\d][\w.]*!"  # the first and the last of several sheets
    r"|(?<![\w.$\\?])(?P<cf>\$?)(?P<c>[A-Za-z]{1,3})(?P<rf>\$?)(?P<r>[1-9][0-9]{0,6})(?![\w.(!\[\\?])"
    r"|(?<![\w.$\\?:])(?P<c1>\$?[A-Za-z]{1,3}):(?P<c2>\$?[A-Za-z]{1,3})(?![\w.(!\[\\?$])"
    r"|(?<![\w.$\\?:])(?P<r1>\$?[1-9][0-9]*):(?P<r2>\$?[1-9][0-9]*)(?![\w.(!\[\\?$])",
    re.DOTALL,
)


def shape_of(text: str, row: int, column: int) -> str:
    """Return the shape of a formula written for a cell; two formulas of one shape differ only by a shift.

    >>> shape_of("A1+$B$2", 1, 3) == shape_of("A5+$B$2", 5, 3) != shape_of("A5+$B$2", 6, 3)
    True
    """

    def relative(match: re.Match[str]) -> str:
        column_fixed, letters, row_fixed, digits = match.group("cf", "c", "rf", "r")
        if digits is not None:
            down, right = int(digits), column_number(letters)
            if right > MAX_COLUMN or down > MAX_ROW:
                return match[0]  # no cell: a name that ends in digits
            return f"\1{_step(row_fixed, down, row)},{_step(column_fixed, right, column)}\1"
        if match["c1"] is not None:
            ends = ["$" if end[0] == "$" else "" for end in (match["c1"], match["c2"])]
            numbers = [column_number(end.lstrip("$")) for end in (match["c1"], match["c2"])]
            return "\2" + ":".join(str(_step(f, p, column)) for f, p in zip(ends, numbers, strict=True)) + "\2"
        if match["r1"] is not None:
            ends = [end[:1].strip("0123456789") for end in (match["r1"], match["r2"])]
            numbers = [int(end.lstrip("$")) for end in (match["r1"], match["r2"])]
            return "\3" + ":".join(str(_step(f, p, row)) for f, p in zip(ends, numbers, strict=True)) + "\3"
        return match[0]

    return _TOKEN.sub(relative, text)


def _step(fixed: str, number: int, base: int) -> str | int:
    return f"${number}" if fixed else number - base


def text_at(text: str, down: int, right: int) -> str:
    """Write a formula as it reads when it is filled so many rows down and columns to the right.

    >>> text_at("A1*$B$2+SUM(C:C)", 2, 1)
    'B3*$B$2+SUM(D:D)'
    """

    def moved(match: re.Match[str]) -> str:
        column_fixed, letters, row_fixed, digits = match.group("cf", "c", "rf", "r")
        if digits is not None:
            if column_number(letters) > MAX_COLUMN or int(digits) > MAX_ROW:
                return match[0]
            return f"{_column_at(column_fixed, letters, right)}{_row_at(row_fixed, digits, down)}"
        if match["c1"] is not None:
            return ":".join(
                _column_at(end[: -len(end.lstrip("$"))], end.lstrip("$"), right) for end in match.group("c1", "c2")
            )
        if match["r1"] is not None:
            return ":".join(
                _row_at(end[: -len(end.lstrip("$"))], end.lstrip("$"), down) for end in match.group("r1", "r2")
            )
        return match[0]

    return _TOKEN.sub(moved, text) if down or right else text


def _column_at(fixed: str, letters: str, right: int) -> str:
    return f"${letters}" if fixed else column_letters((column_number(letters) + right - 1) % MAX_COLUMN + 1)


def _row_at(fixed: str, digits: str, down: int) -> str:
    return f"${digits}" if fixed else str((int(digits) + down - 1) % MAX_ROW + 1)


class _Filling(NamedTuple):
    """What a formula becomes in other rows of its column: a pattern for `%`, and its rows as seen from the host.

    `least` and `most` are the rows in which no reference leaves the sheet.
    """

    pattern: str
    steps: tuple[int, ...]
    least: int
    most: int

    def gives(self, text: str, row: int) -> bool:
        """Whether it is this in that row."""
        if not self.least <= row <= self.most:
            return False
        return self.pattern % tuple([row + step for step in self.steps]) == text


def _filling(text: str, row: int) -> _Filling | None:
    """None if the text refers to whole rows."""
    pieces, steps, end = [], [], 0
    for match in _TOKEN.finditer(text):
        if match["r1"] is not None:
            return None
        if match["r"] is not None and not match["rf"] and column_number(match["c"]) <= MAX_COLUMN:
            if int(match["r"]) > MAX_ROW:
                continue
            start, stop = match.span("r")
            pieces.append(text[end:start].replace("%", "%%") + "%d")
            steps.append(int(match["r"]) - row)
            end = stop
    pieces.append(text[end:].replace("%", "%%"))
    return _Filling("".join(pieces), tuple(steps), 1 - min(steps, default=0), MAX_ROW - max(steps, default=0))


@dataclass(eq=False, slots=True)
class _Shape:
    """What all formulas of one shape have in common.

    Attributes:
        tree: the formula as written in one cell.
        origin: row and column of that cell, from which the tree's relative references are seen.
        stencils: by sheet, once resolved there; None if each cell must be resolved for itself.
    """

    tree: ir.Expression
    origin: tuple[int, int]
    stencils: dict[str, Stencil | None] = field(default_factory=dict)


class Shapes:
    """Parses each shape once."""

    def __init__(self) -> None:
        self._known: dict[str, _Shape] = {}
        self._texts: dict[tuple[str, int, int], _Shape] = {}
        self._columns: dict[int, tuple[_Filling, _Shape]] = {}

    def parse(self, text: str, row: int, column: int) -> _Shape:
        """Return the shape of a formula written for a cell.

        Raises:
            FormulaError: the text is not a formula.
        """
        written = text, row, column  # the cells of a shared formula have these in common
        shape = self._texts.get(written)
        if shape is None:
            self._texts[written] = shape = self._filled(text, row, column) or self._shape(text, row, column)
        return shape

    def _filled(self, text: str, row: int, column: int) -> _Shape | None:
        """Return the shape of the formula met last in the column, if filling that down gives this one."""
        if column not in self._columns:
            return None
        filling, shape = self._columns[column]
        return shape if filling.gives(text, row) else None

    def _shape(self, text: str, row: int, column: int) -> _Shape:
        key = shape_of(text, row, column)
        shape = self._known.get(key)
        if shape is None:
            self._known[key] = shape = _Shape(parse_cell(text), (row, column))
        filling = _filling(text, row)
        if filling is not None:
            self._columns[column] = filling, shape
        return shape


_REFERENCE: Final = r"(?:'(?:[^']|'')*'!)?[\w.$!:]+"
_HIDDEN: Final = re.compile(
    r'"(?:[^"]|"")*"'  # a text
    r"|(?:_xlfn\.)?LAMBDA\((?P<parameters>(?:\s*_xl(?:pm|op)\.[\w.]+\s*,)+)"
    rf"|_xlfn\.ANCHORARRAY\((?P<spilled>{_REFERENCE})\)"
    rf"|_xlfn\.SINGLE\((?P<single>{_REFERENCE})\)"
    r"|'(?:[^']|'')*'"  # a sheet's name
    r"|(?<![\w.])(?P<prefix>(?:_xlfn\.|_xlws\.|_xlpm\.|_xlop\.|_xleta\.|_xll\.)+)",
    re.IGNORECASE,
)
_OPTIONAL: Final = re.compile(r"_xlop\.([\w.]+)", re.IGNORECASE)
_NEEDED: Final = re.compile(r"_xlpm\.", re.IGNORECASE)


def shown_formula(formula: Formula, cell: Cell) -> str:
    """Return a cell's formula with its `=`; in braces where it was entered with Ctrl-Shift-Enter.

    Args:
        formula: as the file holds it; a shared formula's text is that of another cell.
        cell: that it stands in.
    """
    if formula.array is not None and not formula.dynamic:
        return f"{{={_HIDDEN.sub(_shown, formula.text)}}}"
    text = text_at(formula.text, cell.row - formula.row, cell.column - formula.column)
    return f"={_HIDDEN.sub(_shown, text)}"


def _shown(match: re.Match[str]) -> str:
    if match["parameters"] is not None:
        return "LAMBDA(" + _NEEDED.sub("", _OPTIONAL.sub(r"[\1]", match["parameters"]))
    if match["spilled"] is not None:
        return f"{_NEEDED.sub('', match['spilled'])}#"
    if match["single"] is not None:
        return f"@{_NEEDED.sub('', match['single'])}"
    return "" if match["prefix"] is not None else match[0]
