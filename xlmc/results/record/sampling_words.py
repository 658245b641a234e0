"""How a run was sampled and where its errors come from, in the words that every account of it uses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.sampling.methods import GENERATOR, METHODS
from xlmc.statistics.sample import MOST_GROUPS

if TYPE_CHECKING:
    from xlmc.run.simulation import Simulation

__all__ = ["REJECTED_SENTENCE", "errors_text", "generator_text", "method_text", "sampling_sentence"]

REJECTED_SENTENCE: Final = (
    "± of the trials that a filter rejects is that of independent trials, which these samples hardly ever exceed."
)
"""What has to be said where shares are shown that are not followed through the replicates."""


def method_text(simulation: Simulation) -> str:
    """`Latin hypercube: 16 independent replicates of 12,500 trials`."""
    plan = simulation.plan
    if simulation.rare is not None:
        return f"{METHODS[plan.method].name}: {simulation.rare.method}"
    if not plan.size:
        return f"{METHODS[plan.method].name}: independent trials"
    asked = simulation.settings.trials
    more = "" if asked == plan.trials else f", whole ones, for the {asked:,} trials that were asked for"
    return f"{METHODS[plan.method].name}: {plan.replicates} independent replicates of {plan.size:,} trials{more}"


def errors_text(simulation: Simulation) -> str:
    """What the standard errors and intervals are made from."""
    plan = simulation.plan
    if not plan.size:
        return "from the trials, which are independent"
    groups = min(plan.replicates, MOST_GROUPS)
    what = "replicates" if groups == plan.replicates else f"{groups} groups of replicates"
    return f"from the differences between {what}, with Student's t of {groups - 1} degrees of freedom"


def sampling_sentence(simulation: Simulation) -> str:
    """Both in one sentence."""
    done = "" if simulation.rare is None else f" {simulation.rare.sentence}"
    return f"{method_text(simulation)}; errors come {errors_text(simulation)}.{done}"


def generator_text(simulation: Simulation) -> str:
    """Where the random numbers come from."""
    if simulation.rare is not None:
        return f"{GENERATOR}, seeded by (seed, purpose): a stream to learn with, and one to draw the trials with"
    return METHODS[simulation.plan.method].generator
