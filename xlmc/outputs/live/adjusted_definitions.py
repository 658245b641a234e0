"""The definitions of a workbook with the numbers of the window in them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from xlmc.montecarlo.definitions.definitions import Assumption, Decision, Definitions, Filter, Forecast, Solve
from xlmc.montecarlo.definitions.evidence import USE_IS_OFF, Evidence
from xlmc.outputs.live.adjustments import BAND, Adjustments, Changed, numbers_of
from xlmc.outputs.live.kinds import in_kind

__all__ = ["adjusted_assumption", "adjusted_definitions"]


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
    return replace(assumption.with_numbers(numbers_of(given)), **frozen_part)


def _filter(filter_: Filter, changed: Changed) -> Filter:
    given = dict(changed.get(filter_.name, {}))
    used = bool(given.pop("used", filter_.used))
    if filter_.evidence is not None:
        return replace(filter_, used=used, evidence=_evidence(filter_.evidence, changed))
    return replace(filter_, used=used, **numbers_of(given))  # type: ignore[arg-type]  # of its limits


def _evidence(evidence: Evidence, changed: Changed) -> Evidence:
    given = dict(changed.get(evidence.name, {}))
    unused = ("" if given.pop("used") else USE_IS_OFF) if "used" in given else evidence.unused
    numbers = {key: float(value) for key, value in given.items()}
    reading = numbers.pop("reading", evidence.reading)
    return replace(evidence, reading=reading, sizes={**evidence.sizes, **numbers}, unused=unused)


def _forecast(forecast: Forecast, changed: Changed) -> Forecast:
    given = numbers_of(changed.get(forecast.name, {}))
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
