"""The rows of `xlmc_settings`: trials, seed and the like, and when the run ends."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any, NamedTuple, TypeVar

from xlmc.errors import DefinitionError, SimulationError
from xlmc.excel.workbook.workbook import Workbook
from xlmc.montecarlo.definitions.amounts import as_seconds, typed_whole_number
from xlmc.montecarlo.definitions.problems import Findings
from xlmc.montecarlo.definitions.run_settings import SETTINGS, Setting, Settings
from xlmc.montecarlo.definitions.setting_kinds import Names, Seconds, Switch, Whole, Word
from xlmc.montecarlo.definitions.stopping import GOALS, LIMIT, NO_GOAL, Option, Stopping, stopping
from xlmc.montecarlo.definitions.tables.reserved_tables import DefinitionTable
from xlmc.montecarlo.definitions.tables.table_rows import Row, as_text, central_share, number_in, required_text, rows_of
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.spelling import did_you_mean, plain
from xlmc.montecarlo.number_text import count_text

__all__ = ["LEAST_PERCENT", "read_settings", "setting_names"]

_DEFAULT_CENTRAL = 0.51
"""The share of the central range where neither the forecast nor the settings give one: the paper's 51 %."""

_LARGEST = 10**15  # a worksheet holds no more digits
_KNOWN = ("Setting", "Value")

_Reader = Callable[[Row, Findings], Any]

T = TypeVar("T")

LEAST_PERCENT = 0.1
"""A precision in percent below this is most likely a number in a cell of percent format."""


class _Setting(NamedTuple):
    """A setting as people write it, and what reads its row."""

    name: str
    read: _Reader


def read_settings(
    workbook: Workbook, tables: list[DefinitionTable], engines: Collection[str], findings: Findings
) -> tuple[Settings, float, frozenset[str]]:
    """Read the settings; the share of the central range for forecasts that give none; and what is set, by plain names.

    Mistakes leave the default.

    Args:
        workbook: that holds them.
        tables: of settings; there should be one at most.
        engines: the names that the setting Engine may have.
        findings: gets the mistakes.
    """
    settings = _settings(engines)
    for extra in tables[1:]:
        message = f"{tables[0].table.name} and {extra.table.name} both hold settings"
        findings.problem(message, extra.where, "Keep one table, and delete the one that came with a copied sheet")
    values: dict[str, Any] = {}
    for row in rows_of(workbook, tables[:1], _KNOWN, _KNOWN, findings):
        findings.attempt(_take, row, values, settings, findings)
    stated = frozenset(values)
    central = values.pop("range%", None)
    ends = _read_stopping(tables, values, findings)
    if ends.has_goal:
        values.setdefault("trials", LIMIT)
    keys = {plain(row.heading): row.key for row in SETTINGS.values()}
    return (
        Settings(**{keys[name]: value for name, value in values.items() if value is not None}, stopping=ends),
        _DEFAULT_CENTRAL if central is None else central,
        stated,
    )


def setting_names() -> list[str]:
    """Return the settings that a row may name, as people write them."""
    return [setting.name for setting in _settings(()).values() if setting.read is not _arithmetic]


def _take(row: Row, values: dict[str, Any], settings: Mapping[str, _Setting], findings: Findings) -> None:
    """Add the row's setting to `values`, by its plain name.

    Raises:
        DefinitionError: there is no such setting, it is set twice or its value is wrong.
    """
    typed = required_text(row, "Setting")
    key, where = plain(typed), row.cell("Setting")
    if key not in settings:
        hint = did_you_mean(typed, (setting.name for setting in settings.values()))
        raise DefinitionError(f"There is no setting {typed!r}", where=where, hint=hint)
    if key in values:
        raise DefinitionError(f"{typed} is set twice", where=where, hint="Keep one of the two rows")
    values[key] = None  # a setting whose value is wrong is set all the same
    if not row.filled("Value"):
        message = f"{typed} has no value"
        raise DefinitionError(message, where=row.cell("Value"), hint="Fill in Value, or delete the row")
    values[key] = settings[key].read(row, findings)


def _arithmetic(row: Row, _findings: Findings) -> None:
    """Read a row of earlier books, which could ask for float32."""
    typed = required_text(row, "Value")
    if plain(typed) != "float64":
        message = f"There is no arithmetic {typed!r}: xlmc computes in float64"
        raise DefinitionError(message, where=row.cell("Value"), hint="Delete the row")


def _range(row: Row, findings: Findings) -> float:
    return central_share("Range %", _number_of(row, "Range %"), row.cell("Value"), findings)


def _settings(engines: Collection[str]) -> dict[str, _Setting]:
    """Plain name -> the setting."""
    readers: dict[str, _Reader] = {
        **_of_run(engines, ends=False),
        "Range %": _range,
        **_goal_settings(),
        **_of_run(engines, ends=True),
        "Arithmetic": _arithmetic,
    }
    return {plain(name): _Setting(name, read) for name, read in readers.items()}


def _of_run(engines: Collection[str], *, ends: bool) -> dict[str, _Reader]:
    """Heading -> reader of the settings of a run, or of those of its end."""
    rows = [row for row in SETTINGS.values() if row.heading and bool(row.field) is ends]
    return {row.heading: partial(_read, row, engines) for row in rows}


