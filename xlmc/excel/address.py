"""Cells and areas of a workbook: parse and print `Sheet!A1:B2`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

__all__ = [
    "MAX_COLUMN",
    "MAX_ROW",
    "Area",
    "Cell",
    "InFormula",
    "column_letters",
    "column_number",
    "host_of",
    "parse_address",
    "quote_sheet",
]

MAX_ROW = 1_048_576
MAX_COLUMN = 16_384

_A1 = re.compile(r"\$?([A-Za-z]{1,3})\$?([1-9][0-9]{0,6})")
_PLAIN_SHEET = re.compile(r"[^\W\d][\w.]*")
_LOOKS_LIKE_A_CELL = re.compile(r"[A-Za-z]{1,3}[0-9]+|[Rr][0-9]*[Cc][0-9]*|[Rr]|[Cc]")


class Cell(NamedTuple):
    """One cell; rows and columns count from 1. A tuple, because large books make millions and look them up in dicts."""

    sheet: str
    row: int
    column: int

    @property
    def a1(self) -> str:
        """The address within its sheet, `B7`."""
        return f"{column_letters(self.column)}{self.row}"

    def __str__(self) -> str:
        return f"{quote_sheet(self.sheet)}!{self.a1}"


class InFormula(Cell):
    """A part of a cell's formula that is treated as a cell of its own, `Sheet1!B7#2`.

    Its row and column are the cell's; its sheet is one that no workbook can have, for no sheet's name holds brackets.

    >>> part = InFormula.of(Cell("Data", 7, 2), "2")
    >>> str(part), str(part.host)
    ('Data!B7#2', 'Data!B7')
    >>> str(InFormula.of(Cell("[other.xlsx]Data", 7, 2), "2").host)
    "'[other.xlsx]Data'!B7"
    """

    __slots__ = ()

    @classmethod
    def of(cls, host: Cell, label: str) -> InFormula:
        """Return the part of a cell's formula with this label."""
        return cls(f"{host.sheet}[{label}]", host.row, host.column)

    @property
    def host(self) -> Cell:
        """The cell whose formula it is part of."""
        return Cell(self._parts[0], self.row, self.column)

    @property
    def _parts(self) -> tuple[str, str]:
        """The sheet, which may begin with another workbook in brackets, and the label."""
        start = self.sheet.find("[", self.sheet.find("]") + 1 if self.sheet.startswith("[") else 0)
        return self.sheet[:start], self.sheet[start + 1 : -1]

    def __str__(self) -> str:
        return f"{self.host}#{self._parts[1]}"


def host_of(cell: Cell) -> Cell:
    """Return the cell itself, or the one whose formula it is part of."""
    return cell.host if isinstance(cell, InFormula) else cell


@dataclass(frozen=True, slots=True, order=True)
class Area:
    """A rectangle of cells on one sheet, both corners included.

    Attributes:
        further_rows, further_columns: empty ones that belong to it too, beyond all that the sheet holds: a whole column
            ends with the last filled cell, but keeps its size.
    """

    sheet: str
    top: int
    left: int
    bottom: int
    right: int
    further_rows: int = 0
    further_columns: int = 0

    @property
    def rows(self) -> int:
        return self.bottom - self.top + 1

    @property
    def columns(self) -> int:
        return self.right - self.left + 1

    @property
    def is_cut(self) -> bool:
        """Whether it has further rows or columns."""
        return self.further_rows > 0 or self.further_columns > 0

    @property
    def whole(self) -> Area:
        """The area with its further rows and columns counted as ordinary ones."""
        bottom, right = self.bottom + self.further_rows, self.right + self.further_columns
        return Area(self.sheet, self.top, self.left, bottom, right)

    @property
    def filled(self) -> Area:
        """The area without its further rows and columns."""
        return Area(self.sheet, self.top, self.left, self.bottom, self.right)

    def __contains__(self, cell: Cell) -> bool:
        return (
            cell.sheet == self.sheet and self.top <= cell.row <= self.bottom and self.left <= cell.column <= self.right
        )

    def cells(self) -> Iterator[Cell]:
        """Every cell, row by row."""
        for row in range(self.top, self.bottom + 1):
            for column in range(self.left, self.right + 1):
                yield Cell(self.sheet, row, column)

    @property
    def a1(self) -> str:
        """The address within its sheet, `A1:B2`."""
        return f"{column_letters(self.left)}{self.top}:{column_letters(self.right)}{self.bottom}"

    def __str__(self) -> str:
        return f"{quote_sheet(self.sheet)}!{self.a1}"


@cache
def column_letters(number: int) -> str:
    """`28 -> 'AB'`."""
    letters = ""
    while number:
        number, digit = divmod(number - 1, 26)
        letters = chr(ord("A") + digit) + letters
    return letters


@cache
def column_number(letters: str) -> int:
    """`'AB' -> 28`."""
    number = 0
    for letter in letters.upper():
        number = number * 26 + ord(letter) - ord("A") + 1
    return number


def quote_sheet(name: str) -> str:
    """Write the sheet name as a formula does: in quotes where it needs them."""
    if _PLAIN_SHEET.fullmatch(name) and not _LOOKS_LIKE_A_CELL.fullmatch(name):
        return name
    return "'" + name.replace("'", "''") + "'"


def parse_address(text: str, sheet: str | None = None) -> Cell | Area:
    """Read `Sheet!B7`, `'My sheet'!$A$1:$B$2`, or, where `sheet` is given, `B7`.

    Raises:
        ValueError: the text is not an address, or names no sheet and none was given.
    """
    text = text.strip()
    head, bang, tail = text.rpartition("!")
    if bang:
        quoted = len(head) > 1 and head[0] == head[-1] == "'"
        sheet = head[1:-1].replace("''", "'") if quoted else head
    if not sheet:
        raise ValueError(f"{text!r} names no sheet")
    corners = [_A1.fullmatch(part) for part in tail.split(":")]
    if len(corners) > 2 or not all(corners):
        raise ValueError(f"{text!r} is not a cell or an area")
    positions = [(int(match[2]), column_number(match[1])) for match in corners if match]
    if any(row > MAX_ROW or column > MAX_COLUMN for row, column in positions):
        raise ValueError(f"{text!r} lies outside the sheet")
    if len(positions) == 1:
        return Cell(sheet, *positions[0])
    (r1, c1), (r2, c2) = positions
    return Area(sheet, min(r1, r2), min(c1, c2), max(r1, r2), max(c1, c2))
