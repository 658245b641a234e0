"""Writes what the window shows: result workbook, page, JSON, saved run; a copy with the changes; the workbook itself.

Every result holds a record of how it can be repeated, from its workbook. A state that was changed in the window stands
in no workbook; so it is typed into a copy first, the copy is run, and the results are the copy's, with a record that
says what differs from the workbook, and how. They are written only where the numbers are those of the window.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from xlmc.analysis.results.saved import keep
from xlmc.analysis.studies.scenario_workbook import EditedWorkbook, edited_workbook, write_edited
from xlmc.errors import SimulationError
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.target import copy_ending, free_target, refuse_existing, refuse_into_source, unused_path
from xlmc.excel.workbook.writer import write_workbook
from xlmc.montecarlo.definitions.number_styles import in_style_of
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.model.loading import build_model
from xlmc.montecarlo.number_text import counted_text
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.montecarlo.simulation.simulation import ChangedFrom
from xlmc.outputs import save
from xlmc.outputs.json_document import save_json
from xlmc.outputs.live.adjusted_scenarios import scenario_of
from xlmc.outputs.live.adjustments import Adjustments
from xlmc.outputs.live.adjustments_in_words import in_words
from xlmc.outputs.page import page_text, save_page

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["KINDS", "AtRest", "edited_state", "page_of", "save_result", "write_changes"]

_NO_NAME: Final = re.compile(r"[^\w .,+()-]+")
_LONGEST: Final = 60
"""Characters of a scenario's name in the name of a file."""


class _Kind(NamedTuple):
    """The ending of its file, where that is not the workbook's own; and what writes it."""

    ending: str
    write: Callable[[RunResult, Path], Path]


KINDS: Final[Mapping[str, _Kind]] = {
    "book": _Kind("", lambda run, path: save(run, path)),
    "page": _Kind(".html", lambda run, path: save_page(run, path)),
    "json": _Kind(".json", lambda run, path: save_json(run, path)),
    "run": _Kind(".xlmcrun", lambda run, path: keep(run, path)),
}


@dataclass(frozen=True, slots=True)
class AtRest:
    """A state whose run is done.

    Attributes:
        own: the workbook's model.
        adjustments: what differs from it.
        name: of the scenario that it is; empty for none.
        run: its run.
        asked: trials and seed, where they are not those of the workbook.
    """

    own: CompiledModel
    adjustments: Adjustments
    name: str
    run: RunResult
    asked: RunOptions = field(default_factory=RunOptions)

    @property
    def changes(self) -> tuple[str, ...]:
        """Say what differs from the workbook."""
        return tuple(in_words(self.own.definitions, self.adjustments))


def save_result(state: AtRest, book: Path, what: str) -> Path:
    """Write one kind of result beside the workbook, under a name that is free or whose file is ours to replace.

    Args:
        state: the finished one.
        book: the workbook.
        what: a key of `KINDS`.

    Raises:
        WorkbookError: it cannot be written, or a change would have to replace a formula.
        DefinitionError: the workbook's tables have no column for a change.
        SimulationError: the changed copy gives other numbers than the window shows.
    """
    kind, run = KINDS[what], state.run if not state.adjustments else _run_of_copy(state)
    wanted = book.with_name(f"{book.stem}{_label(state)}-results{kind.ending or copy_ending(book)}")
    path, _ = free_target(wanted, run.model.workbook.name)
    return kind.write(run, path)


def _label(state: AtRest) -> str:
    """Return what tells files of a changed state from those of the workbook: `-dry road`, `-changed`."""
    if not state.adjustments:
        return ""
    return f"-{_NO_NAME.sub('_', state.name).strip(' .')[:_LONGEST].strip(' .') or 'changed'}"


def edited_state(own: CompiledModel, adjustments: Adjustments, name: str) -> EditedWorkbook:
    """Return a copy of the workbook with a state typed into it, not written yet.

    Raises:
        WorkbookError, DefinitionError: as for `save_result`.
    """
    return edited_workbook(own, scenario_of(own.definitions, name or "shown in the window", adjustments))


def page_of(state: AtRest) -> str:
    """Return the page of results of a state, as `save_result` writes it.

    Raises:
        WorkbookError, DefinitionError, SimulationError: as for `save_result`.
    """
    return page_text(state.run if not state.adjustments else _run_of_copy(state))


def _run_of_copy(state: AtRest) -> RunResult:
    """Run a copy of the workbook with the state typed into it."""
    edited, book = edited_state(state.own, state.adjustments, state.name), state.own.workbook
    run = run_model(build_model(read_workbook(edited.data, book.name, book.functions), state.own.path), state.asked)
    if not _is_same(run, state.run):
        message = "a copy of the workbook with these changes gives other numbers than the window shows"
        raise SimulationError(message, hint="Nothing was written; please report this")
    return replace(run, changed_from=ChangedFrom(book.name, book.sha256, state.changes))


def _is_same(first: RunResult, second: RunResult) -> bool:
    """Return whether two runs have the same accepted trials, to the last bit."""
    columns = [(run.trial_index, *run.inputs.values(), *run.forecasts.values()) for run in (first, second)]
    return len(columns[0]) == len(columns[1]) and all(
        mine.tobytes() == theirs.tobytes() for mine, theirs in zip(*columns, strict=True)
    )


@in_style_of("own.definitions.settings.number_style")
def write_changes(state: AtRest, book: Path, *, into: bool) -> str:
    """Type the state into a copy of the workbook, or into the workbook itself, of which a copy is kept then.

    Args:
        state: the finished one.
        book: the workbook.
        into: into the workbook itself.

    Returns:
        What was done, in words.

    Raises:
        TakenError: a program has the workbook open, or it has changed since it was read.
        WorkbookError: it is in another format, such as `.xls`, into which xlmc does not write; or as for
            `save_result`.
        DefinitionError: as for `save_result`.
    """
    edited = edited_state(state.own, state.adjustments, state.name)
    asked = "" if state.asked == RunOptions() else " Trials and seed are those of the workbook."
    if not edited.cells:
        raise SimulationError("nothing is changed", hint="move something first")
    if not into:
        path = write_edited(edited, unused_path(book.with_name(f"{book.stem}{_label(state)}{copy_ending(book)}")))
        return f"Written: {path}. {_summary(edited)}{asked}"
    refuse_into_source(book, edited.sha256, "wait until it was read again")
    copy_path = unused_path(book.with_name(f"{book.stem}-before{book.suffix}"))
    write_workbook(copy_path, state.own.workbook.data, lambda: refuse_existing(copy_path))
    write_edited(edited, book, overwrite=True)
    return f"Typed into {book.name}. {_summary(edited)}{asked} The workbook as it was: {copy_path.name}"


def _summary(edited: EditedWorkbook) -> str:
    """Say how many cells were typed into, and what Excel must still do."""
    count, computed = len(edited.cells), edited.computed
    cells = f"{counted_text(count, 'cell')} {'was' if count == 1 else 'were'} typed into"
    values = "has a new value" if computed == 1 else "have new values"
    formulas = f", {counted_text(computed, 'formula')} {values}" if computed else ""
    excel = "; Excel calculates the rest when it opens the file" if edited.calculates else ""
    sheets = "; its result sheets are those of the run before" if edited.has_results else ""
    return f"{cells}{formulas}{excel}{sheets}."
