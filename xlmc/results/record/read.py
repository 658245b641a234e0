"""Read a record back from the sheet of a result workbook that holds it.

The sheet is found by what it holds, so a person may have renamed or moved it. Its first column has the keys:
`run.repeat` beside an entry, `forecasts` beside a section's title, `forecasts[0]` beside the first row of its table.
The columns' keys stand two rows above that.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Final

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.results.record.record_parts import Entry, Record, RecordTable, Section, Value
from xlmc.workbook.model import CellContent, Sheet, Workbook

__all__ = ["read_record"]

_KEY: Final = re.compile(r"(?P<section>[a-z]\w*)(?:\.(?P<entry>\w+)|\[(?P<row>\d+)\])?")
_KEYS, _LABELS, _VALUES = 1, 2, 3
"""Columns of the sheet, counted from 1."""

_MARKS: Final = frozenset({"run.repeat", "run.fingerprint", "counts.trials"})
_NONE: Final = "–"
_HEADINGS: Final = 2
"""Rows between the keys of a table's columns and its first row."""

_Cells = Mapping[tuple[int, int], CellContent]


def read_record(workbook: Workbook) -> Record:
    """The record of the run whose results the workbook holds.

    A text that was too long for its cell is cut, and what had no value is None.

    Raises:
        WorkbookError: the workbook holds no record, or several.
    """
    found = [sheet for sheet in map(workbook.sheets.__getitem__, workbook.sheets) if _holds_record(sheet)]
    if not found:
        hint = "Give the workbook that xlmc simulate wrote, such as case-results.xlsx"
        raise WorkbookError("the workbook holds no record of a run", where=workbook.name, hint=hint)
    if len(found) > 1:
        names = ", ".join(repr(sheet.name) for sheet in found)
        hint = "Delete all but the one of the run to repeat"
        raise WorkbookError(f"the sheets {names} each hold a record of a run", where=workbook.name, hint=hint)
    return Record(tuple(_sections(found[0].cells)))


def _holds_record(sheet: Sheet) -> bool:
    keys = {content.value for (_, column), content in sheet.cells.items() if column == _KEYS}
    return keys >= _MARKS


def _sections(cells: _Cells) -> Iterator[Section]:
    """Every section in the order of its rows."""
    titles: dict[str, str] = {}
    entries: dict[str, list[Entry]] = {}
    rows: dict[str, list[int]] = {}
    for row, found in _rows_with_keys(cells):
        section = found["section"]
        if found["entry"] is not None:
            label = str(_value(cells, row, _LABELS) or "")
            entries.setdefault(section, []).append(Entry(found["entry"], label, _value(cells, row, _VALUES)))
        elif found["row"] is not None:
            rows.setdefault(section, []).append(row)
        else:
            titles[section] = str(_value(cells, row, _LABELS) or "")
    for key, title in titles.items():
        table = _table(cells, rows[key]) if key in rows else None
        yield Section(key, title, tuple(entries.get(key, ())), table)


def _rows_with_keys(cells: _Cells) -> Iterator[tuple[int, re.Match[str]]]:
    """The rows that have a key, in their order."""
    for row in sorted(row for row, column in cells if column == _KEYS):
        found = _KEY.fullmatch(str(cells[row, _KEYS].value))
        if found is not None:
            yield row, found


def _table(cells: _Cells, rows: list[int]) -> RecordTable:
    heading = rows[0] - _HEADINGS
    used = sorted(column for row, column in cells if row == heading and column > _KEYS)
    used = [column for column in used if cells[heading, column].value is not None]
    columns = tuple((str(cells[heading, column].value), str(_value(cells, heading + 1, column))) for column in used)
    return RecordTable(columns, tuple(tuple(_value(cells, row, column) for column in used) for row in rows))


def _value(cells: _Cells, row: int, column: int) -> Value:
    value = cells.get((row, column), CellContent()).value
    if isinstance(value, ErrorCode):
        return value.text
    return None if value == _NONE else value
