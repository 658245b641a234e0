"""The reserved tables of a workbook, and their headings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from difflib import SequenceMatcher

from xlmc.errors import ErrorCode
from xlmc.excel.address import Area, Cell, parse_address
from xlmc.excel.workbook.printable import label
from xlmc.excel.workbook.workbook import CellValue, Table, Workbook
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.distributions.spelling import nearest, plain

__all__ = ["CASE", "CONVERTED", "KINDS", "NEAR_MISS", "DefinitionTable", "as_text", "definition_tables", "likely_table"]

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
    "xlmc_correlation_matrix",
    "xlmc_scenarios",
    "xlmc_solve",
    "xlmc_decisions",
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


_LEAST_ROWS = 2
"""Headings, and a row."""

_SIGNS = {
    "xlmc_assumptions": ({"name", "distribution"}, {"name", "low", "high"}, {"name", "mean", plain("Std dev")}),
    "xlmc_forecasts": ({"name", "cell", "threshold"}, {"name", "value", "threshold"}, {"name", "cell", "units"}),
    "xlmc_filters": ({"name", plain("At least")}, {"name", plain("At most")}, {"name", "above"}, {"name", "below"}),
    "xlmc_correlations": ({"first", "second", "correlation"},),
    "xlmc_settings": ({"setting", "value"},),
}
"""Headings that hardly any other table has."""


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
    """Return the reserved tables of every sheet by kind, each kind present.

    A plain range counts too, where its sheet has the name of a table, or a defined name of a table stands for it.
    """
    result: dict[str, list[DefinitionTable]] = {kind: [] for kind in KINDS}
    for table in workbook.tables:
        kind = next((kind for kind in KINDS if table.name.casefold().startswith(kind)), None)
        if kind is not None:
            result[kind].append(_with_headings(kind, table, findings))
        elif not table.name.casefold().startswith(CASE):
            _point_out_unknown(table, findings)
    for kind in KINDS:
        area = None if result[kind] or kind == CONVERTED else _plain_range(workbook, kind)
        if area is not None:
            headings = [workbook.content(Cell(area.sheet, area.top, at)).value for at in _columns(area)]
            table = Table(kind, area, tuple(map(as_text, headings)))
            message = f"The range {area} is read as the table {kind}: it has its name, and is no table of Excel"
            findings.notice(message, Cell(area.sheet, area.top, area.left))
            result[kind].append(_with_headings(kind, table, findings))
    return result


def as_text(value: CellValue) -> str:
    """Write a value as Excel shows it in a cell of general format."""
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


def likely_table(workbook: Workbook, kind: str) -> Table | None:
    """Return a table with the headings of a reserved one under a name of its own; None where there is none."""
    for table in workbook.tables:
        headings = {plain(heading) for heading in table.columns}
        if not table.name.casefold().startswith(_PREFIX) and any(each <= headings for each in _SIGNS.get(kind, ())):
            return table
    return None


def _plain_range(workbook: Workbook, kind: str) -> Area | None:
    """Return the cells that have the name of a table without being one: headings, and rows down to a blank one."""
    named = workbook.defined_name(kind)
    if named is not None:
        try:
            reference = parse_address(named.text)
        except ValueError:
            return None
        sheet = workbook.sheet_named(reference.sheet)
        if not isinstance(reference, Area) or reference.rows < _LEAST_ROWS or sheet is None:
            return None
        return replace(reference, sheet=sheet.name)
    sheet = workbook.sheet_named(kind)
    filled = sorted(at for at, content in sheet.cells.items() if not content.is_blank) if sheet is not None else []
    if sheet is None or not filled or any(table.area.sheet == sheet.name for table in workbook.tables):
        return None
    (top, left), right = filled[0], filled[0][1]
    taken = set(filled)
    while (top, right + 1) in taken:
        right += 1
    bottom = top
    while any((bottom + 1, column) in taken for column in range(left, right + 1)):
        bottom += 1
    return Area(sheet.name, top, left, bottom, right) if bottom > top else None


def _columns(area: Area) -> range:
    return range(area.left, area.right + 1)


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
