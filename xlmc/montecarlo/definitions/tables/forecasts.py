"""The rows of `xlmc_forecasts`: the answers."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.stating import NOT_ROUNDED, Kind, Role
from xlmc.montecarlo.definitions.tables.identity import Claims, identify
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import (
    Row,
    as_text,
    central_share,
    number,
    number_in,
    optional_text,
    rows_of,
    word_in,
)
from xlmc.montecarlo.distributions.parameters import show

__all__ = ["read_forecasts"]

_STATED = ("Report to", "Kind", "Role")
_KNOWN = ("Name", "Value", "Cell", "Units", "Range %", "Threshold", "Certainty from", "Certainty to", *_STATED)
_NUMBER_FIRST = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
_DEGREES = ("°", "deg", "degree", "degrees")


def read_forecasts(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    computed: Computed,
    central: float,
    claims: Claims,
    findings: Findings,
) -> tuple[Forecast, ...]:
    """Return the forecasts without a mistake, in the order of the rows.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells something gives a value; a forecast should be one.
        central: the share of the central range where a row gives none.
        claims: takes their names and cells.
        findings: takes mistakes and remarks.
    """
    rows = rows_of(workbook, tables, ("Name",), _KNOWN, findings)
    result = [_forecast(row, computed, central, claims, findings) for row in rows]
    return tuple(each for each in result if each is not None)


def _forecast(row: Row, computed: Computed, central: float, claims: Claims, findings: Findings) -> Forecast | None:
    before = len(findings.problems)
    identity = identify(row, claims, findings)
    if identity and not computed.at_all(identity[1]):
        findings.attempt(_remark_on_constant, row.workbook, identity[1], findings)
    share = findings.attempt(_central, row, findings)
    threshold = findings.attempt(number, row, "Threshold")
    asked = findings.attempt(_asked, row)
    units = findings.attempt(optional_text, row, "Units") or ""
    kind = findings.attempt(word_in, row, "Kind", Kind)
    role = findings.attempt(word_in, row, "Role", Role) or Role.ANSWER
    report_to = findings.attempt(_resolution, row, units)
    findings.attempt(_refuse_misfits, row, kind, role)
    if len(findings.problems) > before or not identity:
        return None
    name, cell = identity
    return Forecast(
        name=name,
        cell=cell,
        row=row.where,
        units=units,
        central=central if share is None else share,
        threshold=threshold,
        notes=row.notes(_KNOWN),
        asked=asked,
        report_to=report_to,
        kind=kind,
        role=role,
    )


def _resolution(row: Row, units: str) -> float | None:
    """Return the resolution in the cell, a number or such as `1 mph` in the units of the row; None if it is blank.

    Raises:
        DefinitionError: it is no number above 0, or in other units.
    """
    if not row.filled("Report to"):
        return None
    content, where = row.content("Report to"), row.cell("Report to")
    typed = _NUMBER_FIRST.fullmatch(content.value) if isinstance(content.value, str) else None
    if typed is None or not typed[2]:
        value = number_in(row.heading("Report to"), content, where)
    elif _same_units(typed[2], units):
        value = float(typed[1])
    else:
        message = f"{row.heading('Report to')} is in {typed[2]!r}, and the forecast is in {units!r}"
        message = message if units else f"{row.heading('Report to')} is in {typed[2]!r}, and the forecast has no units"
        raise DefinitionError(message, where=where, hint="Type a number in the units of the forecast, such as 1")
    if not 0.0 < value < math.inf:
        message = f"{row.heading('Report to')} ({show(value)}) must be above 0"
        raise DefinitionError(
            message, where=where, hint="Type the step in which the answer is stated, such as 1 or 0.5"
        )
    return value


def _same_units(first: str, second: str) -> bool:
    first, second = first.casefold(), second.strip().casefold()
    return first == second or (first in _DEGREES and second in _DEGREES)


def _refuse_misfits(row: Row, kind: Kind | None, role: Role | None) -> None:
    """Refuse a resolution of what is not rounded, and a bound of what has no order.

    Raises:
        DefinitionError: the row asks for one.
    """
    if kind not in NOT_ROUNDED:
        return
    hint = "Leave the cell blank, or correct Kind"
    if kind is Kind.CATEGORY and role is not None and role.is_bound:
        raise DefinitionError(f"A forecast of the kind {kind} is no bound", where=row.cell("Role"), hint=hint)
    if row.filled("Report to"):
        message = f"A forecast of the kind {kind} is not rounded"
        raise DefinitionError(message, where=row.cell("Report to"), hint=hint)


def _asked(row: Row) -> tuple[float, float] | None:
    """Return the range whose certainty is to be reported; a blank end is no limit, and two are no range.

    Raises:
        DefinitionError: an end is no number, or the range ends below its beginning.
    """
    low, high = number(row, "Certainty from"), number(row, "Certainty to")
    if low is None and high is None:
        return None
    ends = -math.inf if low is None else low, math.inf if high is None else high
    if ends[0] > ends[1]:
        message = f"The range of the certainty begins at {show(ends[0])} and ends at {show(ends[1])}"
        raise DefinitionError(message, where=row.cell("Certainty from"), hint="Exchange the two numbers")
    return ends


def _central(row: Row, findings: Findings) -> float | None:
    value = number(row, "Range %")
    return None if value is None else central_share(row.heading("Range %"), value, row.cell("Range %"), findings)


def _remark_on_constant(workbook: Workbook, cell: Cell, findings: Findings) -> None:
    """Remark on a forecast that no formula computes.

    Raises:
        DefinitionError: its cell is blank, or holds text or an error.
    """
    content = workbook.content(cell)
    if content.is_blank:
        raise DefinitionError("The forecast cell is blank", where=cell, hint="Point to the cell with the result")
    if isinstance(content.value, str) and content.formula is None:
        message = f"The forecast cell holds the text {as_text(content.value)!r}"
        raise DefinitionError(message, where=cell, hint="Point to the cell with the result")
    if not isinstance(content.value, bool):
        number_in("The forecast cell", content, cell)
    findings.notice("The forecast is a constant: it does not depend on anything", cell)
