"""What differs between a record and a workbook as it is now, and how far two values may be apart to count as one."""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_DOWN, ROUND_HALF_EVEN, ROUND_HALF_UP, Context, Decimal
from typing import TYPE_CHECKING, Final, TypeGuard, TypeVar

from xlmc.analysis.results.record import Record, Value
from xlmc.analysis.results.record.needed_cells import SAVED, TABULATED, content_text, definition_cells
from xlmc.excel.workbook.workbook import CellValue

if TYPE_CHECKING:
    from xlmc.excel.address import Cell
    from xlmc.excel.workbook.workbook import Workbook

__all__ = [
    "Change",
    "Closeness",
    "NumberChange",
    "cell_changes",
    "contents_now",
    "definition_changes",
    "environment_changes",
    "is_emptied_text",
    "is_number",
    "is_rewritten_number",
    "number_changes",
    "same_definition",
    "structure_changes",
]

_ROUNDING: Final = 1e-12
"""How far numbers from another processor may be off, relative to them, their row or their standard deviation."""

_OTHER_PROGRAM: Final = 1e-9
"""How far another program's value of a formula may differ, relative to it."""

_DEFINITIONS: Final = (
    ("assumptions", "assumption", ("name",), ("cell", "status", "distribution", "parameters", "cutoffs")),
    ("forecasts", "forecast", ("name",), ("cell", "range_share", "threshold", "report_to", "kind", "role")),
    ("filters", "filter", ("name",), ("cell", "limits")),
    ("forecast_filters", "filter", ("name", "only_for"), ("cell", "limits")),
    ("checks", "check", ("name",), ("cell", "base")),
    ("decisions", "decision", ("name",), ("cell", "value", "may be")),
    ("solves", "solution", ("name",), ("cell", "to", "by", "low", "high", "root")),
    ("correlations", "correlation", ("first", "second"), ("rank_correlation",)),
)
"""Section, what a row of it is, what names the row, and what a run depends on."""

_COUNTS: Final = ("trials", "accepted", "error_trials", "undecided", "invalid")
_COUNTED: Final = {
    "forecasts": ("trials",),
    "filters": ("rejected", "only", "errors"),
    "forecast_filters": ("discarded",),
    "checks": ("tried", "failed"),
}
_STATISTICS: Final = ("mean", "standard_deviation", "low", "high")

_LATER: Final = ("checks", "forecast_filters", "decisions", "solves")
"""Sections that records have where the workbook has such rows, and that older ones do not have at all."""

_NUMBER: Final = re.compile(
    r"(?<![\w.!:])(?P<sign>-?)[$€£]?\s?(?P<digits>\d{1,3}(?:,\d{3})+(?:\.\d+)?|\d+(?:\.\d+)?)"
    r"(?P<percent>\s?%)?(?:\s?[$€£])?(?![\w.!:])"
)
"""A number of a text as people read it; no part of an address, of a date or of a power of ten."""

K = TypeVar("K", bound=Hashable)


@dataclass(frozen=True, slots=True)
class Closeness:
    """How far numbers may be apart.

    Attributes:
        rewritten: another program has saved the file; some write only 15 digits, and other line ends.
        elsewhere: the run was made with other software or on another processor, which may round differently.
    """

    rewritten: bool = False
    elsewhere: bool = False

    def equal(self, says: CellValue, gives: CellValue, scale: float = 0.0, *, computed: bool = False) -> bool:
        """Whether a value is the one the run gives.

        Args:
            says: what the file holds.
            gives: what the run gives.
            scale: the largest number beside it, from which it may have been computed.
            computed: the file holds a formula, whose value another program may have computed again.
        """
        if is_number(says) and is_number(gives):
            apart = abs(says - gives)
            if apart <= self._apart(max(abs(says), abs(gives)), scale, computed):
                return True
            return self.rewritten and float(says) in _with_fewer_digits(gives)
        if self.rewritten and isinstance(says, str) and isinstance(gives, str):
            return says.splitlines() == gives.splitlines()
        return type(says) is type(gives) and says == gives

    def _apart(self, size: float, scale: float, computed: bool) -> float:
        """How far two numbers of this size may be apart."""
        rewritten = _OTHER_PROGRAM * size if self.rewritten and computed else 0.0
        return max(rewritten, _ROUNDING * max(size, scale) if self.elsewhere else 0.0)


def _with_fewer_digits(number: float) -> set[float]:
    """Yield the number as programs write it: 15 or 16 digits of its shortest or its exact decimal, rounded or
    cut off.
    """
    shortest, exact = Decimal(repr(float(number))), Decimal(float(number))
    rules = [(15, ROUND_DOWN), *((digits, rule) for digits in (15, 16) for rule in (ROUND_HALF_UP, ROUND_HALF_EVEN))]
    return {
        float(Context(prec=digits, rounding=rule).plus(whole)) for digits, rule in rules for whole in (shortest, exact)
    }


def is_number(value: CellValue) -> TypeGuard[int | float]:
    """Whether a value is a number, and not a logical."""
    return isinstance(value, int | float) and not isinstance(value, bool)


