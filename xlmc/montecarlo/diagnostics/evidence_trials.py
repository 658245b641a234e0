"""What evidence is judged by: trials that pass all other filters, and what the model has in place of each reading.

They are independent trials of the run's seed, the same for all engines and sampling methods. There are as many as the
run had, or up to eight times as many where too few of them pass the other filters; a million at most.

Letters: n trials past the filters, k items of evidence, f forecasts.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.engine.engine import Target
from xlmc.engine.numpy.numpy_engine import NumpyProgram
from xlmc.montecarlo.model.draw_binding import parameter_target
from xlmc.montecarlo.model.forecast_filters import FilteringProgram, conditions_of, filters_by_forecast
from xlmc.montecarlo.model.needed import filter_condition

if TYPE_CHECKING:
    from xlmc.engine.engine import Column, Program
    from xlmc.montecarlo.definitions.evidence import Law
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["MOST_TRIALS", "EvidenceTrials", "evidence_trials"]

MOST_TRIALS: Final = 1 << 20
"""Trials that evidence is judged by, at most."""

ENOUGH: Final = 20_000
"""Trials past the other filters that are wanted: ten of them are then expected beyond a reading at the threshold of
what is inconsistent."""

MORE: Final = 8
"""How many times the trials of the run may be drawn to have enough."""

_BLOCK: Final = 1 << 13
_MOST_FORECASTS: Final = 32
"""Forecasts that evidence is shown to move: the first ones."""

OUTER: Final = 0.05
"""The share of an assumption's draws at either end of its range that counts as its end."""

