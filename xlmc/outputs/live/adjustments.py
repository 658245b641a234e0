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
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Final

from xlmc.analysis.results.statements.in_words import given_text, plain_text
from xlmc.errors import ErrorCode
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import (
    CUTOFFS,
    Assumption,
    Correlation,
    Decision,
    Definitions,
    Filter,
    Forecast,
    Parameter,
    Solve,
)
from xlmc.montecarlo.definitions.evidence import SIZES, USE_IS_OFF, Evidence
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
    Typed,
)
from xlmc.montecarlo.distributions import FAMILIES
from xlmc.montecarlo.distributions.spelling import name_key, plain
from xlmc.outputs.live.kinds import KINDS, distribution_in_kind, in_kind, kinds_of

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
    "adjusted_assumption",
    "adjusted_definitions",
    "adjustments_of",
    "assumption_numbers",
    "changes_of",
    "in_words",
    "is_choice",
    "is_own",
    "measured_numbers",
    "movable_limits",
    "own_values",
    "pairs_of",
    "scenario_of",
    "usual_variants",
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

_HEADINGS_OF_KINDS: Final = {spec.key: spec.heading for kind in KINDS for spec in FAMILIES[kind].parameters}

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
        found = Adjustments()
        for of, name, key, value in self._each():
            own = own_values(definitions, of, name, self.kind(of, name))
            if key in own and not is_own(value, own[key]) and is_choice(definitions, of, name, value):
                found = found.having(of, name, key, value)
        return found

    def kind(self, of: str, name: str) -> str | None:
        """Return the kind of distribution that an assumption was given; None for the workbook's."""
        found = self.assumptions.get(name, {}).get("kind") if of == "assumption" else None
        return found if isinstance(found, str) else None

    def in_kind(self, name: str, kind: str | None) -> Adjustments:
        """Return the adjustments with an assumption in another kind, whose numbers suit it; None for its own."""
        kept = {key: value for key, value in self.assumptions.get(name, {}).items() if key in ("base", "frozen", *BAND)}
        return self._with("assumption", name, kept if kind is None else {"kind": kind, **kept})

    def frozen_part(self, definitions: Definitions) -> Adjustments:
        """Return the part that says what is held and where, and which rows are used; nothing that has no effect."""
        found = Adjustments()
        for name, (_, used) in definitions.switches.items():
            if self.filters.get(name, {}).get("used", used) != used:
                found = found.having("filter", name, "used", not used)
        for assumption in definitions.assumptions:
            given = self.assumptions.get(assumption.name, {})
            frozen = given.get("frozen", assumption.frozen)
            if frozen != assumption.frozen:
                found = found.having("assumption", assumption.name, "frozen", frozen)
            if frozen and "base" in given:
                found = found.having("assumption", assumption.name, "base", given["base"])
        return found

    def typed_part(self) -> Adjustments:
        """Return the part that is typed into cells before anything else is changed."""
        return Adjustments(decisions=self.decisions, solves=self.solves)

    def untyped_part(self) -> Adjustments:
        """Return all but that part."""
        return replace(self, decisions={}, solves={})

    def numbers(self, definitions: Definitions) -> Adjustments:
        """Return the rest: numbers of what is drawn, of filters that are used, of forecasts and of correlations."""
        found = Adjustments(forecasts=self.forecasts, correlations=self.correlations)
        for name, given in self.filters.items():
            if given.get("used", definitions.is_used(name)):
                found = found._with("filter", name, {key: value for key, value in given.items() if key != "used"})
        for assumption in definitions.assumptions if self.assumptions else ():
            moved = self.assumptions.get(assumption.name)
            if moved and not moved.get("frozen", assumption.frozen):
                own = {key: value for key, value in moved.items() if key not in ("frozen", "base")}
                found = found._with("assumption", assumption.name, own)
        return found

    def as_json(self) -> dict[str, Any]:
        """Return plain values, which `of_json` reads back."""
        return {part: {name: dict(each) for name, each in self._part(of).items()} for of, part in PARTS.items()}

    @classmethod
    def of_json(cls, found: Mapping[str, Any]) -> Adjustments:
        """Read what `as_json` returned.

        Raises:
            ValueError, TypeError, AttributeError, KeyError, OverflowError: it is something else.
        """
        made = cls()
        for of, part in PARTS.items():
            rows = found[part] if of in ("assumption", "filter") else found.get(part, {})  # new in 0.12.0
            for name, each in rows.items():
                for key, value in each.items():
                    made = made.having(of, str(name), str(key), _amount(str(key), value))
        return made

    def _part(self, of: str) -> Changed:
        found: Changed = getattr(self, PARTS[of])
        return found

    def _with(self, of: str, name: str, own: Mapping[str, Amount]) -> Adjustments:
        part = {other: each for other, each in self._part(of).items() if other != name}
        if own:
            part[name] = own
        return replace(self, **{PARTS[of]: part})

    def _each(self) -> Iterator[tuple[str, str, str, Amount]]:
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


