"""The row for a distribution in a workbook's table `xlmc_assumptions`: the row of that name, or a new one below."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import Table, Workbook
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.assumptions import PARAMETERS, is_percentile
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable, definition_tables
from xlmc.montecarlo.definitions.tables.table_rows import Row, as_text
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.spelling import name_key, plain

__all__ = ["RowEdit", "row_edit"]

_KIND = "xlmc_assumptions"


@dataclass(frozen=True, slots=True)
class RowEdit:
    """What to write.

    Attributes:
        table: that the row is of.
        row: its number.
        is_new: whether the assumption has no row yet.
        contents: by row and column; None empties a cell.
    """

    table: Table
    row: int
    is_new: bool
    contents: Mapping[tuple[int, int], str | float | None]

    @property
    def grows(self) -> bool:
        """Whether the table has to reach to it yet."""
        return self.row > self.table.area.bottom

    @property
    def where(self) -> Cell:
        """The row's first cell."""
        return Cell(self.table.area.sheet, self.row, self.table.area.left)


def row_edit(
    workbook: Workbook, name: str, family: str, parameters: Mapping[str, float], base: float, source: str
) -> RowEdit:
    """Write what is needed so that an assumption has a distribution.

    Args:
        workbook: that has the table.
        name: of the assumption. In a row that has it, the distribution, its parameters and the source are replaced;
            parameters of another distribution are emptied.
        family: of the distribution.
        parameters: heading -> value.
        base: the value of a new row.
        source: where the distribution comes from.

    Raises:
        DefinitionError: there is no such table, it lacks a column, or there is no room below it.
    """
    tables = definition_tables(workbook, Findings())[_KIND]
    if not tables:
        hint = f"Make a table of that name, with the columns Name, Value, Distribution and {', '.join(parameters)}"
        raise DefinitionError(f"{workbook.name} has no table {_KIND}", hint=hint)
    for table in tables:
        body = table.table.body
        for number in range(body.top, body.bottom + 1):
            row = Row(workbook, table, number)
            if name_key(as_text(row.content("Name").value)) == name_key(name):
                return RowEdit(table.table, number, False, _contents(row, family, parameters, source))
    table, number = _place(workbook, tables)
    row = Row(workbook, table, number)
    contents: dict[tuple[int, int], str | float | None] = {_at(row, "Name"): name, _at(row, "Value"): base}
    return RowEdit(table.table, number, True, {**_contents(row, family, parameters, source), **contents})


def _contents(
    row: Row, family: str, parameters: Mapping[str, float], source: str
) -> dict[tuple[int, int], str | float | None]:
    result: dict[tuple[int, int], str | float | None] = {}
    for heading in (*PARAMETERS, *filter(is_percentile, row.headings)):
        if row.has(heading):
            result[_at(row, heading)] = None
    result[_at(row, "Distribution")] = family
    for spec in FAMILIES[family].parameters:
        value = next(parameters[heading] for heading in spec.headings if heading in parameters)
        heading = next((each for each in spec.headings if row.has(each)), spec.heading)
        if row.has(heading) or value != spec.default:
            result[_at(row, heading)] = float(value)
    if row.has("Source"):
        result[_at(row, "Source")] = source
    return result


def _at(row: Row, heading: str) -> tuple[int, int]:
    """Row and column of a cell.

    Raises:
        DefinitionError: the table has no such column.
    """
    if plain(heading) not in row.table.columns:
        table = row.table.table
        hint = f"Type {heading} into the cell behind its last heading: Excel makes a column of it"
        raise DefinitionError(f"the table {table.name} has no column {heading}", where=row.table.where, hint=hint)
    cell = row.cell(heading)
    return cell.row, cell.column


def _place(workbook: Workbook, tables: Sequence[DefinitionTable]) -> tuple[DefinitionTable, int]:
    """Return the first row of a table that is empty, or the row below the last table."""
    for table in tables:
        body = table.table.body
        for number in range(body.top, body.bottom + 1):
            cells = (Cell(body.sheet, number, column) for column in range(body.left, body.right + 1))
            if all(workbook.content(cell).is_blank for cell in cells):
                return table, number
    return tables[-1], _row_below(workbook, tables[-1])


def _row_below(workbook: Workbook, table: DefinitionTable) -> int:
    """Return the row below a table.

    Raises:
        DefinitionError: it is taken.
    """
    area = table.table.area
    number = area.bottom + 1
    row = [Cell(area.sheet, number, column) for column in range(area.left, area.right + 1)]
    taken = [cell for cell in row if not workbook.content(cell).is_blank]
    taken += [cell for cell in row if any(cell in other.area for other in workbook.tables)]
    if table.table.totals_rows or taken:
        hint = "Add an empty row to the table in Excel, with the name in it"
        where = taken[0] if taken else Cell(area.sheet, area.bottom, area.left)
        raise DefinitionError(f"there is no free row below the table {table.table.name}", where=where, hint=hint)
    return number
