"""Definitions, and the sampling of a run, in words: those of the record, the result sheets and `xlmc check`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.excel.address import Cell
from xlmc.montecarlo.definitions.definitions import CUTOFFS, Assumption, DataRange, Definitions, Filter, Parameter
from xlmc.montecarlo.definitions.evidence import ERRORS, SIZES, Evidence, Within
from xlmc.montecarlo.definitions.forms import Form
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
from xlmc.montecarlo.number_text import count_text, exact_text, styled_text
from xlmc.montecarlo.sampling.sampling_methods import GENERATOR, METHODS
from xlmc.montecarlo.statistics import Estimate, proportion
from xlmc.montecarlo.statistics.sample import MOST_GROUPS

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "REJECTED_SENTENCE",
    "UNWEIGHTED",
    "Discarded",
    "changes_text",
    "cutoffs_text",
    "discards_of",
    "distribution_text",
    "errors_text",
    "evidence_text",
    "generator_text",
    "given_text",
    "limits_text",
    "method_text",
    "notes_text",
    "parameters_text",
    "plain_text",
    "sampling_sentence",
    "status",
]


_VALUE: Final = "low"
"""The key of a number that is a value of the quantity itself."""

UNWEIGHTED: Final = (
    "Weighted results leave out what needs trials of equal weight: what the answers depend on, filter limits, "
    "forecasts two at a time, ranges of your own on the sheet Certainty, and rank correlations of accepted trials."
)
"""What results by weights do not hold."""

REJECTED_SENTENCE: Final = (
    "The ± of the trials that a filter rejects is that of independent trials; the error of these samples is hardly "
    "ever larger."
)
"""The note where shares are shown whose errors are not computed from the replicates."""


def plain_text(value: Parameter) -> str:
    """Return the shortest text that reads back as the same number: `0.95`, `6661`; or the cell that holds it."""
    return str(value) if isinstance(value, Cell) else repr(float(value)).removesuffix(".0")


def given_text(value: Parameter) -> str:
    """Return a number as people read it, with all of its digits: `6,661`; or the cell that holds it."""
    return str(value) if isinstance(value, Cell) else exact_text(value)


def parameters_text(assumption: Assumption) -> str:
    """`Low 6,661, High 6,861`; `Low 180,000 (=Estimate!B2)` where a formula gives it; `Data Inputs!Q2:R9` of data."""
    parts = []
    for key, heading in assumption.headings.items():
        if key not in CUTOFFS:
            parts.append(f"{heading} {assumption.text_of(key)}")
    if assumption.data is not None:
        parts.append(_data_text(assumption.data))
    return ", ".join(parts)


def _data_text(data: DataRange) -> str:
    weights = ", cumulative weights" * data.cumulative
    bandwidth = "" if data.bandwidth is None else f", Bandwidth {given_text(data.bandwidth)}"
    return f"Data {data.text or data.area}{weights}{bandwidth}"


def cutoffs_text(assumption: Assumption) -> str:
    """`below 0.5, above 0.9`: what is cut off; empty where nothing is."""
    sides = {"lower_cutoff": "below", "upper_cutoff": "above"}
    return ", ".join(f"{sides[key]} {assumption.text_of(key)}" for key in assumption.cutoffs)


def distribution_text(assumption: Assumption) -> str:
    """Write a distribution: `Normal: Mean 0.77, Std dev 0.05; cut off below 0.6`; `held at 55` of a row without one."""
    given = assumption.given
    if assumption.frozen and given.keys() == {"low", "high"} and given["low"] == given["high"]:
        return f"held at {assumption.text_of('low')}"
    cutoffs = cutoffs_text(assumption)
    ending = f"; cut off {cutoffs}" if cutoffs else ""
    return f"{assumption.distribution}: {parameters_text(assumption)}{ending}"


def limits_text(filter_: Filter) -> str:
    """`at least 0 and below 1`; `TRUE` where it has no limits; what evidence says, where it is some; that it is off."""
    if not filter_.used:
        return "not used: Use is off"
    if filter_.evidence is not None:
        return evidence_text(filter_.evidence)
    limits = ("at_least", "above", "at_most", "below")
    said = [f"{key.replace('_', ' ')} {filter_.text_of(key)}" for key in limits if getattr(filter_, key) is not None]
    return " and ".join(said) or "TRUE"


@dataclass(frozen=True, slots=True)
class Discarded:
    """What a filter of some forecasts only discards for one of them: so many of the accepted trials."""

    filter: Filter
    forecast: str
    trials: int
    share: Estimate


def discards_of(simulation: RunResult) -> list[Discarded]:
    """Say what such filters discard, filter by filter, forecast by forecast."""
    found = []
    for filter_ in simulation.model.forecast_filters:
        for name in filter_.only_for:
            trials = simulation.discards[name][filter_.name]
            found.append(Discarded(filter_, name, trials, proportion(trials, simulation.accepted)))
    return found


def evidence_text(evidence: Evidence) -> str:
    """Write evidence: `reads 12, normal (Std dev 0.6)`; `reads 12, instrument (Percent 10): from 10.9091 to
    13.3333`.
    """
    if not evidence.used or evidence.reading is None:
        return f"not used: {evidence.unused}"
    known = None if any(evidence.cells) else evidence.law
    sizes = ", ".join(f"{SIZES[key]} {given_text(value)}" for key, value in evidence.sizes.items())
    ends_text = ""
    if isinstance(known, Within):
        ends = [("from", known.low), ("to", known.high)]
        ends_text = ": " + " ".join(f"{word} {styled_text(end, '.6g')}" for word, end in ends if end is not None)
    given, weights = f" ({sizes})" if sizes else "", ", as weights" if evidence.weighed else ""
    return f"reads {given_text(evidence.reading)}, {ERRORS[evidence.error].lower()}{given}{ends_text}{weights}"


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
            found = (f"{word} {_number_of(definitions, name, _VALUE, end)}" for word, end in ends if end is not None)
            return " ".join([name, *found])
        case Band(name, low, high):
            return f"{name} from P{show(low)} to P{show(high)}"
        case Numbers(name, values) | Limits(name, values) | Measured(name, values) | Stated(name, values):
            words = (
                f"{key.replace('_', ' ')} {_number_of(definitions, name, key, value)}"
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
    rows: Mapping[str, Sequence[Assumption | Filter]] = {
        "xlmc_assumptions": definitions.assumptions,
        "xlmc_filters": definitions.filters,
    }
    row = next((each for each in rows.get(kind, ()) if name_key(each.name) == name), None)
    if isinstance(row, Assumption):
        headings = {spec.key: spec.headings for spec in row.family.parameters}
        headings |= {key: (written,) for key, written in CUTOFFS.items()}
        key = next((each for each, those in headings.items() if plain(heading) in map(plain, those)), key)
    return given_text(value) if row is None else _form_in(row, key, value).number(value)


def _number_of(definitions: Definitions, name: str, key: str, value: float) -> str:
    """Write a number of an assumption or a filter: a parameter or a limit by its key."""
    rows: tuple[Assumption | Filter, ...] = (*definitions.assumptions, *definitions.filters)
    row = next((each for each in (*rows, *definitions.forecast_filters) if each.name == name), None)
    return given_text(value) if row is None else _form_in(row, key, value).number(value)


def _form_in(row: Assumption | Filter, key: str, value: float) -> Form:
    return row.form_of(key, value) if isinstance(row, Assumption) else row.form


def notes_text(notes: Mapping[str, str]) -> str:
    """Write the table's other columns: `Symbol: w1; Cell name: w_1`."""
    return "; ".join(f"{heading}: {text}" for heading, text in notes.items())