def changes_of(definitions: Definitions, adjustments: Adjustments) -> list[Change]:
    """Return what is to be changed in the workbook, without what has no effect, as a number of what is frozen."""
    found: list[Change] = []
    for assumption in definitions.assumptions:
        if moved := adjustments.assumptions.get(assumption.name):
            found += _of_assumption(assumption, dict(moved))
    for name, given in adjustments.filters.items():
        own = definitions.is_used(name)
        used = bool(given.get("used", own))
        numbers = {key: value for key, value in given.items() if key != "used"}
        if used != own:
            found.append(Switched(name, used))
        if used and numbers and MEASURED.keys() >= numbers.keys():
            found.append(Measured(name, {key: float(value) for key, value in numbers.items()}))
        elif used and numbers:
            found.append(Limits(name, _numbers(numbers)))
    pairs = pairs_of(definitions)
    for name, given in adjustments.correlations.items():
        if name in pairs and "correlation" in given:
            found.append(Correlated(pairs[name].first, pairs[name].second, float(given["correlation"])))
    found += [Stated(name, _numbers(given)) for name, given in adjustments.forecasts.items()]
    found += _typed(definitions, adjustments)
    return found


def _typed(definitions: Definitions, adjustments: Adjustments) -> Iterator[Typed]:
    """Return what is typed into the cells of decisions, and into the rows of cells that are solved for."""
    for decision in definitions.decisions:
        for value in adjustments.decisions.get(decision.name, {}).values():
            yield Typed(decision.cell, decision.content(float(value)), named=decision.name)
    for solve in definitions.solves:
        for key, value in adjustments.solves.get(solve.name, {}).items():
            if key in solve.typed:
                of = ("xlmc_solve", solve.name, SOLVED[key])
                yield Typed(solve.typed[key], float(value), named=f"{solve.name} {SOLVED[key]}", of=of)


def _numbers(given: Mapping[str, Amount]) -> dict[str, float | None]:
    """Return key -> number; None for what is taken away."""
    return {key: None if value == NONE else float(value) for key, value in given.items()}


def _of_assumption(assumption: Assumption, given: dict[str, Amount]) -> Iterator[Change]:
    name, base = assumption.name, given.pop("base", None)
    frozen = given.pop("frozen", assumption.frozen)
    if frozen:
        if base is not None or not assumption.frozen:
            yield Frozen(name, None if base is None else float(base))
        return
    if assumption.frozen:
        yield Drawn(name)
    low, high = (float(given.pop(key, end)) for key, end in BAND.items())
    kind = given.pop("kind", None)
    if kind in kinds_of(assumption) and kind != assumption.distribution:
        yield Redrawn(name, distribution_in_kind(assumption, str(kind)))
    if given:
        yield Numbers(name, _numbers(given))
    if (low, high) != (*BAND.values(),):
        yield Band(name, low, high)


