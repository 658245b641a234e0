"""Writes what the window shows beside its workbook: result workbook, page, JSON, saved run.

Every result holds a record of how it can be repeated, from its workbook. So only the workbook's own state is written:
what was changed in the window stands in no workbook, and a record could not name it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from xlmc.errors import SimulationError
from xlmc.report import save
from xlmc.report.json_document import save_json
from xlmc.report.page import save_page
from xlmc.results.saved import keep
from xlmc.workbook.target import copy_ending, free_target

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["KINDS", "save_result"]


class _Kind(NamedTuple):
    """The ending of its file, where that is not the workbook's own; and what writes it."""

    ending: str
    write: Callable[[Simulation, Path], Path]


KINDS: Final[Mapping[str, _Kind]] = {
    "book": _Kind("", lambda run, path: save(run, path)),
    "page": _Kind(".html", lambda run, path: save_page(run, path)),
    "json": _Kind(".json", lambda run, path: save_json(run, path)),
    "run": _Kind(".xlmcrun", lambda run, path: keep(run, path)),
}


def save_result(run: Simulation, book: Path, what: str, changes: Sequence[str]) -> Path:
    """Write one kind of result beside the workbook, under a name that is free or whose file is ours to replace.

    Args:
        run: the finished one.
        book: the workbook.
        what: a key of `KINDS`.
        changes: in words, what of the run is other than in the workbook.

    Raises:
        WorkbookError: it cannot be written.
        SimulationError: the run is not one of the workbook's own state.
    """
    if changes:
        message = f"results are written of the workbook as it stands, and here is changed: {'; '.join(changes)}"
        hint = "type the changes into the workbook, or go back with “All as in the workbook”"
        raise SimulationError(message, hint=hint)
    kind = KINDS[what]
    wanted = book.with_name(f"{book.stem}-results{kind.ending or copy_ending(book)}")
    path, _ = free_target(wanted, run.model.workbook.name)
    return kind.write(run, path)
