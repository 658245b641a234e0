"""The cells of a workbook as an independent reader sees them (python-calamine), beside what xlmc reads."""

from __future__ import annotations

import io
import math
import re
import zipfile
from collections.abc import Iterator
from datetime import date, datetime, time, timedelta
from typing import Final

from fuzzing.inputs import Disagreement
from xlmc.errors import ErrorCode
from xlmc.excel.workbook.safe_xml import decode
from xlmc.excel.workbook.workbook import CellValue, Workbook

__all__ = ["Cells", "agreed", "differing", "equal", "same", "second_reading"]

Cells = dict[str, dict[tuple[int, int], object]]
"""Sheet -> (row, column), from 1 -> value; without blanks."""

_DECLARED: Final = re.compile(rb"""<\?xml[^>]*?encoding=["']([^"']*)""")
_EPOCHS: Final = {False: datetime(1899, 12, 30), True: datetime(1904, 1, 1)}
_DAY: Final = timedelta(days=1)
_CLOSE: Final = 1e-7
"""Days: a date that calamine makes of a number keeps its milliseconds."""
_LEAP_DAY: Final = 61
"""Before this day Excel counts 1900 as a leap year; a date is one number less."""


def second_reading(data: bytes) -> Cells | None:
    """Every cell with a value; None where calamine cannot read the file."""
    from python_calamine import CalamineError, CalamineWorkbook  # only this kind of input needs it

    try:
        book = CalamineWorkbook.from_filelike(io.BytesIO(data))
        result: Cells = {}
        for name in book.sheet_names:
            sheet = book.get_sheet_by_name(name)
            rows = sheet.to_python(skip_empty_area=False)
            result[name] = {
                (row, column): value
                for row, cells in enumerate(rows, 1)
                for column, value in enumerate(cells, 1)
                if value != ""
            }
    except (CalamineError, OSError, ValueError, OverflowError):  # the last: a day beyond Python's calendar
        return None
    except BaseException as error:  # what a panic in Rust becomes is no Exception
        if type(error).__name__ != "PanicException":
            raise
        return None
    return result


def agreed(book: Workbook, data: bytes) -> Cells | None:
    """The cells as calamine reads them from the file that xlmc read the book from, which must be the same.

    calamine takes every part for UTF-8 or UTF-16: one that declares an older encoding is not compared.

    Raises:
        Disagreement: a cell is another.
    """
    cells = None if _in_older_encoding(data) else second_reading(data)
    for difference in differing(book, cells) if cells is not None else ():
        raise Disagreement(f"calamine reads another value: {difference}")
    return cells


def _in_older_encoding(data: bytes) -> bool:
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        starts = [package.open(name).read(100) for name in package.namelist() if name.endswith((".xml", ".rels"))]
    return any((result := _DECLARED.match(start)) and not result[1].lower().startswith(b"utf") for start in starts)


def differing(book: Workbook, cells: Cells) -> Iterator[str]:
    """Each cell that xlmc reads otherwise, with both values."""
    for name, sheet in book.sheets.items():
        theirs = cells.get(name, {})
        ours = {at: content.value for at, content in sheet.cells.items()}
        for at in sorted(ours.keys() | theirs.keys()):
            if not same(ours.get(at), theirs.get(at), date1904=book.date1904):
                yield f"{name}!R{at[0]}C{at[1]}: xlmc {ours.get(at)!r}, calamine {theirs.get(at)!r}"


def same(ours: CellValue, theirs: object, *, date1904: bool) -> bool:
    """Whether two readers mean one value; a blank and an empty text are one, and so are a number and its date.

    calamine gives nothing where there is an error.
    """
    if isinstance(ours, ErrorCode):
        return theirs is None
    if ours is None or ours == "":
        return theirs in (None, "")
    if isinstance(ours, str) and isinstance(theirs, str):
        return ours in (theirs, decode(theirs))  # which calamine does for some characters only
    if isinstance(theirs, str) and type(ours) is float:
        return _number(theirs) == ours  # blanks around a number, which XML Schema allows
    if isinstance(ours, bool) or isinstance(theirs, bool) or isinstance(ours, str):
        return type(ours) is type(theirs) and ours == theirs
    return _close(ours, theirs, date1904=date1904)


def equal(first: object, second: object) -> bool:
    """Whether two values that calamine reads are one number, or the same; a number may be read as a date."""
    if first == second and type(first) is type(second):
        return True
    numbers = [_serial(each, date1904=False) for each in (first, second)]
    dated = next((each for each in (first, second) if not isinstance(each, int | float)), None)
    plain = next((each for each in (first, second) if isinstance(each, int | float)), None)
    return None not in numbers and plain is not None and _close(float(plain), dated, date1904=None)


def _close(ours: float, theirs: object, *, date1904: bool | None) -> bool:
    """Whether a number is what calamine reads, which makes a date of it where its format is one.

    Of negative and of large numbers it may keep the time of the day alone; with None dates count from either year.
    """
    if not isinstance(theirs, date | time | timedelta):
        return ours == theirs
    if isinstance(theirs, time):
        number = _serial(theirs, date1904=False) or 0.0
        return abs((ours - number + 0.5) % 1 - 0.5) < _CLOSE
    near = set()
    for from1904 in (False, True) if date1904 is None else (date1904,):
        number = _serial(theirs, date1904=from1904)
        assert number is not None
        near |= {number, number - 1} if number <= _LEAP_DAY and not from1904 else {number}
    return any(math.isclose(ours, each, rel_tol=1e-12, abs_tol=_CLOSE) for each in near)


def _number(text: str) -> float | None:
    try:
        return float(text.strip(" \t\r\n"))
    except ValueError:
        return None


def _serial(value: object, *, date1904: bool) -> float | None:
    """A number, or what a date or a duration counts as; None of anything else."""
    match value:
        case bool():
            return None
        case int() | float():
            return float(value)
        case datetime():
            return (value - _EPOCHS[date1904]) / _DAY
        case date():
            return _serial(datetime.combine(value, time()), date1904=date1904)
        case time():
            return (datetime.combine(date(1900, 1, 1), value) - datetime(1900, 1, 1)) / _DAY
        case timedelta():
            return value / _DAY
        case _:
            return None
