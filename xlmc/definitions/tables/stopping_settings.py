"""The rows of `xlmc_settings` that say when a run ends."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

from xlmc.definitions.amounts import as_seconds
from xlmc.definitions.findings import Findings
from xlmc.definitions.stopping import GOALS, NO_GOAL, RARE, Option, Stopping, stopping
from xlmc.definitions.tables.fields import required_text
from xlmc.definitions.tables.setting_values import number_of, whole_number
from xlmc.definitions.tables.tables import DefinitionTable, Row
from xlmc.distributions.base import show
from xlmc.distributions.naming import plain
from xlmc.errors import DefinitionError, SimulationError

__all__ = ["read_stopping", "stopping_settings"]

T = TypeVar("T")

_LEAST_PERCENT = 0.1


def stopping_settings() -> dict[str, Callable[[Row, Findings], Any]]:
    """Setting -> reader of its row: what `stopping` takes."""
    options = {option.setting: partial(_option, option) for option in _options()}
    return options | {
        "Precision": _precision,
        "Precision %": _percent,
        "Rare": _rare,
        "Look at": _names,
        "Time limit": _seconds,
    }


def read_stopping(tables: list[DefinitionTable], values: dict[str, Any], findings: Findings) -> Stopping:
    """What the settings say of the end of the run, taken out of `values`; a mistake is one of the whole table."""
    given = {name: values.pop(plain(name)) for name in stopping_settings() if plain(name) in values}
    if any(value is None for value in given.values()):  # a mistake, which was told
        return NO_GOAL
    try:
        if "Precision %" in given and "Precision" in given:
            raise SimulationError("Precision and Precision % are both set", hint="Keep one of the two rows")
        arguments = {option.setting: option.name for option in _options()} | _OTHERS
        return stopping(**{arguments[name]: value for name, value in given.items()})
    except SimulationError as error:
        findings.problem(error.message, tables[0].where, error.hint or "")
        return NO_GOAL


def _options() -> list[Option]:
    return [option for goal in GOALS.values() for option in goal.options]


def _option(option: Option, row: Row, _findings: Findings) -> Any:
    if isinstance(option.takes, tuple):
        return whole_number(row, option.setting, *option.takes)
    given = required_text(row, "Value") if option.takes is str else number_of(row, option.setting)
    _as_written(row, option.read, given)
    return given


def _precision(row: Row, _findings: Findings) -> float:
    value = number_of(row, "Precision")
    if value <= 0:
        message = f"Precision must be above 0, not {show(value)}"
        raise DefinitionError(message, where=row.cell("Value"), hint="Correct the number")
    return value


def _percent(row: Row, findings: Findings) -> str:
    """A cell in percent format holds 0.01 for 1 %: what could be meant so is refused or told."""
    value, where = number_of(row, "Precision %"), row.cell("Value")
    if value < _LEAST_PERCENT:
        message = f"Precision % must be {_LEAST_PERCENT} or more, not {show(value)}"
        raise DefinitionError(message, where=where, hint="Type 1 for 1 %, in a cell without percent format")
    if value < 1:
        findings.notice(f"Precision % {show(value)} is read as {show(value)} %", where)
    return f"{value!r}%"


def _names(row: Row, _findings: Findings) -> tuple[str, ...]:
    return tuple(name.strip() for name in required_text(row, "Value").split(";") if name.strip())


def _seconds(row: Row, _findings: Findings) -> float:
    content = row.content("Value")
    given = content.value if isinstance(content.value, str) else number_of(row, "Time limit")
    if not isinstance(given, str) and given < 1:
        message = f"Time limit must be 1 second or more, not {show(given)}"
        raise DefinitionError(
            message, where=row.cell("Value"), hint="Type seconds, or a text such as 5m; not a clock time"
        )
    return _as_written(row, as_seconds, given)


def _rare(row: Row, _findings: Findings) -> str:
    typed = required_text(row, "Value")
    if plain(typed) not in RARE:
        message = f"{typed!r} is no way to look for rare trials"
        raise DefinitionError(message, where=row.cell("Value"), hint=f"Use {', '.join(RARE)}")
    return plain(typed)


def _as_written(row: Row, read: Callable[[Any], T], given: object) -> T:
    """What is read from the value; its fault told of the cell."""
    try:
        return read(given)
    except SimulationError as error:
        raise DefinitionError(error.message, where=row.cell("Value"), hint=error.hint) from error


_OTHERS = {"Precision %": "precision", "Rare": "rare", "Look at": "forecasts", "Time limit": "time_limit"}
"""Setting -> what `stopping` calls it, of those that are no option of a goal."""
