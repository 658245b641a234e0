"""Save a finished run in a file."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.record.make import processor, versions
from xlmc.analysis.results.saved.archive import RUN, SUFFIX, WORKBOOK, column_header, column_parts, write_entries
from xlmc.analysis.results.saved.run_json import FORMAT, VERSION, settings_document, tally_document
from xlmc.errors import SimulationError, WorkbookError
from xlmc.excel.own_functions import OwnFunctions
from xlmc.excel.workbook.seal import blank_seal, seal_file
from xlmc.excel.workbook.target import Target
from xlmc.excel.workbook.writer import whole_file
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.simulation.simulation import Origin

if TYPE_CHECKING:
    from xlmc.excel.workbook.workbook import Workbook
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["check_run_path", "keep"]


class _Column(NamedTuple):
    """A column to save: `trial`, `input`, `prior` or `forecast`, and whose."""

    kind: str
    name: str
    type: str
    values: NDArray[Any]


def keep(simulation: RunResult, path: Path, *, overwrite: bool = False) -> Path:
    """Save the run: the workbook it was made from, its settings and counts, and its columns.

    The same run gives the same bytes. Columns on disk are copied a part at a time.

    Args:
        simulation: the finished run.
        path: where to, ending in `.xlmcrun`; an untouched saved run of the same workbook is replaced.
        overwrite: replace any other file too.

    Returns:
        The path.

    Raises:
        TakenError: the file is not ours to replace.
        WorkbookError: the file cannot be written, or has another ending.
        SimulationError: the workbook was not read from a file.
    """
    check_run_path(path)
    if not simulation.model.workbook.data:
        message = "the run cannot be saved: its workbook was not read from a file"
        raise SimulationError(message, hint="read it with xlmc.load")
    target = Target(path, simulation.model.workbook.name, overwrite, read=simulation.model.files)
    target.check()
    with whole_file(path, target.check) as file:
        write_entries(file, _entries(simulation), blank_seal(target.book))
        seal_file(file, target.book)
    return path


def check_run_path(path: Path) -> None:
    """Refuse a name that is not that of a saved run.

    Raises:
        WorkbookError: the name does not end in `.xlmcrun`.
    """
    if path.suffix.casefold() != SUFFIX:
        hint = f"Name it {path.stem + SUFFIX!r}"
        raise WorkbookError(f"a saved run must end in {SUFFIX}", where=path, hint=hint)


def _entries(simulation: RunResult) -> Iterator[tuple[str, int, Iterator[bytes]]]:
    """Name, size and bytes of every entry; the last one holds the checksums of the others."""
    data = simulation.model.workbook.data
    yield WORKBOOK, len(data), iter([data])
    for number, source in enumerate(_sources(simulation).values()):
        yield f"fed/{number}", len(source.data), iter([source.data])
    listed: list[dict[str, Any]] = []
    for number, column in enumerate(_columns(simulation)):
        digest = hashlib.sha256()
        entry, count = f"columns/{number}.npy", column.values.size
        size = len(column_header(count, column.type)) + count * np.dtype(column.type).itemsize
        yield entry, size, column_parts(column.values, column.type, digest)
        about = {"kind": column.kind, "name": column.name, "type": column.type, "count": count}
        listed.append({**about, "entry": entry, "sha256": digest.hexdigest()})
    document = json.dumps(_document(simulation, listed), ensure_ascii=False, allow_nan=False, indent=1).encode()
    yield RUN, len(document), iter([document])


def _sources(simulation: RunResult) -> dict[str, Workbook]:
    """Return the workbooks that fed the run, by file name."""
    feeding = simulation.model.definitions.feeding
    return {} if feeding is None else dict(feeding.sources)


def _feeding_document(simulation: RunResult) -> dict[str, Any]:
    feeding = simulation.model.definitions.feeding
    if feeding is None:
        return {}
    feeds = [{**asdict(feed), "source": feed.file} for feed in feeding.feeds]
    books = [{"name": name, "sha256": book.sha256} for name, book in _sources(simulation).items()]
    return {"feeds": feeds, "fed_by": books}


def _functions_document(functions: OwnFunctions | None) -> dict[str, Any]:
    """Name the file of a person's own functions; a saved run holds no code."""
    return {} if functions is None else {"functions": {"name": functions.file, "sha256": functions.sha256}}


def _columns(simulation: RunResult) -> Iterator[_Column]:
    yield _Column("trial", "", "<i8", simulation.trial_index)
    for kind, columns in (
        ("input", simulation.inputs),
        ("prior", simulation.prior),
        ("forecast", simulation.forecasts),
    ):
        for name in columns:
            yield _Column(kind, name, "<f8", columns[name])


def _document(simulation: RunResult, columns: list[dict[str, Any]]) -> dict[str, Any]:
    model, origin, changed = simulation.model, _origin(simulation), simulation.changed_from
    return {
        "format": FORMAT,
        "version": VERSION,
        "workbook": {"name": model.workbook.name, "sha256": model.workbook.sha256},
        **_feeding_document(simulation),
        **_functions_document(model.workbook.functions),
        "settings": settings_document(simulation.settings),
        "order": [name_key(name) for name in simulation.plan.order],
        "block": simulation.block,
        "trials": simulation.trials,
        "error_trials": simulation.error_trials,
        "tally": tally_document(simulation.tally),
        "invalid": dict(sorted((name_key(name), count) for name, count in simulation.invalid.items())),
        "faults": {name: dict(sorted(faults.items())) for name, faults in simulation.faults.items()},
        "discards": {name: dict(discards) for name, discards in simulation.discards.items()},
        "stopped": asdict(simulation.stopped),
        "rare": None if simulation.rare is None else asdict(simulation.rare),
        "origin": {"software": dict(origin.software), "processor": dict(origin.processor)},
        **({"labels": {name: list(each) for name, each in simulation.labels.items()}} if simulation.labels else {}),
        **({} if changed is None else {"changed_from": asdict(changed)}),
        "columns": columns,
    }


def _origin(simulation: RunResult) -> Origin:
    return simulation.origin or Origin(versions(simulation.settings.engine), processor())
