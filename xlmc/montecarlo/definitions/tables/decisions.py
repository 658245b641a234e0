"""The rows of `xlmc_decisions`: cells that a person decides on, and the values that are tried."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Final

import numpy as np

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Decision
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.identity import Claims, identify
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import Row, number, optional_text, rows_of
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.spelling import nearest, plain
from xlmc.montecarlo.number_text import count_text

__all__ = ["read_decisions", "values_between"]

_KNOWN = ("Name", "Value", "Cell", "Low", "High", "Step", "Values", "Units")
_BY_RANGE = ("Low", "High", "Step")

_SLIP: Final = 0.7
"""Likeness above which a column that is not read may be meant for one that a row lacks."""

_STEPS: Final = 4
"""Steps from Low to High where Step is blank."""

_MOST_VALUES: Final = 100_000
_SLACK: Final = 1e-9
"""The part of a step by which High may be missed: .1 ten times is a little less than 1."""


def read_decisions(
    workbook: Workbook, tables: Iterable[DefinitionTable], computed: Computed, findings: Findings
) -> tuple[Decision, ...]:
    """Return the rows without a mistake, in their order.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells something gives a value; a decision's must have none.
        findings: takes mistakes and remarks.
    """
    claims = Claims("decision")
    rows = rows_of(workbook, tables, ("Name",), _KNOWN, findings)
    return tuple(filter(None, (_decision(row, computed, claims, findings) for row in rows)))


def _decision(row: Row, computed: Computed, claims: Claims, findings: Findings) -> Decision | None:
    before = len(findings.problems)
    identity = identify(row, claims, findings)
    if identity is not None and computed.at_all(identity[1]):
        formula = computed.by_formula(identity[1])
        what = "holds a formula" if formula else "is drawn or solved for in each trial"
        hint = "Decide on a cell that holds a number" if formula else "Decide on another cell, or take that row out"
        findings.problem(f"The cell of the decision {identity[0]!r}, {identity[1]}, {what}", row.where, hint)
    values = findings.attempt(_values, row)
    units = findings.attempt(optional_text, row, "Units") or ""
    if len(findings.problems) > before or identity is None or values is None:
        return None
    listed = row.filled("Values")
    contents = _contents(row) if listed else ()
    between = None if listed or row.filled("Step") else (values[0], values[-1])
    return Decision(*identity, values, row.where, units, between, listed, contents)


def _values(row: Row) -> tuple[float, ...]:
    """Return the values that a row says; a range without a step is divided into a few.

    Raises:
        DefinitionError: it says none, or in two ways.
    """
    filled = [heading for heading in _BY_RANGE if row.filled(heading)]
    if row.filled("Values"):
        if filled:
            message = f"{row.heading('Values')} and {row.heading(filled[0])} are both given"
            raise DefinitionError(message, where=row.cell(filled[0]), hint="Clear one of them")
        return _listed(row)
    low, high, step = (number(row, heading) for heading in _BY_RANGE)
    if low is None or high is None:
        raise _no_values(row)
    step = (high - low) / _STEPS if step is None else step
    if not low < high or not step > 0.0:
        message = f"From {show(low)} to {show(high)} in steps of {show(step)} there are no values"
        raise DefinitionError(message, where=row.cell("Low"), hint="Give Low below High, and Step above 0")
    return values_between(low, high, step, row.cell("Step") if row.filled("Step") else row.where)


def _no_values(row: Row) -> DefinitionError:
    """Say which column may be misspelt, or which cell is blank, where a row has no values."""
    hint = "Fill in Low and High, or Values such as 10; 20; 50"
    for heading in ("Low", "High", "Values"):
        slip = None if row.has(heading) else nearest(heading, _notes(row), _SLIP)
        if slip is not None:
            message = f"The column {slip!r} is not read: did you mean {heading}?"
            where = row.table.heading_cell(row.table.columns[plain(slip)][1])
            return DefinitionError(message, where=where, hint=f"Rename the column {heading}")
    if row.filled("Low") or row.filled("High"):
        blank = "High" if row.filled("Low") else "Low"
        where = row.cell(blank) if row.has(blank) else row.where
        return DefinitionError(f"The decision has no {blank}", where=where, hint=hint)
    return DefinitionError("The decision has no values", where=row.where, hint=hint)


def _notes(row: Row) -> list[str]:
    known = {plain(heading) for heading in _KNOWN}
    return [heading for heading in row.headings if plain(heading) not in known]


def values_between(low: float, high: float, step: float, where: Cell) -> tuple[float, ...]:
    """Return the values from one number to another, a step apart.

    Raises:
        DefinitionError: they are too many.
    """
    count = math.floor((high - low) / step + _SLACK) + 1
    if count > _MOST_VALUES:
        raise DefinitionError(
            f"{count_text(count)} values are more than {count_text(_MOST_VALUES)}",
            where=where,
            hint="Give a larger Step",
        )
    return tuple(np.minimum(low + step * np.arange(count), high).tolist())


def _parts(row: Row) -> list[str]:
    parts = (part.strip() for part in optional_text(row, "Values").split(";"))
    return [part for part in dict.fromkeys(parts) if part]


def _contents(row: Row) -> tuple[str | bool, ...]:
    """Return the texts, TRUE and FALSE that a row lists; nothing where it lists numbers."""
    parts = _parts(row)
    if any(_number(part) is not None for part in parts):
        return ()
    known = {"true": True, "false": False}
    return tuple(dict.fromkeys(known.get(part.casefold(), part) for part in parts))


def _listed(row: Row) -> tuple[float, ...]:
    """Return the numbers that a row lists; of texts their places, from 0.

    Raises:
        DefinitionError: it lists neither, or both.
    """
    texts, numbers = _contents(row), [_number(part) for part in _parts(row)]
    if len(texts) > 1:
        return tuple(map(float, range(len(texts))))
    result = tuple(dict.fromkeys(each for each in numbers if each is not None))
    if not result or len(result) < len(set(numbers)):
        slip = next((part for part, each in zip(_parts(row), numbers, strict=True) if each is None), "")
        what = f"numbers and {slip!r}" if result else f"one value, {slip!r}" if slip else "nothing"
        message = f"{row.heading('Values')} lists {what}"
        hint = "List numbers or texts, separated by semicolons: 10; 20; 50, or red; blue"
        raise DefinitionError(message, where=row.cell("Values"), hint=hint)
    return result


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
