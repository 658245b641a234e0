"""What a record is made of: sections of entries and tables, every one with a key that programs read it by.

Values are plain strings, numbers and logicals, so that a record can be written anywhere and read back: `read_record`
reads the sheet Record.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from xlmc.errors import ErrorCode, WorkbookError
from xlmc.excel.workbook.lazy_sheets import LazySheets
from xlmc.excel.workbook.workbook import CellContent, Sheet, Workbook

__all__ = ["EDITED", "Entry", "Record", "RecordTable", "Section", "Value", "read_record"]

EDITED: Final = "The record was edited: use a copy of the result workbook as xlmc wrote it"
"""What to do about a record that cannot be read."""

Value = str | int | float | bool | None
"""A value in the record. It is None if there is none: no units, no cutoff, no trial to take a mean of."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One fact: a key for programs, a label for people."""

    key: str
    label: str
    value: Value


@dataclass(frozen=True, slots=True)
class RecordTable:
    """Facts of one kind, one a row. `columns` are (key, label); every row has a value for each."""

    columns: tuple[tuple[str, str], ...]
    rows: tuple[tuple[Value, ...], ...]

    def as_dicts(self) -> list[dict[str, Value]]:
        """Return the rows by column key."""
        keys = [key for key, _ in self.columns]
        return [dict(zip(keys, row, strict=True)) for row in self.rows]


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a record: its entries, then its table, if it has one."""

    key: str
    title: str
    entries: tuple[Entry, ...] = ()
    table: RecordTable | None = None


@dataclass(frozen=True, slots=True)
class Record:
    """All that a run was a function of, what it counted, and how to repeat it."""

    sections: tuple[Section, ...]

    def __contains__(self, key: object) -> bool:
        """Whether there is a section of that key."""
        return any(section.key == key for section in self.sections)

    def section(self, key: str) -> Section:
        """Return the section of that key.

        Raises:
            KeyError: there is none.
        """
        for section in self.sections:
            if section.key == key:
                return section
        raise KeyError(key)

    def __getitem__(self, key: str) -> Value:
        """Return the value of an entry, as `record["file.sha256"]`.

        Raises:
            KeyError: there is no such entry.
        """
        section_key, _, wanted = key.partition(".")
        for entry in self.section(section_key).entries:
            if entry.key == wanted:
                return entry.value
        raise KeyError(key)

    def rows(self, key: str) -> list[dict[str, Value]]:
        """Return the rows of a section's table by column key; none where it has no table.

        Raises:
            KeyError: there is no such section.
        """
        table = self.section(key).table
        return [] if table is None else table.as_dicts()

    def as_dict(self) -> dict[str, dict[str, Value | list[dict[str, Value]]]]:
        """Everything by key, as JSON holds it: section -> entry -> value, with the table under `rows`."""
        result: dict[str, dict[str, Value | list[dict[str, Value]]]] = {}
        for section in self.sections:
            result[section.key] = {entry.key: entry.value for entry in section.entries}
            if section.table is not None:
                result[section.key]["rows"] = section.table.as_dicts()
        return result


_KEY: Final = re.compile(r"(?P<section>[a-z]\w*)(?:\.(?P<entry>\w+)|\[(?P<row>\d+)\])?")
_KEYS, _LABELS, _VALUES = 1, 2, 3
"""Columns of the sheet, counted from 1."""

_MARKS: Final = frozenset({"run.repeat", "run.fingerprint", "counts.trials"})
_NONE: Final = "–"
_HEADINGS: Final = 2
"""Rows between the keys of a table's columns and its first row."""

_Cells = Mapping[tuple[int, int], CellContent]


def read_record(workbook: Workbook) -> Record:
    """Return the record of the run whose results the workbook holds.

    A text that was too long for its cell is cut, and what had no value is None.

    Raises:
        WorkbookError: the workbook holds no record, or several.
    """
    sheets = workbook.sheets
    likely = sheets.holding(_MARKS) if isinstance(sheets, LazySheets) else []  # large ones are not parsed for it
    result = [sheet for sheet in map(sheets.__getitem__, likely or sheets) if _holds_record(sheet)]
    if not result:
        hint = "Give the workbook that xlmc simulate wrote, such as case-results.xlsx"
        raise WorkbookError("the workbook holds no record of a run", where=workbook.name, hint=hint)
    if len(result) > 1:
        names = ", ".join(repr(sheet.name) for sheet in result)
        hint = "Delete all but the one of the run to repeat"
        raise WorkbookError(f"the sheets {names} each hold a record of a run", where=workbook.name, hint=hint)
    return Record(tuple(_sections(result[0].cells)))


def _holds_record(sheet: Sheet) -> bool:
    keys = {content.value for (_, column), content in sheet.cells.items() if column == _KEYS}
    return keys >= _MARKS


def _sections(cells: _Cells) -> Iterator[Section]:
    """Every section in the order of its rows."""
    titles: dict[str, str] = {}
    entries: dict[str, list[Entry]] = {}
    rows: dict[str, list[int]] = {}
    for row, match in _rows_with_keys(cells):
        section = match["section"]
        if match["entry"] is not None:
            label = str(_value(cells, row, _LABELS) or "")
            entries.setdefault(section, []).append(Entry(match["entry"], label, _value(cells, row, _VALUES)))
        elif match["row"] is not None:
            rows.setdefault(section, []).append(row)
        else:
            titles[section] = str(_value(cells, row, _LABELS) or "")
    for key, title in titles.items():
        table = _table(cells, rows[key]) if key in rows else None
        yield Section(key, title, tuple(entries.get(key, ())), table)


def _rows_with_keys(cells: _Cells) -> Iterator[tuple[int, re.Match[str]]]:
    """Return the rows that have a key, in their order."""
    for row in sorted(row for row, column in cells if column == _KEYS):
        match = _KEY.fullmatch(str(cells[row, _KEYS].value))
        if match is not None:
            yield row, match


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
