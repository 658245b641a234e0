"""A workbook's model as the left side of the window shows it: assumptions with their handles, filters, forecasts."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, Final
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.statements.in_words import distribution_text, limits_text
from xlmc.analysis.results.statements.run_in_words import status
from xlmc.analysis.results.statements.scenarios_in_words import changes_text
from xlmc.errors import DefinitionError
from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, Decision, Definitions, Filter, Parameter
from xlmc.montecarlo.definitions.evidence import Law, Within
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.definitions.tables.evidence_rows import check_sizes
from xlmc.montecarlo.distributions.whole_numbers import WholeNumbers
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import counted_text
from xlmc.montecarlo.sampling.draws import Draw
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.statistics.estimate import finite, t_quantile
from xlmc.outputs.live.adjusted_definitions import adjusted_assumption, adjusted_definitions
from xlmc.outputs.live.adjusted_scenarios import adjustments_of
from xlmc.outputs.live.adjustments import (
    BAND,
    LIMITS,
    MEASURED,
    NONE,
    REMOVABLE,
    SOLVED,
    Adjustments,
    assumption_numbers,
    measured_numbers,
    movable_limits,
    own_values,
    pairs_of,
)
from xlmc.outputs.live.adjustments_in_words import in_words
from xlmc.outputs.live.kinds import in_kind, kinds_of
from xlmc.outputs.live.protocol import Message
from xlmc.outputs.page.payload import CONFIDENCE, form_json, signs_json

__all__ = [
    "Shapes",
    "assumption_rows",
    "book_message",
    "correlation_rows",
    "decision_rows",
    "filter_rows",
    "forecast_rows",
    "known_scenario",
    "run_row",
    "scenario_rows",
    "shapes_of",
    "solve_rows",
    "stated_rows",
]

_ON_AXIS: Final = frozenset(
    {"low", "high", "likeliest", "low_likeliest", "high_likeliest", "mean", "location", "value", *CUTOFFS}
)
"""Parameters that are values of the quantity itself, and can be dragged along its axis; percentiles are, too."""

_ROWS: Final[WeakKeyDictionary[CompiledModel, dict[str, tuple[Mapping[str, Any], dict[str, Any]]]]] = (
    WeakKeyDictionary()
)
"""What was changed of each assumption of a workbook when its row was made last, and the row: few move at a time."""

Shapes = dict[str, tuple[Draw, dict[str, Any] | None]]
"""Name of an assumption -> how it is drawn, and the shape of that; None for what is no numbers."""

_MOST_TICKS: Final = 60
"""Values of a decision that are marked on its axis."""

_SLACK: Final = 1e-9
"""The part of a step by which a value may miss a multiple of it."""

_SHAPE_DRAWS: Final = 2_000
_SHAPE_BARS: Final = 40
_PROBABILITIES: Final = (np.arange(_SHAPE_DRAWS) + 0.5) / _SHAPE_DRAWS
_FARTHEST: Final = 3.5
"""Standard deviations up to which the error of a reading is drawn."""
_STEPS: Final = 50.0
"""A step of a key is a power of ten, the largest of which a range has at least so many."""


def assumption_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Return every assumption with its numbers as they are now.

    Args:
        own: the model of the workbook.
        adjustments: what was changed.
    """
    known = _ROWS.setdefault(own, {})
    for each in own.assumptions:
        given = adjustments.assumptions.get(each.name, {})
        if each.name not in known or known[each.name][0] != given:
            known[each.name] = given, _assumption(own, adjusted_assumption(each, adjustments), each, given)
    return [known[each.name][1] for each in own.assumptions]


def _assumption(
    model: CompiledModel, assumption: Assumption, own: Assumption, changed: Mapping[str, Any]
) -> dict[str, Any]:
    in_its_kind = in_kind(own, assumption.distribution)
    pairs = assumption_numbers(in_its_kind).items()
    numbers = [_number(assumption, key, heading, value) for key, (heading, value) in pairs]
    values = [each["value"] for each in numbers if each["drags"] and each["value"] is not None]
    values += [] if assumption.base is None else [assumption.base]
    step = _step(max(values) - min(values) if values else 0.0, max(map(abs, values), default=1.0))
    form = PLAIN if assumption.base is None else assumption.form_of("base", assumption.base)
    return {
        "name": assumption.name,
        "units": assumption.units,
        "source": assumption.source,
        "cell": str(assumption.cell),
        "distribution": distribution_text(assumption),
        "kinds": kinds_of(own),
        "kind": assumption.distribution,
        "status": status(model, assumption.name, assumption.frozen),
        "frozen": assumption.frozen,
        "base": assumption.base,
        "ownBase": own.base,
        "step": max(step, 1.0) if isinstance(assumption.family, WholeNumbers) else _step_in(form, step),
        "form": _box_form(form),
        "numbers": numbers,
        "band": None if assumption.data is not None else [changed.get(key, end) for key, end in BAND.items()],
        "changed": bool(changed),
    }


