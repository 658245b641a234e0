"""A row's name and its cell, each of which one row of a kind may have."""

from __future__ import annotations

from dataclasses import dataclass, field

from xlmc.address import Cell
from xlmc.definitions.findings import Findings
from xlmc.definitions.model import name_key
from xlmc.definitions.tables.cell_reference import cell_of_row
from xlmc.definitions.tables.fields import required_text
from xlmc.definitions.tables.tables import Row
from xlmc.errors import DefinitionError

__all__ = ["Claims", "identify"]


@dataclass(slots=True)
class Claims:
    """The names and cells that the rows read so far have taken; `kind` is what one row is called, `assumption`."""

    kind: str
    names: dict[str, tuple[str, Cell]] = field(default_factory=dict)
    cells: dict[Cell, Cell] = field(default_factory=dict)

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
        if cell in self.cells:
            message = f"Two {self.kind} rows have the same cell {cell}, this one and {self.cells[cell]}"
            raise DefinitionError(message, where=where, hint="Keep one row for each cell")
        self.cells[cell] = where
        return cell


def identify(row: Row, claims: Claims, findings: Findings) -> tuple[str, Cell] | None:
    """The row's name and cell, now taken; None, and a problem, where either is missing, wrong or taken."""
    name = findings.attempt(required_text, row, "Name")
    if name is None or findings.attempt(claims.take_name, name, row.cell("Name")) is None:
        return None
    cell = findings.attempt(cell_of_row, row, name, findings)
    if cell is None or findings.attempt(claims.take_cell, cell, row.where) is None:
        return None
    return name, cell
