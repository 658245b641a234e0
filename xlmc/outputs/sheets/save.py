"""Write a run's result sheets into a copy of its workbook, or into the workbook itself."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from xlmc.analysis.studies.scenario_answers import scenario_answers
from xlmc.errors import SimulationError, WorkbookError
from xlmc.excel.workbook.inject import inject
from xlmc.excel.workbook.injection.host import result_sheets
from xlmc.excel.workbook.package_check import checked_bytes
from xlmc.excel.workbook.seal import sealed_parts
from xlmc.excel.workbook.target import (
    Target,
    is_same_file,
    refuse_into_source,
    refuse_other_copy,
    refuse_read,
)
from xlmc.excel.workbook.writer import QUICK, write_workbook
from xlmc.montecarlo.diagnostics.result_cells import filled_sheets
from xlmc.outputs.sheets.book import ResultSheet, build_sheets
from xlmc.outputs.sheets.trials_sheet import TRIAL_ROWS

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["check_ending", "save"]


def save(
    simulation: RunResult,
    path: Path,
    *,
    command: str | None = None,
    rows: int = TRIAL_ROWS,
    overwrite: bool = False,
    further: Mapping[str, ResultSheet] | None = None,
) -> Path:
    """Write the workbook with result sheets behind its own; those of an earlier run are replaced.

    Cells that show results of a run, such as `RiskMean(B9)`, show this one's.

    Args:
        simulation: the finished run.
        path: where to; an untouched result of the same workbook is replaced.
        command: what the person typed, for the record.
        rows: the most accepted trials to write out.
        overwrite: replace any other file too, and write into the workbook itself where the path is its own.
        further: the sheets of the sections that have none of their own, by the names of the sections.

    Returns:
        The path.

    Raises:
        TakenError: the file is not ours to replace, is open in a program, or is the workbook itself and has changed
            since it was read.
        WorkbookError: the file cannot be written, or has another ending than the workbook.
        SimulationError: the run is of a scenario, which no file holds.
        DefinitionError: the workbook's table `xlmc_case` is not what it must be.
    """
    book = simulation.model.workbook
    if not book.parts:
        hint = "Type the scenario into a workbook first (xlmc scenario, or save_scenario in Python), and run that"
        raise SimulationError("no file holds the workbook of this run", hint=hint)
    check = partial(_check, simulation, path, overwrite=overwrite)
    check_ending(path, simulation.model.path)
    check()
    scenario_answers(simulation)  # cells may ask about them
    sheets = build_sheets(simulation, command=command, rows=rows, further=further)
    own = {**book.parts, **filled_sheets(book, simulation.shown_results)}
    parts = inject(own, sheets)
    if not _is_source(simulation, path):  # the person's own file, which is never ours to replace
        parts = sealed_parts(parts, result_sheets(parts)[-1], simulation.model.workbook.name)
    write_workbook(path, checked_bytes(parts, book.parts, QUICK), check)
    return path


def check_ending(path: Path, source: Path) -> None:
    """Refuse an ending that is not the workbook's, and results of a workbook without an ending.

    Raises:
        WorkbookError: the ending is another, there is none, or the path leads to a folder.
    """
    if not source.suffix:
        hint = f"Rename it, such as {source.name.strip('.') + '.xlsx'!r}: Excel opens no result without an ending"
        raise WorkbookError("the name of the workbook has no ending", where=source, hint=hint)
    refuse_other_copy(path, source, "results")


def _check(simulation: RunResult, path: Path, *, overwrite: bool) -> None:
    """Refuse to replace somebody's file, or the workbook itself where it has changed since it was read."""
    if overwrite and _is_source(simulation, path):
        refuse_into_source(path, simulation.model.workbook.sha256, "Run again, or write to another file")
        return
    hint = "Name another file, or write the result sheets into it with --in-place (in Python: overwrite=True)"
    refuse_read(path, simulation.model.files, hint)
    Target(path, simulation.model.workbook.name, overwrite).check()


def _is_source(simulation: RunResult, path: Path) -> bool:
    return is_same_file(path, simulation.model.path)
