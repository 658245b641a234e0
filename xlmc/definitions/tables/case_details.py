"""The rows of `xlmc_case`: what a report says of the case on its cover. No number of a run depends on them."""

from __future__ import annotations

from datetime import date, timedelta

from xlmc.definitions.definitions import CaseDetails
from xlmc.definitions.problems import Findings
from xlmc.definitions.tables.fields import optional_text, required_text
from xlmc.definitions.tables.table_rows import DefinitionTable, Row, rows_of
from xlmc.distributions.spelling import did_you_mean, plain
from xlmc.errors import DefinitionError
from xlmc.workbook.workbook import Workbook

__all__ = ["read_case"]

_COLUMNS = ("Field", "Value")
_FIELDS = {
    "Title": "title",
    "Case number": "number",
    "Analyst": "analyst",
    "Organisation": "organisation",
    "Organization": "organisation",
    "Date": "date",
}
_KEYS = {plain(field): key for field, key in _FIELDS.items()}
_DAY_0 = date(1899, 12, 30)
"""Day 0 of Excel's dates, from March 1900 on."""


def read_case(workbook: Workbook, tables: list[DefinitionTable], findings: Findings) -> CaseDetails:
    """What the table says; a field that it leaves out or leaves blank is empty.

    Args:
        workbook: that holds it.
        tables: of the case; there should be one at most.
        findings: gets the mistakes.
    """
    for extra in tables[1:]:
        message = f"{tables[0].table.name} and {extra.table.name} both hold the case"
        findings.problem(message, extra.where, "Keep one table, and delete the one that came with a copied sheet")
    found: dict[str, str] = {}
    for row in rows_of(workbook, tables[:1], _COLUMNS, _COLUMNS, findings):
        findings.attempt(_take, row, found)
    return CaseDetails(**found)


def _take(row: Row, found: dict[str, str]) -> None:
    """Add the row's field to `found`.

    Raises:
        DefinitionError: there is no such field, it is given twice, or the date is none.
    """
    typed, where = required_text(row, "Field"), row.cell("Field")
    key = _KEYS.get(plain(typed))
    if key is None:
        raise DefinitionError(f"There is no field {typed!r}", where=where, hint=did_you_mean(typed, _FIELDS))
    if key in found:
        raise DefinitionError(f"{typed} is given twice", where=where, hint="Keep one of the two rows")
    found[key] = _date(row) if key == "date" else optional_text(row, "Value")


def _date(row: Row) -> str:
    """A date that was typed as one, or as the text `YYYY-MM-DD`."""
    value = row.content("Value").value
    try:
        if isinstance(value, int | float) and not isinstance(value, bool):
            return (_DAY_0 + timedelta(days=int(value))).isoformat()
        text = optional_text(row, "Value")
        return date.fromisoformat(text).isoformat() if text else ""
    except (ValueError, OverflowError):
        hint = "Type a date, or the text YYYY-MM-DD"
        raise DefinitionError("This is no date", where=row.cell("Value"), hint=hint) from None
