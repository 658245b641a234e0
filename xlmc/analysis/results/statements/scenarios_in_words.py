"""What scenarios change, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, TypeAlias

from xlmc.analysis.results.statements.in_words import given_text
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Definitions, Filter, Forecast
from xlmc.montecarlo.definitions.evidence import SIZES, Evidence
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.scenarios import (
    Band,
    Change,
    Correlated,
    Drawn,
    Frozen,
    Limits,
    Measured,
    Numbers,
    Range,
    Redrawn,
    Scenario,
    Stated,
    Switched,
    Tabulated,
    Typed,
)
from xlmc.montecarlo.distributions.parameters import show
from xlmc.montecarlo.distributions.spelling import name_key, plain
from xlmc.montecarlo.model.cell_forms import content_in

__all__ = ["changes_text"]

Formed: TypeAlias = Assumption | Filter | Evidence | Forecast
"""A row that says how its numbers are written."""

_VALUE: Final = "low"
"""The key of a number that is a value of the quantity itself."""
_CENTRAL: Final = "central"
"""The key of a forecast's central range, in percent."""
_NOT_IN_UNITS: Final = {**SIZES, _CENTRAL: "Range %", "report_to": "Report to"}
"""Key of a number of evidence or of a forecast that is not in the units of its cell -> its heading."""


def changes_text(scenario: Scenario, definitions: Definitions) -> str:
    """Say what a scenario changes: `Friction from 0.6 to 0.8; Restitution at most 0.5; Inputs!D28 = -20`.

    Args:
        scenario: the changes.
        definitions: of the workbook, whose assumptions and filters say how their numbers are written.
    """
    return "; ".join(_change_text(each, definitions) for each in scenario.changes) or "nothing"


def _change_text(change: Change, definitions: Definitions) -> str:
    match change:
        case Frozen(name, value):
            return f"{name} {'frozen' if value is None else f'= {_number_of(definitions, name, _VALUE, value)}'}"
        case Drawn(name):
            return f"{name} drawn"
        case Range(name, low, high):
            ends = [("from", low), ("to", high)] if None not in (low, high) else [("at least", low), ("at most", high)]
            result = (f"{word} {_number_of(definitions, name, _VALUE, end)}" for word, end in ends if end is not None)
            return " ".join([name, *result])
        case Band(name, low, high):
            return f"{name} from P{show(low)} to P{show(high)}"
        case Numbers(name, values) | Limits(name, values) | Measured(name, values) | Stated(name, values):
            words = (
                f"{key.replace('_', ' ')} {_number_of(definitions, name, key, value)}{' %' * (key == _CENTRAL)}"
                for key, value in values.items()
                if value is not None
            )
            return f"{name} {' and '.join(words) or 'without ' + ', '.join(key.replace('_', ' ') for key in values)}"
        case Switched(name, used):
            return f"{name} {'used' if used else 'not used'}"
        case Correlated(first, second, value):
            return f"correlation of {first} and {second} {given_text(value)}"
        case Redrawn(name, distribution):
            return f"{name} {distribution!r}"
        case Tabulated(number, values):
            return f"value {number} of RiskSimtable: {values}"
        case Typed(cell, value, _, named, of, form):
            if of is not None and isinstance(value, float):
                return f"{named} = {_number_in_row(definitions, *of, value)}"
            return f"{named or cell} = {content_in(form, value) or 'nothing'}"


def _number_in_row(definitions: Definitions, kind: str, name: str, heading: str, value: float) -> str:
    """Write a number of a table's row, such as the High of an assumption or a limit of a filter."""
    key = _VALUE if plain(heading) == "value" else ""
    rows: Mapping[str, Sequence[Formed]] = {
        "xlmc_assumptions": definitions.assumptions,
        "xlmc_filters": (*definitions.filters, *definitions.forecast_filters),
        "xlmc_forecasts": definitions.forecasts,
        "xlmc_evidence": definitions.evidence,
    }
    row = next((each for each in rows.get(kind, ()) if name_key(each.name) == name), None)
    if not isinstance(row, Assumption):
        key = next((each for each, written in _NOT_IN_UNITS.items() if plain(heading) == plain(written)), key)
    else:
        headings = {spec.key: spec.headings for spec in row.family.parameters}
        headings |= {key: (written,) for key, written in CUTOFFS.items()}
        key = next((each for each, those in headings.items() if plain(heading) in map(plain, those)), key)
    return given_text(value) if row is None else _form_in(row, key, value).number(value)


def _number_of(definitions: Definitions, name: str, key: str, value: float) -> str:
    """Write a number of an assumption, a filter, evidence or a forecast by its key."""
    filters = (*definitions.filters, *definitions.forecast_filters, *definitions.unused)
    rows: tuple[Formed, ...] = (*definitions.assumptions, *filters, *definitions.evidence, *definitions.forecasts)
    row = next((each for each in rows if each.name == name), None)
    return given_text(value) if row is None else _form_in(row, key, value).number(value)


def _form_in(row: Formed, key: str, value: float) -> Form:
    if isinstance(row, Assumption):
        return row.form_of(key, value)
    return PLAIN if key in _NOT_IN_UNITS else row.form
