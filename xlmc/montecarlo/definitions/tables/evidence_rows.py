"""The rows of `xlmc_evidence`: what was measured, how well, and what the model has in its place.

A row whose reading is blank, or whose `Use` is off, is listed and changes nothing. Any other one becomes a filter.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Filter, Parameter
from xlmc.montecarlo.definitions.evidence import ERRORS, SIZES, USE_IS_OFF, Evidence, Within
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
from xlmc.montecarlo.distributions.spelling import did_you_mean, name_key, plain

__all__ = ["as_filter", "check_sizes", "read_evidence"]

_KNOWN: Final = ("Name", "Value", "Cell", "Reading", "Error", *SIZES.values(), "±", "Source", "Use")

_TAKES: Final[Mapping[str, tuple[tuple[str, ...], ...]]] = {
    "uniform": (("plus_minus",), ("percent",)),
    "instrument": (("percent",), ("resolution",), ("percent", "resolution")),
    "normal": (("std_dev",), ("percent",)),
    "lognormal": (("std_dev",), ("percent",)),
    "at least": ((), ("plus_minus",), ("std_dev",), ("percent",), ("resolution",), ("percent", "resolution")),
    "at most": ((), ("plus_minus",), ("std_dev",), ("percent",), ("resolution",), ("percent", "resolution")),
}
"""Error -> the sets of sizes that it may be given by."""

_HOW: Final[Mapping[str, str]] = {
    "uniform": "Fill in Plus or minus, in the units of the reading, or Percent, of the reading",
    "instrument": "Fill in Percent, of what is measured, or Resolution, in the units of the reading, or both",
    "normal": "Fill in Std dev, in the units of the reading, or Percent, of the reading",
    "lognormal": "Fill in Std dev, of the logarithm, or Percent: 20 is a Std dev of 0.2",
    "at least": "Leave the error blank, or fill in Plus or minus, or Std dev, or Percent and Resolution",
    "at most": "Leave the error blank, or fill in Plus or minus, or Std dev, or Percent and Resolution",
}

_ALSO: Final = {"limits": "uniform", "rectangular": "uniform", "gaussian": "normal", "lognorm": "lognormal"}


def read_evidence(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    computed: Computed,
    filters: Iterable[Filter],
    findings: Findings,
    switched: Mapping[str, bool],
) -> tuple[Evidence, ...]:
    """Read the rows without a mistake, in their order, those that are not used among them.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells something gives a value; evidence must be on one.
        filters: the rows of `xlmc_filters`, whose names no evidence may have.
        findings: takes mistakes and remarks.
        switched: see `is_used`.
    """
    tables = tuple(tables)
    for table in tables:
        if not holds_rows(workbook, table):
            findings.notice(f"The table {table.table.name} holds no evidence", table.where)
    claims, taken = Claims("evidence", shared=True), {name_key(each.name): each.row for each in filters}
    results = []
    for row in rows_of(workbook, tables, ("Name", "Reading"), _KNOWN, findings):
        each = _evidence(row, computed, claims, findings, switched)
        if each is None:
            continue
        if each.used and name_key(each.name) in taken:
            message = f"{each.name!r} is the name of a filter, too ({taken[name_key(each.name)]})"
            findings.problem(message, row.cell("Name"), "Give each its own name; state each fact once")
        results.append(each)
    for why, where in {each.unused: each.row for each in reversed(results) if not each.used}.items():
        named = named_rows([each for each in results if each.unused == why])
        findings.notice(f"Evidence that is not used, because {why.replace('it has', 'there is')}: {named}", where)
    return tuple(results)


def _evidence(
    row: Row, computed: Computed, claims: Claims, findings: Findings, switched: Mapping[str, bool]
) -> Evidence | None:
    before = len(findings.problems)
    identity = identify(row, claims, findings)
    source = findings.attempt(optional_text, row, "Source") or ""
    used = findings.attempt(_used, row, switched)
    error = findings.attempt(_error, row) if used else "uniform"
    if identity is None or used is None or error is None or len(findings.problems) > before:
        return None
    name, cell = identity
    notes = row.notes(_KNOWN)
    if not used:
        why = USE_IS_OFF if row.filled("Reading") else "it has no reading"
        aside = Findings()  # mistakes of a row that is off do not matter
        reading, given = aside.attempt(parameter, row, "Reading"), aside.attempt(_sizes, row)
        error = aside.attempt(_error, row) or error
        return Evidence(name, cell, row.where, reading, error, given or {}, source, why, notes)
    reading = findings.attempt(parameter, row, "Reading")
    sizes = findings.attempt(_sizes, row)
    findings.attempt(_refuse_constant, row, cell, computed)
    if reading is None or sizes is None or len(findings.problems) > before:
        return None
    evidence = Evidence(name, cell, row.where, reading, error, sizes, source, notes=notes)
    findings.attempt(_refuse_wrong_sizes, row, evidence)
    if len(findings.problems) > before:
        return None
    if not source:
        where = row.cell("Source") if row.has("Source") else row.where
        asker = vocabulary_of(row.workbook).asker
        findings.notice(f"The evidence {name!r} gives no Source, the first thing that {asker} asks for", where)
    return evidence


def _used(row: Row, switched: Mapping[str, bool]) -> bool:
    """Whether the row counts: its reading is there and nothing switches it off; see `is_used`.

    Raises:
        DefinitionError: `Use` is neither on nor off, or it is on and there is no reading.
    """
    asked = is_used(row, switched)
    if row.filled("Use") and asked and not row.filled("Reading"):
        message = f"{row.heading('Use')} is on, and there is no reading"
        raise DefinitionError(message, where=row.cell("Reading"), hint="Fill in Reading, or clear Use")
    return asked and row.filled("Reading")


def _error(row: Row) -> str:
    """Return the kind of error, a key of `ERRORS`; `uniform` where the cell is blank.

    Raises:
        DefinitionError: there is no such kind.
    """
    typed = optional_text(row, "Error")
    known = {plain(key): key for key in ERRORS} | _ALSO
    if not typed:
        return "uniform"
    if plain(typed) not in known:
        message = f"There is no kind of error {typed!r}"
        raise DefinitionError(message, where=row.cell("Error"), hint=did_you_mean(typed, ERRORS.values()))
    return known[plain(typed)]


def _sizes(row: Row) -> dict[str, Parameter]:
    """Key of `SIZES` -> what the row holds.

    Raises:
        DefinitionError: a cell holds no number, or the same is said twice.
    """
    headings = {**SIZES, "also": "±"}
    result = {key: value for key, heading in headings.items() if (value := parameter(row, heading)) is not None}
    if "also" in result:
        if "plus_minus" in result:
            message = f"{row.heading('Plus or minus')} and ± are both filled in"
            raise DefinitionError(message, where=row.cell("±"), hint="Clear one of them")
        result["plus_minus"] = result.pop("also")
    return result


def _refuse_constant(row: Row, cell: Cell, computed: Computed) -> None:
    """Refuse a cell that nothing computes: the reading itself may have been pointed to.

    Raises:
        DefinitionError: nothing does.
    """
    if computed.at_all(cell):
        return
    value = as_text(row.workbook.content(cell).value)
    holds = f"holds {value!r} and no formula" if value else "is blank"
    message = f"The cell {cell} {holds}: evidence is about a quantity that the model computes"
    raise DefinitionError(message, where=row.where, hint="Point Cell to that quantity; what was measured is Reading")


def _refuse_wrong_sizes(row: Row, evidence: Evidence) -> None:
    """Check what says how large the error is.

    Raises:
        DefinitionError: too much is said, or too little, or a number is impossible.
    """
    given, kind = tuple(key for key in SIZES if key in evidence.sizes), ERRORS[evidence.error]
    possible = _TAKES[evidence.error]
    if given not in possible:
        known = {key for each in possible for key in each}
        wrong = next((key for key in given if key not in known), None)
        if wrong is not None:
            message = f"The error {kind} of {evidence.name!r} takes no {SIZES[wrong]}"
            raise DefinitionError(message, where=_cell_of(row, wrong), hint=_HOW[evidence.error])
        twice = " and ".join(SIZES[key] for key in given)
        what = f"is given twice, by {twice}" if given else "says nothing of its size"
        where = _cell_of(row, given[-1]) if given else row.where
        raise DefinitionError(f"The error {kind} of {evidence.name!r} {what}", where=where, hint=_HOW[evidence.error])
    numbers = {key: static_value(value, row.workbook) for key, value in evidence.sizes.items()}
    reading = static_value(evidence.reading, row.workbook)
    for key, value in numbers.items():
        if value is not None:
            _refuse_size(evidence, key, value, _cell_of(row, key))
    if reading is not None and None not in numbers.values():
        check_sizes(evidence, reading, {key: float(value) for key, value in numbers.items() if value is not None})


def _refuse_size(evidence: Evidence, key: str, value: float, where: Cell) -> None:
    if value < 0:
        message = f"{SIZES[key]} ({show(value)}) of {evidence.name!r} is negative"
        raise DefinitionError(message, where=where, hint="Type how far the reading may be off, without a sign")
    if key == "percent" and value < 1:
        message = (
            f"Percent of {evidence.name!r} is {show(value)}, which may be {show(value)} % or {show(100 * value)} %"
        )
        hint = "Type 5 for 5 %, in a cell without percent format; less than 1 % goes into another column"
        raise DefinitionError(message, where=where, hint=hint)
    if key == "percent" and value >= 100:
        message = f"Percent ({show(value)}) of {evidence.name!r} must be below 100"
        raise DefinitionError(message, where=where, hint="Correct the number, or make the evidence one-sided")


def check_sizes(evidence: Evidence, reading: float, sizes: Mapping[str, float]) -> None:
    """Check the numbers of a row that is used.

    Args:
        evidence: the row.
        reading: its reading.
        sizes: its sizes.

    Raises:
        DefinitionError: they are no error of a reading.
    """
    for key, value in sizes.items():
        _refuse_size(evidence, key, value, evidence.row)
    if evidence.error == "lognormal" and reading <= 0:
        message = f"The reading of {evidence.name!r} ({show(reading)}) has no logarithm"
        raise DefinitionError(message, where=evidence.row, hint="A lognormal error is for quantities above 0")
    one_sided = evidence.error in ("at least", "at most")
    size = sizes.get("percent", 0.0) * (1.0 if evidence.error in ("instrument", "lognormal") else abs(reading))
    if one_sided or sizes.get("plus_minus") or sizes.get("std_dev") or sizes.get("resolution") or size:
        return
    message = f"The error of {evidence.name!r} is 0: no reading is exact, and no trial would agree with it"
    raise DefinitionError(message, where=evidence.row, hint=_HOW[evidence.error])


def _cell_of(row: Row, key: str) -> Cell:
    heading = SIZES[key]
    return row.cell(heading) if row.filled(heading) else row.cell("±")


def as_filter(evidence: Evidence) -> Filter:
    """Return the filter that keeps what agrees with a row that is used; its limits are numbers once those of the row
    are.
    """
    law = None if any(evidence.cells) else evidence.law
    return Filter(
        evidence.name,
        evidence.cell,
        evidence.row,
        at_least=law.low if isinstance(law, Within) else None,
        at_most=law.high if isinstance(law, Within) else None,
        because=evidence.source,
        notes=evidence.notes,
        evidence=evidence,
    )
