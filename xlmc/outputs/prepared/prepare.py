"""A workbook of a person's own with xlmc's tables: on a new sheet, or as further rows of the tables that it has.

Everything else in the file stays byte for byte, but for the parts that any new sheet extends.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from xlmc.engine.engines import ENGINES
from xlmc.errors import DefinitionError
from xlmc.excel.address import Area, Cell
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.injection.cell_edit import Content, Typed, with_contents, with_last_row
from xlmc.excel.workbook.injection.host import result_sheets
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.structure import free_sheet_name, table_part
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.definitions_reader import read_definitions
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.proposals import Proposal, Proposals, proposals
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable, definition_tables
from xlmc.montecarlo.model.labels import calculate_labels
from xlmc.outputs.prepared.tables_sheet import HEADINGS, SHEET, NewRow, frozen_formula, tables_sheet

__all__ = ["Prepared", "prepared", "with_tables"]

_KINDS = ("xlmc_assumptions", "xlmc_forecasts")


@dataclass(frozen=True, slots=True)
class Prepared:
    """A workbook with tables, not written yet.

    Attributes:
        proposals: the cells that have rows now.
        sheet: the new sheet; empty where all rows were added to tables that were there.
        data: the file; the one that was read where nothing was added.
    """

    proposals: Proposals
    sheet: str
    data: bytes = field(repr=False)

    @property
    def is_new(self) -> bool:
        """Return whether anything was added."""
        return bool(self.sheet or self.proposals.assumptions or self.proposals.forecasts)


def prepared(
    path: Path, assumptions: Sequence[Area] | None, forecasts: Sequence[Area] | None, book: Workbook | None = None
) -> Prepared:
    """Propose rows, and return the workbook with them.

    Args:
        path: of the workbook.
        assumptions: where to look for inputs; everywhere where None.
        forecasts: where to look for answers; everywhere where None.
        book: that was read from the path.

    Raises:
        DefinitionError: the workbook has definitions of another program, or a table that cannot take further rows.
        WorkbookError: the file cannot be read, or no sheet can be added to it.
    """
    book = read_workbook(path) if book is None else book
    read = read_definitions(calculate_labels(book), ENGINES)
    tables = definition_tables(book, Findings())
    _refuse_other_definitions(book, read.assumptions, tables)
    cells = {each.cell for each in read.assumptions} | {each.cell for each in read.forecasts}
    cells |= {cell for kind in _KINDS for table in tables[kind] for cell in _pointed_to(book, table)}
    results = {*result_sheets(book.parts)}
    left_out = {sheet.name for sheet in book.sheets.values() if sheet.part in results}
    result = proposals(book, cells, assumptions, forecasts, left_out)
    rows = {
        "xlmc_assumptions": [_row(each) for each in result.assumptions],
        "xlmc_forecasts": [_row(each) for each in result.forecasts],
    }
    return Prepared(result, *_with_rows(book, tables, rows))


def with_tables(book: Workbook, rows: Mapping[str, Sequence[NewRow]], title: str) -> bytes:
    """Return the file of a workbook without tables with a sheet of these."""
    kinds = [*HEADINGS]
    parts = inject(
        book.parts, tables_sheet(rows, kinds, free_sheet_name(book.parts, SHEET), title), replace=False, marked=False
    )
    return checked_bytes(parts, book.parts)


def _refuse_other_definitions(
    book: Workbook, assumptions: Sequence[object], tables: Mapping[str, list[DefinitionTable]]
) -> None:
    if assumptions and not any(tables.values()):
        hint = f"It runs as it is: xlmc simulate {book.name}; xlmc convert {book.name} turns them into tables"
        message = "the workbook has its assumptions already, in calls or dialogs of another program"
        raise DefinitionError(message, where=book.name, hint=hint)


def _pointed_to(book: Workbook, table: DefinitionTable) -> Iterator[Cell]:
    """Yield the cells that a table's rows are about as far as they say so, also those of rows with a mistake."""
    from xlmc.montecarlo.definitions.cell_references import cell_of_reference, formula_at

    column = table.columns.get("cell")
    body = table.table.body
    for row in range(body.top, body.bottom + 1) if column is not None else ():
        at = Cell(body.sheet, row, column[1])  # type: ignore[index]
        formula = book.content(at).formula
        if formula is not None:
            try:
                yield cell_of_reference(book, formula_at(formula, at), at.sheet, at)
            except DefinitionError:
                continue  # a check of the workbook tells of it


