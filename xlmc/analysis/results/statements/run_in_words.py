"""The sampling of a run in words, and what it discards: those of the record, the result sheets and summaries."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.number_text import count_text
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
    "discards_of",
    "errors_text",
    "generator_text",
    "method_text",
    "sampling_sentence",
    "status",
]

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


@dataclass(frozen=True, slots=True)
class Discarded:
    """What a filter of some forecasts only discards for one of them: so many of the accepted trials."""

    filter: Filter
    forecast: str
    trials: int
    share: Estimate


def discards_of(simulation: RunResult) -> list[Discarded]:
    """Say what such filters discard, filter by filter, forecast by forecast."""
    results = []
    for filter_ in simulation.model.forecast_filters:
        for name in filter_.only_for:
            trials = simulation.discards[name][filter_.name]
            results.append(Discarded(filter_, name, trials, proportion(trials, simulation.accepted)))
    return results


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
