"""What differs between a record and a workbook as it is now."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeVar

from xlmc.replay.closeness import Closeness
from xlmc.results.record import Record, Value
from xlmc.results.record.recorded_cells import SAVED, content_text, definition_cells

if TYPE_CHECKING:
    from xlmc.address import Cell
    from xlmc.workbook.model import Workbook

__all__ = [
    "Change",
    "NumberChange",
    "cell_changes",
    "contents_now",
    "definition_changes",
    "environment_changes",
    "is_rewritten_number",
    "number_changes",
    "structure_changes",
]

_SAME: Final = 1e-12
"""How far numbers from another processor may be off, relative to them or to their standard deviation."""

_DEFINITIONS: Final = (
    ("assumptions", "assumption", ("name",), ("cell", "status", "distribution", "parameters", "cutoffs")),
    ("forecasts", "forecast", ("name",), ("cell", "range_share", "threshold")),
    ("filters", "filter", ("name",), ("cell", "limits")),
    ("checks", "check", ("name",), ("cell", "base")),
    ("correlations", "correlation", ("first", "second"), ("rank_correlation",)),
)
"""Section, what a row of it is, what names the row, and what a run depends on."""

_COUNTS: Final = ("trials", "accepted", "error_trials", "undecided", "invalid")
_COUNTED: Final = {"forecasts": ("trials",), "filters": ("rejected", "only", "errors"), "checks": ("tried", "failed")}
_STATISTICS: Final = ("mean", "standard_deviation", "low", "high")

_LATER: Final = "checks"
"""A section that records have where the workbook has such rows, and that older ones do not have at all."""

K = TypeVar("K", bound=Hashable)


@dataclass(frozen=True, slots=True)
class Change:
    """One thing that is not as it was.

    Attributes:
        kind: `cell`, `defined name`, `table`, `assumption`, `software` and so on.
        where: which one.
        old: what it was; None where the record does not have it, because a cell was blank or was not needed.
        new: what it is now; None where it is not there any more.
    """

    kind: str
    where: str
    old: str | None
    new: str | None


@dataclass(frozen=True, slots=True)
class NumberChange:
    """A number of the record that the repeat did not give to the last bit.

    Attributes:
        close: it did to 1e-12.
    """

    name: str
    recorded: float | None
    repeated: float | None
    close: bool


def contents_now(workbook: Workbook, recorded: Mapping[Cell, str]) -> dict[Cell, str]:
    """The recorded cells as they are now, needed or not, and those of the reserved tables."""
    saved = {cell for cell, text in recorded.items() if SAVED in text}
    cells = [*recorded, *sorted(definition_cells(workbook) - recorded.keys())]
    found = {cell: content_text(workbook, cell, saved) for cell in cells if workbook.sheet_of(cell) is not None}
    return {cell: text for cell, text in found.items() if text}


def cell_changes(recorded: Mapping[Cell, str], found: Mapping[Cell, str]) -> list[Change]:
    """The cells that hold something else than they did."""
    return list(_differing("cell", recorded, found))


def is_rewritten_number(change: Change) -> bool:
    """Whether a cell holds the number that it did, as a program writes it that keeps 15 digits."""
    try:
        old, new = float(change.old or ""), float(change.new or "")
    except ValueError:
        return False
    return change.kind == "cell" and Closeness(rewritten=True).equal(new, old)


def structure_changes(recorded: Record, found: Record) -> list[Change]:
    """The names and tables that mean something else than they did."""
    old, new = (
        {(str(row["what"]), str(row["name"])): str(row["means"]) for row in record.rows("structure")}
        for record in (recorded, found)
    )
    return [
        Change(what, name, old.get((what, name)), new.get((what, name)))
        for what, name in dict.fromkeys((*old, *new))
        if old.get((what, name)) != new.get((what, name))
    ]


def definition_changes(recorded: Record, found: Record) -> list[Change]:
    """The definitions that are not as they were."""
    changes: list[Change] = []
    for section, kind, naming, keys in _DEFINITIONS:
        old, new = (_rows(record, section, naming) for record in (recorded, found))
        for name in dict.fromkeys((*old, *new)):
            if name not in old or name not in new:
                changes.append(Change(kind, name, *(_presence(name in rows) for rows in (old, new))))
                continue
            for key in keys:
                label = f"{name}, {key.replace('_', ' ')}"
                changes += _differing(kind, {label: _text(old[name].get(key))}, {label: _text(new[name].get(key))})
    return changes


def environment_changes(recorded: Record, found: Record) -> list[Change]:
    """The versions and the processor that are not as they were."""
    changes: list[Change] = []
    for section in ("software", "processor"):
        old, new = (
            {entry.key: _text(entry.value) for entry in record.section(section).entries} for record in (recorded, found)
        )
        changes += _differing(section, old, new)
    return changes


def number_changes(recorded: Record, found: Record) -> list[NumberChange]:
    """The recorded numbers that the repeat did not give to the last bit."""
    changes = [
        _number(f"trials: {key.replace('_', ' ')}", recorded[f"counts.{key}"], found[f"counts.{key}"], 0.0)
        for key in _COUNTS
    ]
    for section in ("filters", "forecasts", "checks"):
        old, new = (_rows(record, section, ("name",)) for record in (recorded, found))
        for name in (name for name in old if name in new):
            scale = _as_number(new[name].get("standard_deviation")) or 0.0
            counted, measured = _COUNTED[section], _STATISTICS if section == "forecasts" else ()
            changes += [
                _number(
                    f"{name}: {key.replace('_', ' ')}",
                    old[name].get(key),
                    new[name].get(key),
                    0.0 if key in counted else _SAME,
                    scale,
                )
                for key in (*counted, *measured)
            ]
    return [change for change in changes if change.recorded != change.repeated]


def _number(name: str, old: Value, new: Value, tolerance: float, scale: float = 0.0) -> NumberChange:
    recorded, repeated = _as_number(old), _as_number(new)
    close = recorded == repeated
    if recorded is not None and repeated is not None:
        close = abs(recorded - repeated) <= tolerance * max(abs(repeated), scale)
    return NumberChange(name, recorded, repeated, close)


def _as_number(value: Value) -> float | None:
    return value if isinstance(value, int | float) else None


def _rows(record: Record, section: str, naming: Sequence[str]) -> dict[str, dict[str, Value]]:
    if section not in record and section == _LATER:
        return {}
    return {" and ".join(str(row[key]) for key in naming): row for row in record.rows(section)}


def _differing(kind: str, old: Mapping[K, str], new: Mapping[K, str]) -> Iterator[Change]:
    for key in dict.fromkeys((*old, *new)):
        if old.get(key) != new.get(key):
            yield Change(kind, str(key), old.get(key), new.get(key))


def _presence(there: bool) -> str | None:
    return "defined" if there else None


def _text(value: Value) -> str:
    """A value as the record shows it; a text and a number that look alike are one."""
    if isinstance(value, float) and value.is_integer():
        return str(int(value))
    return "" if value is None else str(value)
