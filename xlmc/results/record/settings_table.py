"""The settings of a run in the record, exactly, and read back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Final

from xlmc.definitions.model import Settings
from xlmc.definitions.stopping import Precision, Stopping
from xlmc.errors import WorkbookError, XlmcError
from xlmc.results.record.model import Entry, Record, Section, Value

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["FLOAT64", "in_float32", "recorded_settings", "settings_section"]

FLOAT64: Final = "float64"
"""The arithmetic of all runs; those of xlmc 0.3.0 and before could also be computed in float32."""


def in_float32(version: str, where: Path | None = None) -> WorkbookError:
    """What is said of a run that was.

    Args:
        version: the xlmc that made it; empty where nothing says so.
        where: the file, where it is not known to whoever is told.
    """
    made = f"xlmc {version}" if version else "An older xlmc"
    message = f"{made} computed this run in float32, and this one computes in float64 only"
    return WorkbookError(message, where=where, hint=f"Open or repeat it with {made.removeprefix('An ')}")


def settings_section(simulation: Simulation) -> Section:
    """What the run was asked to do, each setting so that it reads back as the same one."""
    settings, asked = simulation.settings, simulation.settings.stopping
    precision = asked.precision
    entries = (
        Entry("trials", "Trials at most", settings.trials),
        Entry("seed", "Seed", str(settings.seed)),  # as text: a worksheet's numbers have 15 to 17 digits
        Entry("sampling", "Sampling", settings.sampling),
        Entry("engine", "Engine", settings.engine),
        Entry("lognorm", "RiskLognorm is that of", settings.lognorm or None),
        Entry("until_accepted", "Until so many are accepted", asked.accepted),
        Entry("precision", "Precision", None if precision is None else precision.tolerance),
        Entry("relative", "It is a share of the number", None if precision is None else precision.relative),
        Entry("precision_of", "Of these numbers", None if precision is None else ",".join(precision.numbers)),
        Entry("confidence", "At this confidence", None if precision is None else precision.confidence),
        Entry("adaptive", "Stable digits", asked.digits),
        Entry(
            "for", "Of these forecasts", json.dumps(asked.forecasts, ensure_ascii=False) if asked.forecasts else None
        ),
        Entry("time_limit", "Seconds at most", asked.seconds),
        Entry("rare", "Search for rare trials", asked.rare),
    )
    return Section("settings", "Settings", entries)


def recorded_settings(record: Record) -> Settings:
    """The settings of a recorded run.

    Raises:
        KeyError: the record does not hold them.
        WorkbookError: they are none, or the run was computed in float32.
    """
    section = {entry.key: entry.value for entry in record.section("settings").entries}
    if section.get("arithmetic", FLOAT64) != FLOAT64:
        software = {entry.key: entry.value for entry in record.section("software").entries}
        raise in_float32(str(software.get("xlmc", "")))
    try:
        return Settings(
            trials=_whole(section["trials"]),
            seed=int(str(section["seed"])),
            sampling=str(section["sampling"]),
            engine=str(section["engine"]),
            lognorm=str(section["lognorm"] or ""),
            stopping=_stopping(section),
        )
    except (TypeError, ValueError, XlmcError) as error:
        hint = "The record was edited: use a copy of the result workbook as xlmc wrote it"
        raise WorkbookError(f"the settings in the record cannot be read ({error})", hint=hint) from error


def _stopping(section: dict[str, Value]) -> Stopping:
    precision = None
    if section["precision"] is not None:
        numbers = tuple(str(section["precision_of"]).split(","))
        confidence = float(section["confidence"])  # type: ignore[arg-type]
        precision = Precision(float(section["precision"]), bool(section["relative"]), numbers, confidence)
    forecasts = tuple(str(name) for name in json.loads(str(section["for"] or "[]")))
    seconds = section["time_limit"]
    return Stopping(
        accepted=None if section["until_accepted"] is None else _whole(section["until_accepted"]),
        precision=precision,
        digits=None if section["adaptive"] is None else _whole(section["adaptive"]),
        forecasts=forecasts,
        seconds=None if seconds is None else float(seconds),
        rare=None if section["rare"] is None else str(section["rare"]),
    )


def _whole(value: Value) -> int:
    if not isinstance(value, int | float) or value != int(value):
        raise ValueError(f"{value!r} is no whole number")
    return int(value)
