"""The reserved tables of a workbook, and their headings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import SequenceMatcher

from xlmc.excel.address import Cell
from xlmc.excel.workbook.printable import label
from xlmc.excel.workbook.workbook import Table, Workbook
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.distributions.spelling import nearest, plain

__all__ = ["CASE", "CONVERTED", "KINDS", "NEAR_MISS", "DefinitionTable", "definition_tables"]

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

NEAR_MISS = 0.8
"""Likeness above which an unknown name is taken for a slip."""

_SLIP = 0.74  # likeness of the first letters above which they are: one of four is another


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


def definition_tables(workbook: Workbook, findings: Findings) -> dict[str, list[DefinitionTable]]:
    """Return the reserved tables of every sheet by kind, each kind present."""
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
        if _starts_like(begins, _PREFIX, _SLIP) and _starts_like(begins, plain(kind), NEAR_MISS):
            hint = f"Rename it {kind} (Table Design); if it is not meant for xlmc, give it a name without xlmc"
            findings.problem(f"The table {table.name} is not read: did you mean {kind}?", where, hint)
            return
    if begins.startswith(_PREFIX):
        findings.notice(f"The table {table.name} is not read: xlmc reads {', '.join(KINDS)}", where)
    elif slip := nearest(table.name, KINDS, NEAR_MISS):
        findings.notice(f"The table {table.name} is not read: did you mean {slip}?", where)


def _starts_like(text: str, known: str, closeness: float) -> bool:
    """Whether a text begins as a known one does, but for a slip; what follows does not count."""
    lengths = range(len(known) - 1, len(known) + 2)
    return any(SequenceMatcher(None, text[:length], known).ratio() > closeness for length in lengths)


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
