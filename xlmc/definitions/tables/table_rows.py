"""The reserved tables of a workbook, their headings and their rows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher

from xlmc.address import Cell
from xlmc.definitions.problems import Findings
from xlmc.distributions.spelling import nearest, plain
from xlmc.errors import ErrorCode
from xlmc.workbook.printable import label
from xlmc.workbook.workbook import CellContent, CellValue, Table, Workbook

__all__ = [
    "CASE",
    "CONVERTED",
    "KINDS",
    "DefinitionTable",
    "Row",
    "as_text",
    "definition_tables",
    "holds_rows",
    "rows_of",
]

CONVERTED = "xlmc_converted"
"""What the name of the table starts with that `xlmc convert` writes: a workbook that has it has its definitions in
tables, also those of Crystal Ball's dialogs, where they could be converted."""

KINDS = (
    "xlmc_assumptions",
    "xlmc_forecasts",
    "xlmc_filters",
    "xlmc_evidence",
    "xlmc_checks",
    "xlmc_correlations",
    "xlmc_scenarios",
    "xlmc_settings",
    CONVERTED,
)
"""What the names of the tables start with; a copied sheet's `xlmc_assumptions3` counts too."""

CASE = "xlmc_case"
"""What the name of the table starts with that says whose case it is: for reports; a run does not read it."""

_PREFIX = "xlmc"

_NEAR_MISS = 0.8  # likeness above which an unknown name is taken for a slip
_SLIP = 0.74  # likeness of the first letters above which they are: one of four is another
_MISSPELT = 0.85  # likeness above which a heading is taken for one that the table lacks

_TOLD = frozenset({"units", "source", "because"})
"""Columns that are only shown: a slip in their heading changes no number."""


@dataclass(frozen=True, slots=True)
class DefinitionTable:
    """A reserved table. `columns` maps the plain spelling of a heading to the heading as written and its column."""

    kind: str
    table: Table
    columns: Mapping[str, tuple[str, int]]

    @property
    def where(self) -> Cell:
        return Cell(self.table.area.sheet, self.table.area.top, self.table.area.left)

    def heading_cell(self, column: int) -> Cell:
        return Cell(self.table.area.sheet, self.table.area.top, column)


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a reserved table; columns go by any spelling of their heading."""

    workbook: Workbook
    table: DefinitionTable
    number: int

    def has(self, heading: str) -> bool:
        """Whether the table has the column at all."""
        return plain(heading) in self.table.columns

    def filled(self, heading: str) -> bool:
        """Whether the table has the column and the row holds something in it."""
        return self.has(heading) and not self.content(heading).is_blank

    @property
    def headings(self) -> tuple[str, ...]:
        """Every heading of the table, as written."""
        return tuple(written for written, _ in self.table.columns.values())

    def heading(self, heading: str) -> str:
        """The heading as this table writes it."""
        return self.table.columns[plain(heading)][0]

    def cell(self, heading: str) -> Cell:
        """The table's own cell in that column."""
        return Cell(self.table.table.area.sheet, self.number, self.table.columns[plain(heading)][1])

    def content(self, heading: str) -> CellContent:
        """What the table's own cell holds; blank where the table has no such column."""
        return self.workbook.content(self.cell(heading)) if self.has(heading) else CellContent()

    @property
    def where(self) -> Cell:
        """The cell that stands for the row: its first."""
        return Cell(self.table.table.area.sheet, self.number, self.table.table.area.left)

    def notes(self, known: Iterable[str]) -> dict[str, str]:
        """The filled cells of the columns that nobody else reads, heading as written -> text."""
        spellings = {plain(heading) for heading in known}
        return {
            written: as_text(self.content(written).value)
            for spelling, (written, _) in self.table.columns.items()
            if spelling not in spellings and self.filled(written)
        }


def as_text(value: CellValue) -> str:
    """A value as Excel shows it in a cell of general format."""
    match value:
        case None:
            return ""
        case bool():
            return "TRUE" if value else "FALSE"
        case ErrorCode():
            return value.text
        case str():
            return label(value.strip())
        case _:
            return format(value, ".15g")


def definition_tables(workbook: Workbook, findings: Findings) -> dict[str, list[DefinitionTable]]:
    """The reserved tables of every sheet by kind, each kind present."""
    found: dict[str, list[DefinitionTable]] = {kind: [] for kind in KINDS}
    for table in workbook.tables:
        kind = next((kind for kind in KINDS if table.name.casefold().startswith(kind)), None)
        if kind is not None:
            found[kind].append(_with_headings(kind, table, findings))
        elif not table.name.casefold().startswith(CASE):
            _point_out_unknown(table, findings)
    return found


