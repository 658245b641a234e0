"""The order in which assumptions take the dimensions of Sobol points: those that matter most first.

Some dimensions of a net are less even together than others, and with some thousand points in a replicate it shows: in
the order of the workbook, the case study's filtered means vary as with Monte Carlo; in this one, two thirds as much
(docs/sampling.md has the orders that were tried). Which assumptions matter, a short run by Monte Carlo says, with
streams that the Sobol points have nothing to do with.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.loop.blocks import Block, Task
from xlmc.montecarlo.loop.scheduling.run_spec import model_runner
from xlmc.montecarlo.sampling.sampling_methods import METHODS
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.statistics.association import centred_ranks

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["PILOT_TRIALS", "plan_sampling"]

PILOT_TRIALS: Final = 32_768

_COMPARED = 4_096
"""Accepted trials that are compared with the forecasts: they know a rank correlation to 0.016."""

_DECIMALS = 6
"""The rounding of the scores: the last bits, which may differ from processor to processor, must not decide."""

Floats = NDArray[np.float64]


def plan_sampling(model: CompiledModel, settings: Settings) -> SamplingPlan:
    """Plan a run, with the order of its dimensions where the method has any."""
    plan = SamplingPlan.of(settings.sampling, settings.trials)
    return replace(plan, order=_order_by_importance(model, settings.seed)) if METHODS[plan.method].ordered else plan


def _order_by_importance(model: CompiledModel, seed: int) -> tuple[str, ...]:
    """Order the names of the drawn assumptions; those that matter alike stay in the order of the workbook."""
    chances = {a.name for a in model.chances}  # last, so that evidence moves no other draw
    program = model.program("numpy")  # whatever runs the trials, so that every engine has the same order
    block = min(PILOT_TRIALS, program.largest_block)
    runner = model_runner(model, program, "numpy", seed, block)
    starts = range(0, PILOT_TRIALS, block)
    blocks = [runner.run(Task(start, min(block, PILOT_TRIALS - start), prior=True)) for start in starts]
    accepted, forecasts = _joined([each.draws for each in blocks]), _columns(blocks)
    largest = _largest_correlations(accepted, forecasts)
    scores = {
        name: round(_score(draws, accepted[name], largest[name]), _DECIMALS)
        for name, draws in _joined([each.prior or {} for each in blocks]).items()
    }
    return tuple(sorted(model.draws, key=lambda name: (name in chances, -scores[name])))


def _score(prior: Floats, accepted: Floats, correlation: float) -> float:
    """How much the filters move or narrow it, or else its largest rank correlation with a forecast."""
    known, left = prior[~np.isnan(prior)], accepted
    if left.size < 2 or not (spread := float(np.std(known))):
        return 0.0
    moved, narrowed = abs(float(np.mean(left) - np.mean(known))) / spread, 1.0 - float(np.std(left)) / spread
    return max(moved, narrowed, correlation)


def _largest_correlations(accepted: Mapping[str, Floats], forecasts: Sequence[Floats]) -> dict[str, float]:
    """Return each assumption's largest rank correlation with a forecast, without its sign.

    An assumption is ranked once for all forecasts that are numbers in the same trials. Ranks are multiples of a half,
    and so their products and sums are exact: matrix products of them have the same bits whatever adds them up.
    """
    alike: dict[bytes, tuple[NDArray[np.intp], list[Floats]]] = {}
    for forecast in forecasts:
        numbers = np.flatnonzero(~np.isnan(forecast))[:_COMPARED]
        alike.setdefault(numbers.tobytes(), (numbers, []))[1].append(centred_ranks(forecast[numbers]))
    result = dict.fromkeys(accepted, 0.0)
    for numbers, ranks in alike.values():
        of_forecasts = np.array(ranks)
        squares = np.sum(of_forecasts**2, axis=1)
        for name, draws in accepted.items():
            own = centred_ranks(draws[numbers])
            size = np.sqrt(squares * np.sum(own**2))
            each = np.divide(np.abs(of_forecasts @ own), size, out=np.zeros_like(size), where=size > 0.0)
            result[name] = max(result[name], min(float(each.max()), 1.0))
    return result


def _joined(parts: Sequence[Mapping[str, Floats]]) -> dict[str, Floats]:
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _columns(blocks: Sequence[Block]) -> list[Floats]:
    return [np.concatenate(columns) for columns in zip(*(block.forecasts for block in blocks), strict=True)]