def _number(assumption: Assumption, key: str, heading: str, before: Parameter) -> dict[str, Any]:
    value = assumption.given.get(key)
    drags = assumption.data is None and (key in _ON_AXIS or (key[:1] == "p" and key[1:2].isdigit()))
    form = PLAIN if value is None or isinstance(value, Cell) else assumption.form_of(key, value)
    cell = assumption.text_of(key) if key in assumption.stated else ""
    return _handle(key, heading, value, before, drags=drags, cell=cell, form=form)


def _handle(
    key: str,
    heading: str,
    value: Parameter | None,
    before: Parameter | None,
    *,
    drags: bool,
    cell: str = "",
    form: Form = PLAIN,
) -> dict[str, Any]:
    """Return a number that can be changed.

    Args:
        key: of the number.
        heading: as it is read.
        value: now; None for one that was taken away.
        before: in the workbook.
        drags: whether it lies on the axis of the quantity.
        cell: what computes it, in words; by default its cell.
        form: how it is written.
    """
    return {
        "key": key,
        "heading": heading,
        "value": None if isinstance(value, Cell) or value is None else finite(value),
        "own": None if isinstance(before, Cell) or before is None else finite(before),
        "cell": cell or str(value) if isinstance(value, Cell) else "",
        "drags": drags,
        "goes": key in REMOVABLE,
        "step": _step_in(form, _step(0.0, abs(value))) if isinstance(value, float | int) else 1.0,
        "form": _box_form(form),
    }


def _box_form(form: Form) -> dict[str, Any] | None:
    """Return how a date, a percentage or an amount of money is written and read in a box; None for other numbers."""
    return form_json(form) if form.kind in (Kind.DATE, Kind.PERCENT, Kind.CURRENCY) else None


def _step_in(form: Form, step: float) -> float:
    """Return a step; of dates a day, of times an hour, of spans of time a minute: serial numbers say nothing."""
    return {"day": 1.0, "time": 1 / 24, "span": 1 / 1440}[form.shows] if form.kind is Kind.DATE else step


def _step(span: float, size: float) -> float:
    wanted = span / _STEPS if 0.0 < span < math.inf else size / (5.0 * _STEPS)
    return float(f"1e{math.floor(math.log10(wanted) + 1e-9)}") if wanted > 0.0 else 0.01


def shapes_of(
    model: CompiledModel, names: Sequence[str] | None = None, known: Shapes | None = None
) -> dict[str, dict[str, Any]]:
    """Return the drawn distributions, small: name -> `low`, `high` and the heights of bars of equal width, up to 1.

    Args:
        model: whose.
        names: of those wanted; by default of all that are drawn.
        known: those that were made last, from who asks again and again; it takes the new ones.
    """
    known = {} if known is None else known
    wanted = [name for name in (model.bases if names is None else names) if name in model.bases]
    new = [n for n in wanted if n not in known or known[n][0] != model.draws[n] or not known[n][0].fixed]
    quantiles = model.quantiles(_PROBABILITIES, new) if new else {}
    known |= {name: (model.draws[name], _shape(quantiles[name])) for name in new}
    return {name: shape for name in wanted if (shape := known[name][1]) is not None}


