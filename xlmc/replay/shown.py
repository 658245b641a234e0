"""Compare all that a result workbook shows of a run with what the repeated run gives, and say what is left out."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import xlmc
from xlmc.replay.own_cells import compare_own_cells
from xlmc.replay.restored import entry
from xlmc.replay.sheets import SheetComparison, compare_sheets

if TYPE_CHECKING:
    from xlmc.record import Record
    from xlmc.replay.closeness import Closeness
    from xlmc.simulation import Simulation
    from xlmc.workbook import Workbook

__all__ = ["compare_shown"]


def compare_shown(
    workbook: Workbook, run: Simulation, record: Record, closeness: Closeness, *, same_run: bool
) -> SheetComparison:
    """Compare the result sheets, and the workbook's own cells that show results.

    Args:
        workbook: the file.
        run: the repeated run, told of as the recorded one.
        record: of the recorded one.
        closeness: how far numbers may be apart.
        same_run: the model is the recorded one, or gives the same trials; nothing is compared otherwise.
    """
    if not same_run:
        said = "the result sheets: the model is no longer the one that they were computed from"
        return SheetComparison(left_out=(said,))
    command = entry(record, "run.command")
    sheets = compare_sheets(workbook, run, None if command is None else str(command), closeness)
    own = compare_own_cells(workbook, run, closeness)
    found = SheetComparison(
        sheets.sheets,
        (*own.differences, *sheets.differences),
        sheets.missing,
        (*own.left_out, *sheets.left_out),
    )
    return _of_version(found, str(entry(record, "software.xlmc")))


def _of_version(found: SheetComparison, version: str) -> SheetComparison:
    """The comparison; where another version of xlmc wrote the sheets, what differs may be its way of writing."""
    if found.same or version == xlmc.__version__:
        return found
    count = len(found.differences)
    cells = f"{count:,} cell{'s' * (count != 1)} differ{'s' * (count == 1)}, {len(found.missing)} sheets are missing"
    said = (
        f"the result sheets were written by xlmc {version}, and this is {xlmc.__version__}, which may write them "
        f"otherwise ({cells}): compare their numbers with that version"
    )
    return replace(found, differences=(), missing=(), left_out=(*found.left_out, said))