def _point_out_unknown(table: Table, findings: Findings) -> None:
    """Refuse a name that is nearly a reserved one: a misspelt table of filters would filter nothing.

    Any other name with xlmc's prefix gets a notice, and so does a reserved name without the prefix.
    """
    where = Cell(table.area.sheet, table.area.top, table.area.left)
    begins = plain(table.name)
    for kind in KINDS:
        if _starts_like(begins, _PREFIX, _SLIP) and _starts_like(begins, plain(kind), _NEAR_MISS):
            hint = f"Rename it {kind} (Table Design); if it is not meant for xlmc, give it a name without xlmc"
            findings.problem(f"The table {table.name} is not read: did you mean {kind}?", where, hint)
            return
    if begins.startswith(_PREFIX):
        findings.notice(f"The table {table.name} is not read: xlmc reads {', '.join(KINDS)}", where)
    elif slip := nearest(table.name, KINDS, _NEAR_MISS):
        findings.notice(f"The table {table.name} is not read: did you mean {slip}?", where)


def _starts_like(text: str, known: str, closeness: float) -> bool:
    """Whether a text begins as a known one does, but for a slip; what follows does not count."""
    lengths = range(len(known) - 1, len(known) + 2)
    return any(SequenceMatcher(None, text[:length], known).ratio() > closeness for length in lengths)


def rows_of(
    workbook: Workbook,
    tables: Iterable[DefinitionTable],
    required: Iterable[str],
    known: Iterable[str],
    findings: Findings,
) -> Iterator[Row]:
    """The rows of these tables that hold anything, without header and totals.

    A table that lacks a required column is a problem and gives no rows. A heading that nobody reads but that looks
    like a known one is pointed out, because its column is kept as a note only; where the table lacks the known one,
    and numbers depend on it, the heading is a problem.
    """
    required, known = tuple(required), tuple(known)
    for table in tables:
        _point_out_slips(workbook, table, known, required, findings)
        if _complete(table, required, findings):
            _point_out_row_below(workbook, table, required, findings)
            yield from _filled_rows(workbook, table)


def holds_rows(workbook: Workbook, table: DefinitionTable) -> bool:
    """Whether any row of the table holds anything."""
    return next(_filled_rows(workbook, table), None) is not None


def _with_headings(kind: str, table: Table, findings: Findings) -> DefinitionTable:
    columns: dict[str, tuple[str, int]] = {}
    for number, heading in enumerate(table.columns, start=table.area.left):
        heading = label(heading)
        spelling = plain(heading)
        if spelling in columns:
            message = f"The table {table.name} has two columns {columns[spelling][0]!r} and {heading!r}"
            where = Cell(table.area.sheet, table.area.top, number)
            findings.problem(message, where, "Rename or delete one of them")
        else:
            columns[spelling] = heading, number
    return DefinitionTable(kind, table, columns)


def _complete(table: DefinitionTable, required: tuple[str, ...], findings: Findings) -> bool:
    missing = [heading for heading in required if plain(heading) not in table.columns]
    for heading in missing:
        slip = nearest(heading, (written for written, _ in table.columns.values()))
        hint = f"Rename the column {slip!r} to {heading}" if slip else f"Add a column {heading}"
        findings.problem(f"The table {table.table.name} has no column {heading}", table.where, hint)
    return not missing


def _point_out_slips(
    workbook: Workbook, table: DefinitionTable, known: tuple[str, ...], required: tuple[str, ...], findings: Findings
) -> None:
    spellings = {plain(heading) for heading in known}
    missing = [heading for heading in known if plain(heading) not in table.columns and plain(heading) not in _TOLD]
    missing = [heading for heading in missing if heading not in required]  # `_complete` tells of these
    for spelling, (written, number) in table.columns.items():
        slip = None if spelling in spellings else nearest(written, known, _NEAR_MISS)
        if slip is None:
            continue
        where = table.heading_cell(number)
        meant = nearest(written, missing, _MISSPELT)
        if meant is not None and any(row.filled(written) for row in _filled_rows(workbook, table)):
            hint = f"Rename the column {meant}; if it is a note, give it a heading that is less like {meant}"
            findings.problem(f"The column {written!r} is not read: did you mean {meant}?", where, hint)
        else:
            findings.notice(f"The column {written!r} is kept as a note only: did you mean {slip}?", where)


def _point_out_row_below(
    workbook: Workbook, table: DefinitionTable, required: Iterable[str], findings: Findings
) -> None:
    """Excel takes a row that is typed below a table into it; other programs do not, and nobody would miss the row."""
    area = table.table.area
    row = Row(workbook, table, area.bottom + 1)
    filled = sum(row.filled(written) for written in row.headings)
    taken = table.table.totals_rows or any(row.where in other.area for other in workbook.tables)
    if filled > 1 and all(map(row.filled, required)) and not taken:
        name = table.table.name
        message = f"This row is right below the table {name} and is not read: drag the table's corner over it"
        findings.notice(f"{message}, or leave a blank row above it", row.where)


def _filled_rows(workbook: Workbook, table: DefinitionTable) -> Iterator[Row]:
    body = table.table.body
    for number in range(body.top, body.bottom + 1):
        row = Row(workbook, table, number)
        if any(row.filled(written) for written, _ in table.columns.values()):
            yield row
