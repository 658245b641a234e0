"""Make the record of a finished run."""

from __future__ import annotations

import hashlib
import re
import shlex
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.record.definition_tables import (
    assumption_section,
    check_section,
    correlation_section,
    decision_section,
    evidence_section,
    filter_section,
    forecast_filter_section,
    forecast_section,
    solve_section,
)
from xlmc.analysis.results.record.errors_met import errors_met
from xlmc.analysis.results.record.needed_cells import cell_section, needed_contents, structure_section
from xlmc.analysis.results.record.record_parts import Entry, Record, RecordTable, Section
from xlmc.analysis.results.record.settings_table import settings_section
from xlmc.analysis.results.statements.run_in_words import errors_text, generator_text, method_text
from xlmc.excel.own_functions import OwnFunctions, the_same_functions
from xlmc.excel.workbook.inject import original_hash
from xlmc.montecarlo.columns import holds_nan, parts
from xlmc.montecarlo.definitions.feeds import Feed
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.interruption import checkpoint
from xlmc.montecarlo.simulation.simulation import KEPT_INPUTS, ChangedFrom

if TYPE_CHECKING:
    from xlmc.montecarlo.rare.account import RareAccount
    from xlmc.montecarlo.simulation.simulation import RunResult
import platform
from importlib.metadata import version

from xlmc.engine.engines import ENGINES
from xlmc.montecarlo.statistics.estimate import finite

__all__ = [
    "LIBRARIES",
    "fingerprint",
    "make_record",
    "processor",
    "quoted_argument",
    "recorded_feeds",
    "recorded_functions",
    "repeat_command",
    "simulate_command",
    "versions",
]

LIBRARIES = ("numpy", "scipy", "formulas", "XlsxWriter", "openpyxl")


def versions(engine: str = "numpy") -> dict[str, str]:
    """Name -> version of xlmc, of Python and of the libraries a result depends on, those of its engine among them."""
    from xlmc.montecarlo.loop.version import __version__

    own = {"xlmc": __version__, "python": platform.python_version()}
    return own | {name: _installed(name) for name in (*LIBRARIES, *filter(None, [ENGINES[engine].library]))}


@cache
def _installed(library: str) -> str:
    """Return the version of a library, which is read from files only once in a process."""
    return version(library)


def processor() -> dict[str, str]:
    """Return the kind of machine and the vector instructions NumPy found: its sine may differ between them in the last
    bit.
    """
    import numpy

    result: dict[str, list[str]] = numpy.show_config(mode="dicts")["SIMD Extensions"]  # type: ignore[assignment]
    features = [*result.get("baseline", []), *result.get("found", [])]
    return {
        "machine": platform.machine(),
        "system": platform.system(),
        "vector_instructions": " ".join(features) or "none",
    }


CHANGED_FROM: Final = "changed"
"""Key of the section on the workbook that the run's own was made of."""

FEEDS: Final = "feeds"
"""Key of the section on the workbooks that fed the run."""

FUNCTIONS: Final = "functions"
"""Key of the section on the file of a person's own functions."""

_FEED_COLUMNS: Final = (
    ("assumption", "Assumption"),
    ("book", "Of"),
    ("answer", "Takes"),
    ("file", "Of the workbook"),
    ("sha256", "SHA-256 of its file"),
)

_FORMAT: Final = 2
"""The format of the record: from 2 on it holds the settings and the cells that a run can be repeated and checked by."""

_SHARES = {
    "trials": "accepted trials divided by all trials; its 95 % interval is by Wilson's formula",
    "accepted": "(N − 1)/(n − 1) for n trials until the N-th was accepted; its 95 % interval is exact",
}
"""How the share of accepted trials is estimated, by what ended the run."""

