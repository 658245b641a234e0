"""What the window has changed, in words."""

from __future__ import annotations

from typing import Final, TypeAlias

from xlmc.analysis.results.statements.in_words import given_text
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import (
    Assumption,
    Decision,
    Definitions,
    Filter,
    Forecast,
    Parameter,
    Solve,
)
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.outputs.live.adjustments import BAND, LIMITS, MEASURED, SOLVED, STATED, Adjustments, Amount, own_values
from xlmc.outputs.live.kinds import KINDS

__all__ = ["changed_text", "in_words"]

Formed: TypeAlias = Assumption | Filter | Forecast | Decision | Solve
"""A row that says how its numbers are written."""

_HEADINGS_OF_KINDS: Final = {spec.key: spec.heading for kind in KINDS for spec in FAMILIES[kind].parameters}


def in_words(definitions: Definitions, adjustments: Adjustments) -> list[str]:
    """Say what differs, a phrase each: `friction: High 0.75 → 0.85`; also of what the workbook no longer has."""
    result = []
    for of, name, key, value in adjustments.each():
        own = own_values(definitions, of, name, adjustments.kind(of, name))
        if key in own:
            label = changed_text(definitions, of, name, key, own[key], value)
        else:
            number = _amount_text(key, value)
            label = f"{LIMITS.get(key, key.replace('_', ' '))} {number} (no longer in the workbook)"
        result.append(f"{name}: {label}")
    return result


def changed_text(
    definitions: Definitions, of: str, name: str, key: str, before: Parameter | bool | str | None, after: Amount
) -> str:
    """Write a change: `High 0.75 → 0.85`, `frozen`, `at least 0 → 0.1`."""
    if key == "frozen":
        return "frozen" if after else "not frozen"
    if key == "used":
        return "used" if after else "not used"
    if of == "correlation":
        heading = "correlation"
    elif of in ("decision", "solve"):
        heading = {"value": "value", **SOLVED}[key]
    elif of != "assumption":
        heading = {**LIMITS, **MEASURED, **STATED}[key]
    elif key in BAND:
        heading = "band from" if key == "band_low" else "band to"
        return f"{heading} {_amount_text(key, after)} %"
    elif key in ("base", "kind"):
        heading = {"base": "value", "kind": "kind"}[key]
    else:
        assumption = next(each for each in definitions.assumptions if each.name == name)
        heading = {**_HEADINGS_OF_KINDS, **assumption.headings}[key]
    choices = next((each for each in definitions.decisions if of == "decision" and each.name == name), None)
    if choices is not None and choices.contents:
        old = "another" if before is None else choices.shown(float(before))  # type: ignore[arg-type]  # its value
        return f"{heading} {old} → {choices.shown(float(after))}"
    row = next((each for each in _rows_with_forms(definitions, of) if each.name == name), None)
    old, new = ("none" if value is None else _amount_text(key, value, row) for value in (before, after))
    return f"{heading} {old} → {new}"


def _rows_with_forms(definitions: Definitions, of: str) -> tuple[Formed, ...]:
    """Return the rows of a kind that say how their numbers are written."""
    match of:
        case "assumption":
            return definitions.assumptions
        case "filter":
            return (*definitions.filters, *definitions.forecast_filters, *definitions.unused)
        case "forecast":
            return definitions.forecasts
        case "decision":
            return definitions.decisions
        case "solve":
            return definitions.solves
    return ()


def _amount_text(key: str, value: Parameter | Amount, row: Formed | None = None) -> str:
    """Write a value: `0.75`, `51 %`; `none` for what is taken away; `on` and `off` of a switch; of a row with dates,
    percentages or money as its cell shows it.
    """
    if isinstance(value, bool):
        return ("off", "on")[value]
    if isinstance(value, str):
        return value
    if isinstance(value, Cell) or row is None:
        return f"{given_text(value)} %" if key == "central" else given_text(value)
    if isinstance(row, Assumption):
        return row.form_of(key, value).number(value)
    if isinstance(row, Solve):
        return given_text(value, row.form_of(key))
    if key == "central":
        return f"{given_text(value)} %"
    return row.form.number(value) if key in (*LIMITS, "reading", "value", "threshold") else given_text(value)