def scenario_of(definitions: Definitions, name: str, adjustments: Adjustments) -> Scenario:
    """Return a state of the window as a scenario, such as the workbook's table `xlmc_scenarios` holds."""
    return Scenario(name, tuple(changes_of(definitions, adjustments)))


def adjustments_of(definitions: Definitions, scenario: Scenario) -> Adjustments | None:
    """Return a scenario of the workbook as a state of the window; None if the window has no handle for a change."""
    assumptions = {each.name: each for each in definitions.assumptions}
    found = Adjustments()
    kinds: dict[str, str] = {}
    typed = [_of_handle(definitions, each) for each in scenario.changes if isinstance(each, Typed)]
    for change in (*typed, *(each for each in scenario.changes if not isinstance(each, Typed))):
        if isinstance(change, Typed):
            handle = _handle_of(definitions, change)
            if handle is None:
                return None
            found = found.having(*handle)
            continue
        values = _values(change, assumptions)
        if values is None:
            return None
        of, name = _row_of(change)
        if isinstance(change, Redrawn):
            kinds[name] = change.distribution.family
        own = own_values(definitions, of, name, kinds.get(name))
        for key, value in values.items():
            if key not in own and value == NONE:
                continue  # there is nothing to be taken away
            if key not in own:
                return None
            found = found.having(of, name, key, value)
    return found


def _of_handle(definitions: Definitions, typed: Typed) -> Change:
    """Return what is typed into a row of a table as a change of what the row says; itself where no handle does that."""
    kind, written, heading = typed.of or ("", "", "")
    rows = {name_key(each.name): each.name for each in _rows_of_table(definitions, kind)}
    name = rows.get(written, "")
    keys = {plain(each): key for key, headings in _headings(definitions, kind, name) for each in headings}
    key, value, where = keys.get(plain(heading), ""), typed.value, typed.where
    if key == "frozen" and isinstance(value, bool):
        return Frozen(name, None, where) if value else Drawn(name, where)
    number = _number_typed(typed)
    if key in ("", "frozen") or (number is None and (value is not None or key not in REMOVABLE)):
        return typed
    if kind == "xlmc_evidence" and number is not None:
        return Measured(name, {key: number}, where)
    if kind == "xlmc_filters":
        return Limits(name, {key: number}, where)
    if kind == "xlmc_forecasts":
        return Stated(name, {key: number}, where)
    return Numbers(name, {key: number}, where)


def _handle_of(definitions: Definitions, typed: Typed) -> tuple[str, str, str, float] | None:
    """Return the kind, the name, the key and the value of what is typed: of a decision, or of a row that solves."""
    number = _number_typed(typed)
    for decision in definitions.decisions:
        if decision.cell == typed.cell:
            value = decision.value_of(typed.value) if decision.contents else number
            return None if value is None else ("decision", decision.name, "value", value)
    for solve in definitions.solves:
        for key, where in solve.typed.items():
            if where == typed.cell:
                return None if number is None else ("solve", solve.name, key, number)
    return None


def _number_typed(typed: Typed) -> float | None:
    """Return the number that is typed; None for anything else."""
    value = typed.value
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool | ErrorCode) else None


def _rows_of_table(definitions: Definitions, kind: str) -> Iterable[Assumption | Filter | Evidence | Forecast]:
    """Return what the rows of a kind of table define."""
    match kind:
        case "xlmc_assumptions":
            return definitions.assumptions
        case "xlmc_filters":
            return (*definitions.filters, *definitions.forecast_filters, *definitions.unused)
        case "xlmc_evidence":
            return definitions.evidence
        case "xlmc_forecasts":
            return definitions.forecasts
    return ()