@dataclass(frozen=True, slots=True)
class Change:
    """One thing that is not as it was.

    Attributes:
        kind: `cell`, `defined name`, `table`, `assumption`, `software` and so on.
        where: which one.
        old: what it was; None if the record does not have it, because a cell was blank or was not needed.
        new: what it is now; None if it is not there any more.
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
    """Return the recorded cells as they are now, needed or not, and those of the reserved tables."""
    saved = {cell for cell, text in recorded.items() if SAVED in text}
    tabulated = {cell for cell, text in recorded.items() if text.startswith(TABULATED)}
    cells = [*recorded, *sorted(definition_cells(workbook) - recorded.keys())]
    result = {
        cell: content_text(workbook, cell, saved, tabulated) for cell in cells if workbook.sheet_of(cell) is not None
    }
    return {cell: text for cell, text in result.items() if text}


def cell_changes(recorded: Mapping[Cell, str], result: Mapping[Cell, str]) -> list[Change]:
    """Return the cells that hold something else than they did."""
    return list(_differing("cell", recorded, result))


def is_rewritten_number(change: Change) -> bool:
    """Whether a cell holds the number that it did, as a program writes it that keeps 15 digits."""
    try:
        old, new = float(change.old or ""), float(change.new or "")
    except ValueError:
        return False
    return change.kind == "cell" and Closeness(rewritten=True).equal(new, old)


def is_emptied_text(change: Change) -> bool:
    """Whether a cell that held a text without a character is blank, as openpyxl and LibreOffice save it."""
    return change.kind == "cell" and change.old == '""' and change.new is None


def structure_changes(recorded: Record, result: Record) -> list[Change]:
    """Return the names and tables that mean something else than they did."""
    old, new = (
        {(str(row["what"]), str(row["name"])): str(row["means"]) for row in record.rows("structure")}
        for record in (recorded, result)
    )
    return [
        Change(what, name, old.get((what, name)), new.get((what, name)))
        for what, name in dict.fromkeys((*old, *new))
        if old.get((what, name)) != new.get((what, name))
    ]


def definition_changes(recorded: Record, result: Record) -> list[Change]:
    """Return the definitions that are not as they were."""
    changes: list[Change] = []
    for section, kind, naming, keys in _DEFINITIONS:
        old, new = (_rows(record, section, naming) for record in (recorded, result))
        for name in dict.fromkeys((*old, *new)):
            if name not in old or name not in new:
                changes.append(Change(kind, name, *(_presence(name in rows) for rows in (old, new))))
                continue
            for key in keys:
                label = f"{name}, {key.replace('_', ' ')}"
                was, now = _text(old[name].get(key)), _text(new[name].get(key))
                if not same_definition(was, now):
                    changes += _differing(kind, {label: was}, {label: now})
    return changes


def same_definition(was: str, now: str) -> bool:
    """Tell whether two texts of a definition differ at most in how their numbers are written.

    Versions before 0.12.0 wrote `Low 0.1` where a cell shows `10 %`, and left out thousands separators and currencies.
    """
    return _NUMBER.sub(_without_form, was) == _NUMBER.sub(_without_form, now)


def _without_form(match: re.Match[str]) -> str:
    number = Decimal(match["digits"].replace(",", ""))
    return f"{match['sign']}{(number / 100 if match['percent'] else number).normalize():f}"


def environment_changes(recorded: Record, result: Record) -> list[Change]:
    """Return the versions and the processor that are not as they were."""
    changes: list[Change] = []
    for section in ("software", "processor"):
        old, new = (
            {entry.key: _text(entry.value) for entry in record.section(section).entries}
            for record in (recorded, result)
        )
        changes += _differing(section, old, new)
    return changes


def number_changes(recorded: Record, result: Record) -> list[NumberChange]:
    """Return the recorded numbers that the repeat did not give to the last bit."""
    changes = [
        _number(f"trials: {key.replace('_', ' ')}", recorded[f"counts.{key}"], result[f"counts.{key}"], 0.0)
        for key in _COUNTS
    ]
    for section in ("filters", "forecast_filters", "forecasts", "checks"):
        naming = ("name", "only_for") if section == "forecast_filters" else ("name",)
        old, new = (_rows(record, section, naming) for record in (recorded, result))
        for name in (name for name in old if name in new):
            scale = _as_number(new[name].get("standard_deviation")) or 0.0
            counted, measured = _COUNTED[section], _STATISTICS if section == "forecasts" else ()
            changes += [
                _number(
                    f"{name}: {key.replace('_', ' ')}",
                    old[name].get(key),
                    new[name].get(key),
                    0.0 if key in counted else _ROUNDING,
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
    if section not in record and section in _LATER:
        return {}
    return {" and ".join(str(row[key]) for key in naming): row for row in record.rows(section)}


def _differing(kind: str, old: Mapping[K, str], new: Mapping[K, str]) -> Iterator[Change]:
    for key in dict.fromkeys((*old, *new)):
        if old.get(key) != new.get(key):
            yield Change(kind, str(key), old.get(key), new.get(key))


def _presence(there: bool) -> str | None:
    return "defined" if there else None


def _text(value: Value) -> str:
    """Write a value as the record shows it; a text and a number that look alike are the same."""
    if isinstance(value, float) and value.is_integer():
        return str(int(value))
    return "" if value is None else str(value)
