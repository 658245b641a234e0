"""The settings of a run in the record, exactly, and read back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import astuple, fields
from typing import TYPE_CHECKING, Any, Final, get_type_hints

from xlmc.analysis.results.record.record_parts import EDITED, Entry, Record, Section, Value
from xlmc.errors import WorkbookError, XlmcError
from xlmc.montecarlo.definitions.run_settings import ENDS, SETTINGS, Setting, Settings
from xlmc.montecarlo.definitions.stopping import GOALS, Goal, Stopping, only_one

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["recorded_settings", "settings_section"]


def settings_section(simulation: RunResult) -> Section:
    """Yield what the run was asked to do, each setting so that it reads back as the same one."""
    settings = simulation.settings
    of_run, of_end = ([row for row in SETTINGS.values() if bool(row.field) is ends] for ends in (False, True))
    entries = (
        *_setting_entries(of_run, settings),
        *(entry for kind in GOALS.values() for entry in _goal_entries(kind, settings.stopping.goal)),
        *_setting_entries(of_end, settings),
    )
    return Section("settings", "Settings", entries)


def _setting_entries(rows: Iterable[Setting], settings: Settings) -> Iterator[Entry]:
    """Yield an entry for every setting: empty, or none at all, where nothing is said of it."""
    for row in rows:
        value = row.of(settings)
        stated = bool(value) or not row.blank
        if stated or not row.sparse:
            yield Entry(row.entry_key, row.label, row.kind.entry(value) if stated else None)


def _goal_entries(kind: type[Goal], asked: Goal | None) -> Iterator[Entry]:
    """Yield an entry for every field of a goal, empty where another was asked for."""
    values = astuple(asked) if isinstance(asked, kind) else [None] * len(kind.labels)
    for (key, label), value in zip(kind.labels, values, strict=True):
        yield Entry(key, label, ",".join(value) if isinstance(value, tuple) else value)


def recorded_settings(record: Record) -> Settings:
    """Return the settings of a recorded run.

    Raises:
        KeyError: the record does not hold them.
        WorkbookError: they cannot be read.
    """
    section = {entry.key: entry.value for entry in record.section("settings").entries}
    try:
        given = {row.field or row.key: value for row, value in _recorded(section)}
        goals = [_goal(kind, section) for kind in GOALS.values() if section.get(kind.labels[0][0]) is not None]
        ends = {name.removeprefix(ENDS): given.pop(name) for name in list(given) if name.startswith(ENDS)}
        return Settings(**given, stopping=Stopping(goal=only_one(goals), **ends))
    except (TypeError, ValueError, XlmcError) as error:
        raise WorkbookError(f"the settings in the record cannot be read ({error})", hint=EDITED) from error


def _recorded(section: dict[str, Value]) -> Iterator[tuple[Setting, Any]]:
    """Return the settings that the entries say."""
    for row in SETTINGS.values():
        value = section.get(row.entry_key) if row.sparse else section[row.entry_key]
        if value is not None or not row.blank:
            yield row, row.kind.recorded(value)


def _goal(kind: type[Goal], section: dict[str, Value]) -> Goal:
    hints = get_type_hints(kind)
    values = zip(fields(kind), kind.labels, strict=True)
    return kind(*(_READERS.get(hints[field.name], _list)(section[key]) for field, (key, _) in values))


def _list(value: Value) -> tuple[str, ...]:
    return tuple(str(value).split(","))


def _whole(value: Value) -> int:
    if not isinstance(value, int | float) or value != int(value):
        raise ValueError(f"{value!r} is not a whole number")
    return int(value)


_READERS: Final[dict[Any, Callable[[Any], Any]]] = {int: _whole, float: float, bool: bool, str: str}
"""The type of a goal's field -> what reads its entry; lists of texts stand with commas."""