_PILED: Final = 0.75
"""The mean weight nearest to a limit by that up to the median, at least, where the weight piles up at the limit; less
than 1, so that a weight that is even up to the limit does so for every seed."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class EvidenceTrials:
    """What was found.

    Attributes:
        trials: how many were drawn.
        log_weights: `(k, n)` the logarithm of the chance that an item keeps a trial; -inf where the model's quantity is
            an error.
        quantities: `(k, n)` what the model has in place of each reading; NaN for an error.
        forecasts: forecast -> `(n,)`; NaN where it is no number.
        at_ends: assumption -> the share of the weight of all evidence with the draw in the lowest, and in the highest,
            twentieth of its range; 0 where the range has no limit there, or the weight does not pile up at it.
    """

    trials: int
    log_weights: Floats
    quantities: Floats
    forecasts: Mapping[str, Floats]
    at_ends: Mapping[str, tuple[float, float]]

    @property
    def n(self) -> int:
        """Trials that pass all filters but evidence."""
        return int(self.log_weights.shape[1])


def evidence_trials(model: CompiledModel, seed: int, trials: int) -> EvidenceTrials:
    """Draw and evaluate them.

    Args:
        model: with evidence that is used.
        seed: of the run.
        trials: of the run.
    """
    least, most = min(trials, MOST_TRIALS), min(MORE * trials, MOST_TRIALS)
    items = [(each.cell, each.evidence.law) for each in model.filters if each.evidence is not None]
    plain = [Target(filter_condition(each), each.cell) for each in model.filters if each.evidence is None]
    shown = model.forecasts[:_MOST_FORECASTS]
    names = [each.name for each in shown]
    wanted = [parameter_target(cell) for cell, _ in items]
    wanted += [Target(each.cell, each.cell) for each in shown]
    program: Program = NumpyProgram.of(
        model.lowering, plain, [*wanted, *conditions_of(model.forecast_filters)], model.fallible
    )
    if model.forecast_filters:
        own = filters_by_forecast(shown, model.forecast_filters)
        program = FilteringProgram(program, (*[()] * len(items), *own))
    block = min(_BLOCK, program.largest_block)
    sampler, evaluator = model.sampler(seed, block), program.evaluator(block)
    ends = _Ends(model)
    parts: list[Floats] = []
    laws = [law for _, law in items]
    drawn = past = 0
    while drawn < least or (past < ENOUGH and drawn < most):
        start, n = drawn, min(block, (least if drawn < least else most) - drawn)
        drawn += n
        draws = sampler.draw(start)
        accepted = np.ones(block, bool)
        for column in evaluator.filters(draws, block):
            accepted &= ~_fails(column)
        accepted[n:] = False
        survivors = np.flatnonzero(accepted)
        past += survivors.size
        if not survivors.size:
            continue
        result = np.array([column.as_floats() for column in evaluator.forecasts(survivors)])
        parts.append(result)
        ends.add({key: values[survivors] for key, values in draws.items()}, _log_weights(laws, result).sum(axis=0))
    result = np.concatenate([np.empty((len(wanted), 0)), *parts], axis=1)
    quantities = result[: len(items)]
    forecasts = dict(zip(names, result[len(items) :], strict=True))
    return EvidenceTrials(drawn, _log_weights(laws, result), quantities, forecasts, ends.shares)


def _log_weights(laws: Sequence[Law], values: Floats) -> Floats:
    """`(k, n)`; what is an error agrees with nothing."""
    weights = [np.where(np.isnan(m), -np.inf, law.log_weight(m)) for law, m in zip(laws, values, strict=False)]
    return np.array(weights).reshape(len(laws), values.shape[1])


def _fails(column: Column) -> NDArray[np.bool_]:
    fails = column.values == 0
    return np.asarray(fails if column.codes is None else fails | (column.codes > 0))


@dataclass
class _Outer:
    """The trials whose draws lie in the outer twentieth of a range that has a limit there.

    Attributes:
        limit: the end of the range.
        inner: where the twentieth begins.
        distances: `(m,)` from the limit, block by block; `log_weights` beside them.
    """

    limit: float
    inner: float
    distances: list[Floats] = field(default_factory=list)
    log_weights: list[Floats] = field(default_factory=list)

    def add(self, draws: Floats, log_weights: Floats) -> None:
        """Keep the trials of a block that lie there."""
        distance = np.abs(draws - self.limit)
        here = distance <= abs(self.inner - self.limit)
        self.distances.append(distance[here])
        self.log_weights.append(log_weights[here])

    def share(self, largest: float, total: float) -> float:
        """Return the share of the weight here, where it piles up at the limit; else 0.

        It does where, of the trials between the limit and the weighted median, the nearest quarter carries about a
        quarter of the weight, or more. A reading that is sharp beside the range leaves hardly a weight there.
        """
        order = np.argsort(np.concatenate(self.distances), kind="stable")
        reached = np.cumsum(np.exp(np.concatenate(self.log_weights)[order] - largest))
        if not order.size or not reached[-1]:
            return 0.0
        middle = int(np.searchsorted(reached, reached[-1] / 2.0))
        nearest = middle // 4
        piled = reached[nearest] / (nearest + 1) >= _PILED * reached[middle] / (middle + 1)
        return float(reached[-1]) / total if piled else 0.0


class _Ends:
    """Collects the trials whose draws lie at the ends of their ranges, and the weight of all.

    Assumptions whose parameters vary, or that take few values, have no such ends, and neither has a side on which a
    distribution has no limit.
    """

    def __init__(self, model: CompiledModel) -> None:
        quantiles = model.quantiles([0.0, OUTER, 1.0 - OUTER, 1.0])
        fixed = [a.name for a in model.live if model.draws[a.name].fixed and model.draws[a.name].ties() is None]
        self._sides: dict[str, tuple[_Outer | None, _Outer | None]] = {}
        for name in fixed:
            least, low, high, most = map(float, quantiles[name])
            if low < high:
                sides = ((least, low), (most, high))
                lower, upper = (_Outer(*side) if math.isfinite(side[0]) else None for side in sides)
                self._sides[name] = lower, upper
        self._log_weights: list[Floats] = []

    def add(self, draws: Mapping[str, Floats], log_weights: Floats) -> None:
        """Take the trials of a block: `(n,)` each."""
        self._log_weights.append(log_weights)
        for name, sides in self._sides.items():
            for side in sides:
                if side is not None:
                    side.add(draws[name], log_weights)

    @property
    def shares(self) -> dict[str, tuple[float, float]]:
        """Assumption -> the share at its lower end, and at its upper end; none where no trial has a weight."""
        weights = np.concatenate([np.empty(0), *self._log_weights])
        largest = float(weights.max(initial=-np.inf))
        if largest == -np.inf:
            return {}
        total = float(np.exp(weights - largest).sum())
        return {
            name: (
                0.0 if lower is None else lower.share(largest, total),
                0.0 if upper is None else upper.share(largest, total),
            )
            for name, (lower, upper) in self._sides.items()
        }
