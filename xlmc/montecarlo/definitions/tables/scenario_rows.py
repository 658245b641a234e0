"""The rows of `xlmc_scenarios`: what each scenario changes. A blank cell leaves things as they are in the workbook.

A column is headed by what it changes:

- an assumption, by its name or its cell: a number holds it there, `.6 to .8` is another range, `P0 to P10` a band of
  its distribution, `frozen` and `drawn` say whether it is drawn;
- a filter, by its name: `0 to .5`, `at most .5`, `below 1`;
- a column of a row of another table, by the row's name and the column's heading: `Friction Low`, `Restitution At most`;
- any other cell, by its defined name or its address: what is typed into it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.errors import DefinitionError, ErrorCode
from xlmc.excel.address import Cell, InFormula
from xlmc.excel.workbook.workbook import CellContent, CellValue, Workbook
from xlmc.montecarlo.definitions.cell_references import cell_of_reference, is_address, split_sheet
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Filter
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.scenarios import (
    Band,
    Change,
    Drawn,
    Frozen,
    Limits,
    Numbers,
    Range,
    Scenario,
    Switched,
    Typed,
)
from xlmc.montecarlo.definitions.tables.filters import LIMITS
from xlmc.montecarlo.definitions.tables.identity import Claims
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import Row, as_text, logical_in, number_in, optional_text, rows_of
from xlmc.montecarlo.distributions.spelling import by_names, name_key, nearest, plain

__all__ = ["read_scenarios"]

_KNOWN: Final = ("Name", "Note")

_NUMBER: Final = r"[-+−]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?\s*%?"
_RANGE: Final = re.compile(rf"(?:from\s+)?({_NUMBER})\s*(?:to|–|…|\.\.\.?)\s*({_NUMBER})", re.IGNORECASE)
_ONE_END: Final = re.compile(rf"(at least|at most|above|below)\s+({_NUMBER})", re.IGNORECASE)
_BAND: Final = re.compile(r"P(\d{1,3}(?:\.\d+)?)\s*(?:to|–|…|\.\.\.?)\s*P(\d{1,3}(?:\.\d+)?)", re.IGNORECASE)

_OF_ASSUMPTION: Final = (
    "Type a number to hold it at, a range such as 0.6 to 0.8, a band such as P0 to P10, frozen, or drawn"
)
_OF_FILTER: Final = "Type limits such as 0 to 0.5, at least 0, at most 0.5, above 0 or below 1"
_SWITCHES: Final = ("xlmc_filters", "xlmc_evidence")
"""Tables whose rows can be used or not, also where they have no column `Use`."""

_NOTHING: Final = "none"
"""What takes a cutoff or a limit away."""

Take = Callable[[CellContent, Cell], Change]
"""Reads a cell of a scenario: what it holds, and where it stands."""


@dataclass(frozen=True, slots=True)
class _Column:
    """What a column changes: `target` is the same for two columns that change the same."""

    heading: str
    target: object
    take: Take


def read_scenarios(
    workbook: Workbook,
    tables: Mapping[str, Sequence[DefinitionTable]],
    assumptions: Iterable[Assumption],
    filters: Iterable[Filter],
    findings: Findings,
) -> tuple[Scenario, ...]:
    """Return the scenarios without a mistake, in the order of the rows.

    Args:
        workbook: where they are read.
        tables: all reserved tables, by kind.
        assumptions: of the workbook.
        filters: of the workbook.
        findings: takes mistakes and remarks.
    """
    claims = Claims("scenario")
    result: list[Scenario | None] = []
    headings = _Headings(workbook, tables, tuple(assumptions), tuple(filters))
    for table in tables["xlmc_scenarios"]:
        columns = [each for each in _columns(table, headings, findings) if each is not None]
        others = [written for written, _ in table.columns.values() if plain(written) not in map(plain, _KNOWN)]
        rows = rows_of(workbook, [table], ("Name",), (*_KNOWN, *others), findings)
        result += [_scenario(row, columns, claims, findings) for row in rows]
    return tuple(each for each in result if each is not None)


def _columns(table: DefinitionTable, headings: _Headings, findings: Findings) -> Iterator[_Column | None]:
    taken: dict[object, str] = {}
    for written, number in table.columns.values():
        if plain(written) in map(plain, _KNOWN):
            continue
        where = table.heading_cell(number)
        column = findings.attempt(headings.column, written, where)
        if column is not None and column.target in taken:
            message = f"The columns {taken[column.target]!r} and {written!r} change the same"
            findings.problem(message, where, "Delete one of them")
            continue
        if column is not None:
            taken[column.target] = written
            if isinstance(column.target, Cell) and is_address(split_sheet(written)[1]):
                message = f"The heading {written!r} goes stale when rows move; a defined name of the cell follows it"
                findings.notice(message, where)
        yield column


def _scenario(row: Row, columns: Sequence[_Column], claims: Claims, findings: Findings) -> Scenario | None:
    before = len(findings.problems)
    name = findings.attempt(optional_text, row, "Name")
    if name == "":
        findings.problem("The scenario has no name", row.cell("Name"), "Fill in Name, or clear the whole row")
    elif name is not None:
        findings.attempt(claims.take_name, name, row.cell("Name"))
    note = findings.attempt(optional_text, row, "Note") or ""
    changes = [findings.attempt(_read, column, row) for column in columns if row.filled(column.heading)]
    if len(findings.problems) > before or not name:
        return None
    if not changes:
        findings.notice(f"The scenario {name!r} changes nothing", row.where)
    return Scenario(name, tuple(each for each in changes if each is not None), note, row.where)


def _read(column: _Column, row: Row) -> Change:
    """Return the change that a cell asks for; a formula counts as what Excel calculated.

    Raises:
        DefinitionError: it cannot be read.
    """
    content, where = row.content(column.heading), row.cell(column.heading)
    if content.value is None or isinstance(content.value, ErrorCode):
        number_in(column.heading, content, where)  # refuses it, and says why
    return column.take(content, where)


class _Headings:
    """Finds out what the heading of a column changes."""

    def __init__(
        self,
        workbook: Workbook,
        tables: Mapping[str, Sequence[DefinitionTable]],
        assumptions: Sequence[Assumption],
        filters: Sequence[Filter],
    ) -> None:
        self._workbook = workbook
        self._assumptions = by_names(assumptions)
        self._filters = {name_key(each.name): each for each in filters if each.evidence is None}
        self._rows = list(_named_rows(workbook, tables))
        written = {name for name, row in self._rows if row.table.kind in ("xlmc_assumptions", "xlmc_filters")}
        self._faulty = written - self._assumptions.keys() - self._filters.keys()

    def column(self, heading: str, where: Cell) -> _Column | None:
        """Return what it changes; None for a row with a mistake, which is a problem already.

        Raises:
            DefinitionError: nothing, or more than one thing.
        """
        columns = [*self._of_names(heading), *self._of_columns(heading)]
        if not columns and name_key(heading) in self._faulty:
            return None
        if not columns:
            return self._of_cell(heading, where)
        if len(columns) > 1:
            message = f"{heading!r} may mean several things"
            hint = (
                "Head the column with the row's name and a heading of its table, such as Friction Low, or with a cell"
            )
            raise DefinitionError(message, where=where, hint=hint)
        return columns[0]

    def _of_names(self, heading: str) -> Iterator[_Column]:
        key = name_key(heading)
        if key in self._assumptions:
            yield _of_assumption(heading, self._assumptions[key])
        if key in self._filters:
            yield _of_filter(heading, self._filters[key])

    def _of_columns(self, heading: str) -> Iterator[_Column]:
        """Return a column of a row of another table; or a number of an assumption or a limit that has no such
        column.
        """
        key = name_key(heading)
        result: dict[Cell, _Column] = {}
        for name, row in self._rows:
            rest = key.removeprefix(f"{name} ") if key.startswith(f"{name} ") else ""
            if rest == "use" and row.table.kind in _SWITCHES:
                result[row.where] = _Column(heading, (row.where, "use"), _switch_of(as_text(row.content("Name").value)))
            elif rest and row.has(rest) and plain(rest) != "name":
                cell, of = row.cell(rest), (row.table.kind, name, rest)
                result[cell] = _Column(heading, cell, _typed(cell, heading, of, clears=_is_number_column(rest)))
        if result:
            yield from result.values()
            return
        for name, assumption in self._assumptions.items():
            rest = plain(key.removeprefix(f"{name} ")) if key.startswith(f"{name} ") else ""
            for spec_key, headings in _numbers_of(assumption):
                if rest and rest in map(plain, headings):
                    yield _Column(heading, (name, spec_key), _number_of(assumption, spec_key))
        for name, filter_ in self._filters.items():
            rest = plain(key.removeprefix(f"{name} ")) if key.startswith(f"{name} ") else ""
            for limit, written in LIMITS.items():
                if rest == plain(written):
                    yield _Column(heading, (name, limit), _limit_of(filter_, limit))

    def _of_cell(self, heading: str, where: Cell) -> _Column:
        head, tail = split_sheet(heading)
        known = [*dict.fromkeys(each.name for each in self._assumptions.values())]
        known += [each.name for each in self._filters.values()] + [each.name for each in self._workbook.names]
        if head is None and (is_address(tail) or self._workbook.defined_name(tail, where.sheet) is None):
            likely = nearest(heading, known)
            hint = f"Did you mean {likely}?" if likely else "Head it with the name of an assumption, a filter or a cell"
            if is_address(tail):
                hint = f"Name the sheet, too, such as Inputs!{tail.upper()}"
            message = f"{heading!r} is neither an assumption, a filter, a defined name nor a cell of a sheet"
            raise DefinitionError(message, where=where, hint=hint)
        cell = cell_of_reference(self._workbook, heading, where.sheet, where)
        own = next((each for each in self._assumptions.values() if each.cell == cell), None)
        if own is not None:
            return _of_assumption(heading, own)
        return _Column(heading, cell, _typed(cell, heading, None, clears=False))


def _named_rows(workbook: Workbook, tables: Mapping[str, Sequence[DefinitionTable]]) -> Iterator[tuple[str, Row]]:
    """Return the rows of the other tables that have a name, by its key."""
    for kind, those in tables.items():
        for table in those if kind != "xlmc_scenarios" else ():
            body = table.table.body
            for number in range(body.top, body.bottom + 1):
                row = Row(workbook, table, number)
                name = name_key(as_text(row.content("Name").value))
                if name:
                    yield name, row


def _of_assumption(heading: str, assumption: Assumption) -> _Column:
    name = assumption.name

    def take(content: CellContent, where: Cell) -> Change:
        value = content.value
        if isinstance(value, int | float) and not isinstance(value, bool | ErrorCode):
            return Frozen(name, float(value), where)
        text = as_text(value)
        if text.casefold() in ("frozen", "drawn"):
            return Frozen(name, None, where) if text.casefold() == "frozen" else Drawn(name, where)
        if re.fullmatch(_NUMBER, text):  # typed into a cell that was made a text, as ranges are
            return Frozen(name, _number(text), where)
        if match := _BAND.fullmatch(text):
            return Band(name, float(match[1]), float(match[2]), where)
        if match := _RANGE.fullmatch(text):
            return Range(name, _number(match[1]), _number(match[2]), where)
        if (match := _ONE_END.fullmatch(text)) and match[1].casefold() in ("at least", "at most"):
            least = match[1].casefold() == "at least"
            end = _number(match[2])
            return Range(name, end if least else None, None if least else end, where)
        raise DefinitionError(f"{text!r} says nothing of the assumption {name!r}", where=where, hint=_OF_ASSUMPTION)

    return _Column(heading, name_key(name), take)


def _of_filter(heading: str, filter_: Filter) -> _Column:
    name = filter_.name

    def take(content: CellContent, where: Cell) -> Change:
        text = as_text(content.value)
        if match := _RANGE.fullmatch(text):
            low, high = _number(match[1]), _number(match[2])
            return Limits(name, {"at_least": low, "at_most": high, "above": None, "below": None}, where)
        if match := _ONE_END.fullmatch(text):
            key = match[1].casefold().replace(" ", "_")
            other = {"at_least": "above", "above": "at_least", "at_most": "below", "below": "at_most"}[key]
            return Limits(name, {key: _number(match[2]), other: None}, where)
        raise DefinitionError(f"{text!r} is not a limit of the filter {name!r}", where=where, hint=_OF_FILTER)

    return _Column(heading, ("filter", name_key(name)), take)


def _typed(cell: Cell, heading: str, of: tuple[str, str, str] | None, *, clears: bool) -> Take:
    def take(content: CellContent, where: Cell) -> Change:
        value: CellValue = content.value
        if clears and isinstance(value, str) and value.strip().casefold() == _NOTHING:
            value = None
        return Typed(cell, value, where, heading, of)

    return take


def _switch_of(name: str) -> Take:
    def take(content: CellContent, where: Cell) -> Change:
        return Switched(name, logical_in("The cell", content, where), where)

    return take


def _number_of(assumption: Assumption, key: str) -> Take:
    def take(content: CellContent, where: Cell) -> Change:
        return Numbers(assumption.name, {key: _number_or_none(content, where)}, where)

    return take


def _limit_of(filter_: Filter, key: str) -> Take:
    def take(content: CellContent, where: Cell) -> Change:
        return Limits(filter_.name, {key: _number_or_none(content, where)}, where)

    return take


def _number_or_none(content: CellContent, where: Cell) -> float | None:
    if isinstance(content.value, str) and content.value.strip().casefold() == _NOTHING:
        return None
    return number_in("The cell", content, where)


def _numbers_of(assumption: Assumption) -> Iterator[tuple[str, Sequence[str]]]:
    """Return the parameters and cutoffs of an assumption: key, and how people write it."""
    if isinstance(assumption.cell, InFormula):
        for spec in assumption.family.parameters:
            yield spec.key, spec.headings
    for key, heading in CUTOFFS.items():
        yield key, (heading,)


def _is_number_column(heading: str) -> bool:
    return plain(heading) in {plain(each) for each in (*LIMITS.values(), *CUTOFFS.values(), "Threshold")}


def _number(text: str) -> float:
    """Write a number as it is typed into a text: `.6`, `60 %`, `−3`."""
    bare = text.replace("−", "-").strip()
    return float(bare.removesuffix("%")) / 100 if bare.endswith("%") else float(bare)
