"""What was changed in the window, beside the workbook: numbers of its rows, and switches.

Keys of an assumption are those of its parameters and cutoffs, `base` for the value that it is held at, `frozen`, those
of a band of its distribution that it is confined to, and `kind`, the name of its distribution, whose numbers it then
has; keys of a filter are those of its limits, of a row of evidence its `reading` and those of its error, and of both
`used`; keys of a forecast are its `threshold` and `central`, its central range in percent. A decision has its `value`,
the number in its cell; a cell that is solved for has what is typed of `to`, `low` and `high`. A limit, cutoff or
threshold that is `NONE` is taken away.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from xlmc.montecarlo.definitions.definitions import (
    CUTOFFS,
    Assumption,
    Correlation,
    Definitions,
    Filter,
    Forecast,
    Parameter,
)
from xlmc.montecarlo.definitions.evidence import SIZES, Evidence
from xlmc.outputs.live.kinds import KINDS, in_kind, kinds_of

__all__ = [
    "BAND",
    "LIMITS",
    "MEASURED",
    "NONE",
    "PARTS",
    "REMOVABLE",
    "SOLVED",
    "STATED",
    "SWITCHES",
    "Adjustments",
    "Amount",
    "Changed",
    "assumption_numbers",
    "is_choice",
    "is_own",
    "measured_numbers",
    "movable_limits",
    "numbers_of",
    "own_values",
    "pairs_of",
]

LIMITS: Final = {"at_least": "at least", "above": "above", "at_most": "at most", "below": "below"}
"""Key of a filter's limit -> how it is read."""

BAND: Final = {"band_low": 0.0, "band_high": 100.0}
"""Key of each end of a band of a distribution, in percent -> where it is with no band."""

SWITCHES: Final = frozenset({"frozen", "used"})
"""Keys whose values are yes or no."""

MEASURED: Final = {"reading": "reading", **{key: heading.lower() for key, heading in SIZES.items()}}
"""Key of a number of evidence -> how it is read."""

STATED: Final = {"threshold": "threshold", "central": "central range"}
"""Key of how a forecast is stated -> how it is read."""

SOLVED: Final = {"to": "To", "low": "Low", "high": "High"}
"""Key of a number of a cell that is solved for -> its heading."""

NONE: Final = "none"
"""The value of what is taken away."""

REMOVABLE: Final = frozenset({*LIMITS, *CUTOFFS, "threshold"})
"""Keys of what can be taken away."""

PARTS: Final = {
    "assumption": "assumptions",
    "filter": "filters",
    "forecast": "forecasts",
    "correlation": "correlations",
    "decision": "decisions",
    "solve": "solves",
}
"""Kind of row -> the field of `Adjustments` that holds its changes."""

Amount = float | bool | str
"""A number, a switch, `NONE`, or a kind of distribution."""

Changed = Mapping[str, Mapping[str, Amount]]
"""Name -> key -> value."""


