"""The rows of `xlmc_settings`: trials, seed and the like."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any, NamedTuple

from xlmc.definitions.findings import Findings
from xlmc.definitions.model import Settings
from xlmc.definitions.stopping import LIMIT, MOST_TRIALS
from xlmc.definitions.tables.fields import central_share, required_text
from xlmc.definitions.tables.setting_values import number_of, whole_number
from xlmc.definitions.tables.stopping_settings import read_stopping, stopping_settings
from xlmc.definitions.tables.tables import DefinitionTable, Row, rows_of
from xlmc.distributions.naming import did_you_mean, plain
from xlmc.errors import DefinitionError
from xlmc.sampling.methods import METHODS
from xlmc.workbook.model import Workbook

__all__ = ["DEFAULT_CENTRAL", "read_settings"]

DEFAULT_CENTRAL = 0.51
"""The share of the central range where neither the forecast nor the settings give one: the paper's 51 %."""

_LARGEST_SEED = 10**15  # a worksheet holds no more digits
_KNOWN = ("Setting", "Value")
_LOGNORMS = ("@RISK", "XLRisk")

_Reader = Callable[[Row, Findings], Any]


class _Setting(NamedTuple):
    """A setting as people write it, and what reads its row."""

    name: str
    read: _Reader


def read_settings(
    workbook: Workbook, tables: list[DefinitionTable], engines: Collection[str], findings: Findings
) -> tuple[Settings, float]:
    """The settings, and the share of the central range for forecasts that give none; mistakes leave the default.

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
    central = values.pop("range%", None)
    ends = read_stopping(tables, values, findings)
    if ends.has_goal:
        values.setdefault("trials", LIMIT)
    return (
        Settings(**{key: value for key, value in values.items() if value is not None}, stopping=ends),
        DEFAULT_CENTRAL if central is None else central,
    )


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


def _trials(row: Row, _findings: Findings) -> int:
    return whole_number(row, "Trials", 1, MOST_TRIALS)


def _seed(row: Row, _findings: Findings) -> int:
    return whole_number(row, "Seed", 0, _LARGEST_SEED)


def _sampling(row: Row, _findings: Findings) -> str:
    typed = required_text(row, "Value")
    known = {name: method.key for method in METHODS.values() for name in (method.key, *method.also)}
    if plain(typed) not in known:
        *keys, last = METHODS
        hint = f"Use {', '.join(keys)} or {last}"
        raise DefinitionError(f"There is no sampling method {typed!r}", where=row.cell("Value"), hint=hint)
    return known[plain(typed)]


def _engine(engines: Collection[str], row: Row, _findings: Findings) -> str:
    typed = required_text(row, "Value")
    if plain(typed) not in engines:
        message = f"There is no engine {typed!r}"
        raise DefinitionError(message, where=row.cell("Value"), hint=did_you_mean(typed, engines))
    return plain(typed)


def _lognorm(row: Row, _findings: Findings) -> str:
    typed = required_text(row, "Value")
    found = {plain(name): name for name in _LOGNORMS}.get(plain(typed))
    if found is None:
        hint = "Use @RISK (mean and std dev of the draw) or XLRisk (of its logarithm)"
        raise DefinitionError(f"There is no RiskLognorm of {typed!r}", where=row.cell("Value"), hint=hint)
    return found


def _arithmetic(row: Row, _findings: Findings) -> None:
    """A row of earlier books, which could ask for float32."""
    typed = required_text(row, "Value")
    if plain(typed) != "float64":
        message = f"There is no arithmetic {typed!r}: xlmc computes in float64"
        raise DefinitionError(message, where=row.cell("Value"), hint="Delete the row")


def _range(row: Row, findings: Findings) -> float:
    return central_share("Range %", number_of(row, "Range %"), row.cell("Value"), findings)


def _settings(engines: Collection[str]) -> dict[str, _Setting]:
    """Plain name -> the setting."""
    readers: dict[str, _Reader] = {
        "Trials": _trials,
        "Seed": _seed,
        "Sampling": _sampling,
        "Engine": partial(_engine, engines),
        "Arithmetic": _arithmetic,
        "Range %": _range,
        **stopping_settings(),
        "Lognorm": _lognorm,
    }
    return {plain(name): _Setting(name, read) for name, read in readers.items()}
