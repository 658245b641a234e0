"""The rows of `xlmc_checks`: cells that must be TRUE, at the base case and in the accepted trials."""

from __future__ import annotations

from collections.abc import Iterable

from xlmc.definitions.computed import Computed
from xlmc.definitions.findings import Findings
from xlmc.definitions.model import Check
from xlmc.definitions.tables.fields import optional_text
from xlmc.definitions.tables.filters import LIMITS
from xlmc.definitions.tables.identity import Claims, identify
from xlmc.definitions.tables.tables import DefinitionTable, Row, holds_rows, is_blank, rows_of
from xlmc.errors import DefinitionError
from xlmc.workbook.model import Workbook

__all__ = ["read_checks"]

_KNOWN = ("Name", "Value", "Cell", "Because")


def read_checks(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    computed: Computed,
    claims: Claims,
    findings: Findings,
) -> tuple[Check, ...]:
    """The checks without a mistake, in the order of the rows.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells something gives a value; a check should be on one.
        claims: takes their names and cells.
        findings: takes mistakes and remarks.
    """
    tables = tuple(tables)
    for table in tables:
        if not holds_rows(workbook, table):
            findings.notice(f"The table {table.table.name} holds no check", table.where)
    rows = rows_of(workbook, tables, ("Name",), _KNOWN, findings)
    found = [_check(row, computed, claims, findings) for row in rows]
    return tuple(each for each in found if each is not None)


def _check(row: Row, computed: Computed, claims: Claims, findings: Findings) -> Check | None:
    before = len(findings.problems)
    identity = identify(row, claims, findings)
    because = findings.attempt(optional_text, row, "Because") or ""
    findings.attempt(_refuse_limits, row)
    if len(findings.problems) > before or not identity:
        return None
    name, cell = identity
    if is_blank(row.workbook.content(cell)) and not computed.at_all(cell):
        findings.problem("The check cell is blank", cell, "Point to a cell that is TRUE or FALSE, such as =B7>0")
        return None
    if not computed.at_all(cell):
        findings.notice("The check is a constant: it does not depend on anything", cell)
    return Check(name=name, cell=cell, row=row.where, because=because, notes=row.notes(_KNOWN))


def _refuse_limits(row: Row) -> None:
    """Refuse limits, which a check does not have: kept as notes, they would never be tested.

    Raises:
        DefinitionError: the row fills in a limit.
    """
    given = next((heading for heading in LIMITS.values() if row.filled(heading)), None)
    if given is not None:
        message = f"A check has no limits: its cell must be TRUE, and {row.heading(given)} would not be tested"
        hint = "Write the limits into the check's cell, such as =AND(B7>0,B7<=1.5), or make the row a filter"
        raise DefinitionError(message, where=row.cell(given), hint=hint)