def _headings(definitions: Definitions, kind: str, name: str) -> Iterator[tuple[str, Sequence[str]]]:
    """Return the key of each handle of a row, and how its column may be headed."""
    match kind:
        case "xlmc_assumptions":
            assumption = next((each for each in definitions.assumptions if each.name == name), None)
            for spec in () if assumption is None else assumption.family.parameters:
                yield spec.key, spec.headings
            yield from ((key, (heading,)) for key, heading in CUTOFFS.items())
            yield "frozen", ("Frozen",)
        case "xlmc_filters":
            yield from ((key, (heading,)) for key, heading in LIMITS.items())
        case "xlmc_evidence":
            yield "reading", ("Reading",)
            yield from ((key, (heading, "±") if key == "plus_minus" else (heading,)) for key, heading in SIZES.items())
        case "xlmc_forecasts":
            yield from (("threshold", ("Threshold",)), ("central", ("Range %",)))


def _row_of(change: Change) -> tuple[str, str]:
    """Return the kind and the name of the row that a change with values is of."""
    match change:
        case Limits(name) | Switched(name) | Measured(name):
            return "filter", name
        case Stated(name):
            return "forecast", name
        case Correlated(first, second):
            return "correlation", f"{first} and {second}"
        case Frozen(name) | Drawn(name) | Band(name) | Range(name) | Numbers(name) | Redrawn(name):
            return "assumption", name
    raise TypeError(change)


def _values(change: Change, assumptions: Mapping[str, Assumption]) -> dict[str, Amount] | None:
    """Return key -> value of one change; None if it is another kind of change."""
    match change:
        case Frozen(_, value):
            return {"frozen": True} if value is None else {"frozen": True, "base": value}
        case Drawn():
            return {"frozen": False}
        case Switched(_, used):
            return {"used": used}
        case Correlated(_, _, value):
            return {"correlation": value}
        case Redrawn(name, to) if name in assumptions and to.family in kinds_of(assumptions[name]):
            suited = in_kind(assumptions[name], to.family).given
            return {"kind": to.family, **{key: value for key, value in to.given.items() if value != suited.get(key)}}
        case Band(_, low, high):
            return dict(zip(BAND, (low, high), strict=True))
        case Range(name, low, high) if name in assumptions and {"low", "high"} <= {*assumptions[name].parameters}:
            ends: dict[str, float | None] = {"low": low, "high": high}
            return {key: end for key, end in ends.items() if end is not None}
        case Numbers(_, values) | Limits(_, values) | Measured(_, values) | Stated(_, values):
            return {key: NONE if value is None else value for key, value in values.items()}
    return None


def adjusted_definitions(definitions: Definitions, adjustments: Adjustments) -> Definitions:
    """Return the definitions with these values, whatever they are."""
    return replace(
        definitions,
        assumptions=tuple(adjusted_assumption(each, adjustments) for each in definitions.assumptions),
        filters=tuple(_filter(each, adjustments.filters) for each in definitions.filters),
        forecast_filters=tuple(_filter(each, adjustments.filters) for each in definitions.forecast_filters),
        unused=tuple(_filter(each, adjustments.filters) for each in definitions.unused),
        evidence=tuple(_evidence(each, adjustments.filters) for each in definitions.evidence),
        forecasts=tuple(_forecast(each, adjustments.forecasts) for each in definitions.forecasts),
        decisions=tuple(_decision(each, adjustments.decisions) for each in definitions.decisions),
        solves=tuple(_solve(each, adjustments.solves) for each in definitions.solves),
    )


def adjusted_assumption(assumption: Assumption, adjustments: Adjustments) -> Assumption:
    """Return an assumption with its numbers as they are now, whatever they are."""
    given = dict(adjustments.assumptions.get(assumption.name, {}))
    if not given:
        return assumption
    frozen_part: dict[str, Any] = {key: given.pop(key) for key in ("base", "frozen") if key in given}
    for key in BAND:
        given.pop(key, None)
    assumption = in_kind(assumption, str(given.pop("kind", assumption.distribution)))
    return replace(assumption.with_numbers(_numbers(given)), **frozen_part)


def _filter(filter_: Filter, changed: Changed) -> Filter:
    given = dict(changed.get(filter_.name, {}))
    used = bool(given.pop("used", filter_.used))
    if filter_.evidence is not None:
        return replace(filter_, used=used, evidence=_evidence(filter_.evidence, changed))
    return replace(filter_, used=used, **_numbers(given))  # type: ignore[arg-type]  # of its limits


