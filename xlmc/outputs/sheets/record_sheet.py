"""The sheet Record: all that the run depends on, for people to read and for programs to read back.

Column A, folded away, holds the keys of `Record`: `file.sha256` beside an entry, `forecasts` beside a section's title,
`forecasts[0]` beside the first row of its table. The hidden row above a table's headings holds the columns' keys.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count, repeat
from typing import TYPE_CHECKING

from xlmc.analysis.results.record import Entry, Record, RecordTable, Section, Value
from xlmc.outputs.document.cells import NONE, Shown, number_format

if TYPE_CHECKING:
    from xlmc.outputs.sheets.page import Page

__all__ = ["WIDTHS", "write_record"]

_UNIT = 8.8
_UNITS = 13
WIDTHS = (24, 42, *[_UNIT] * _UNITS)
_FIRST, _LAST = 1, len(WIDTHS) - 1
_ROW = 13.5
_SPANS = {"limits": 2, "because": 5, "parameters": 2, "source": 3, "notes": 2, "error": 3, "message": 14, "first": 3}
"""How many columns of the sheet a column of a table takes; all others take one."""

_CODE = frozenset({"repeat", "command", "fingerprint", "sha256", "original_sha256"})

_PLAIN = frozenset({"seed"})
"""Whole numbers that are names, not counts: without separators of thousands."""

_LISTED = frozenset({"structure", "cells"})
"""Sections as long as the model: each row takes one line, however long its text."""

_ELSEWHERE = frozenset(
    {"forecasts", "filters", "forecast_filters", "evidence", "checks", "assumptions", "correlations"}
)
"""Sections whose contents other result sheets print."""

_BEHIND = (
    "Below stand the definitions of forecasts, filters, checks and assumptions, which the sheets Results and "
    "Assumptions print; lists without entries; and the cells, names and tables that the run needed. They are not "
    "printed, unless you clear the print area. What was not asked for is folded away."
)


def write_record(page: Page, record: Record, name: str) -> None:
    """Write the sheet: what is printed first, then what is not."""
    page.sheet.set_column(0, 0, WIDTHS[0], None, {"level": 1, "hidden": True})
    page.sheet.set_column(1, 1, WIDTHS[1], None, {"collapsed": True})
    page.height = _ROW
    page.title("Record of the run", f"{name}: what the numbers depend on, and how to repeat them", _FIRST)
    empty = [s for s in record.sections if not s.entries and s.table is not None and not s.table.rows]
    behind = [section for section in record.sections if section.key in _LISTED | _ELSEWHERE or section in empty]
    for section in record.sections:
        if section not in behind:
            _write_section(page, section)
    page.wide(_BEHIND, "remark", _LAST, _FIRST)
    printed = page.row
    for section in behind:
        _write_section(page, section)
    page.set_up_printing(name, printed=printed, columns=(_FIRST, _LAST))


def _write_section(page: Page, section: Section) -> None:
    page.heading(section.title, _FIRST)
    _write_key(page, page.row - 1, section.key)
    for entry in section.entries:
        _write_entry(page, section.key, entry)
    if section.table is not None and section.table.rows:
        _write_table(page, section.key, section.table)
    elif section.table is not None:
        page.wide("None", "text", _LAST, _FIRST)


def _write_entry(page: Page, section: str, entry: Entry) -> None:
    _write_key(page, page.row, f"{section}.{entry.key}")
    if entry.key.startswith("packed_"):
        page.line([_cell(each, "listed") for each in (entry.label, entry.value)], count(_FIRST), fit=False)
        return
    look = "code" if entry.key in _CODE else "text"
    page.line([Shown(entry.label, look="label"), _cell(entry.value, look, entry.key)], (_FIRST, _FIRST + 1), _LAST)
    if entry.value is None:
        page.sheet.set_row(page.row - 1, None, None, {"level": 1, "hidden": True})


def _write_table(page: Page, section: str, table: RecordTable) -> None:
    listed = section in _LISTED
    starts, last = _column_starts([key for key, _ in table.columns])
    if listed:
        starts, last = list(range(_FIRST, _FIRST + len(table.columns))), _LAST
    page.line([Shown(key, look="key") for key, _ in table.columns], starts, last)
    page.sheet.set_row(page.row - 1, None, None, {"hidden": True})
    page.line([Shown(label, look="header left") for _, label in table.columns], starts, last)
    for number, row in enumerate(table.rows):
        _write_key(page, page.row, f"{section}[{number}]")
        cells = list(map(_cell, row, repeat("listed" if listed else "text")))
        page.line(cells, starts, None if listed else last, fit=not listed)


def _column_starts(keys: Sequence[str]) -> tuple[list[int], int]:
    """Return the sheet's column at which each column of a table starts, and at which the last one ends."""
    starts, column = [], _FIRST
    for key in keys:
        starts.append(column)
        column += _SPANS.get(key, 1)
    return starts, column - 1


def _write_key(page: Page, row: int, key: str) -> None:
    page.put(row, 0, Shown(key, look="key"))


def _cell(value: Value, look: str, key: str = "") -> Shown:
    """Return a value as it is shown; the cell keeps all digits of a number."""
    if value is None or value == "":
        return Shown(NONE, look=look)
    if isinstance(value, str | bool) or key in _PLAIN:
        return Shown(value, look=look)
    return Shown(value, number_format(value), look)
