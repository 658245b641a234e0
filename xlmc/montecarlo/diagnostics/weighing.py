"""Evidence with a normal or lognormal error by weights: no trial is rejected by it, and each counts with its chance.

A trial that rejection would keep with probability w counts w times (importance weights). Where the model's quantity is
far from the reading in nearly all trials, that uses what rejection throws away. What decides is the workbook's setting
`Evidence`, or a rule on the run's first trials, never the time that either takes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.definitions import Filter
from xlmc.montecarlo.definitions.evidence_methods import EVIDENCE_METHODS
from xlmc.montecarlo.diagnostics.evidence_trials import evidence_trials
from xlmc.montecarlo.loop.blocks import portions
from xlmc.montecarlo.model.draw_binding import parameter_target
from xlmc.montecarlo.number_text import count_text, fixed_text, number_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["Weighting", "choose_method", "weighing", "weighting_of"]

FIRST_TRIALS: Final = 1 << 16
"""Trials of the run that the rule looks at."""

FEWEST_KEPT: Final = 1_000
"""Trials that rejection should keep in the whole run; where it would keep fewer, weights are looked at."""

GAIN: Final = 2.0
"""How many times as many effective trials weights must leave, if they are to be taken."""

_BLOCK: Final = 1 << 13

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Weighting:
    """The weights of a run's accepted trials.

    Attributes:
        weights: `(m,)` as shares of the largest.
        mean, largest: of them as they are, the chance that rejection would keep a trial.
    """

    weights: Floats
    mean: float
    largest: float

    @property
    def effective(self) -> float:
        """How many trials of equal weight carry as much: (Σw)²/Σw²."""
        squares = float(np.sum(self.weights * self.weights))
        return float(np.sum(self.weights)) ** 2 / squares if squares else 0.0

    def even_rows(self, most: int) -> NDArray[np.intp]:
        """Return rows of equal weight for the first `most` weighted ones: drawn in proportion to the weights, in order.

        They are as many as carry as much, so that a heavy trial stands among them several times.
        """
        weights = self.weights[:most]
        reached = np.cumsum(weights)
        if not weights.size or not reached[-1]:
            return np.empty(0, np.intp)
        count = max(1, int(reached[-1] ** 2 / np.sum(weights**2)))
        return np.asarray(np.searchsorted(reached, (np.arange(count) + 0.5) / count * reached[-1]))

    @property
    def sentence(self) -> str:
        """What weights mean for the numbers, and how large they are."""
        return (
            "Each accepted trial counts with the chance that the evidence would keep it (weights): together the "
            f"{count_text(self.weights.size)} say as much as {fixed_text(self.effective, 0)} trials of "
            "equal weight (effective sample "
            f"size), and errors and intervals allow for that. Mean weight {number_text(self.mean, 3)}, "
            f"largest {number_text(self.largest, 3)}. "
            "Percentiles are not given if fewer than ten effective trials lie beyond them"
        )


def choose_method(model: CompiledModel, settings: Settings) -> str:
    """How a run uses evidence whose error is no limit: `rejection` or `weights`; otherwise empty.

    By itself it takes weights where the first trials say that rejection would keep fewer than a thousand in the whole
    run, and that weights leave at least twice as many in effect. A run with a goal always rejects, and so does one with
    scenarios, which are compared trial by trial.

    Raises:
        SimulationError: weights were asked for in such a run.
    """
    asked = settings.evidence or EVIDENCE_METHODS[0]
    if not model.chances:
        return ""
    goal = settings.stopping.goal is not None or settings.scenarios
    if asked == "weights" and goal:
        what = "with scenarios" if settings.scenarios else "that goes on until a goal"
        hint = "Ask for a number of trials without scenarios, or set Evidence to rejection"
        raise SimulationError(f"a run {what} cannot weight its trials", hint=hint)
    if asked != "auto" or goal:
        return "rejection" if goal else asked
    trials = evidence_trials(model, settings.seed, min(settings.trials, FIRST_TRIALS))
    logs = trials.log_weights.sum(axis=0)
    largest = logs.max(initial=-np.inf)
    if largest == -np.inf:
        return "rejection"
    shares = np.exp(logs - largest)
    accepted, effective = float(np.exp(logs).sum()), float(shares.sum()) ** 2 / float(np.sum(shares * shares))
    few = accepted * settings.trials / trials.trials < FEWEST_KEPT
    return "weights" if few and effective >= GAIN * accepted else "rejection"


def weighing(model: CompiledModel) -> CompiledModel:
    """Return the same model, whose evidence rejects nothing that has a weight above 0."""
    filters = tuple(_weighed(each) for each in model.filters)
    return type(model)(model.workbook, replace(model.definitions, filters=filters), model.path)


def _weighed(filter_: Filter) -> Filter:
    evidence = filter_.evidence
    if evidence is None or evidence.bell is None:
        return filter_
    return replace(filter_, evidence=replace(evidence, weighed=True))


def weighting_of(model: CompiledModel, inputs: Mapping[str, Floats], m: int) -> Weighting | None:
    """Return the weights of accepted trials; None if they are all equal.

    Args:
        model: the workbook.
        inputs: assumption -> its accepted draws, `(m,)`, of all accepted trials; none where all are frozen.
        m: the accepted trials.
    """
    items = [(each.cell, each.evidence.law) for each in model.filters if each.evidence and each.evidence.weighed]
    if not items:
        return None
    evaluator = model.evaluator([parameter_target(cell) for cell, _ in items], _BLOCK)
    logs = np.zeros(m)
    for part, block in portions(inputs, m, _BLOCK):
        columns = evaluator.filters(block, part.stop - part.start)
        logs[part] = sum(law.log_weight(column.as_floats()) for (_, law), column in zip(items, columns, strict=True))
    largest = float(logs.max(initial=-np.inf))
    if largest == -np.inf:
        return Weighting(np.zeros(m), 0.0, 0.0)
    return Weighting(np.exp(logs - largest), float(np.exp(logs).mean()), float(np.exp(largest)))
