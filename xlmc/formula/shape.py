"""The shape of a formula: its text with every relative reference written as a distance from its own cell.

A column of formulas filled down has one shape, and is parsed once.
"""

from __future__ import annotations

import re

from xlmc.address import MAX_COLUMN, MAX_ROW, column_number
from xlmc.formula import ir
from xlmc.formula.parse import parse

__all__ = ["Shapes", "shape_of"]

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
        if found["r"] is not None:
            number = column_number(found["c"])
            if number > MAX_COLUMN or int(found["r"]) > MAX_ROW:
                return found[0]  # no cell: a name that ends in digits
            return f"\1{_step(found['rf'], int(found['r']), row)},{_step(found['cf'], number, column)}\1"
        if found["c1"] is not None:
            ends = [(end[0] == "$" and "$") or "" for end in (found["c1"], found["c2"])]
            places = [column_number(end.lstrip("$")) for end in (found["c1"], found["c2"])]
            return "\2" + ":".join(_step(f, p, column) for f, p in zip(ends, places, strict=True)) + "\2"
        if found["r1"] is not None:
            rows = (found["r1"], found["r2"])
            return "\3" + ":".join(_step(end[:1].strip("0123456789"), int(end.lstrip("$")), row) for end in rows) + "\3"
        return found[0]

    return _TOKEN.sub(relative, text)


def _step(fixed: str, place: int, base: int) -> str:
    return f"${place}" if fixed else str(place - base)


class Shapes:
    """Parses each shape once."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[ir.Expression, tuple[int, int]]] = {}

    def parse(self, text: str, row: int, column: int) -> tuple[ir.Expression, tuple[int, int]]:
        """The tree of a formula written for a cell, and the cell that its relative references are seen from.

        Raises:
            FormulaError: the text is not a formula.
        """
        shape = shape_of(text, row, column)
        if shape not in self._known:
            self._known[shape] = parse(text), (row, column)
        return self._known[shape]
