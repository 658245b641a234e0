"""The shape of a formula: its text with every relative reference written as a distance from its own cell.

A column of formulas filled down has one shape, and is parsed once.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from xlmc.address import MAX_COLUMN, MAX_ROW, column_number
from xlmc.formula import ir
from xlmc.formula.parse import parse
from xlmc.formula.stencil import Stencil

__all__ = ["Shape", "Shapes", "shape_of"]

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
    """The shape of a formula written for a cell; two formulas of one shape differ only by a shift.

    >>> shape_of("A1+$B$2", 1, 3) == shape_of("A5+$B$2", 5, 3) != shape_of("A5+$B$2", 6, 3)
    True
    """

    def relative(found: re.Match[str]) -> str:
        column_fixed, letters, row_fixed, digits = found.group("cf", "c", "rf", "r")
        if digits is not None:
            down, right = int(digits), column_number(letters)
            if right > MAX_COLUMN or down > MAX_ROW:
                return found[0]  # no cell: a name that ends in digits
            return f"\1{_step(row_fixed, down, row)},{_step(column_fixed, right, column)}\1"
        if found["c1"] is not None:
            ends = ["$" if end[0] == "$" else "" for end in (found["c1"], found["c2"])]
            places = [column_number(end.lstrip("$")) for end in (found["c1"], found["c2"])]
            return "\2" + ":".join(str(_step(f, p, column)) for f, p in zip(ends, places, strict=True)) + "\2"
        if found["r1"] is not None:
            ends = [end[:1].strip("0123456789") for end in (found["r1"], found["r2"])]
            places = [int(end.lstrip("$")) for end in (found["r1"], found["r2"])]
            return "\3" + ":".join(str(_step(f, p, row)) for f, p in zip(ends, places, strict=True)) + "\3"
        return found[0]

    return _TOKEN.sub(relative, text)


def _step(fixed: str, place: int, base: int) -> str | int:
    return f"${place}" if fixed else place - base


@dataclass(eq=False, slots=True)
class Shape:
    """What all formulas of one shape have in common.

    Attributes:
        tree: the formula as written in one cell.
        origin: row and column of that cell, from which the tree's relative references are seen.
        stencils: by sheet, once resolved there; None where each cell must be resolved for itself.
    """

    tree: ir.Expression
    origin: tuple[int, int]
    stencils: dict[str, Stencil | None] = field(default_factory=dict)


class Shapes:
    """Parses each shape once."""

    def __init__(self) -> None:
        self._known: dict[str, Shape] = {}
        self._texts: dict[tuple[str, int, int], Shape] = {}

    def parse(self, text: str, row: int, column: int) -> Shape:
        """The shape of a formula written for a cell.

        Raises:
            FormulaError: the text is not a formula.
        """
        written = text, row, column  # the cells of a shared formula have these in common
        found = self._texts.get(written)
        if found is None:
            key = shape_of(text, row, column)
            found = self._known.get(key)
            if found is None:
                self._known[key] = found = Shape(parse(text), (row, column))
            self._texts[written] = found
        return found
