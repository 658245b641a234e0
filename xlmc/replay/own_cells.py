"""Compare the workbook's own cells that show results, such as `=RiskMean(B9)`, with what the repeated run gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.address import Cell
from xlmc.errors import ErrorCode
from xlmc.replay.closeness import Closeness
from xlmc.replay.sheets import CellDifference, SheetComparison
from xlmc.run.result_cells import result_values
from xlmc.workbook.model import CellContent

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation
    from xlmc.workbook.model import Workbook

__all__ = ["compare_own_cells"]

_BLANK: Final = CellContent()


def compare_own_cells(workbook: Workbook, run: Simulation, closeness: Closeness) -> SheetComparison:
    """Compare the cells that show results, and those that depend on them.

    A program without the add-in shows `#NAME?` in cells that call its functions, and computes what depends on them from
    that: neither tells anything of the file.

    Args:
        workbook: the file.
        run: the repeated run.
        closeness: how far numbers may be apart.
    """
    values = result_values(run)
    found = {cell: workbook.content(cell) for cell in sorted(values)}
    empty = [cell for cell, content in found.items() if _is_uncomputed(content)]
    if empty:
        asking = set(run.model.definitions.results) | set(run.model.definitions.unavailable)
        found = {cell: content for cell, content in found.items() if cell in asking and cell not in empty}
    differences = (
        CellDifference(cell, content.value, values[cell])
        for cell, content in found.items()
        if not closeness.equal(content.value, values[cell], computed=True)
    )
    return SheetComparison(differences=tuple(differences), left_out=_said(len(values) - len(found), empty))


def _is_uncomputed(content: CellContent) -> bool:
    return content.formula is not None and content.value in (None, ErrorCode.NAME)


def _said(count: int, empty: list[Cell]) -> tuple[str, ...]:
    if not empty:
        return ()
    cells = "1 cell that shows" if count == 1 else f"{count:,} cells that show"
    return (f"{cells} results of the run: a program without the add-in saved them ({empty[0]})",)