@dataclass(frozen=True, slots=True)
class Adjustments:
    """All that differs from the workbook; nothing in it is as in the workbook."""

    assumptions: Changed = field(default_factory=dict)
    filters: Changed = field(default_factory=dict)
    forecasts: Changed = field(default_factory=dict)
    correlations: Changed = field(default_factory=dict)
    decisions: Changed = field(default_factory=dict)
    solves: Changed = field(default_factory=dict)

    def __bool__(self) -> bool:
        return any(self._part(of) for of in PARTS)

    def having(self, of: str, name: str, key: str, value: Amount | None) -> Adjustments:
        """Return the adjustments with one value set; None sets it back to the workbook's."""
        before = self._part(of)
        own = {k: v for k, v in before.get(name, {}).items() if k != key}
        if value is not None:
            own[key] = value
        return self._with(of, name, own)

    def without(self, of: str, name: str) -> Adjustments:
        """Return the adjustments with one row set back to the workbook's."""
        return self._with(of, name, {})

    def only(self, definitions: Definitions) -> Adjustments:
        """Return what still differs from a workbook that was changed meanwhile: nothing of rows that it no longer has,
        and of values that it now has itself.
        """
        adjustments = Adjustments()
        for of, name, key, value in self.each():
            own = own_values(definitions, of, name, self.kind(of, name))
            if key in own and not is_own(value, own[key]) and is_choice(definitions, of, name, value):
                adjustments = adjustments.having(of, name, key, value)
        return adjustments

    def kind(self, of: str, name: str) -> str | None:
        """Return the kind of distribution that an assumption was given; None for the workbook's."""
        result = self.assumptions.get(name, {}).get("kind") if of == "assumption" else None
        return result if isinstance(result, str) else None

    def in_kind(self, name: str, kind: str | None) -> Adjustments:
        """Return the adjustments with an assumption in another kind, whose numbers suit it; None for its own."""
        kept = {key: value for key, value in self.assumptions.get(name, {}).items() if key in ("base", "frozen", *BAND)}
        return self._with("assumption", name, kept if kind is None else {"kind": kind, **kept})

    def frozen_part(self, definitions: Definitions) -> Adjustments:
        """Return the part that says what is held and where, and which rows are used; nothing that has no effect."""
        adjustments = Adjustments()
        for name, (_, used) in definitions.switches.items():
            if self.filters.get(name, {}).get("used", used) != used:
                adjustments = adjustments.having("filter", name, "used", not used)
        for assumption in definitions.assumptions:
            given = self.assumptions.get(assumption.name, {})
            frozen = given.get("frozen", assumption.frozen)
            if frozen != assumption.frozen:
                adjustments = adjustments.having("assumption", assumption.name, "frozen", frozen)
            if frozen and "base" in given:
                adjustments = adjustments.having("assumption", assumption.name, "base", given["base"])
        return adjustments

    def typed_part(self) -> Adjustments:
        """Return the part that is typed into cells before anything else is changed."""
        return Adjustments(decisions=self.decisions, solves=self.solves)

    def untyped_part(self) -> Adjustments:
        """Return all but that part."""
        return replace(self, decisions={}, solves={})

    def numbers(self, definitions: Definitions) -> Adjustments:
        """Return the rest: numbers of what is drawn, of filters that are used, of forecasts and of correlations."""
        adjustments = Adjustments(forecasts=self.forecasts, correlations=self.correlations)
        for name, given in self.filters.items():
            if given.get("used", definitions.is_used(name)):
                adjustments = adjustments._with(
                    "filter", name, {key: value for key, value in given.items() if key != "used"}
                )
        for assumption in definitions.assumptions if self.assumptions else ():
            moved = self.assumptions.get(assumption.name)
            if moved and not moved.get("frozen", assumption.frozen):
                own = {key: value for key, value in moved.items() if key not in ("frozen", "base")}
                adjustments = adjustments._with("assumption", assumption.name, own)
        return adjustments

    def as_json(self) -> dict[str, Any]:
        """Return plain values, which `of_json` reads back."""
        return {part: {name: dict(each) for name, each in self._part(of).items()} for of, part in PARTS.items()}

    @classmethod
    def of_json(cls, result: Mapping[str, Any]) -> Adjustments:
        """Read what `as_json` returned.

        Raises:
            ValueError, TypeError, AttributeError, KeyError, OverflowError: it is something else.
        """
        made = cls()
        for of, part in PARTS.items():
            rows = result[part] if of in ("assumption", "filter") else result.get(part, {})  # new in 0.12.0
            for name, each in rows.items():
                for key, value in each.items():
                    made = made.having(of, str(name), str(key), _amount(str(key), value))
        return made

    def _part(self, of: str) -> Changed:
        result: Changed = getattr(self, PARTS[of])
        return result

    def _with(self, of: str, name: str, own: Mapping[str, Amount]) -> Adjustments:
        part = {other: each for other, each in self._part(of).items() if other != name}
        if own:
            part[name] = own
        return replace(self, **{PARTS[of]: part})

    def each(self) -> Iterator[tuple[str, str, str, Amount]]:
        """Yield the kind of row, its name, the key and the value of each change."""
        for of in PARTS:
            for name, each in self._part(of).items():
                for key, value in each.items():
                    yield of, name, key, value


