"""The rows of `xlmc_solve`: cells that are solved for in every trial."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.computed import Computed
from xlmc.montecarlo.definitions.definitions import Parameter, Solve
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.stating import Which
from xlmc.montecarlo.definitions.tables.identity import Claims, cell_pointed_to
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import (
    Row,
    optional_text,
    parameter,
    required_text,
    rows_of,
    static_value,
    word_in,
)
from xlmc.montecarlo.distributions.parameters import show

__all__ = ["read_solves", "refuse_taken"]

_KNOWN = ("Name", "Cell", "To", "By", "Low", "High", "Root")
_NEEDED = ("Name", "Cell", "To", "By", "Low", "High")
_ONLY = "only"
"""What Root may say for a trial with a single value, which blank means, too."""


def read_solves(
    workbook: Workbook, tables: Iterable[DefinitionTable], computed: Computed, findings: Findings
) -> tuple[Solve, ...]:
    """Return the rows without a mistake, in their order.

    Args:
        workbook: where they are read.
        tables: the tables that hold them.
        computed: which cells have formulas; one that is solved for must not.
        findings: takes mistakes and remarks.
    """
    claims = Claims("solve")
    rows = rows_of(workbook, tables, _NEEDED, _KNOWN, findings)
    return tuple(filter(None, (_solve(row, computed, claims, findings) for row in rows)))


def _solve(row: Row, computed: Computed, claims: Claims, findings: Findings) -> Solve | None:
    before = len(findings.problems)
    name = findings.attempt(required_text, row, "Name")
    if name is not None:
        findings.attempt(claims.take_name, name, row.cell("Name"))
    cell = findings.attempt(_cell, row, "Cell", findings)
    by = findings.attempt(_cell, row, "By", findings)
    if by is not None:
        findings.attempt(claims.take_cell, by, row.where)
        findings.attempt(_refuse_formula, by, row.cell("By"), computed)
    to, low, high = (findings.attempt(_number, row, heading) for heading in ("To", "Low", "High"))
    root = findings.attempt(_root, row)
    if len(findings.problems) > before or name is None or cell is None or by is None:
        return None
    assert to is not None
    assert low is not None
    assert high is not None
    ends = static_value(low, row.workbook), static_value(high, row.workbook)
    if None not in ends and not ends[0] < ends[1]:  # type: ignore[operator]  # both are numbers
        message = f"Low ({show(ends[0])}) is not below High ({show(ends[1])})"  # type: ignore[arg-type]
        findings.problem(message, row.cell("High"), "Give the least and the largest value that the cell may have")
        return None
    numbers = {"to": to, "low": low, "high": high}
    typed = {key: row.cell(key.capitalize()) for key, given in numbers.items() if not isinstance(given, Cell)}
    return Solve(name, cell, to, by, low, high, row.where, root, typed)


def _cell(row: Row, heading: str, findings: Findings) -> Cell:
    if not row.filled(heading):
        message = f"{row.heading(heading)} is blank"
        raise DefinitionError(message, where=row.cell(heading), hint="Write a reference, such as =Inputs!B7")
    return cell_pointed_to(row, heading, findings)


def _refuse_formula(by: Cell, where: Cell, computed: Computed) -> None:
    if computed.by_formula(by):
        message = f"{by} holds a formula, and only a cell without one can be solved for"
        raise DefinitionError(message, where=where, hint="Point By to the input that is to be found")


def _number(row: Row, heading: str) -> Parameter:
    result = parameter(row, heading)
    if result is None:
        message = f"{row.heading(heading)} is blank"
        raise DefinitionError(message, where=row.cell(heading), hint="Type a number, or a formula that gives one")
    return result


def _root(row: Row) -> Which | None:
    if optional_text(row, "Root").casefold() == _ONLY:
        return None
    return word_in(row, "Root", Which)


def refuse_taken(solves: Iterable[Solve], assumptions: Mapping[Cell, Cell], findings: Findings) -> None:
    """Refuse a row that solves for the cell of an assumption.

    Args:
        solves: the rows.
        assumptions: cell -> the row of its assumption.
        findings: takes the mistakes.
    """
    for each in solves:
        if each.by in assumptions:
            message = f"{each.by} is the cell of an assumption ({assumptions[each.by]}), which is drawn"
            findings.problem(message, each.row, "Solve for another cell, or take the assumption's row out")
