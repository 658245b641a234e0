"""Sobol's indices of a model: where they are right to give, and the trials they need."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.definitions.model import name_key
from xlmc.statistics import Estimate
from xlmc.studies.sensitivity.sobol import sobol_indices

if TYPE_CHECKING:
    from xlmc.evaluation.engine import Evaluator
    from xlmc.run.model import Model
    from xlmc.run.simulation import Simulation

__all__ = ["SobolRun", "pick_and_freeze", "why_not"]

MOST_PAIRS: Final = 1 << 13
LEAST_PAIRS: Final = 1 << 8
_LEAST_EVALUATED, _MOST_EVALUATED = 1 << 15, 1 << 17

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SobolRun:
    """Sobol indices of a model.

    Attributes:
        pairs: of independent trials.
        indices: assumption -> one (first order, total) a forecast, in the order of the workbook.
    """

    pairs: int
    indices: Mapping[str, tuple[tuple[Estimate, Estimate], ...]]


def why_not(simulation: Simulation) -> str:
    """Why Sobol indices would mislead; empty where they would not."""
    model = simulation.model
    if simulation.accepted < simulation.trials:
        return (
            "Sobol indices are not given: the filters reject trials, and among the accepted ones the assumptions are "
            "no longer independent, so that the variance cannot be shared out among them. What each explains is given "
            "instead"
        )
    if model.groups:
        return (
            "Sobol indices are not given: assumptions are correlated, so that the variance cannot be shared out among "
            "them. What each explains is given instead"
        )
    if len(model.scene.stages) > 1:
        return (
            "Sobol indices are not given: parameters of assumptions depend on other assumptions, so that these are not "
            "independent. What each explains is given instead"
        )
    return ""


def pick_and_freeze(model: Model, assumptions: Sequence[str], trials: int, seed: int) -> SobolRun:
    """The indices of a model without correlations, whatever its filters; of very many assumptions, of the first ones.

    Args:
        model: to evaluate.
        assumptions: names of live ones, of which the indices are wanted.
        trials: of the run; no more than half as many are evaluated, but some at least.
        seed: of the run. The trials are its first ones by Monte Carlo, and those that follow them.
    """
    evaluations = max(_LEAST_EVALUATED, min(_MOST_EVALUATED, trials // 2))
    chosen = assumptions[: max(evaluations // LEAST_PAIRS - 2, 1)]
    pairs = min(MOST_PAIRS, evaluations // (len(chosen) + 2))
    program = model.program("numpy")
    block = min(pairs, program.largest_block)
    first, second = _draws(model, seed, 0, pairs, block), _draws(model, seed, pairs, pairs, block)
    evaluator = program.evaluator(block)
    a, b = (_answers(evaluator, draws, pairs, block) for draws in (first, second))
    found = {}
    for name in chosen:
        key = name_key(name)
        c = _answers(evaluator, {**first, key: second[key]}, pairs, block)
        found[name] = tuple(sobol_indices(*answers) for answers in zip(a, b, c, strict=True))
    return SobolRun(pairs, found)


def _draws(model: Model, seed: int, start: int, count: int, block: int) -> dict[str, Floats]:
    """`(count,)` draws of independent trials from `start` on."""
    sampler = model.sampler(seed, block)
    drawn = {name_key(a.name): np.empty(count) for a in model.live}
    for first in range(0, count, block):
        part = sampler.draw(start + first)
        for key, values in drawn.items():
            values[first : first + block] = part[key][: count - first]
    return drawn


def _answers(evaluator: Evaluator, draws: Mapping[str, Floats], count: int, block: int) -> list[Floats]:
    """`(count,)` a forecast, NaN where it is no number."""
    found: list[list[Floats]] = []
    for first in range(0, count, block):
        part = {key: values[first : first + block] for key, values in draws.items()}
        n = min(block, count - first)
        evaluator.filters(part, n)
        found.append([column.as_floats() for column in evaluator.forecasts(np.arange(n))])
    return [np.concatenate(columns) for columns in zip(*found, strict=True)]