_RARE_SHARE = "the mean weight of the trials drawn where accepted ones lie; its 95 % interval is that of its logarithm"
_CONVENTIONS = (
    ("percentiles", "Percentiles", "linear between trials, as Excel's PERCENTILE.INC"),
    ("central_range", "Central range", "as many trials lie below it as above it; it is not the shortest such range"),
    ("kurtosis", "Kurtosis", "3 for the normal distribution"),
    ("mode", "Mode", "the half-sample mode (within the densest half, again and again); of counts the most frequent"),
    ("errors", "Standard errors (±)", "Monte Carlo error alone"),
    ("shares", "Intervals of shares", "95 %, by Wilson's formula; longer where a share rests on a few trials"),
    ("trial_numbers", "Trial numbers", "counted from 0"),
    ("logicals", "Logicals", "TRUE counts as 1, FALSE as 0"),
)
_LABELS = {
    "python": "Python",
    "numpy": "NumPy",
    "scipy": "SciPy",
    "machine": "Machine",
    "system": "System",
    "vector_instructions": "Vector instructions",
}
_PLAIN = re.compile(r"[\w.,:+@%/=-]+")
_SAFE_IN_DOUBLE_QUOTES = re.compile(r'[^"\\$`!%\n]+')


def make_record(simulation: RunResult, command: str | None = None) -> Record:
    """Make the record of a run; the same run on the same machine has the same record.

    Args:
        simulation: the finished run.
        command: what the person typed; None for a run from Python.
    """
    contents = needed_contents(simulation.model)
    software, machine = _environment(simulation)
    return Record(
        (
            _run(simulation, command),
            _file(simulation),
            *([] if simulation.changed_from is None else [_changed_from(simulation.changed_from)]),
            *_feeds(simulation),
            *_functions(simulation),
            _counts(simulation),
            _end(simulation),
            _sampling(simulation),
            settings_section(simulation),
            *([] if simulation.rare is None else [_rare(simulation.rare)]),
            forecast_section(simulation),
            filter_section(simulation),
            *([forecast_filter_section(simulation)] if simulation.model.forecast_filters else []),
            *([evidence_section(simulation)] if simulation.model.evidence else []),
            *([check_section(simulation)] if simulation.checks else []),
            *([decision_section(simulation)] if simulation.model.definitions.decisions else []),
            *([solve_section(simulation)] if simulation.model.definitions.solves else []),
            assumption_section(simulation),
            correlation_section(simulation),
            _messages("warnings", "Warnings", simulation.warnings),
            _messages("notices", "Notices", [str(notice) for notice in simulation.notices]),
            _errors(simulation),
            _conventions(simulation),
            Section("software", "Software", _entries(software)),
            Section("processor", "Processor", _entries(machine)),
            structure_section(simulation.model, contents.values()),
            cell_section(contents),
        )
    )


def _environment(simulation: RunResult) -> tuple[Mapping[str, str], Mapping[str, str]]:
    """Return the software and the processor of the run: those it was saved with, or those here."""
    origin = simulation.origin
    if origin is not None:
        return origin.software, origin.processor
    return versions(simulation.settings.engine), processor()


def _run(simulation: RunResult, command: str | None) -> Section:
    given = () if command is None else (Entry("command", "Command that was given", command),)
    entries = (
        Entry("repeat", "Command that repeats it", repeat_command(simulation)),
        *given,
        Entry("fingerprint", "SHA-256 of the accepted trials", _known_fingerprint(simulation)),
        Entry("format", "Format of this record", _FORMAT),
    )
    return Section("run", "This run", entries)


def _file(simulation: RunResult) -> Section:
    book = simulation.model.workbook
    entries = (
        Entry("name", "Name", book.name),
        Entry("sha256", "SHA-256 of the file", book.sha256 or None),
        # Result sheets do not change this one, so a result workbook can be checked against the book it came from.
        Entry(
            "original_sha256",
            "SHA-256 of the file without result sheets",
            original_hash(book.parts) if book.parts else None,
        ),
    )
    return Section("file", "Workbook", entries)


def _changed_from(result: ChangedFrom) -> Section:
    """Say what the workbook of the run differs in from the one that it was made of."""
    entries = (
        Entry("name", "Workbook that was changed", result.name),
        Entry("sha256", "SHA-256 of its file", result.sha256),
    )
    rows = tuple((change,) for change in result.changes)
    return Section(CHANGED_FROM, "Changed from that workbook", entries, RecordTable((("change", "Change"),), rows))