def _shape(values: NDArray[np.float64]) -> dict[str, Any] | None:
    """Return the shape of `(q,)` quantiles; None if they are no numbers."""
    finite_draws = values[np.isfinite(values)]
    if finite_draws.size < _SHAPE_DRAWS // 2:
        return None
    first, last = float(finite_draws[0]), float(finite_draws[-1])
    middle = finite_draws[finite_draws.size // 200 : finite_draws.size - finite_draws.size // 200]
    if last - first > 3.0 * (middle[-1] - middle[0]) > 0.0:  # a long tail would leave the rest in one bar
        first, last = float(middle[0]), float(middle[-1])
    if not last > first:
        return {"low": first, "high": last, "heights": [1.0]}
    counts, _ = np.histogram(finite_draws, np.linspace(first, last, _SHAPE_BARS + 1))
    return {"low": first, "high": last, "heights": [round(float(h), 3) for h in counts / counts.max()]}


def filter_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Return every filter and row of evidence with its numbers as they are now, also what is not used; see
    `assumption_rows`.
    """
    definitions = own.definitions
    now = adjusted_definitions(definitions, Adjustments(filters=adjustments.filters))
    idle = {each.name for each in own.evidence if not each.used and each.can_be_used}
    pairs = zip(_filters(now, idle), _filters(definitions, idle), strict=True)
    changed = {name for name, each in adjustments.filters.items() if each}
    return [_filter(each, before, definitions, changed=each.name in changed) for each, before in pairs]


def _filters(definitions: Definitions, idle: Collection[str]) -> tuple[Filter, ...]:
    """Return the filters, and what would be filters of the evidence that the workbook does not use."""
    rows = (each for each in definitions.evidence if each.name in idle)
    unused = (Filter(e.name, e.cell, e.row, because=e.source, evidence=e, used=e.used) for e in rows)
    return *definitions.filters, *definitions.forecast_filters, *definitions.unused, *unused


def _filter(filter_: Filter, own: Filter, definitions: Definitions, *, changed: bool) -> dict[str, Any]:
    limits = list(_limits(filter_, own, definitions))
    law = _law(filter_)
    typed = [each["value"] for each in limits if each["drags"] and each["value"] is not None]
    shape = None if law is None else _shape_of_error(law)
    typed += [] if shape is None else [shape["low"], shape["high"]]
    step = _step(max(typed) - min(typed) if len(typed) > 1 else 0.0, max(map(abs, typed), default=1.0) or 1.0)
    says = limits_text(filter_) if law is not None or not filter_.used else f"keeps {_kept(filter_)}"
    return {
        "name": filter_.name,
        "cell": str(filter_.cell),
        "says": says,
        "because": " · ".join(filter(None, (*_reach(filter_), filter_.because))),
        "step": _step_in(filter_.form, step),
        "form": _box_form(filter_.form),
        "shape": shape,
        "changed": changed,
        "switches": filter_.name in definitions.switches,
        "used": filter_.used,
        "limits": limits,
    }


def _kept(filter_: Filter) -> str:
    """Say what a filter keeps, or evidence whose law is not known."""
    return limits_text(filter_) if filter_.evidence is None else "what agrees with its reading"


def _limits(filter_: Filter, own: Filter, definitions: Definitions) -> Iterator[dict[str, Any]]:
    """Return the numbers of a filter that can be changed: its limits, or the reading and the error of evidence."""
    evidence = next((each for each in definitions.evidence if own.evidence and each.name == own.name), None)
    if evidence is None or filter_.evidence is None or own.evidence is None:
        for key, before in movable_limits(own).items():
            yield _handle(key, LIMITS[key], getattr(filter_, key), before, drags=True, form=filter_.form)
        return
    now, known = measured_numbers(filter_.evidence), measured_numbers(own.evidence)
    for key, before in measured_numbers(evidence).items():
        value = before if now[key] == known[key] else now[key]  # a cell, where a formula computes it
        form = filter_.form if key == "reading" else PLAIN
        yield _handle(key, MEASURED[key], value, before, drags=key == "reading", form=form)


def _law(filter_: Filter) -> Law | None:
    """Return the law of evidence; None if there is none, or if its numbers are impossible."""
    evidence = filter_.evidence
    if evidence is None or not isinstance(evidence.reading, float) or any(evidence.cells):
        return None
    try:
        check_sizes(evidence, evidence.reading, evidence.sizes)  # type: ignore[arg-type]  # they are no cells
    except DefinitionError:
        return None
    return evidence.law


def _shape_of_error(law: Law) -> dict[str, Any] | None:
    """Return how likely a quantity is by its reading alone, as `shapes_of`.

    None if it is bounded on one side, or if its error reaches further than numbers do.
    """
    if isinstance(law, Within):
        return None if law.low is None or law.high is None else {"low": law.low, "high": law.high, "heights": [1.0]}
    z = np.linspace(-_FARTHEST, _FARTHEST, _SHAPE_BARS + 1)
    with np.errstate(all="ignore"):
        m = law.reading * np.exp(z * law.sigma) if law.logarithmic else law.reading + z * law.sigma
        edges = np.linspace(m[0], m[-1], _SHAPE_BARS + 1)
        heights = np.exp(law.log_weight(0.5 * (edges[1:] + edges[:-1])))
    if not np.isfinite([*edges, m[-1] - m[0], *heights]).all():
        return None
    return {"low": float(m[0]), "high": float(m[-1]), "heights": [round(float(h), 3) for h in heights]}


def stated_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Return how every forecast is stated now: its threshold, None for none, and its central range in percent."""
    rows = []
    for each in own.forecasts:
        values = own_values(own.definitions, "forecast", each.name)
        given = adjustments.forecasts.get(each.name, {})
        threshold = given.get("threshold", values["threshold"])
        central = given.get("central", values["central"])
        shown = None if threshold == NONE else threshold
        rows.append({"name": each.name, "threshold": shown, "central": central, "changed": bool(given)})
    return rows


def _reach(filter_: Filter) -> Iterator[str]:
    """Say of which forecasts a filter is, if it is not of all."""
    if filter_.only_for:
        yield f"only for {'; '.join(filter_.only_for)}"


def forecast_rows(model: CompiledModel) -> list[dict[str, Any]]:
    """Return every forecast: its name and units."""
    return [{"name": each.name, "units": each.units, "cell": str(each.cell)} for each in model.forecasts]


def book_message(model: CompiledModel) -> Message:
    """Return the message that tells of the workbook as it is."""
    return {
        "kind": "book",
        "name": model.workbook.name,
        "folder": str(model.path.parent),
        "forecasts": forecast_rows(model),
        "notices": [str(each) for each in model.notices],
        "settings": _settings_text(model),
        "shapes": shapes_of(model),
        "z": t_quantile(math.inf, CONFIDENCE),
        "signs": signs_json(),
    }


def correlation_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Return the rank correlation of every two assumptions that the workbook gives one, as it is now."""
    rows = []
    for name, each in pairs_of(own.definitions).items():
        given = adjustments.correlations.get(name, {})
        rows.append({"name": name, "value": given.get("correlation", each.number), "changed": bool(given)})
    return rows


def decision_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Return every decision with the number in its cell as it is now, and the values that studies try."""
    now = adjusted_definitions(own.definitions, Adjustments(decisions=adjustments.decisions))
    rows = []
    for each, before in zip(now.decisions, own.definitions.decisions, strict=True):
        ends = [min(each.values), max(each.values)]
        tried = [] if each.between is not None or len(each.values) > _MOST_TICKS else list(each.values)
        choices = [each.shown(value) for value in each.values] if each.contents else []
        rows.append(
            {
                "name": each.name,
                "units": each.units,
                "cell": str(each.cell),
                "says": f"tried: {each.values_text}",
                "numbers": [_handle("value", "Value", each.base, before.base, drags=True, form=each.form)],
                "form": _box_form(each.form),
                "ends": ends,
                "tried": tried,
                "choices": choices,
                "step": _step_of(each),
                "changed": each is not before,
            }
        )
    return rows


def solve_rows(own: CompiledModel, adjustments: Adjustments) -> list[dict[str, Any]]:
    """Return every cell that is solved for, and what for; the numbers that are typed in its row can be changed."""
    now = adjusted_definitions(own.definitions, Adjustments(solves=adjustments.solves))
    rows = []
    for each, before in zip(now.solves, own.definitions.solves, strict=True):
        numbers = [
            _handle(key, heading, getattr(each, key), getattr(before, key), drags=False)
            for key, heading in SOLVED.items()
        ]
        root = "" if each.root is None else f", the {each.root.value} of several values"
        rows.append(
            {
                "name": each.name,
                "cell": str(each.by),
                "says": f"{each.by} is solved for in each trial, so that {each.cell} equals To{root}",
                "numbers": numbers,
                "changed": each is not before,
            }
        )
    return rows


def _step_of(decision: Decision) -> float:
    """Return the distance of the values of a decision, if all are multiples of it; otherwise that of a range."""
    low, high = min(decision.values), max(decision.values)
    apart = float(f"{decision.values[1] - low:.12g}") if len(decision.values) > 1 else 0.0
    whole = apart and not decision.listed and decision.between is None
    if whole and all(abs(each / apart - round(each / apart)) < _SLACK for each in decision.values):
        return apart
    return _step(high - low, max(abs(low), abs(high)))


def run_row(model: CompiledModel, asked: RunOptions) -> dict[str, Any]:
    """Return the trials and the seed of runs at rest, and those of the workbook."""
    own = model.definitions.settings
    now = asked.settings(own)
    changed = asked != RunOptions()
    return {"trials": now.trials, "seed": now.seed, "own": [own.trials, own.seed], "changed": changed}


def _settings_text(model: CompiledModel) -> str:
    """Write the settings: `200,000 trials, Monte Carlo, seed 999`."""
    settings = model.definitions.settings
    return f"{counted_text(settings.trials, 'trial')}, {METHODS[settings.sampling].name}, seed {settings.seed}"


def scenario_rows(definitions: Definitions, stored: Mapping[str, Adjustments]) -> Iterator[Message]:
    """Return the scenarios of the workbook, then those kept in the window, which replace one of the same name."""
    for scenario in definitions.scenarios:
        if scenario.name not in stored:
            shows = adjustments_of(definitions, scenario) is not None
            yield {"name": scenario.name, "changes": [changes_text(scenario, definitions)], "own": True, "shows": shows}
    for name, each in stored.items():
        yield {"name": name, "changes": in_words(definitions, each), "own": False, "shows": True}


def known_scenario(definitions: Definitions, stored: Mapping[str, Adjustments], name: str) -> Adjustments | None:
    """Return a scenario by name; None if there is none that can be shown."""
    if name in stored:
        return stored[name].only(definitions)
    scenario = next((each for each in definitions.scenarios if each.name == name), None)
    return None if scenario is None else adjustments_of(definitions, scenario)
