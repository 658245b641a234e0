"""The repeated run as the recorded one was told of: its file's name, its settings, what ended it."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import TYPE_CHECKING

from xlmc.run.stopping.stopped import Stopped

if TYPE_CHECKING:
    from xlmc.definitions.model import Settings
    from xlmc.results.record import Record, Value
    from xlmc.run.model import Model
    from xlmc.run.simulation import Simulation

__all__ = ["entry", "restored"]


def restored(run: Simulation, record: Record, settings: Settings) -> Simulation:
    """The run under the name of the recorded one's workbook, with its settings, ended by what ended that.

    Args:
        run: the repeated run, which ended because it came to the number of trials.
        record: of the recorded one.
        settings: of the recorded one.
    """
    return replace(
        run,
        model=_renamed(run.model, str(record["file.name"])),
        settings=settings,
        stopped=_stopped(record),
    )


def entry(record: Record, key: str) -> Value:
    """An entry of the record; None where it has no such entry."""
    try:
        return record[key]
    except KeyError:
        return None


def _renamed(model: Model, name: str) -> Model:
    found = copy.copy(model)
    found.workbook = replace(model.workbook, name=name)
    own = (str(model.path), model.workbook.name)
    found.notices = tuple(
        replace(notice, where=name) if str(notice.where) in own else notice for notice in model.notices
    )
    return found


def _stopped(record: Record) -> Stopped:
    by, sentence, goal = (entry(record, f"end.{key}") for key in ("by", "in_words", "goal"))
    said = str(sentence or "")
    stopped = Stopped(str(by), said, None if goal is None else str(goal))
    return stopped if stopped.reached else replace(stopped, because=said.removesuffix(f" before {goal}"))
