"""A workbook's model as the left side of the window shows it: assumptions with their handles, filters, forecasts."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.statements.in_words import (
    changes_text,
    distribution_text,
    evidence_text,
    limits_text,
    status,
)
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Definitions, Filter, Parameter
from xlmc.montecarlo.definitions.evidence import Evidence
from xlmc.montecarlo.distributions.whole_numbers import WholeNumbers
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.statistics.estimate import finite, t_quantile
from xlmc.outputs.live.adjustments import (
    BAND,
    LIMITS,
    Adjustments,
    adjusted_definitions,
    adjustments_of,
    assumption_numbers,
    in_words,
    movable_limits,
)
from xlmc.outputs.live.protocol import Message
from xlmc.outputs.page.payload import CONFIDENCE

__all__ = [
    "assumption_rows",
    "book_message",
    "filter_rows",
    "forecast_rows",
    "known_scenario",
    "scenario_rows",
    "shapes_of",
]

_ON_AXIS: Final = frozenset(
    {"low", "high", "likeliest", "low_likeliest", "high_likeliest", "mean", "location", "value", *CUTOFFS}
)
"""Parameters that are values of the quantity itself, and can be dragged along its axis; percentiles are, too."""

_SHAPE_DRAWS: Final = 2_000
_SHAPE_BARS: Final = 40
_PROBABILITIES: Final = (np.arange(_SHAPE_DRAWS) + 0.5) / _SHAPE_DRAWS
_OUTSIDE: Final = 0.35
"""Room that an axis leaves on either side of the distribution, as a part of its width."""
_STEPS: Final = 50.0
"""A step of a key is a power of ten, the largest of which a range has at least so many."""


def assumption_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Every assumption with its numbers as they are now.

    Args:
        own: the model of the workbook.
        adjustments: what was changed.
    """
    now = adjusted_definitions(own.definitions, adjustments)
    changed = adjustments.assumptions
    pairs = zip(now.assumptions, own.assumptions, strict=True)
    return [_assumption(own, each, before, changed.get(each.name, {})) for each, before in pairs]


def _assumption(
    model: CompiledModel, assumption: Assumption, own: Assumption, changed: Mapping[str, Any]
) -> dict[str, Any]:
    numbers = [_number(assumption, own, key, heading, value) for key, heading, value in _numbers(assumption)]
    values = [each["value"] for each in numbers if each["drags"] and each["value"] is not None]
    values += [] if assumption.base is None else [assumption.base]
    step = _step(max(values) - min(values) if values else 0.0, max(map(abs, values), default=1.0))
    return {
        "name": assumption.name,
        "units": assumption.units,
        "source": assumption.source,
        "cell": str(assumption.cell),
        "distribution": distribution_text(assumption),
        "status": status(model, assumption.name, assumption.frozen),
        "frozen": assumption.frozen,
        "base": assumption.base,
        "ownBase": own.base,
        "step": max(step, 1.0) if isinstance(assumption.family, WholeNumbers) else step,
        "numbers": numbers,
        "band": None if assumption.data is not None else [changed.get(key, end) for key, end in BAND.items()],
        "changed": bool(changed),
    }


def _numbers(assumption: Assumption) -> Iterator[tuple[str, str, Parameter]]:
    for key, (heading, value) in assumption_numbers(assumption).items():
        yield key, heading, value


def _number(assumption: Assumption, own: Assumption, key: str, heading: str, value: Parameter) -> dict[str, Any]:
    before = assumption_numbers(own)[key][1]
    return {
        "key": key,
        "heading": heading,
        "value": None if isinstance(value, Cell) else value,
        "own": None if isinstance(before, Cell) else before,
        "cell": assumption.stated.get(key, str(value)) if isinstance(value, Cell) else "",
        "drags": assumption.data is None and (key in _ON_AXIS or (key[:1] == "p" and key[1:2].isdigit())),
        "step": _step(0.0, abs(value)) if isinstance(value, float | int) else 1.0,
    }


def _step(span: float, size: float) -> float:
    wanted = span / _STEPS if span > 0.0 else size / (5.0 * _STEPS)
    return float(f"1e{math.floor(math.log10(wanted) + 1e-9)}") if wanted > 0.0 else 0.01


def shapes_of(model: CompiledModel, names: Sequence[str] | None = None) -> dict[str, dict[str, Any]]:
    """The distributions that are drawn, small: name -> `low`, `high` and the heights of bars of equal width, up to 1.

    Args:
        model: whose.
        names: of those wanted; by default of all that are drawn.
    """
    return {
        name: found
        for name, values in model.quantiles(_PROBABILITIES, names).items()
        if (names is None or name in names) and (found := _shape(values)) is not None
    }