def _amount(key: str, value: object) -> Amount:
    """Return a value that was read from a file.

    Raises:
        ValueError, TypeError, OverflowError: it is none.
    """
    if isinstance(value, bool):
        return value
    if value == NONE and key in REMOVABLE:
        return NONE
    if key == "kind":
        if value not in KINDS:
            raise ValueError(f"there is no kind {value!r}")
        return str(value)
    number = float(value)  # type: ignore[arg-type]  # whatever it is
    if not math.isfinite(number):
        raise ValueError(f"{key} is {number}")
    return number


def is_choice(definitions: Definitions, of: str, name: str, value: Amount | None) -> bool:
    """Return whether a row may have a value: of a decision among texts, only these."""
    if of != "decision" or value is None:
        return True
    return all(not each.contents or value in each.values for each in definitions.decisions if each.name == name)


def is_own(value: Amount, own: Parameter | bool | str | None) -> bool:
    """Return whether a value is what the workbook says."""
    return value == own or (value == NONE and own is None)


def assumption_numbers(assumption: Assumption) -> dict[str, tuple[str, Parameter]]:
    """Return key of each parameter and cutoff that is given -> its heading and its value."""
    return {key: (heading, assumption.given[key]) for key, heading in assumption.headings.items()}


def own_values(
    definitions: Definitions, of: str, name: str, kind: str | None = None
) -> dict[str, Parameter | bool | str | None]:
    """Return what can be set of a row, as the workbook has it; nothing of a name that it does not have.

    Of an assumption in another `kind` these are the numbers that suit it.
    """
    if of == "filter":
        rows = (*definitions.filters, *definitions.forecast_filters, *definitions.unused)
        filter_ = next((each for each in rows if each.name == name), None)
        evidence = next((each for each in definitions.evidence if each.name == name), None)
        switch = {"used": definitions.is_used(name)} if name in definitions.switches else {}
        numbers = {} if evidence is None else measured_numbers(evidence)
        return {**numbers, **({} if filter_ is None else movable_limits(filter_)), **switch}
    if of == "correlation":
        pair = pairs_of(definitions).get(name)
        return {} if pair is None else {"correlation": pair.value}
    if of == "decision":
        decision = next((each for each in definitions.decisions if each.name == name), None)
        return {} if decision is None else {"value": decision.base}
    if of == "solve":
        solve = next((each for each in definitions.solves if each.name == name), None)
        return {} if solve is None else {key: getattr(solve, key) for key in solve.typed}
    if of == "forecast":
        forecast = next((each for each in definitions.forecasts if each.name == name), None)
        return {} if forecast is None else {"threshold": forecast.threshold, "central": _percent(forecast)}
    assumption = next((each for each in definitions.assumptions if each.name == name), None)
    if assumption is None:
        return {}
    own_kind = {"kind": assumption.distribution} if kinds_of(assumption) else {}
    if kind is not None:
        assumption = in_kind(assumption, kind)
    numbers = {key: value for key, (_, value) in assumption_numbers(assumption).items()}
    return {**own_kind, **numbers, **BAND, "base": assumption.base, "frozen": assumption.frozen}


def pairs_of(definitions: Definitions) -> dict[str, Correlation]:
    """Return the correlations of the workbook, each by the names of its two assumptions."""
    return {f"{each.first} and {each.second}": each for each in definitions.correlations}


def movable_limits(filter_: Filter) -> dict[str, Parameter]:
    """Return the limits of a filter; none of evidence, whose reading and error say what it keeps."""
    limits = {} if filter_.evidence is not None else {key: getattr(filter_, key) for key in LIMITS}
    return {key: value for key, value in limits.items() if value is not None}


def measured_numbers(evidence: Evidence) -> dict[str, Parameter]:
    """Return the reading of evidence and the numbers of its error, of those that are given."""
    reading = {} if evidence.reading is None else {"reading": evidence.reading}
    return {**reading, **{key: evidence.sizes[key] for key in SIZES if key in evidence.sizes}}


def _percent(forecast: Forecast) -> float:
    """Return the central range of a forecast, in percent."""
    return float(f"{100.0 * forecast.central:.12g}")


def numbers_of(given: Mapping[str, Amount]) -> dict[str, float | None]:
    """Return key -> number; None for what is taken away."""
    return {key: None if value == NONE else float(value) for key, value in given.items()}