def status(model: CompiledModel, name: str, frozen: bool) -> str:
    """Say what a run does with the assumption: `drawn`, `frozen`, or `not needed` by any forecast or filter."""
    if frozen:
        return "frozen"
    return "drawn" if name in model.draws else "not needed"


def method_text(simulation: RunResult) -> str:
    """`Latin hypercube: 16 independent replicates of 12,500 trials`."""
    plan = simulation.plan
    if simulation.rare is not None:
        return f"{METHODS[plan.method].name}: {simulation.rare.method}"
    if not plan.size:
        return f"{METHODS[plan.method].name}: independent trials"
    asked = simulation.settings.trials
    more = "" if asked == plan.trials else f", whole ones, for the {count_text(asked)} trials that were asked for"
    return (
        f"{METHODS[plan.method].name}: {plan.replicates} independent replicates of {count_text(plan.size)} trials{more}"
    )


def errors_text(simulation: RunResult) -> str:
    """Say what the standard errors and intervals are made from."""
    plan = simulation.plan
    if not plan.size:
        return "from the spread of the trials"
    groups = min(plan.replicates, MOST_GROUPS)
    what = "replicates" if groups == plan.replicates else f"{groups} groups of replicates"
    return f"from the differences between {what}, with Student's t of {groups - 1} degrees of freedom"


def sampling_sentence(simulation: RunResult) -> str:
    """How the run was sampled and where its errors come from, in one sentence."""
    done = "" if simulation.rare is None else f" {simulation.rare.sentence}"
    weighting = simulation.weighting
    weighed = "" if weighting is None else f" {weighting.sentence}. {UNWEIGHTED}"
    if simulation.model.chances:
        weighed = " Evidence with a normal error keeps a trial by chance, so those kept count alike (rejection)."
    return f"{method_text(simulation)}; errors come {errors_text(simulation)}.{done}{weighed}"


def generator_text(simulation: RunResult) -> str:
    """Name the source of the random numbers, in words."""
    if simulation.rare is not None:
        return f"{GENERATOR}, seeded by (seed, purpose): a stream to learn with, and one to draw the trials with"
    return METHODS[simulation.plan.method].generator