def changed_from_of(record: Record) -> ChangedFrom | None:
    """Return what the run of a record says of the workbook that its own was made of; None if it says nothing."""
    if CHANGED_FROM not in record:
        return None
    changes = tuple(str(row["change"]) for row in record.rows(CHANGED_FROM))
    return ChangedFrom(str(record["changed.name"]), str(record["changed.sha256"]), changes)


def _feeds(simulation: RunResult) -> Iterator[Section]:
    """Return the other workbooks whose answers fed assumptions; nothing where there are none."""
    feeding = simulation.model.definitions.feeding
    if feeding is None:
        return
    rows = tuple(
        (
            feed.assumption,
            feed.book or simulation.model.workbook.name,
            feed.answer,
            feed.file,
            feeding.sources[feed.file].sha256,
        )
        for feed in feeding.feeds
    )
    yield Section(FEEDS, "Fed by other workbooks, trial by trial", table=RecordTable(_FEED_COLUMNS, rows))


def _functions(simulation: RunResult) -> Iterator[Section]:
    """Return the file of a person's own functions, which formulas call; nothing where there is none."""
    own = simulation.model.workbook.functions
    if own is not None:
        entries = Entry("name", "File", own.file), Entry("sha256", "SHA-256 of the file", own.sha256)
        yield Section(FUNCTIONS, "Functions in Python, which formulas call", entries)


def recorded_functions(record: Record, given: OwnFunctions | None, path: Path) -> OwnFunctions | None:
    """Return the functions that the formulas of a recorded run called; None where there were none.

    Args:
        record: of the run.
        given: the functions that the person named.
        path: of the file with the record.

    Raises:
        WorkbookError: the person named none, or others.
    """
    if FUNCTIONS not in record:
        return None
    return the_same_functions(given, str(record["functions.name"]), str(record["functions.sha256"]), path)


def recorded_feeds(record: Record) -> list[tuple[Feed, str]]:
    """Return the feeds of a recorded run, each with the SHA-256 of the workbook that fed; their sources are
    file names.
    """
    if FEEDS not in record:
        return []
    result = []
    for row in record.rows(FEEDS):
        texts = {key: str(row[key]) for key, _ in _FEED_COLUMNS}
        book = "" if texts["book"] == str(record["file.name"]) else texts["book"]
        result.append((Feed(texts["assumption"], book, texts["answer"], texts["file"]), texts["sha256"]))
    return result


def _counts(simulation: RunResult) -> Section:
    entries = (
        Entry("trials", "Trials", simulation.trials),
        Entry("accepted", "Accepted", simulation.accepted),
        Entry("inputs_kept", "Accepted trials whose draws are kept", simulation.kept_inputs),
        Entry("acceptance", "Share accepted", finite(simulation.acceptance.value)),
        Entry("acceptance_error", "Its standard error", finite(simulation.acceptance.error)),
        *_weight_entries(simulation),
        Entry("error_trials", "Lost to errors", simulation.error_trials),
        Entry("undecided", "Error in a filter, and no filter FALSE", simulation.tally.by_error),
        Entry("invalid", "Draws whose parameters are not a distribution", sum(simulation.invalid.values())),
    )
    return Section("counts", "Trials", entries)


def _weight_entries(simulation: RunResult) -> tuple[Entry, ...]:
    """Return the weights that evidence gives the accepted trials, where they do not count alike."""
    weighting = simulation.weighting
    if weighting is None:
        return ()
    return (
        Entry("effective", "Effective sample size", weighting.effective),
        Entry("mean_weight", "Mean weight", weighting.mean),
        Entry("largest_weight", "Largest weight", weighting.largest),
    )


