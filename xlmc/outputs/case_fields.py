"""The fields that say whose case a report is about, from the optional table `xlmc_case` of the workbook, and what a
person gives beside it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import date, timedelta
from typing import Final

from xlmc.errors import DefinitionError, SimulationError
from xlmc.excel.address import Cell
from xlmc.excel.functions.dates.date_text import MONTHS
from xlmc.excel.workbook.printable import label
from xlmc.excel.workbook.workbook import CellValue, Workbook
from xlmc.montecarlo.definitions.tables.reserved_tables import CASE
from xlmc.montecarlo.definitions.tables.table_rows import as_text
from xlmc.montecarlo.distributions.spelling import plain

__all__ = ["FIELDS", "Case", "case_of", "fields_from"]

FIELDS: Final = ("Title", "Case number", "Analyst", "Organisation", "Date")
"""The fields that the report has a place for; any other stands on the cover too, below them."""

_SPELLINGS: Final = {"organization": "Organisation", "case": "Case number", "number": "Case number"}
_FIRST_DAY: Final = {False: date(1899, 12, 30), True: date(1904, 1, 1)}
"""The day before day 1 of the calendar that begins in 1900 (Excel counts a 29 February 1900), and of that of 1904."""
_LAST_SERIAL: Final = 2_958_465


@dataclass(frozen=True, slots=True)
class Case:
    """The fields by name, as they are printed; `dated` is the day that the field Date gives, if it gives one."""

    fields: Mapping[str, str]
    dated: date | None

    def __getitem__(self, field: str) -> str:
        """Return what the field says; empty where it is not given."""
        return self.fields.get(field, "")

    @property
    def in_a_line(self) -> str:
        """The fields that say whose case it is, one behind the other; empty where none is given."""
        return ", ".join(self[field] for field in FIELDS if self[field])


def case_of(workbook: Workbook, given: Mapping[str, str]) -> Case:
    """Return the case of a workbook; what is given wins over the table.

    Args:
        workbook: its table `xlmc_case` has two columns, the field and what it says.
        given: field -> what it says.

    Raises:
        DefinitionError: the table has another number of columns, or a field twice, or there are two tables.
        SimulationError: a field is given without a name.
    """
    result: dict[str, CellValue] = dict(_rows(workbook))
    for name, text in given.items():
        if not name.strip():
            raise SimulationError("a field of the case has no name", hint="Give it as 'Case number=2026-17'")
        result[_field(name)] = label(text.strip())
    dated = _day(result.get("Date"), workbook.date1904)
    fields = {name: as_text(result[name]) for name in (*FIELDS, *result) if result.get(name) is not None}
    if dated is not None:
        fields["Date"] = f"{dated.day} {MONTHS[dated.month - 1]} {dated.year}"
    return Case({name: text for name, text in fields.items() if text}, dated)


def fields_from(given: Iterable[str]) -> dict[str, str]:
    """Fields as people type them, each as `Case number=2026-17`.

    >>> fields_from(["Case number=2026-17", "Analyst=J. Doe"])
    {'Case number': '2026-17', 'Analyst': 'J. Doe'}

    Raises:
        SimulationError: one has no equals sign, or no name before it.
    """
    result = {}
    for each in given:
        name, equals, text = each.partition("=")
        if not (equals and name.strip()):
            raise SimulationError(
                f"a field of the case is not {label(each)!r}", hint="Give it as 'Case number=2026-17'"
            )
        result[name.strip()] = text.strip()
    return result


def _rows(workbook: Workbook) -> Iterable[tuple[str, CellValue]]:
    tables = [table for table in workbook.tables if table.name.casefold().startswith(CASE)]
    if len(tables) > 1:
        area = tables[1].area
        where = Cell(area.sheet, area.top, area.left)
        hint = "Keep one table, and delete the one that came with a copied sheet"
        message = f"{tables[0].name} and {tables[1].name} both say whose case this is"
        raise DefinitionError(message, where=where, hint=hint)
    seen: set[str] = set()
    for table in tables:
        area = table.body
        if len(table.columns) != 2:
            hint = "One for the field, such as Case number, and one for what it says"
            where = Cell(area.sheet, area.top, area.left)
            raise DefinitionError(f"the table {table.name} must have two columns", where=where, hint=hint)
        for row in range(area.top, area.bottom + 1):
            where = Cell(area.sheet, row, area.left)
            name = as_text(workbook.content(where).value)
            if not name:
                continue
            field = _field(name)
            if field in seen:
                raise DefinitionError(
                    f"{field} occurs twice in {table.name}", where=where, hint="Delete one of the rows"
                )
            seen.add(field)
            yield field, workbook.content(Cell(area.sheet, row, area.left + 1)).value


def _field(name: str) -> str:
    """Return the field as the report names it."""
    known = {plain(each): each for each in FIELDS} | _SPELLINGS
    return known.get(plain(name), label(name.strip()))


def _day(value: CellValue, from_1904: bool) -> date | None:
    """Return the day that a cell or a person gives: a serial number of Excel, or text such as 2026-11-23."""
    if isinstance(value, str):
        try:
            return date.fromisoformat(value.strip())
        except ValueError:  # it is printed as it is
            return None
    if isinstance(value, int | float) and not isinstance(value, bool) and 1 <= value <= _LAST_SERIAL:
        return _FIRST_DAY[from_1904] + timedelta(days=int(value))
    return None
