"""The sheet Record: what the run was a function of, for people to read and programs to read back.

Column A, folded away, holds the keys of `Record`: `file.sha256` beside an entry, `forecasts` beside a table's title,
and for a table `name`, `cell`, … in a hidden row above its headings.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from xlmc.record import Entry, Record, RecordTable, Value
from xlmc.report.cells import Shown

if TYPE_CHECKING:
    from xlmc.report.page import Page

__all__ = ["WIDTHS", "write_record"]

WIDTHS = (22, 34, 16, 22, 34, *[14] * 6)
_LAST = len(WIDTHS) - 1
_CODE = frozenset({"repeat", "command", "fingerprint", "sha256", "original_sha256"})


def write_record(page: Page, record: Record, name: str) -> None:
    """Write the sheet."""
    page.sheet.set_column(0, 0, WIDTHS[0], None, {"level": 1, "hidden": True})
    page.sheet.set_column(1, 1, WIDTHS[1], None, {"collapsed": True})
    page.title("", "")
    page.row = 0
    page.line([Shown("Record of the run", look="title")], 1)
    page.line([Shown(f"{name}: everything the numbers depend on, and how to repeat them", look="subtitle")], 1)
    for section in record.sections:
        page.heading(section.title, 1, key=section.key)
        for entry in section.entries:
            _write_entry(page, section.key, entry)
        if section.table is not None:
            _write_table(page, section.table)
    page.sheet.print_area(0, 1, page.row, _LAST)
    page.printed(name)


def _write_entry(page: Page, section: str, entry: Entry) -> None:
    page.put(page.row, 0, Shown(f"{section}.{entry.key}", look="key"))
    page.put(page.row, 1, Shown(entry.label, look="label"))
    look = "code" if entry.key in _CODE else "text"
    page.across(_shown(entry.value, look), 2, _LAST)
