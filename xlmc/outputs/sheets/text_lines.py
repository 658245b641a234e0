"""How many lines a text takes in a cell, whatever letters the computer has that shows it.

A row is as high as its texts need, and neither Excel nor LibreOffice sees to that in merged cells. A column's width is
counted in digits. Beside a digit, letters are taken for as wide as in the wider one of Carlito, which is as wide as
Calibri, and DejaVu Sans, which LibreOffice takes where it has no other: running text has 1.23 letters to a digit.
"""

from __future__ import annotations

import math
from typing import Final

__all__ = ["line_count"]

_WIDTHS: Final = {
    letter: width
    for width, letters in {
        0.5: " '.,:;Iijl·’",
        0.6: "!()-J[]f",
        0.7: "rt²°",
        0.8: '"/\\`sz“”',
        0.9: "?FLckvxy|–",
        1.1: "ABCRVXZ",
        1.2: "DGH",
        1.3: "#&+<=>NOQU^~±−×≤≥",
        1.4: "wω",
        1.5: "%",
        1.6: "m…",
        1.7: "M∞",
        1.8: "@W",
    }.items()
    for letter in letters
}
"""Letter -> its width in digits; all others are as wide as a digit, or `_FULL` from the scripts of East Asia on."""

_FULL: Final = 2.0
_EAST: Final = "\u1100"
_BOLD: Final = 1.08
"""How much wider bold letters are."""


def line_count(text: str, room: float, *, bold: bool = False, even: float = 0.0) -> int:
    """Return how many lines a text takes that is broken between words, and within those that are too long for a line.

    Args:
        text: with its own line breaks.
        room: the width of a line, in digits.
        bold: whether its letters are bold.
        even: the width of each letter, in digits, where all are as wide; otherwise 0.

    >>> line_count("a line and a second one", 12.0)
    2
    """
    room = max(room, 1.0) / (_BOLD if bold else 1.0)
    return sum(_lines_of(line, room, even) for line in text.split("\n"))


def _lines_of(line: str, room: float, even: float) -> int:
    """Return the lines that a text without line breaks takes."""
    lines, filled = 1, 0.0
    space = even or _WIDTHS[" "]
    for word in line.split(" "):
        width = even * len(word) if even else sum(map(_width, word))
        if filled and filled + space + width > room:
            lines, filled = lines + 1, 0.0
        filled += (space if filled else 0.0) + width
        if filled > room:
            further = math.ceil(filled / room) - 1
            lines, filled = lines + further, filled - further * room
    return lines


def _width(letter: str) -> float:
    return _WIDTHS.get(letter, _FULL if letter >= _EAST else 1.0) if letter > " " else 0.0