def _shape(values: NDArray[np.float64]) -> dict[str, Any] | None:
    """The shape of `(q,)` quantiles; None where they are not numbers."""
    finite_draws = values[np.isfinite(values)]
    if finite_draws.size < _SHAPE_DRAWS // 2:
        return None
    first, last = float(finite_draws[0]), float(finite_draws[-1])
    middle = finite_draws[finite_draws.size // 200 : finite_draws.size - finite_draws.size // 200]
    if last - first > 3.0 * (middle[-1] - middle[0]) > 0.0:  # a long tail would leave the rest in one bar
        first, last = float(middle[0]), float(middle[-1])
    if not last > first:
        return {"low": first, "high": last, "heights": [1.0]}
    counts, _ = np.histogram(finite_draws, _SHAPE_BARS, (first, last))
    return {"low": first, "high": last, "heights": [round(float(h), 3) for h in counts / counts.max()]}


def filter_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Every filter with its limits as they are now, those that are not used among them; see `assumption_rows`."""
    definitions, now = own.definitions, adjusted_definitions(own.definitions, adjustments)
    pairs = zip(_filters(now), _filters(definitions), strict=True)
    rows = [_filter(each, before, before.name in definitions.switches) for each, before in pairs]
    idle = [each for each in own.evidence if not each.used and each.can_be_used]
    return [*rows, *(_idle_evidence(each, adjustments) for each in idle)]


def _filters(definitions: Definitions) -> tuple[Filter, ...]:
    return *definitions.filters, *definitions.forecast_filters, *definitions.unused


def _idle_evidence(evidence: Evidence, adjustments: Adjustments) -> dict[str, Any]:
    """A row of evidence that the workbook does not use; where the window does, its reading is told with the answer."""
    used = bool(adjustments.filters.get(evidence.name, {}).get("used", False))
    return {
        "name": evidence.name,
        "cell": str(evidence.cell),
        "keeps": "what agrees with its reading" if used else evidence_text(evidence),
        "because": evidence.source,
        "step": 1.0,
        "changed": used,
        "switches": True,
        "used": used,
        "limits": [],
    }


def _filter(filter_: Filter, own: Filter, switches: bool) -> dict[str, Any]:
    given = [(key, getattr(filter_, key), before) for key, before in movable_limits(own).items()]
    typed = [now for _, now, _ in given if not isinstance(now, Cell)]
    step = _step(max(typed) - min(typed) if len(typed) > 1 else 0.0, max(map(abs, typed), default=1.0) or 1.0)
    return {
        "name": filter_.name,
        "cell": str(filter_.cell),
        "keeps": limits_text(filter_),
        "because": " · ".join(filter(None, (*_reach(filter_), filter_.because))),
        "step": step,
        "changed": filter_.used != own.used or any(now != before for _, now, before in given),
        "switches": switches,
        "used": filter_.used,
        "limits": [
            {
                "key": key,
                "heading": LIMITS[key],
                "value": None if isinstance(now, Cell) else finite(now),
                "own": None if isinstance(before, Cell) else finite(before),
                "cell": str(now) if isinstance(now, Cell) else "",
            }
            for key, now, before in given
        ],
    }


def _reach(filter_: Filter) -> Iterator[str]:
    """Of which forecasts a filter is, where it is not of all."""
    if filter_.only_for:
        yield f"only for {'; '.join(filter_.only_for)}"


def forecast_rows(model: CompiledModel) -> list[dict[str, Any]]:
    """Every forecast: its name and units."""
    return [{"name": each.name, "units": each.units, "cell": str(each.cell)} for each in model.forecasts]


def book_message(model: CompiledModel) -> Message:
    """The message that tells of the workbook as it is."""
    return {
        "kind": "book",
        "name": model.workbook.name,
        "folder": str(model.path.parent),
        "forecasts": forecast_rows(model),
        "notices": [str(each) for each in model.notices],
        "settings": _settings_text(model),
        "shapes": shapes_of(model),
        "z": t_quantile(math.inf, CONFIDENCE),
    }


def _settings_text(model: CompiledModel) -> str:
    """`200,000 trials, Monte Carlo, seed 999`."""
    settings = model.definitions.settings
    return f"{settings.trials:,} trials, {METHODS[settings.sampling].name}, seed {settings.seed}"


def scenario_rows(definitions: Definitions, stored: Mapping[str, Adjustments]) -> Iterator[Message]:
    """The scenarios of the workbook, then those kept in the window, which replace one of the same name."""
    for scenario in definitions.scenarios:
        if scenario.name not in stored:
            shows = adjustments_of(definitions, scenario) is not None
            yield {"name": scenario.name, "changes": [changes_text(scenario)], "own": True, "shows": shows}
    for name, each in stored.items():
        yield {"name": name, "changes": in_words(definitions, each), "own": False, "shows": True}


def known_scenario(definitions: Definitions, stored: Mapping[str, Adjustments], name: str) -> Adjustments | None:
    """A scenario by name; None where there is none, or none that can be shown."""
    if name in stored:
        return stored[name].only(definitions)
    found = next((each for each in definitions.scenarios if each.name == name), None)
    return None if found is None else adjustments_of(definitions, found)
