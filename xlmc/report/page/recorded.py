"""The record of the run on the page: every section of it can be opened, and is open in print."""

from __future__ import annotations

from xlmc.report.page.element import Html, element
from xlmc.report.sheets.cells import NONE
from xlmc.results.record import Entry, Record, RecordTable, Section, Value
from xlmc.results.record.wording import number_text
from xlmc.workbook.printable import printable

__all__ = ["recorded"]

_OPEN = frozenset({"run", "file", "counts"})
_CODE = frozenset({"repeat", "command", "fingerprint", "sha256", "original_sha256"})


def recorded(record: Record) -> Html:
    """The section."""
    said = "What the numbers depend on, and how to repeat them. Every number stands here in full."
    return element(
        "section",
        element("h2", "Record"),
        element("p", said),
        *(_section(section) for section in record.sections),
        id="record",
    )


def _section(section: Section) -> Html:
    found = [element("summary", section.title)]
    entries = [entry for entry in section.entries if not entry.key.startswith("packed_")]  # for programs alone
    if entries:
        found.append(element("dl", *(each for entry in entries for each in _entry(section.key, entry))))
    if section.table is not None:
        found.append(_table(section.table) if section.table.rows else element("p", "None"))
    return element("details", *found, open="" if section.key in _OPEN else None, data_section=section.key)


def _entry(section: str, entry: Entry) -> tuple[Html, Html]:
    said = _said(entry.value)
    shown = element("code", said) if entry.key in _CODE else element("span", said)
    return element("dt", entry.label), element("dd", shown, data_key=f"{section}.{entry.key}")


def _table(table: RecordTable) -> Html:
    heads = element("tr", *(element("th", label, scope="col") for _, label in table.columns))
    rows = (element("tr", *(element("td", _said(value)) for value in row)) for row in table.rows)
    inner = element("table", element("thead", heads), element("tbody", *rows))
    return element("div", inner, class_="wide-table record")


def _said(value: Value) -> str:
    if value is None or value == "":
        return NONE
    if isinstance(value, bool):
        return str(value).upper()
    return printable(value) if isinstance(value, str) else number_text(value)
