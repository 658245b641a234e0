"""Adjustments of the window as a scenario of the workbook, and a scenario as adjustments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from xlmc.errors import ErrorCode
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Definitions, Filter, Forecast
from xlmc.montecarlo.definitions.evidence import SIZES, Evidence
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
from xlmc.montecarlo.distributions.spelling import name_key, plain
from xlmc.outputs.live.adjustments import (
    BAND,
    LIMITS,
    MEASURED,
    NONE,
    REMOVABLE,
    SOLVED,
    Adjustments,
    Amount,
    numbers_of,
    own_values,
    pairs_of,
)
from xlmc.outputs.live.kinds import distribution_in_kind, in_kind, kinds_of

__all__ = ["adjustments_of", "changes_of", "scenario_of"]


def changes_of(definitions: Definitions, adjustments: Adjustments) -> list[Change]:
    """Return what is to be changed in the workbook, without what has no effect, as a number of what is frozen."""
    result: list[Change] = []
    for assumption in definitions.assumptions:
        if moved := adjustments.assumptions.get(assumption.name):
            result += _of_assumption(assumption, dict(moved))
    for name, given in adjustments.filters.items():
        own = definitions.is_used(name)
        used = bool(given.get("used", own))
        numbers = {key: value for key, value in given.items() if key != "used"}
        if used != own:
            result.append(Switched(name, used))
        if used and numbers and MEASURED.keys() >= numbers.keys():
            result.append(Measured(name, {key: float(value) for key, value in numbers.items()}))
        elif used and numbers:
            result.append(Limits(name, numbers_of(numbers)))
    pairs = pairs_of(definitions)
    for name, given in adjustments.correlations.items():
        if name in pairs and "correlation" in given:
            result.append(Correlated(pairs[name].first, pairs[name].second, float(given["correlation"])))
    result += [Stated(name, numbers_of(given)) for name, given in adjustments.forecasts.items()]
    result += _typed(definitions, adjustments)
    return result


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
        yield Numbers(name, numbers_of(given))
    if (low, high) != (*BAND.values(),):
        yield Band(name, low, high)


def scenario_of(definitions: Definitions, name: str, adjustments: Adjustments) -> Scenario:
    """Return a state of the window as a scenario, such as the workbook's table `xlmc_scenarios` holds."""
    return Scenario(name, tuple(changes_of(definitions, adjustments)))


def adjustments_of(definitions: Definitions, scenario: Scenario) -> Adjustments | None:
    """Return a scenario of the workbook as a state of the window; None if the window has no handle for a change."""
    assumptions = {each.name: each for each in definitions.assumptions}
    adjustments = Adjustments()
    kinds: dict[str, str] = {}
    typed = [_of_handle(definitions, each) for each in scenario.changes if isinstance(each, Typed)]
    for change in (*typed, *(each for each in scenario.changes if not isinstance(each, Typed))):
        if isinstance(change, Typed):
            handle = _handle_of(definitions, change)
            if handle is None:
                return None
            adjustments = adjustments.having(*handle)
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
            adjustments = adjustments.having(of, name, key, value)
    return adjustments


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
