"""The rows of `xlmc_assumptions`: uncertain inputs."""

from __future__ import annotations

from collections.abc import Iterable

from xlmc.address import Cell
from xlmc.definitions.computed import Computed
from xlmc.definitions.findings import Findings
from xlmc.definitions.model import Assumption
from xlmc.definitions.tables.data import OPTIONS, cached_data_family, given_data, refuse_options
from xlmc.definitions.tables.fields import logical, number_in, optional_text
from xlmc.definitions.tables.identity import Claims, identify
from xlmc.definitions.tables.parameters import (
    CUTOFFS,
    PARAMETER_HEADINGS,
    given_parameters,
    range_of,
    remark_on_range,
)
from xlmc.definitions.tables.percentiles import is_percentile, with_percentiles
from xlmc.definitions.tables.tables import DefinitionTable, Row, is_blank, rows_of
from xlmc.distributions import FAMILIES, Family, family_named
from xlmc.errors import DefinitionError
from xlmc.workbook.model import Workbook

__all__ = ["read_assumptions"]

_FIXED = ("Name", "Value", "Cell", "Distribution", *CUTOFFS.values(), "Units", "Source", "Frozen")
_KNOWN = (*_FIXED, *PARAMETER_HEADINGS, *OPTIONS)


def read_assumptions(
    workbook: Workbook, tables: Iterable[DefinitionTable], computed: Computed, claims: Claims, findings: Findings
) -> tuple[Assumption, ...]:
    """The assumptions without a mistake, in the order of the rows.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells have formulas; an assumption must not.
        claims: takes their names and cells.
        findings: takes mistakes and remarks.
    """
    tables = tuple(tables)
    percentiles = (written for table in tables for written, _ in table.columns.values() if is_percentile(written))
    known = (*_KNOWN, *percentiles)
    rows = rows_of(workbook, tables, ("Name",), known, findings)
    found = [findings.attempt(_assumption, row, known, computed, claims, findings) for row in rows]
    return tuple(filter(None, found))


def _assumption(
    row: Row, known: tuple[str, ...], computed: Computed, claims: Claims, findings: Findings
) -> Assumption | None:
    """The assumption of a row; None where the findings have a problem of it.

    Raises:
        DefinitionError: its numbers break a rule of its distribution.
    """
    before = len(findings.problems)
    identity = identify(row, claims, findings)
    frozen = findings.attempt(logical, row, "Frozen") or False
    base = None if identity is None else findings.attempt(_base, row.workbook, computed, identity[1], frozen, findings)
    kind = findings.attempt(_family, row)
    given = family = data = None
    if kind is not None:
        refuse_options(row, kind, findings)
        given = given_parameters(row, kind, findings)
        data = None if kind.data is None else findings.attempt(given_data, row, kind, computed, findings)
        family = kind if data is None else findings.attempt(cached_data_family, data, kind, row.workbook)
    units = findings.attempt(optional_text, row, "Units") or ""
    source = findings.attempt(optional_text, row, "Source") or ""
    if len(findings.problems) > before or not (identity and kind and given):
        return None
    name, cell = identity
    ends = None if family is None else range_of(family, given, row.workbook)
    if family is not None and ends is not None and not frozen:
        remark_on_range(family, ends, given.places, base, cell, findings)
    return Assumption(
        name=name,
        cell=cell,
        distribution=kind.name,
        parameters=given.parameters,
        row=row.where,
        base=base,
        lower_cutoff=given.cutoffs.get("lower_cutoff"),
        upper_cutoff=given.cutoffs.get("upper_cutoff"),
        units=units,
        source=source,
        frozen=frozen,
        notes=row.notes(known),
        own_family=None if family is FAMILIES[kind.name] else family,
        data=data,
    )


def _family(row: Row) -> Family:
    typed = optional_text(row, "Distribution")
    family = family_named(typed, where=row.cell("Distribution")) if typed else FAMILIES["Uniform"]
    return with_percentiles(row, family)


def _base(workbook: Workbook, computed: Computed, cell: Cell, frozen: bool, findings: Findings) -> float | None:
    """The assumption cell's own value; None, with a notice, where it is blank.

    Raises:
        DefinitionError: the cell holds a formula or anything but a number, or is blank and frozen.
    """
    content = workbook.content(cell)
    if computed.by_formula(cell):
        message = "The assumption cell holds a formula, which every draw would overwrite"
        raise DefinitionError(
            message, where=cell, hint="Replace the formula by its value (Copy, Paste Special ▸ Values)"
        )
    if not is_blank(content):
        return number_in("The assumption cell", content, cell)
    if frozen:
        message = "The assumption is frozen, and its cell is blank"
        raise DefinitionError(message, where=cell, hint="Type the value to hold it at")
    findings.notice("The assumption cell is blank, so there is no base case", cell)
    return None
