"""Write a run's result sheets into a copy of its workbook, or into the workbook itself."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

from xlmc.errors import WorkbookError
from xlmc.report.book import build_sheets
from xlmc.report.trials import TRIAL_ROWS
from xlmc.result_cells import filled_sheets
from xlmc.workbook.inject import inject
from xlmc.workbook.writer import check_folder, package_bytes, refuse_if_open, write_workbook

if TYPE_CHECKING:
    from xlmc.simulation import Simulation

__all__ = ["check_book_path", "save"]


def save(simulation: Simulation, path: Path, *, command: str | None = None, rows: int = TRIAL_ROWS) -> Path:
    """Write the workbook with result sheets behind its own; those of an earlier run are replaced.

    Cells that show results of a run, such as `RiskMean(B9)`, show this one's.

    Args:
        simulation: the finished run.
        path: where to; an existing file is replaced.
        command: what the person typed, for the record.
        rows: the most accepted trials to write out.

    Returns:
        The path.

    Raises:
        WorkbookError: the file cannot be written, is open in a program, has another ending than the workbook, or is
            the workbook itself and has changed since it was read.
    """
    _check_ending(path, simulation.model.path)
    refuse_if_open(path)
    _refuse_changed(simulation, path)
    sheets = build_sheets(simulation, command=command, rows=rows)
    parts = {**simulation.model.workbook.parts, **filled_sheets(simulation)}
    write_workbook(path, package_bytes(inject(parts, sheets)))
    return path


def check_book_path(path: Path, source: Path) -> None:
    """Refuse, before a run, what its result workbook could not be written to after it.

    Args:
        path: where to.
        source: the workbook.

    Raises:
        WorkbookError: the file has another ending than the workbook, no folder to go to, may not be written, or is open
            in a program.
    """
    _check_ending(path, source)
    check_folder(path)
    refuse_if_open(path)


def _check_ending(path: Path, source: Path) -> None:
    # Excel opens no file whose ending says that it has macros when it has none, or the other way round.
    if path.suffix.casefold() != source.suffix.casefold():
        hint = f"Name it {path.with_suffix(source.suffix).name!r}"
        raise WorkbookError(f"results of a {source.suffix} workbook must end in {source.suffix}", where=path, hint=hint)


def _refuse_changed(simulation: Simulation, path: Path) -> None:
    """Refuse to write the workbook as it was read over one that a person has changed meanwhile."""
    source = simulation.model.path
    if not (path.exists() and source.exists() and path.samefile(source)):
        return
    if hashlib.sha256(path.read_bytes()).hexdigest() != simulation.model.workbook.sha256:
        hint = "Run again, or write to another file"
        raise WorkbookError("the workbook has changed since it was read", where=path, hint=hint)
