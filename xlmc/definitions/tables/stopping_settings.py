"""The rows of `xlmc_settings` that say when a run ends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final, TypeVar

from xlmc.definitions.findings import Findings
from xlmc.definitions.stopping import (
    MOST_DIGITS,
    MOST_TRIALS,
    NO_GOAL,
    RARE,
    Stopping,
    as_confidence,
    as_numbers,
    as_seconds,
    stopping,
)
from xlmc.definitions.tables.fields import required_text
from xlmc.definitions.tables.setting_values import number_of, whole_number
from xlmc.definitions.tables.tables import DefinitionTable, Row
from xlmc.distributions.base import show
from xlmc.distributions.naming import plain
from xlmc.errors import DefinitionError, SimulationError

__all__ = ["STOPPING_SETTINGS", "read_stopping"]

T = TypeVar("T")

_LEAST_PERCENT = 0.1


def read_stopping(tables: list[DefinitionTable], values: dict[str, Any], findings: Findings) -> Stopping:
    """What the settings say of the end of the run, taken out of `values`; a mistake is one of the whole table."""
    mistaken = any(values.get(key, key) is None for key in _ENDS)
    given = {argument: values.pop(key, None) for key, argument in _ENDS.items()}
    if mistaken:
        return NO_GOAL
    relative, absolute = given.pop("percent"), given["tolerance"]
    try:
        if relative is not None and absolute is not None:
            raise SimulationError("Precision and Precision % are both set", hint="Keep one of the two rows")
        given["tolerance"] = absolute if relative is None else f"{relative!r}%"
        return stopping(**{argument: value for argument, value in given.items() if value is not None})
    except SimulationError as error:
        findings.problem(error.message, tables[0].where, error.hint or "")
        return NO_GOAL


def _accepted(row: Row, _findings: Findings) -> int:
    return whole_number(row, "Until accepted", 2, MOST_TRIALS)


def _digits(row: Row, _findings: Findings) -> int:
    return whole_number(row, "Significant digits", 1, MOST_DIGITS)


def _precision(row: Row, _findings: Findings) -> float:
    value = number_of(row, "Precision")
    if value <= 0:
        message = f"Precision must be above 0, not {show(value)}"
        raise DefinitionError(message, where=row.cell("Value"), hint="Correct the number")
    return value


def _percent(row: Row, findings: Findings) -> float:
    """A cell in percent format holds 0.01 for 1 %: what could be meant so is refused or told."""
    value, where = number_of(row, "Precision %"), row.cell("Value")
    if value < _LEAST_PERCENT:
        message = f"Precision % must be {_LEAST_PERCENT} or more, not {show(value)}"
        raise DefinitionError(message, where=where, hint="Type 1 for 1 %, in a cell without percent format")
    if value < 1:
        findings.notice(f"Precision % {show(value)} is read as {show(value)} %", where)
    return value


def _precision_of(row: Row, _findings: Findings) -> tuple[str, ...]:
    return _as_written(row, as_numbers, required_text(row, "Value"))


def _names(row: Row, _findings: Findings) -> tuple[str, ...]:
    return tuple(name.strip() for name in required_text(row, "Value").split(";") if name.strip())


def _confidence(row: Row, _findings: Findings) -> float:
    return _as_written(row, as_confidence, number_of(row, "Confidence %"))


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


STOPPING_SETTINGS: Final[Mapping[str, Callable[[Row, Findings], Any]]] = {
    "Until accepted": _accepted,
    "Rare": _rare,
    "Precision": _precision,
    "Precision %": _percent,
    "Precision of": _precision_of,
    "Confidence %": _confidence,
    "Significant digits": _digits,
    "Look at": _names,
    "Time limit": _seconds,
}
"""Setting -> reader of its row."""

_ENDS = {
    plain("Until accepted"): "accepted",
    plain("Rare"): "rare",
    plain("Precision"): "tolerance",
    plain("Precision %"): "percent",
    plain("Precision of"): "numbers",
    plain("Confidence %"): "confidence",
    plain("Significant digits"): "digits",
    plain("Look at"): "forecasts",
    plain("Time limit"): "seconds",
}
"""Setting -> what `stopping` calls it."""
