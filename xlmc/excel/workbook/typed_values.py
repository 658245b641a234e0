"""Values as people type them for a cell: on the command line with `--set`, or in a CSV file."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isinf
from pathlib import Path
from typing import Final

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.places import changeable_cell
from xlmc.excel.workbook.workbook import CellValue, Workbook

__all__ = ["ValueRows", "read_value_rows", "typed_change", "typed_value"]

_LOGICALS: Final = {"TRUE": True, "FALSE": False}
_ERRORS: Final = {code.text: code for code in ErrorCode if code not in (ErrorCode.GETTING_DATA, ErrorCode.SPILL)}
"""Errors that Excel takes as such where they are typed."""
_PLAIN: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.ASCII | re.IGNORECASE)
_COMMA: Final = re.compile(r"[+-]?\d+,\d+")
_THOUSANDS: Final = re.compile(r"[+-]?\d{1,3},\d{3}")
_NOTE: Final = "#"
_MOST_ROWS: Final = 1_000_000


@dataclass(frozen=True, slots=True)
class ValueRows:
    """Rows of values for cells.

    Attributes:
        headings: of all columns, as the file writes them; those that begin with # are notes. None where the file lists
            the cells of one row, one below the other.
        given: what stands in each row, by heading: values of cells, and the texts of notes.
        rows: what each row types into cells.
    """

    headings: tuple[str, ...]
    given: tuple[Mapping[str, CellValue], ...]
    rows: tuple[Mapping[Cell, CellValue], ...]


def typed_value(text: str, book: Workbook) -> CellValue:
    """Return what Excel makes of a text that is typed into a cell: a number, a date, TRUE or FALSE, an error value, a
    text, nothing.

    An apostrophe in front makes a text of anything, as in Excel.

    Raises:
        ValueError: a comma may part thousands or decimals, or it is a formula.
    """
    from xlmc.excel.functions.number_text import parse_number

    bare = text.strip()
    if bare.startswith("'"):
        return bare[1:]
    if not bare:
        return None
    if bare.upper() in _LOGICALS:
        return _LOGICALS[bare.upper()]
    if bare.upper() in _ERRORS:
        return _ERRORS[bare.upper()]
    if bare.startswith("=") and len(bare) > 1:
        raise ValueError(f"{bare!r} is a formula: type its value")
    if _COMMA.fullmatch(bare) and not _THOUSANDS.fullmatch(bare):
        raise ValueError(f"{bare!r} is no number: decimals stand behind a point, as in {bare.replace(',', '.')}")
    value = float(bare) if _PLAIN.fullmatch(bare) else parse_number(bare, book.date1904)
    return text if value is None or isinf(value) else value


def typed_change(book: Workbook, text: str) -> tuple[Cell, CellValue]:
    """Return the cell and the value of `Inputs!B3=4.2`, or of `Rate=7 %` for a name of one cell.

    Raises:
        WorkbookError: the text is no such change, or the cell cannot be changed.
    """
    place, equals, value = text.partition("=")
    if not equals or not place.strip():
        hint = "Write the cell, an equals sign and the value: --set Inputs!B3=4.2"
        raise WorkbookError(f"{text!r} is no change of a cell", hint=hint)
    try:
        cell = place if isinstance(place, Cell) else changeable_cell(book, place)
        return cell, typed_value(value, book)
    except (KeyError, ValueError) as error:
        raise WorkbookError(f"--set {text}: {error.args[0]}") from None


def read_value_rows(path: Path, book: Workbook) -> ValueRows:
    """Return the rows of a CSV file whose headings are cells; or one row, where the headings are Cell and Value.

    Raises:
        WorkbookError: the file cannot be read, a heading is no cell, or a value is none; the message names the line.
    """
    _, lines = lines_of(path)
    if not lines:
        raise WorkbookError("the file holds no rows", where=path, hint="Write cells as headings, and rows of values")
    (_, headings), *body = lines
    headings = [heading.strip() for heading in headings]
    if [heading.casefold() for heading in headings[:2]] == ["cell", "value"]:
        listed = {}
        for number, row in body:
            _refuse_other_length(path, number, row, headings)
            place, value = row[:2]
            cell, typed = _typed(path, number, book, place, value)
            if cell in listed:
                raise WorkbookError(
                    f"line {number}: {cell} stands here a second time", where=path, hint="Leave one out"
                )
            listed[cell] = typed
        return ValueRows((), ({},), (listed,))
    cells = {at: _typed(path, 1, book, heading, "")[0] for at, heading in _cells_of(headings)}
    if len({*cells.values()}) < len(cells):
        raise WorkbookError("two headings are the same cell", where=path, hint="Leave one out")
    given: list[Mapping[str, CellValue]] = []
    rows = []
    for number, row in body:
        _refuse_other_length(path, number, row, headings)
        rows.append({cell: _typed(path, number, book, cell, row[at])[1] for at, cell in cells.items()})
        given.append({heading: rows[-1][cells[at]] if at in cells else row[at] for at, heading in enumerate(headings)})
    if not rows:
        raise WorkbookError("the file holds headings, and no row of values", where=path, hint="Add a row of values")
    return ValueRows(tuple(headings), tuple(given), tuple(rows))


def _refuse_other_length(path: Path, line: int, row: list[str], headings: list[str]) -> None:
    """Refuse a row with more or fewer values than headings: each would be typed into a wrong cell, or one emptied.

    Raises:
        WorkbookError: it has.
    """
    if len(row) == len(headings):
        return
    values = "1 value" if len(row) == 1 else f"{len(row)} values"
    message = f"line {line} has {values}, and there are {len(headings)} headings"
    hint = "To empty a cell, leave its field blank and keep the separator"
    if len(row) > len(headings):
        hint = "Put a text with a comma in it in quotation marks, and type numbers without commas"
    raise WorkbookError(message, where=path, hint=hint)


def _cells_of(headings: list[str]) -> Iterator[tuple[int, str]]:
    return ((at, heading) for at, heading in enumerate(headings) if not heading.startswith(_NOTE))


def _typed(path: Path, line: int, book: Workbook, place: str | Cell, value: str) -> tuple[Cell, CellValue]:
    try:
        cell = place if isinstance(place, Cell) else changeable_cell(book, place)
        return cell, typed_value(value, book)
    except KeyError as error:
        hint = f"Name a cell; a heading that begins with {_NOTE} is a note" if line == 1 else None
        raise WorkbookError(f"line {line}: {error.args[0]}", where=path, hint=hint) from None
    except ValueError as error:
        raise WorkbookError(f"line {line}: {error}", where=path) from None


def lines_of(path: Path) -> tuple[str, list[tuple[int, list[str]]]]:
    """Return the mark that parts cells (comma, semicolon or tab) and the lines that hold anything, with their numbers.

    Raises:
        WorkbookError: the file cannot be read, is not in UTF-8, is no table, or has too many lines.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        hint = "Save it as CSV UTF-8 (in Excel: File, Save As)"
        raise WorkbookError("the file is not text in UTF-8", where=path, hint=hint) from None
    except OSError as error:
        message, hint = (
            f"the file cannot be read ({error.strerror or error})",
            "Check its name and that you may read it",
        )
        raise WorkbookError(message, where=path, hint=hint) from error
    first = text.partition("\n")[0]
    mark = max(",;\t", key=first.count)
    reader, lines = csv.reader(io.StringIO(text, newline=""), delimiter=mark), []
    try:
        for row in reader:
            if reader.line_num > _MOST_ROWS:
                hint = "Split it into several files"
                raise WorkbookError(f"the file has more than {_MOST_ROWS:,} lines", where=path, hint=hint)
            if any(cell.strip() for cell in row):
                lines.append((reader.line_num, row))
    except csv.Error as error:
        message = f"line {reader.line_num} cannot be read ({error})"
        raise WorkbookError(message, where=path, hint="Correct it, or save the file as CSV again") from error
    return mark, lines
