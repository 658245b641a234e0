"""How results look on a terminal or in a pipe: tables that fit its width, notes and warnings.

In a table words wrap, numbers are never cut, and what is too wide becomes a list.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

import click

from xlmc.cli.terminal import encodable, on_terminal, paragraph, put, say, width, words
from xlmc.errors import shortened
from xlmc.excel.workbook.printable import printable

if TYPE_CHECKING:
    from xlmc.errors import Notice

__all__ = ["heading", "notices", "table", "table_lines", "use_number_style", "warnings"]

_PIPE_WIDTH: Final = 160

_BOLD: Final = "\x1b[1m", "\x1b[0m"

_GAPS: Final = ("   ", "  ")
"""Between columns: the narrower one where the wider one would cut something."""

_LEAST: Final = 13
"""Columns of text are not made narrower than this to make room."""


def table(title: str, headings: Sequence[str], rows: Sequence[Sequence[str]], *, right: Sequence[int] = ()) -> None:
    """Print rows under headings; the columns of `right` are numbers, aligned to the right.

    No line is longer than the terminal is wide, and none in a pipe longer than `_PIPE_WIDTH`.
    """
    widest = width() if on_terminal() else _PIPE_WIDTH
    shown = [[_one_line(cell) for cell in row] for row in rows]
    lines = table_lines([_one_line(heading) for heading in headings], shown, right, widest, encodable("─"))
    put("\n".join((*_title(title), *lines)) + "\n\n")


def heading(title: str) -> None:
    """Print a heading, with a line of space below it."""
    put("\n".join(_title(title)) + "\n")


def _title(text: str) -> tuple[str, ...]:
    return (_bold(paragraph(_one_line(text))), "") if text else ()


def use_number_style(style: str) -> None:
    """Write all numbers in a style until the command ends; see `in_style`."""
    from xlmc.montecarlo.definitions.number_styles import in_style

    click.get_current_context().with_resource(in_style(style))


def notices(result: Sequence[Notice]) -> None:
    """Print what the person should know, to stderr."""
    for notice in result:
        say(f"note: {notice}", err=True)


def warnings(result: Sequence[str], missing: Collection[str] = ()) -> None:
    """Print why an answer must not be used, to stderr; of those that are `missing`, that others do not need them."""
    for warning in result:
        meaning = "this answer is missing, and the others do not need it"
        verdict = meaning if warning in missing else "the answer must not be used as it is"
        say(f"warning: {shortened(warning)}; {verdict}.", err=True)


def _one_line(cell: str) -> str:
    return encodable(" ".join(printable(cell).splitlines()))


def _bold(text: str) -> str:
    plain = not on_terminal() or os.name != "posix" or "NO_COLOR" in os.environ or os.environ.get("TERM") == "dumb"
    return text if plain else text.join(_BOLD)


@dataclass(frozen=True, slots=True)
class _Column:
    """A column: its heading and cells, each as the pieces between which a line may end."""

    heading: list[str]
    cells: list[list[str]]
    right: bool

    @property
    def natural(self) -> int:
        """The width at which nothing wraps."""
        return max(_wide(" ".join(pieces)) for pieces in (self.heading, *self.cells))

    @property
    def least(self) -> int:
        """The width below which a number, or a word of text that is not long, would be cut."""
        pieces = [piece for cell in self.cells for piece in cell]
        longest = max((_wide(piece) for piece in pieces), default=0)
        heading = max((_wide(piece) for piece in self.heading), default=0)
        return max(heading, longest if self.right else min(longest, _LEAST))


def table_lines(
    headings: Sequence[str], rows: Sequence[Sequence[str]], right: Sequence[int], width: int, rule: str
) -> Iterator[str]:
    """Return the lines of a table.

    Args:
        headings: of its columns.
        rows: their cells.
        right: the columns that are aligned to the right: their cells are numbers, which wrap only before "to".
        width: of the longest line.
        rule: the character of the line below the headings.
    """
    columns = [
        _Column(_words(heading), [_pieces(row[index], index in right) for row in rows], index in right)
        for index, heading in enumerate(headings)
    ]
    for gap in _GAPS:
        widths = _widths(columns, width, gap)
        if widths is not None:
            yield from _lines([column.heading for column in columns], columns, widths, gap)
            yield " " + rule * (sum(widths) + len(gap) * (len(widths) - 1))
            for index in range(len(rows)):
                yield from _lines([column.cells[index] for column in columns], columns, widths, gap)
            return
    yield from _list_rows(headings, rows, width)


def _widths(columns: Sequence[_Column], width: int, gap: str) -> list[int] | None:
    """Return the width of each column; None if they cannot be made narrow enough."""
    widths = [column.natural for column in columns]
    available = width - 2 - len(gap) * (len(columns) - 1)
    least = [column.least for column in columns]
    if sum(least) > available:
        return None
    while sum(widths) > available:  # the widest that can give way does
        index = max((index for index in range(len(widths)) if widths[index] > least[index]), key=widths.__getitem__)
        widths[index] -= 1
    return widths


def _lines(cells: Sequence[list[str]], columns: Sequence[_Column], widths: Sequence[int], gap: str) -> Iterator[str]:
    wrapped = [_wrap(pieces, width) for pieces, width in zip(cells, widths, strict=True)]
    for parts in zip_longest(*wrapped, fillvalue=""):
        filled = (_pad(part, width, column) for part, width, column in zip(parts, widths, columns, strict=True))
        yield f" {gap.join(filled)}".rstrip()


def _pad(text: str, width: int, column: _Column) -> str:
    blank = " " * (width - _wide(text))
    return blank + text if column.right else text + blank


def _list_rows(headings: Sequence[str], rows: Sequence[Sequence[str]], width: int) -> Iterator[str]:
    """Each row as lines of heading and cell."""
    longest = max((_wide(heading) for heading in headings[1:]), default=0)
    for row in rows:
        for part in _wrap(_words(row[0]), width - 1):
            yield f" {part}"
        for heading, cell in zip(headings[1:], row[1:], strict=True):
            start = f"   {heading}{' ' * (longest - _wide(heading))}  "
            for part in _wrap(_words(cell), max(_LEAST, width - len(start))) if cell else ():
                yield start + part
                start = " " * len(start)


def _pieces(cell: str, right: bool) -> list[str]:
    if not right:
        return _words(cell)
    first, to, second = cell.partition(" to ")
    return [first, f"to {second}"] if to else [cell]


def _words(text: str) -> list[str]:
    return words(text) or [""]


def _wrap(pieces: Sequence[str], width: int) -> list[str]:
    lines: list[str] = []
    for piece in pieces:
        if lines and _wide(lines[-1]) + 1 + _wide(piece) <= width:
            lines[-1] += f" {piece}"
        else:
            *full, last = _fold(piece, width)
            lines += [*full, last]
    return lines


def _fold(word: str, width: int) -> list[str]:
    """Return the parts of a word that is longer than a line."""
    parts = [""]
    for letter in word:
        if parts[-1] and _wide(parts[-1]) + _wide(letter) > width:
            parts.append("")
        parts[-1] += letter
    return parts


_NARROW: Final = re.compile("[ -~\xa0-\u02ff\u0370-\u03ff\u2010-\u2027\u2030-\u205f\u2070-\u209f\u2190-\u22ff]*")
"""Signs of one column each, as words and numbers here have: accents, Greek, dashes, superscripts, arrows, operators."""


def _wide(text: str) -> int:
    """Columns of the screen that a text takes: two for an East Asian letter, none for a mark on another."""
    if text.isascii() or _NARROW.fullmatch(text):
        return len(text)
    from rich.cells import cell_len

    return cell_len(text)
