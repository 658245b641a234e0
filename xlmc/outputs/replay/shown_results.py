"""Compare all that a result workbook shows of a run with what the repeated run gives, and say what is left out."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record import changed_from_of
from xlmc.analysis.studies.scenario_answers import scenario_answers
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.excel.workbook.workbook import CellContent
from xlmc.montecarlo.loop.stopping.stopped import Stopped
from xlmc.montecarlo.loop.version import __version__
from xlmc.montecarlo.number_text import count_text
from xlmc.outputs.replay.changes import Closeness, is_number
from xlmc.outputs.replay.sheets import CellDifference, SheetComparison, compare_sheets
from xlmc.outputs.replay.versions import recorded_version

if TYPE_CHECKING:
    from xlmc.analysis.results.record import Record, Value
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["as_recorded", "compare_shown"]

_BLANK: Final = CellContent()


def compare_shown(
    workbook: Workbook, run: RunResult, record: Record, closeness: Closeness, *, same_run: bool
) -> SheetComparison:
    """Compare the result sheets, and the workbook's own cells that show results.

    Args:
        workbook: the file.
        run: the repeated run, with the name, the settings and the ending of the recorded one.
        record: of the recorded one.
        closeness: how far numbers may be apart.
        same_run: the model is the recorded one, or gives the same trials; nothing is compared otherwise.
    """
    if not same_run:
        reason = "the result sheets: the model is no longer the one that they were computed from"
        return SheetComparison(left_out=(reason,))
    scenario_answers(run)  # cells may ask about them
    command = _entry(record, "run.command")
    sheets = compare_sheets(workbook, run, None if command is None else str(command), closeness)
    own = _compare_own_cells(workbook, run, closeness)
    comparison = SheetComparison(
        sheets.sheets,
        (*own.differences, *sheets.differences),
        sheets.missing,
        (*own.left_out, *sheets.left_out),
    )
    return _of_version(comparison, recorded_version(record))


def _of_version(comparison: SheetComparison, version: str) -> SheetComparison:
    """Return the comparison without the sheets that another version of xlmc laid out differently: these cannot be
    compared.
    """
    if comparison.same or version == __version__:
        return comparison
    laid_out = {
        each.where.sheet for each in comparison.differences if not (is_number(each.says) and is_number(each.gives))
    }
    otherwise = dict.fromkeys((*comparison.missing, *(each.where.sheet for each in comparison.differences)))
    wrote = f"xlmc {version} wrote" if version else "another xlmc wrote"
    reason = tuple(
        f"the sheet {sheet}, which {wrote} differently from {__version__}"
        for sheet in otherwise
        if sheet in laid_out or sheet in comparison.missing
    )
    differences = tuple(each for each in comparison.differences if each.where.sheet not in laid_out)
    return replace(comparison, differences=differences, missing=(), left_out=(*comparison.left_out, *reason))


def _compare_own_cells(workbook: Workbook, run: RunResult, closeness: Closeness) -> SheetComparison:
    """Compare the cells that show results, and those that depend on them.

    A program without the add-in shows `#NAME?` in cells that call its functions, and computes from that what depends on
    them: neither says anything about the run.

    Args:
        workbook: the file.
        run: the repeated run.
        closeness: how far numbers may be apart.
    """
    values = run.shown_results.cells
    result = {cell: workbook.content(cell) for cell in sorted(values)}
    empty = [cell for cell, content in result.items() if _is_uncomputed(content)]
    if empty:
        asking = set(run.model.definitions.results) | set(run.model.definitions.unavailable)
        result = {cell: content for cell, content in result.items() if cell in asking and cell not in empty}
    differences = (
        CellDifference(cell, content.value, values[cell])
        for cell, content in result.items()
        if not closeness.equal(content.value, values[cell], computed=True)
    )
    return SheetComparison(differences=tuple(differences), left_out=_left_out_text(len(values) - len(result), empty))


def _is_uncomputed(content: CellContent) -> bool:
    return content.formula is not None and content.value in (None, ErrorCode.NAME)


def _left_out_text(count: int, empty: list[Cell]) -> tuple[str, ...]:
    if not empty:
        return ()
    cells = "1 cell that shows" if count == 1 else f"{count_text(count)} cells that show"
    return (f"{cells} results of the run: a program without the add-in saved them ({empty[0]})",)


def as_recorded(run: RunResult, record: Record, settings: Settings) -> RunResult:
    """Return the run under the name of the recorded one's workbook, with its settings, ended by what ended that.

    Args:
        run: the repeated run, which ended because it came to the number of trials.
        record: of the recorded one.
        settings: of the recorded one.
    """
    return replace(
        run,
        model=_rename(run.model, str(record["file.name"])),
        settings=settings,
        stopped=_recorded_end(record),
        changed_from=changed_from_of(record),
    )


def _entry(record: Record, key: str) -> Value:
    """Return an entry of the record; None if it has no such entry."""
    try:
        return record[key]
    except KeyError:
        return None


def _rename(model: CompiledModel, name: str) -> CompiledModel:
    result = copy.copy(model)
    result.workbook = replace(model.workbook, name=name)
    own = (str(model.path), model.workbook.name)
    result.notices = tuple(
        replace(notice, where=name) if str(notice.where) in own else notice for notice in model.notices
    )
    return result


def _recorded_end(record: Record) -> Stopped:
    by, sentence, goal = (_entry(record, f"end.{key}") for key in ("by", "in_words", "goal"))
    reason = str(sentence or "")
    stopped = Stopped(str(by), reason, None if goal is None else str(goal))
    return stopped if stopped.reached else replace(stopped, because=reason.removesuffix(f" before {goal}"))
