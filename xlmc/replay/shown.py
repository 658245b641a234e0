"""Compare all that a result workbook shows of a run with what the repeated run gives, and say what is left out."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from xlmc.replay.closeness import is_number
from xlmc.replay.own_cells import compare_own_cells
from xlmc.replay.restored import entry
from xlmc.replay.sheets import SheetComparison, compare_sheets
from xlmc.replay.versions import recorded_version
from xlmc.run.version import __version__

if TYPE_CHECKING:
    from xlmc.replay.closeness import Closeness
    from xlmc.results.record import Record
    from xlmc.run.simulation import Simulation
    from xlmc.workbook.model import Workbook

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
    return _of_version(found, recorded_version(record))


def _of_version(found: SheetComparison, version: str) -> SheetComparison:
    """The comparison; of sheets that another version of xlmc laid out otherwise, the numbers cannot be compared."""
    if found.same or version == __version__:
        return found
    laid_out = {each.where.sheet for each in found.differences if not (is_number(each.says) and is_number(each.gives))}
    otherwise = dict.fromkeys((*found.missing, *(each.where.sheet for each in found.differences)))
    wrote = f"xlmc {version} wrote" if version else "another xlmc wrote"
    said = tuple(
        f"the sheet {sheet}, which {wrote} otherwise than {__version__} does"
        for sheet in otherwise
        if sheet in laid_out or sheet in found.missing
    )
    differences = tuple(each for each in found.differences if each.where.sheet not in laid_out)
    return replace(found, differences=differences, missing=(), left_out=(*found.left_out, *said))
