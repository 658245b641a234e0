"""Repeat the run that a result workbook or a saved run records, with the definitions that stand in the same file."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.record import Record, make_record, recorded_feeds, recorded_functions
from xlmc.analysis.results.record.needed_cells import needed_contents, recorded_cells
from xlmc.analysis.results.record.record_parts import read_record
from xlmc.analysis.results.record.settings_table import recorded_settings
from xlmc.analysis.results.saved import SUFFIX, is_saved_run, open_run
from xlmc.errors import WorkbookError, XlmcError
from xlmc.excel.workbook.lazy_sheets import naming_file
from xlmc.excel.workbook.reader import read_workbook
from xlmc.excel.workbook.seal import read_seal
from xlmc.montecarlo.definitions.number_styles import STYLES, in_style
from xlmc.montecarlo.definitions.run_options import KEPT_INPUTS, RunOptions
from xlmc.montecarlo.definitions.stopping import GOALS, AcceptedTrials
from xlmc.montecarlo.loop.version import __version__
from xlmc.montecarlo.model.loading import build_model, fed
from xlmc.montecarlo.simulation.simulate import run_model
from xlmc.outputs.replay.changes import (
    Change,
    Closeness,
    NumberChange,
    cell_changes,
    contents_now,
    definition_changes,
    environment_changes,
    is_emptied_text,
    is_rewritten_number,
    number_changes,
    structure_changes,
)
from xlmc.outputs.replay.sheets import SheetComparison
from xlmc.outputs.replay.shown_results import as_recorded, compare_shown
from xlmc.outputs.replay.versions import Rule, recorded_version, rules_since

if TYPE_CHECKING:
    from xlmc.excel.address import Cell
    from xlmc.excel.formula import ir
    from xlmc.excel.own_functions import OwnFunctions
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.definitions.feeds import Feed
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulate import OnProgress
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Replayed", "recorded_run", "replay"]

_NEEDED: Final = (
    "run.fingerprint",
    "file.name",
    "counts.trials",
    "counts.accepted",
    "counts.inputs_kept",
    "end.by",
)
"""Entries that the repeat, or the report on it, needs."""


@dataclass(frozen=True, slots=True)
class Replayed:
    """A recorded run and its repeat.

    Attributes:
        record: of the run.
        repeated: the run again, from the workbook as it is now; None if it cannot be run any more.
        fault: why it cannot be run.
        changes: what is not as the record has it: cells, names, tables, definitions.
        environment: the versions and the processor that differ.
        numbers: numbers of the record that the repeat did not give to the last bit.
        same_bits: the accepted trials are the same to the last bit.
        shown: the result sheets, and the workbook's own cells that show results, beside those of the repeat.
        version: the xlmc that made the run.
        rules: what this xlmc computes differently from that one, where the recorded cells hold something of it.
    """

    record: Record
    repeated: RunResult | None
    fault: XlmcError | None
    changes: tuple[Change, ...]
    environment: tuple[Change, ...]
    numbers: tuple[NumberChange, ...]
    same_bits: bool
    shown: SheetComparison = field(default_factory=SheetComparison)
    version: str = __version__
    rules: tuple[Rule, ...] = ()

    @property
    def of_this_version(self) -> bool:
        """Whether this xlmc made the run."""
        return self.version == __version__

    @property
    def to_the_last_bit(self) -> bool:
        """Whether nothing differs at all, except perhaps versions."""
        return self.same_bits and self.shown.same and not (self.changes or self.numbers or self.fault)

    @property
    def identical(self) -> bool:
        """Whether the run was repeated: to the last bit, or, with other software or another processor, to 1e-12."""
        if self.to_the_last_bit:
            return True
        close = self.shown.same and all(number.close for number in self.numbers)
        return close and bool(self.environment) and not (self.changes or self.fault or self.same_bits)


def replay(
    path: str | Path,
    *,
    books: Iterable[str | Path] = (),
    jobs: int = 1,
    progress: OnProgress | None = None,
    python: Mapping[Cell, ir.Expression] | None = None,
    functions: OwnFunctions | None = None,
) -> Replayed:
    """Repeat a recorded run, and compare it with its record.

    Args:
        path: a result workbook, or a saved run.
        books: workbooks that fed the run, where they do not lie beside the result workbook.
        jobs: threads or processes.
        progress: as for `Model.simulate`.
        python: the cells that a function of Python computes, each with the call; None for none.
        functions: those that the run's formulas called.

    Raises:
        WorkbookError: the file cannot be read, holds no record, or one by an xlmc that recorded less; or a workbook
            that fed the run is missing, or is not the one that did.
        XlmcError: the workbook cannot be run, though this xlmc made the run, and nothing that was recorded has
            changed.
    """
    path = Path(path)
    if path.suffix.casefold() == SUFFIX or is_saved_run(path):
        run = open_run(path, python, functions)
        with in_style(run.settings.number_style):
            return _replay(run.model.workbook, make_record(run), run.model, jobs, progress)
    with naming_file(str(path)):
        workbook = read_workbook(path)
        record = read_record(workbook)
        workbook = replace(workbook, functions=recorded_functions(record, functions, path))
        model = build_model(workbook, path, python=python) if python else None
        with in_style(_style_of(record)):  # of the texts that are compared
            return _replay(workbook, record, model, jobs, progress, path, _fed_by(record, path, books))


def _style_of(record: Record) -> str:
    """Return the number style of a recorded run; empty where it has none of those that there are."""
    entries = record.section("settings").entries if "settings" in record else ()
    result = {entry.key: entry.value for entry in entries}.get("number_style")
    return str(result) if result in STYLES else ""


def _fed_by(record: Record, path: Path, books: Iterable[str | Path]) -> tuple[Feed, ...]:
    """Return the feeds of a recorded run, with the files that fed it.

    Raises:
        WorkbookError: one is missing, or is not the one that did.
    """
    given = {Path(each).name.casefold(): Path(each) for each in books}
    feeds = []
    for feed, sha256 in recorded_feeds(record):
        file = given.get(feed.file.casefold(), path.with_name(feed.file))
        if not file.is_file():
            message = f"the workbook {feed.file!r}, which fed the run, is not beside it"
            raise WorkbookError(message, where=path, hint=f"put it there, or name it: --book FOLDER/{feed.file}")
        if hashlib.sha256(file.read_bytes()).hexdigest() != sha256:
            message = f"{feed.file} is not the workbook that fed the run: its SHA-256 is not {sha256}"
            raise WorkbookError(message, where=file, hint=f"find that file, and name it: --book FOLDER/{feed.file}")
        feeds.append(replace(feed, source=str(file)))
    return tuple(feeds)


def recorded_run(
    path: str | Path, *, progress: OnProgress | None = None, functions: OwnFunctions | None = None
) -> RunResult:
    """Repeat the run that a result workbook records: under the name and with the SHA-256 of its workbook.

    Args:
        path: a result workbook.
        progress: as for `Model.simulate`.
        functions: those that the run's formulas called.

    Raises:
        WorkbookError: the file cannot be read, holds no record, or the repeated run differs from the recorded one.
        XlmcError: as for `replay`.
    """
    result = replay(path, progress=progress, functions=functions)
    if result.repeated is None or not result.identical:
        hint = f"xlmc replay {Path(path).name} says what differs"
        raise WorkbookError("the run that is recorded here cannot be repeated as it was", where=path, hint=hint)
    run = as_recorded(result.repeated, result.record, recorded_settings(result.record))
    run.model.workbook = replace(run.model.workbook, sha256=str(result.record["file.sha256"]))
    return run


def _replay(
    workbook: Workbook,
    record: Record,
    model: CompiledModel | None,
    jobs: int,
    progress: OnProgress | None,
    path: Path | None = None,
    feeds: Sequence[Feed] = (),
) -> Replayed:
    cells, settings = _read_recorded(record, path)
    version = recorded_version(record)
    rules = rules_since(version, cells.values())
    _refuse_incomplete(record, settings, version, path)
    try:
        model = model or fed(build_model(workbook, path or Path(workbook.name)), feeds)
        repeated = _repeat(model, record, settings, jobs, progress)
    except XlmcError as fault:
        changes = tuple(cell_changes(cells, contents_now(workbook, cells)))
        if not changes and version == __version__:
            raise
        return Replayed(record, None, fault, changes, (), (), same_bits=False, version=version, rules=rules)
    result = make_record(repeated)
    same_bits = record["run.fingerprint"] == result["run.fingerprint"]
    try:
        numbers = number_changes(record, result)
        of_the_model = (*structure_changes(record, result), *definition_changes(record, result))
        environment = tuple(environment_changes(record, result))
    except KeyError as error:
        raise _lacking_error(repr(error.args[0]), version, path) from error
    changes = (*cell_changes(cells, contents_now(workbook, cells) | needed_contents(model)), *of_the_model)
    shown = SheetComparison()
    if path is not None:
        rewritten = not _is_untouched(path)
        if same_bits and rewritten:
            changes = tuple(change for change in changes if not is_emptied_text(change))
        reported = tuple(change for change in changes if not (same_bits and rewritten and is_rewritten_number(change)))
        # Numbers with fewer digits beside the model move the last digits of what is computed from the base case.
        closeness = Closeness(rewritten=rewritten, elsewhere=bool(environment) or len(reported) < len(changes))
        changes, same_run = reported, same_bits or not reported
        shown = compare_shown(workbook, as_recorded(repeated, record, settings), record, closeness, same_run=same_run)
    return Replayed(
        record=record,
        repeated=repeated,
        fault=None,
        changes=changes,
        environment=environment,
        # Some programs write 15 or 16 digits of a number: where the trials are the same, the record has lost the last.
        numbers=tuple(number for number in numbers if not (same_bits and number.close)),
        same_bits=same_bits,
        shown=shown,
        version=version,
        rules=rules,
    )


def _is_untouched(path: Path) -> bool:
    """Whether a result workbook is as xlmc wrote it; False if that cannot be decided."""
    seal = read_seal(path)
    return seal is not None and seal.whole


def _read_recorded(record: Record, path: Path | None) -> tuple[dict[Cell, str], Settings]:
    """Return the cells and the settings of the record.

    Raises:
        WorkbookError: an older xlmc wrote it, which recorded neither, or it was edited.
    """
    try:
        return recorded_cells(record), recorded_settings(record)
    except KeyError as error:
        message = f"the record lacks {error.args[0]!r}: an older xlmc wrote it, which did not record the cells"
        command = _repeat_command(record)
        hint = f"Repeat it by hand, and compare: {command}" if command else "Run the workbook again"
        raise WorkbookError(message, where=path, hint=hint) from error


def _refuse_incomplete(record: Record, settings: Settings, version: str, path: Path | None) -> None:
    """Refuse a record without an entry that the repeat or what is said of it needs; the goal of the run is one.

    Raises:
        WorkbookError: it lacks one.
    """
    for key in _NEEDED:
        try:
            record[key]
        except KeyError as error:
            raise _lacking_error(repr(key), version, path) from error
    by = str(record["end.by"])
    reached = GOALS.get(AcceptedTrials.key if by == "search" else by)
    if reached is not None and not isinstance(settings.stopping.goal, reached):
        raise _lacking_error(repr(f"settings.{reached.labels[0][0]}"), version, path)
    words = next((entry.value for entry in record.section("end").entries if entry.key == "goal"), None)
    if words and not settings.stopping.has_goal:
        raise _lacking_error(f"the setting that asked for its goal, {words}", version, path)


def _lacking_error(what: str, version: str, path: Path | None) -> WorkbookError:
    edited = "It was edited" if version in ("", __version__) else f"xlmc {version} made it"
    return WorkbookError(f"the record lacks {what}", where=path, hint=f"{edited}: run the workbook again")


def _repeat_command(record: Record) -> str:
    try:
        return str(record["run.repeat"])
    except KeyError:
        return ""


def _repeat(
    model: CompiledModel, record: Record, settings: Settings, jobs: int, progress: OnProgress | None
) -> RunResult:
    """Run again: up to the trial that ended the recorded run, whatever did."""
    trials, accepted, stored = (_count(record, key) for key in ("trials", "accepted", "inputs_kept"))
    by = str(record["end.by"])
    options = RunOptions.repeating(settings, trials=trials, by=by, weighable=bool(model.chances))
    keep_inputs = stored if stored < accepted else max(stored, KEPT_INPUTS)
    return run_model(model, replace(options, jobs=jobs, keep_inputs=keep_inputs), progress=progress)


def _count(record: Record, key: str) -> int:
    value = record[f"counts.{key}"]
    if not isinstance(value, int | float) or value != int(value) or value < 0:
        raise WorkbookError(f"the record counts {value!r} {key}", hint="The record was edited")
    return int(value)
