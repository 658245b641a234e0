"""A row's name and its cell, each of which one row of a kind may have.

A row says which cell it is about by its own `Value`, by `Cell`, or by a defined name equal to its `Name`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import DefinedName, Workbook
from xlmc.montecarlo.definitions.cell_references import (
    cell_of_name,
    cell_of_reference,
    formula_at,
    is_address,
    refuse_name_of_other_sheet,
    split_sheet,
)
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.tables.table_rows import Row, as_text, required_text
from xlmc.montecarlo.distributions.spelling import name_key

__all__ = ["Claims", "cell_pointed_to", "identify"]


@dataclass(slots=True)
class Claims:
    """The names and cells that the rows read so far have taken; `kind` is what one row is called, `assumption`.

    Attributes:
        shared: whether several rows may be about one cell.
        names: key of a name -> the name, and where it stands.
        cells: cell -> the row that is about it.
        calls: call of a formula that a row stands for -> the name of the row, and its cell.
    """

    kind: str
    shared: bool = False
    names: dict[str, tuple[str, Cell]] = field(default_factory=dict)
    cells: dict[Cell, Cell] = field(default_factory=dict)
    calls: dict[Cell, tuple[str, Cell]] = field(default_factory=dict)

    def take_name(self, name: str, where: Cell) -> str:
        """Take the name for the row at `where`.

        Raises:
            DefinitionError: another row has it.
        """
        key = name_key(name)
        if key in self.names:
            message = f"Two rows define the {self.kind} {name!r}, this one and {self.names[key][1]}"
            hint = "Give each row its own name, or delete the table that came with a copied sheet"
            raise DefinitionError(message, where=where, hint=hint)
        self.names[key] = name, where
        return name

    def take_cell(self, cell: Cell, where: Cell) -> Cell:
        """Take the cell for the row at `where`.

        Raises:
            DefinitionError: another row has it.
        """
        if cell in self.cells and not self.shared:
            message = f"Two {self.kind} rows have the same cell {cell}, this one and {self.cells[cell]}"
            raise DefinitionError(message, where=where, hint="Keep one row for each cell")
        self.cells[cell] = where
        return cell

    def take_call(self, call: Cell, name: str, cell: Cell) -> None:
        """Take the call of a formula for a row that has its name and its cell.

        Raises:
            DefinitionError: another row stands for it.
        """
        if call in self.calls:
            message = f"two rows replace the call {call}, this one and that of {self.calls[call][1]}"
            raise DefinitionError(message, where=self.cells[cell], hint="Keep one of them")
        self.calls[call] = name, cell


def identify(row: Row, claims: Claims, findings: Findings) -> tuple[str, Cell] | None:
    """Return the row's name and cell, now taken; None, and a problem, where either is missing, wrong or taken."""
    name = findings.attempt(required_text, row, "Name")
    if name is None or findings.attempt(claims.take_name, name, row.cell("Name")) is None:
        return None
    cell = findings.attempt(_cell_of_row, row, name, findings)
    if cell is None or findings.attempt(claims.take_cell, cell, row.where) is None:
        return None
    return name, cell


def _cell_of_row(row: Row, name: str, findings: Findings) -> Cell:
    """Return the cell that the row is about.

    Args:
        row: the row.
        name: the row's name.
        findings: takes the notice that a reference written as text goes stale.

    Raises:
        DefinitionError: it says two cells, none, or one that cannot be used.
    """
    where = row.where
    if row.filled("Cell"):
        where = row.cell("Cell")
        if row.filled("Value"):
            hint = "Clear one of them: Value is itself the cell, Cell points to one elsewhere"
            raise DefinitionError("Both Value and Cell are filled in", where=where, hint=hint)
        cell = cell_pointed_to(row, "Cell", findings)
    elif row.filled("Value") or row.filled("Call"):
        cell = row.cell("Value")
    else:
        cell = _cell_by_name(row, name)
    _refuse_inside_merged(row.workbook, cell, where)
    return cell


def cell_pointed_to(row: Row, heading: str, findings: Findings) -> Cell:
    """Return the cell that a column of the row refers to; a notice says that a reference as a text goes stale.

    Raises:
        DefinitionError: it is no reference to one cell.
    """
    where, content = row.cell(heading), row.content(heading)
    if content.formula is not None:
        text = formula_at(content.formula, where)
        return cell_of_reference(row.workbook, text, where.sheet, where)
    if not isinstance(content.value, str):
        message = f"{heading} holds {as_text(content.value)}, which is not a reference"
        raise DefinitionError(message, where=where, hint="Write a formula that is one reference, such as =Inputs!B7")
    text = content.value.strip().removeprefix("=").strip()
    cell = _cell_of_text(row, text, where)
    message = (
        f"{heading} is the text {text!r}, which goes stale when rows move or names change; the formula ={cell} follows"
    )
    findings.notice(message, where, alike=f"text in {heading} of {row.table.table.name}")
    return cell


def _cell_of_text(row: Row, text: str, where: Cell) -> Cell:
    head, tail = split_sheet(text)
    if head is None and is_address(tail):
        message = f"{text!r} names no sheet, and may be a cell or a name"
        hint = f"Write the formula ={text.upper()}, or name the sheet, such as Inputs!{text.upper()}"
        raise DefinitionError(message, where=where, hint=hint)
    name = _name_in_sight(row.workbook, tail, where) if head is None else None
    if name is not None:
        return cell_of_name(row.workbook, name, where)
    return cell_of_reference(row.workbook, text, where.sheet, where)


def _cell_by_name(row: Row, name: str) -> Cell:
    defined_name = _name_in_sight(row.workbook, name, row.where)
    if defined_name is not None:
        return cell_of_name(row.workbook, defined_name, row.where)
    if row.has("Value") and not row.has("Cell"):
        return row.cell("Value")  # an input still to be filled in
    hint = "Fill in Value or Cell" if row.has("Value") else "Fill in Cell with a reference, such as =Inputs!B7"
    raise DefinitionError(
        f"Nothing says which cell {name!r} is: there is no defined name {name!r}", where=row.where, hint=hint
    )


def _name_in_sight(workbook: Workbook, name: str, where: Cell) -> DefinedName | None:
    """Return the defined name as a table on this sheet means it, if there is one.

    Raises:
        DefinitionError: the workbook's and the sheet's own differ, or only other sheets have one.
    """
    defined_names = [each for each in workbook.names if each.name.casefold() == name.strip().casefold()]
    here = [each for each in defined_names if each.sheet is None or each.sheet.casefold() == where.sheet.casefold()]
    if len({each.text.strip().removeprefix("=").casefold() for each in here}) > 1:
        message = f"{name!r} is a name of the workbook and another one of this sheet"
        raise DefinitionError(message, where=where, hint="Fill in Cell with the reference that is meant")
    if not here:
        refuse_name_of_other_sheet(workbook, name, where)
    return here[0] if here else None


def _refuse_inside_merged(workbook: Workbook, cell: Cell, where: Cell) -> None:
    for area in workbook.sheets[cell.sheet].merged:
        anchor = Cell(area.sheet, area.top, area.left)
        if cell in area and cell != anchor:
            message = f"{cell} lies inside the merged cells {area}, which only their first cell fills"
            raise DefinitionError(message, where=where, hint=f"Point to {anchor}")