def _end(simulation: RunResult) -> Section:
    stopped, asked = simulation.stopped, simulation.settings.stopping
    entries = (
        Entry("by", "Ended by", stopped.by),
        Entry("in_words", "In words", stopped.sentence),
        Entry("goal", "Goal: go on until", stopped.goal),
        Entry("reached", "Reached it", stopped.reached),
        Entry("most_trials", "Trials at most", simulation.settings.trials),
        Entry("time_limit", "Seconds at most", asked.seconds),
        Entry("blocks", "Blocks of trials", -(-simulation.trials // simulation.block)),
        Entry("share_accepted", "The share accepted is", _share_words(simulation)),
    )
    return Section("end", "What ended the run", entries)


def _share_words(simulation: RunResult) -> str:
    if simulation.rare is not None:
        return _RARE_SHARE
    return _SHARES.get(simulation.stopped.by, _SHARES["trials"])


def _sampling(simulation: RunResult) -> Section:
    settings, plan = simulation.settings, simulation.plan
    replicates = (
        Entry("asked", "Trials that were asked for", settings.trials),
        Entry("replicates", "Independent replicates", plan.replicates),
        Entry("replicate", "Trials in a replicate", plan.size),
    )
    entries = (
        Entry("trials", "Trials", simulation.trials),
        Entry("seed", "Seed", settings.seed),
        Entry("method", "Method", settings.sampling),
        Entry("method_in_words", "In words", method_text(simulation)),
        *(replicates if plan.size else ()),
        Entry("errors", "Errors come", errors_text(simulation)),
        Entry("generator", "Generator", generator_text(simulation)),
        *([Entry("dimensions", "Sobol dimensions", ", ".join(map(name_key, plan.order)))] if plan.order else []),
        Entry("engine", "Engine", settings.engine),
        Entry("block", "Trials in a block", simulation.block),
    )
    return Section("sampling", "Sampling", entries)


def _rare(account: RareAccount) -> Section:
    low, high = account.acceptance.interval or (None, None)
    entries = (
        Entry("in_words", "In words", account.sentence),
        Entry("evaluations", "Trials evaluated in all", account.evaluations),
        Entry("learning", "Of them, to learn where accepted ones lie", account.learning),
        Entry("proposals", "Of them, drawn where accepted ones lie", account.proposals),
        Entry("proposals_accepted", "Drawn there and accepted by the filters", account.proposals_accepted),
        Entry("kept", "Kept, with equal weight", account.kept),
        Entry("effective", "Effective sample size of the kept ones", finite(account.size)),
        Entry("fresh", "Drawn after enough were kept, for the probability", account.fresh),
        Entry("acceptance", "Probability that a trial is accepted", finite(account.acceptance.value)),
        Entry("acceptance_low", "Its 95 % interval (by its logarithm), from", finite(low)),
        Entry("acceptance_high", "to", finite(high)),
        Entry("acceptance_effective", "Effective sample size behind it", finite(account.effective)),
        Entry("searched", "The same probability by splitting, for comparison", finite(account.searched)),
        Entry("ways", "Ways (sets of branches) searched separately", account.ways),
        Entry("explored", "Probability of parts that splitting missed", finite(account.explored)),
        Entry("at_least", "The probability is only a lower limit", account.at_least),
        Entry("plain_accepted", "Plain trials before the search that were accepted", account.plain_accepted),
        Entry("checked", "Trials from widened assumptions after the search", account.checked),
        Entry("missed", "Probability of parts met but not described", finite(account.missed)),
        Entry("levels", "Levels of the splitting", account.levels),
        Entry("components", "Normal distributions in the mixture", account.components),
        Entry("directions", "Directions in which it was learned", account.directions),
        Entry("dimensions", "Assumptions that are drawn", account.dimensions),
        *(
            (Entry("solved", "Assumptions that the filters were solved for", ", ".join(account.solved)),)
            if account.solved
            else ()
        ),
        Entry("engine", "Engine of the search and of its trials", "numpy"),
        Entry("lost", "Trials of the search with errors in cells", account.lost),
        Entry("faulty", "Accepted trials with an error in a forecast", account.faulty),
    )
    return Section("rare", "Search for rare accepted trials", entries)


def _errors(simulation: RunResult) -> Section:
    columns = (("kind", "In a"), ("name", "Name"), ("cell", "Cell"), ("error", "Error"), ("trials", "Trials"))
    rows = tuple((met.kind, met.name, str(met.cell), met.error, met.trials) for met in errors_met(simulation))
    return Section("errors", "Errors in cells", table=RecordTable(columns, rows))


def _conventions(simulation: RunResult) -> Section:
    replicates = "of a sample: the mean square about the mean, and the squared error of the mean"
    variance = replicates if simulation.plan.size else "of a sample: divided by n − 1, as Excel's VAR.S"
    entries = [Entry(*convention) for convention in _CONVENTIONS]
    entries.insert(2, Entry("variance", "Variance", variance))
    return Section("conventions", "Conventions", tuple(entries))


def _messages(key: str, title: str, messages: Sequence[str]) -> Section:
    rows = tuple((message,) for message in messages)
    return Section(key, title, table=RecordTable((("message", "Message"),), rows))


def _entries(result: Mapping[str, str]) -> tuple[Entry, ...]:
    return tuple(Entry(key, _LABELS.get(key, key), text) for key, text in result.items())


def fingerprint(simulation: RunResult) -> str:
    """SHA-256 (lower-case hex) of the accepted trials: indices, then inputs, then forecasts, in the workbook's order.

    Inputs are those of the first 1,048,576 accepted trials, or what the run kept of them. Indices are 8-byte
    little-endian integers, the rest IEEE doubles, little-endian; every missing number is the same NaN.
    """
    digest = hashlib.sha256()
    for part in parts(simulation.trial_index):
        digest.update(part.astype("<i8", copy=False).data)
    for values in simulation.inputs.values():
        _update(digest, values[:KEPT_INPUTS])
    for values in simulation.forecasts.values():
        _update(digest, values)
    return digest.hexdigest()


_FINGERPRINTS: Final[WeakKeyDictionary[RunResult, str]] = WeakKeyDictionary()
"""Each file of a run has a record of its own, and reading gigabytes takes its time."""


def _known_fingerprint(simulation: RunResult) -> str:
    if simulation not in _FINGERPRINTS:
        _FINGERPRINTS[simulation] = fingerprint(simulation)
    return _FINGERPRINTS[simulation]


def _update(digest: hashlib._Hash, values: NDArray[np.float64]) -> None:
    for part in parts(values):
        checkpoint()
        same = np.where(np.isnan(part), np.nan, part) if holds_nan(part) else part
        digest.update(same.astype("<f8", copy=False).data)


def repeat_command(simulation: RunResult) -> str:
    """Return what to type, in the workbook's folder, to get the same numbers: `xlmc simulate book.xlsx --trials …
    --seed …`.

    See `RunOptions.repeating` and `RunOptions.arguments`. Of a changed copy, which may stand in no file, it is said how
    to make one.
    """
    book, changed = simulation.model.workbook.name, simulation.changed_from
    first = ""
    if changed is not None:
        book = f"COPY{Path(book).suffix}"
        first = f"type the changes that this record lists into a copy of {changed.name}, and then: "
    arguments = simulation.repeating.arguments(simulation.model.definitions.settings)
    feeding = simulation.model.definitions.feeding
    for feed in () if feeding is None else feeding.feeds:
        arguments += ["--feed", feed.text]
    own = simulation.model.workbook.functions
    if own is not None:
        arguments += ["--functions", own.file]
    if simulation.model.definitions.python:
        return f"in Python, of the model of {Path(book).stem}: {_python_call(arguments)}"
    return first + simulate_command(book, arguments)


def _python_call(arguments: Sequence[str]) -> str:
    """Return the arguments of a command as those of a method: `simulate(trials=1000, sampling='lhs')`."""
    names = [each[2:].replace("-", "_") for each in arguments[::2]]
    values = [each if each.isdecimal() else repr(each) for each in arguments[1::2]]
    return f"simulate({', '.join(f'{name}={value}' for name, value in zip(names, values, strict=True))})"


def simulate_command(book: str, arguments: Sequence[str]) -> str:
    """Return what to type in a workbook's folder to run it with these arguments."""
    named = f"./{book}" if book.startswith("-") else book
    return " ".join(["xlmc simulate", *map(quoted_argument, [named, *arguments])])


def quoted_argument(text: str) -> str:
    """Quote the text as one argument of a command: in double quotes, which every shell knows, or else as
    POSIX quotes.
    """
    if _PLAIN.fullmatch(text):
        return text
    return f'"{text}"' if _SAFE_IN_DOUBLE_QUOTES.fullmatch(text) else shlex.quote(text)