def _evidence(evidence: Evidence, changed: Changed) -> Evidence:
    given = dict(changed.get(evidence.name, {}))
    unused = ("" if given.pop("used") else USE_IS_OFF) if "used" in given else evidence.unused
    numbers = {key: float(value) for key, value in given.items()}
    reading = numbers.pop("reading", evidence.reading)
    return replace(evidence, reading=reading, sizes={**evidence.sizes, **numbers}, unused=unused)


def _forecast(forecast: Forecast, changed: Changed) -> Forecast:
    given = _numbers(changed.get(forecast.name, {}))
    if not given:
        return forecast
    central = given.get("central")
    share = forecast.central if central is None else central / 100.0
    return replace(forecast, threshold=given.get("threshold", forecast.threshold), central=share)


def _decision(decision: Decision, changed: Changed) -> Decision:
    given = changed.get(decision.name, {})
    return replace(decision, base=float(given["value"])) if given else decision


def _solve(solve: Solve, changed: Changed) -> Solve:
    given = {key: float(value) for key, value in changed.get(solve.name, {}).items()}
    return replace(solve, **given) if given else solve  # type: ignore[arg-type]  # the keys are of its numbers


def in_words(definitions: Definitions, adjustments: Adjustments) -> list[str]:
    """Say what differs, a phrase each: `friction: High 0.75 → 0.85`; also of what the workbook no longer has."""
    found = []
    for of, name, key, value in adjustments._each():
        own = own_values(definitions, of, name, adjustments.kind(of, name))
        if key in own:
            label = changed_text(definitions, of, name, key, own[key], value)
        else:
            number = _amount_text(key, value)
            label = f"{LIMITS.get(key, key.replace('_', ' '))} {number} (no longer in the workbook)"
        found.append(f"{name}: {label}")
    return found


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
    shown = "none" if before is None else _amount_text(key, before)
    return f"{heading} {shown} → {_amount_text(key, after)}"


def _amount_text(key: str, value: Parameter | Amount) -> str:
    """Write a value: `0.75`, `51 %`; `none` for what is taken away; `on` and `off` of a switch."""
    if isinstance(value, bool):
        return ("off", "on")[value]
    if isinstance(value, str):
        return value
    return f"{given_text(value)} %" if key == "central" else given_text(value)


def usual_variants(definitions: Definitions) -> dict[str, Adjustments]:
    """Return variants that show how firm an answer is: all ranges wider and narrower, each limit halved and doubled.

    Ranges are those of the assumptions with numbers `low` and `high`; a limit of 0 stays.
    """
    found: dict[str, Adjustments] = {}
    for label, factor in (("half as wide", 0.5), ("one and a half times as wide", 1.5)):
        made = Adjustments()
        for name, low, high in _ranges(definitions):
            middle, half = 0.5 * (low + high), 0.5 * (high - low) * factor
            for key, end in (("low", middle - half), ("high", middle + half)):
                made = made.having("assumption", name, key, float(f"{end:.12g}"))  # 0.6875, not 0.6874999999999999
        if made:
            found[f"every range {label}"] = made
    for filter_ in definitions.filters:
        for key, limit in movable_limits(filter_).items():
            if isinstance(limit, Cell) or not limit:
                continue
            for label, factor in (("half", 0.5), ("twice", 2.0)):
                name = f"{filter_.name} {LIMITS[key]} {plain_text(limit * factor)} ({label})"
                found[name] = Adjustments().having("filter", filter_.name, key, limit * factor)
    return found


def _ranges(definitions: Definitions) -> Iterator[tuple[str, float, float]]:
    """Return name, low and high of the drawn assumptions that are given by these two numbers."""
    for each in definitions.assumptions:
        low, high = each.parameters.get("low"), each.parameters.get("high")
        if not each.frozen and len(each.parameters) == 2 and isinstance(low, float) and isinstance(high, float):
            yield each.name, low, high