def _row(each: Proposal) -> NewRow:
    value = each.value
    assert value is None or isinstance(value, float | int | str | bool)
    return NewRow({"Name": each.name, "Units": each.units or None}, each.cell, value)


def _with_rows(
    book: Workbook,
    tables: Mapping[str, list[DefinitionTable]],
    rows: Mapping[str, Sequence[NewRow]],
) -> tuple[str, bytes]:
    """Return the name of the new sheet and the file."""
    parts = dict(book.parts)
    missing = [kind for kind in HEADINGS if not tables[kind]]
    for kind, new in rows.items():
        if tables[kind] and new:
            _add(book, parts, tables[kind][-1], new)
    wanted = [kind for kind in missing if kind in _KINDS and rows[kind]] or ([] if any(tables.values()) else missing)
    name = ""
    if wanted:
        name = free_sheet_name(book.parts, SHEET)
        kinds = missing if not any(tables.values()) else wanted
        parts = inject(
            parts, tables_sheet(rows, kinds, name, "What is uncertain, and what is asked"), replace=False, marked=False
        )
    elif not any(rows.values()):
        return "", book.data
    return name, checked_bytes(parts, book.parts)


def _add(book: Workbook, parts: dict[str, bytes], table: DefinitionTable, rows: Sequence[NewRow]) -> None:
    """Put rows below a table, or into its blank rows at the end.

    Raises:
        DefinitionError: it lacks a column for them, or there is no room below.
    """
    needed = ("Name", "Cell", "Frozen") if table.kind == "xlmc_assumptions" else ("Name", "Cell")
    for heading in needed:
        if heading.casefold() not in table.columns:
            hint = f"Type {heading} into the cell behind its last heading: Excel makes a column of it"
            raise DefinitionError(f"the table {table.table.name} has no column {heading}", where=table.where, hint=hint)
    area, body = table.table.area, table.table.body
    top = body.bottom + 1
    while top > body.top and _is_blank(book, area, top - 1):
        top -= 1
    bottom = top + len(rows) - 1
    taken = [row for row in range(body.bottom + 1, bottom + 1) if not _is_free(book, area, row)]
    if taken or (table.table.totals_rows and bottom > body.bottom):
        where = Cell(area.sheet, taken[0] if taken else area.bottom, area.left)
        hint = f"Make room for {len(rows)} rows below it in Excel, or name fewer cells with --assumption and --forecast"
        raise DefinitionError(
            f"there is no room for more rows below the table {table.table.name}", where=where, hint=hint
        )
    contents: dict[tuple[int, int], Content] = {}
    columns = {spelling: column for spelling, (_, column) in table.columns.items()}
    for number, row in enumerate(rows, top):
        for heading, value in row.given.items():
            if heading.casefold() in columns and value is not None:
                contents[number, columns[heading.casefold()]] = value
        contents[number, columns["cell"]] = Typed(f"{row.cell}", row.value)
        if table.kind == "xlmc_assumptions":
            contents[number, columns["frozen"]] = _frozen(table, number)
    sheet = book.sheets[area.sheet]
    parts[sheet.part] = with_contents(parts[sheet.part], sheet.part, sheet.name, contents)
    if bottom > body.bottom:
        part = table_part(parts, table.table.name)
        parts[part] = with_last_row(parts[part], part, bottom)


def _frozen(table: DefinitionTable, row: int) -> Content:
    """Return what freezes a row: until it is filled in where the columns are ours, else TRUE."""
    headings = [written for written, _ in table.columns.values()]
    ours = list(HEADINGS["xlmc_assumptions"])
    if headings[: len(ours)] == ours:
        left = table.table.area.left + ours.index("Distribution")
        return Typed(frozen_formula(row - 1, left - 1).removeprefix("="), True)
    return True


def _is_blank(book: Workbook, area: Area, row: int) -> bool:
    return all(book.content(Cell(area.sheet, row, column)).is_blank for column in range(area.left, area.right + 1))


def _is_free(book: Workbook, area: Area, row: int) -> bool:
    cells = [Cell(area.sheet, row, column) for column in range(area.left, area.right + 1)]
    return _is_blank(book, area, row) and not any(cell in other.area for other in book.tables for cell in cells)
