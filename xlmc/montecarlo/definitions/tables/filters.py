"""The rows of `xlmc_filters`, what makes a trial physically possible, and of `xlmc_checks`, cells that must be TRUE."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from xlmc.errors import DefinitionError, ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Check, Filter, Parameter
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.identity import Claims, identify
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import (
    Row,
    as_text,
    holds_rows,
    is_used,
    named_rows,
    optional_text,
    parameter,
    rows_of,
    static_value,
)
from xlmc.montecarlo.definitions.vocabulary import vocabulary_of
from xlmc.montecarlo.distributions.parameters import show

__all__ = ["LIMITS", "LIMIT_HINT", "contradiction", "read_checks", "read_filters"]

LIMITS = {"at_least": "At least", "at_most": "At most", "above": "Above", "below": "Below"}
"""Limits of a filter and their headings."""
_FILTER_COLUMNS = ("Name", "Value", "Cell", *LIMITS.values(), "Because", "Only for", "Use")
LIMIT_HINT = "Fill in At least, At most, Above or Below, or make the cell a test such as =B7>0"
"""What to do where the cell of a filter is no test."""

_CHECK_COLUMNS = ("Name", "Value", "Cell", "Because")


def read_filters(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    computed: Computed,
    claims: Claims,
    findings: Findings,
    switched: Mapping[str, bool],
) -> tuple[Filter, ...]:
    """Return the filters without a mistake, in the order of the rows, those that are not used among them.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells something gives a value; a filter should be on one.
        claims: takes their names and cells.
        findings: takes mistakes and remarks.
        switched: see `is_used`.
    """
    rows = rows_of(workbook, tables, ("Name",), _FILTER_COLUMNS, findings)
    filters = tuple(each for row in rows if (each := _filter(row, computed, claims, findings, switched)) is not None)
    idle = [each for each in filters if not each.used]
    if idle:
        findings.notice(f"Filters that are not used, because Use is off: {named_rows(idle)}", idle[0].row)
    return filters


def _filter(
    row: Row, computed: Computed, claims: Claims, findings: Findings, switched: Mapping[str, bool]
) -> Filter | None:
    before = len(findings.problems)
    used = findings.attempt(is_used, row, switched)
    # a row that is off may be another version of one that is on, of the same cell
    identity = identify(row, claims if used else replace(claims, shared=True, cells={}), findings)
    if used is False:
        return None if identity is None else _unused(row, *identity)
    limits = {key: findings.attempt(parameter, row, heading) for key, heading in LIMITS.items()}
    because = findings.attempt(optional_text, row, "Because") or ""
    only_for = findings.attempt(optional_text, row, "Only for") or ""
    if len(findings.problems) > before or not identity:
        return None
    name, cell = identity
    findings.attempt(_refuse_contradiction, row, limits)
    findings.attempt(
        _look_at, row.workbook, cell, not any(map(row.filled, LIMITS.values())), computed.at_all(cell), findings
    )
    if len(findings.problems) > before:
        return None
    if not because:
        where = row.cell("Because") if row.has("Because") else row.where
        asker = vocabulary_of(row.workbook).asker
        findings.notice(
            f"The filter {name!r} gives no evidence under Because, the first thing that {asker} asks for", where
        )
    known: dict[str, Any] = {
        **limits,
        "because": because,
        "only_for": _listed(only_for),
        "notes": row.notes(_FILTER_COLUMNS),
    }
    return Filter(name=name, cell=cell, row=row.where, **known)


def _unused(row: Row, name: str, cell: Cell) -> Filter:
    """Read a row that is switched off, as far as it can be read: its mistakes do not matter."""
    aside = Findings()
    limits: dict[str, Any] = {key: aside.attempt(parameter, row, heading) for key, heading in LIMITS.items()}
    because, only_for = (aside.attempt(optional_text, row, heading) or "" for heading in ("Because", "Only for"))
    written: dict[str, Any] = {"because": because, "only_for": _listed(only_for), "notes": row.notes(_FILTER_COLUMNS)}
    return Filter(name=name, cell=cell, row=row.where, used=False, **limits, **written)


def _listed(names: str) -> tuple[str, ...]:
    """Names that semicolons separate."""
    return tuple(name.strip() for name in names.split(";") if name.strip())


def _refuse_contradiction(row: Row, limits: Mapping[str, Parameter | None]) -> None:
    """Check the limits on their numbers, typed in or as Excel cached them.

    Raises:
        DefinitionError: no number can satisfy two of them.
    """
    pair = contradiction({key: static_value(limit, row.workbook) for key, limit in limits.items()})
    if pair is not None:
        key, message = pair
        raise DefinitionError(message, where=row.cell(LIMITS[key]), hint="Correct one of them")


def contradiction(limits: Mapping[str, float | None]) -> tuple[str, str] | None:
    """Return the first of two limits that no number can satisfy both, and why; otherwise None.

    Args:
        limits: by key; None for one that is not given or not known.
    """
    for floor, ceiling in (("at_least", "at_most"), ("at_least", "below"), ("above", "at_most"), ("above", "below")):
        low, high = limits.get(floor), limits.get(ceiling)
        if low is None or high is None or low < high:
            continue
        if low > high or (floor, ceiling) != ("at_least", "at_most"):
            pair = f"{LIMITS[floor]} ({show(low)}) and {LIMITS[ceiling]} ({show(high)})"
            return floor, f"{pair} contradict each other: no trial could pass"
    return None


def _look_at(workbook: Workbook, cell: Cell, must_be_true: bool, computed: bool, findings: Findings) -> None:
    """Remark on a filter whose cell no formula computes. What a formula gives is looked at when it can be computed.

    Raises:
        DefinitionError: the cell is blank or text, or, without limits, holds a number other than 0 and 1.
    """
    if computed:
        return
    content = workbook.content(cell)
    if content.is_blank:
        raise DefinitionError("The filter cell is blank", where=cell, hint="Point to the cell to be tested")
    if isinstance(content.value, str) and content.value.strip():
        message = f"The filter cell holds the text {as_text(content.value)!r}"
        raise DefinitionError(message, where=cell, hint=LIMIT_HINT)
    if must_be_true and _is_a_quantity(content.value):
        message = f"The filter has no limit, and its cell holds {as_text(content.value)}, neither TRUE nor FALSE"
        raise DefinitionError(message, where=cell, hint=LIMIT_HINT)
    findings.notice("The filter is a constant: it does not depend on anything", cell)


def _is_a_quantity(value: object) -> bool:
    """Report a number that does not stand for TRUE or FALSE."""
    return isinstance(value, int | float) and not isinstance(value, bool | ErrorCode) and value not in (0, 1)


def read_checks(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    computed: Computed,
    claims: Claims,
    findings: Findings,
) -> tuple[Check, ...]:
    """Return the checks without a mistake, in the order of the rows.

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
    rows = rows_of(workbook, tables, ("Name",), _CHECK_COLUMNS, findings)
    result = [_check(row, computed, claims, findings) for row in rows]
    return tuple(each for each in result if each is not None)


def _check(row: Row, computed: Computed, claims: Claims, findings: Findings) -> Check | None:
    before = len(findings.problems)
    identity = identify(row, claims, findings)
    because = findings.attempt(optional_text, row, "Because") or ""
    findings.attempt(_refuse_limits, row)
    if len(findings.problems) > before or not identity:
        return None
    name, cell = identity
    if row.workbook.content(cell).is_blank and not computed.at_all(cell):
        findings.problem("The check cell is blank", cell, "Point to a cell that is TRUE or FALSE, such as =B7>0")
        return None
    if not computed.at_all(cell):
        findings.notice("The check is a constant: it does not depend on anything", cell)
    return Check(name=name, cell=cell, row=row.where, because=because, notes=row.notes(_CHECK_COLUMNS))


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
