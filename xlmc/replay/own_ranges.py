"""What the formulas of a result sheet give where somebody has typed a range of their own beside them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from xlmc.address import Cell
from xlmc.evaluation.graph.lower import Lowering
from xlmc.formula import Resolver, build_graph
from xlmc.workbook.model import CellContent

if TYPE_CHECKING:
    from xlmc.workbook.model import Sheet, Workbook

__all__ = ["counted"]

_Place = tuple[int, int]
_BLANK: Final = CellContent()


def counted(
    built: Workbook, sheet: Sheet, typed: Mapping[_Place, CellContent], rows: Collection[int]
) -> dict[_Place, CellContent]:
    """The formulas of these rows, with their values computed anew.

    Args:
        built: the result sheets of the run.
        sheet: the one among them with the formulas.
        typed: what the file holds in the cells that a person may fill in.
        rows: that are looked at.
    """
    filled = replace(sheet, cells={**sheet.cells, **typed})
    workbook = replace(built, sheets={**built.sheets, sheet.name: filled})
    places = [place for place, content in sheet.cells.items() if content.formula is not None and place[0] in rows]
    cells = {place: Cell(sheet.name, *place) for place in places}
    lowering = Lowering(build_graph(Resolver(workbook), [*cells.values()], frozenset()), {}, {})
    found = {}
    for place, cell in cells.items():
        value = lowering.value(cell)
        assert value is not None  # nothing that it reads is drawn
        found[place] = replace(sheet.cells[place], value=value.objects().ravel()[0])
    return found