def _read(setting: Setting, engines: Collection[str], row: Row, _findings: Findings) -> Any:
    """Return the value of a setting's row.

    Raises:
        DefinitionError: it is none.
    """
    match setting.kind:
        case Whole(least=least, most=most):
            return _whole_number(row, setting.heading, least, _LARGEST if most is None else most)
        case Word() as kind:
            return _word(row, kind, engines if setting.key == "engine" else kind.words())
        case Names():
            return tuple(name.strip() for name in required_text(row, "Value").split(";") if name.strip())
        case Seconds():
            return _seconds(row)
        case Switch():
            raise AssertionError(setting.key)  # no workbook says one


def _word(row: Row, kind: Word, words: Collection[str]) -> str:
    """Return the one of the words that was typed, in any case; a number is none, as Excel changes how it is typed."""
    typed = required_text(row, "Value")
    spelling = kind.spelling or plain
    result = {spelling(word): word for word in words} | kind.also()
    if spelling(typed) in result and isinstance(row.content("Value").value, str):
        return result[spelling(typed)]
    *some, last = words
    hint = kind.hint or (did_you_mean(typed, words) if kind.suggest else f"Use {', '.join(some)} or {last}")
    raise DefinitionError(kind.fault.format(repr(typed)), where=row.cell("Value"), hint=hint)


def _number_of(row: Row, name: str) -> float:
    """Return the number in the row's Value.

    Raises:
        DefinitionError: there is something else in it.
    """
    return number_in(name, row.content("Value"), row.cell("Value"))


def _whole_number(row: Row, name: str, least: int, most: int) -> int:
    """Return the whole number in the row's Value, also as a text like `200,000` or `200k`.

    Raises:
        DefinitionError: there is something else in it, or a number outside `least` … `most`.
    """
    written = _whole_number_as_text(row, name)
    value = _number_of(row, name) if written is None else written
    if not least <= value <= most or value != int(value):
        message = f"{name} must be a whole number from {count_text(least)} to {count_text(most)}, not {show(value)}"
        raise DefinitionError(message, where=row.cell("Value"), hint="Correct the number")
    return int(value)


def _whole_number_as_text(row: Row, name: str) -> int | None:
    """Return what is written in a cell of text; None if the cell holds something else."""
    text = row.content("Value").value
    if not isinstance(text, str):
        return None
    value = typed_whole_number(text)
    if value is None:
        message = f"{name} is {as_text(text)!r}, which is not a whole number"
        raise DefinitionError(message, where=row.cell("Value"), hint="Type it like 200000, 200,000, 2e5 or 200k")
    return value


def _goal_settings() -> dict[str, Callable[[Row, Findings], Any]]:
    """List setting -> reader of its row: what goals take."""
    options = {option.setting: partial(_option, option) for option in _options()}
    return options | {"Precision": _precision, "Precision %": _percent}


def _read_stopping(tables: list[DefinitionTable], values: dict[str, Any], findings: Findings) -> Stopping:
    """Take what the settings say of the end of the run out of `values`; a mistake is reported for the whole table."""
    arguments = {option.setting: option.name for option in _options()} | {"Precision %": "precision"}
    arguments |= {row.heading: row.key for row in SETTINGS.values() if row.field}
    given = {name: values.pop(plain(name)) for name in arguments if plain(name) in values}
    if any(value is None for value in given.values()):  # a mistake that was reported before
        return NO_GOAL
    try:
        if "Precision %" in given and "Precision" in given:
            raise SimulationError("Precision and Precision % are both set", hint="Keep one of the two rows")
        return stopping(**{arguments[name]: value for name, value in given.items()})
    except SimulationError as error:
        findings.problem(error.message, tables[0].where, error.hint or "")
        return NO_GOAL


def _options() -> list[Option]:
    return [option for goal in GOALS.values() for option in goal.options]


def _option(option: Option, row: Row, _findings: Findings) -> Any:
    if isinstance(option.takes, tuple):
        return _whole_number(row, option.setting, *option.takes)
    given = required_text(row, "Value") if option.takes is str else _number_of(row, option.setting)
    _as_written(row, option.read, given)
    return given


def _precision(row: Row, _findings: Findings) -> float:
    value = _number_of(row, "Precision")
    if value <= 0:
        message = f"Precision must be above 0, not {show(value)}"
        raise DefinitionError(message, where=row.cell("Value"), hint="Correct the number")
    return value


def _percent(row: Row, findings: Findings) -> str:
    """Refuse, or note, a number that may be a percentage: a cell in percent format holds 0.01 for 1 %."""
    value, where = _number_of(row, "Precision %"), row.cell("Value")
    if value < LEAST_PERCENT:
        message = f"Precision % must be {LEAST_PERCENT} or more, not {show(value)}"
        raise DefinitionError(message, where=where, hint="Type 1 for 1 %, in a cell without percent format")
    if value < 1:
        findings.notice(f"Precision % {show(value)} is read as {show(value)} %", where)
    return f"{value!r}%"


def _seconds(row: Row) -> float:
    content = row.content("Value")
    given = content.value if isinstance(content.value, str) else _number_of(row, "Time limit")
    if not isinstance(given, str) and given < 1:
        message = f"Time limit must be 1 second or more, not {show(given)}"
        raise DefinitionError(
            message, where=row.cell("Value"), hint="Type seconds, or a text such as 5m; not a clock time"
        )
    return _as_written(row, as_seconds, given)


def _as_written(row: Row, read: Callable[[Any], T], given: object) -> T:
    """Read a value; a fault names the cell."""
    try:
        return read(given)
    except SimulationError as error:
        raise DefinitionError(error.message, where=row.cell("Value"), hint=error.hint) from error
