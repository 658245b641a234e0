"""What evidence is judged by: trials that pass all other filters, and what the model has in place of each reading.

They are independent trials of the run's seed, the same for all engines and sampling methods. There are as many as the
run had, or up to eight times as many where too few of them pass the other filters; a million at most.

Letters: n trials past the filters, k items of evidence, f forecasts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
    from xlmc.montecarlo.model.model import Model

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
            twentieth of its range.
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


def evidence_trials(model: Model, seed: int, trials: int) -> EvidenceTrials:
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
        kept = np.ones(block, bool)
        for column in evaluator.filters(draws, block):
            kept &= ~_fails(column)
        for name in model.fallible:
            kept &= ~np.isnan(draws[name])
        kept[n:] = False
        survivors = np.flatnonzero(kept)
        past += survivors.size
        if not survivors.size:
            continue
        found = np.array([column.as_floats() for column in evaluator.forecasts(survivors)])
        parts.append(found)
        ends.add({key: values[survivors] for key, values in draws.items()}, _log_weights(laws, found).sum(axis=0))
    found = np.concatenate([np.empty((len(wanted), 0)), *parts], axis=1)
    quantities = found[: len(items)]
    forecasts = dict(zip(names, found[len(items) :], strict=True))
    return EvidenceTrials(drawn, _log_weights(laws, found), quantities, forecasts, ends.shares)


def _log_weights(laws: Sequence[Law], found: Floats) -> Floats:
    """`(k, n)`; what is an error agrees with nothing."""
    weights = [np.where(np.isnan(m), -np.inf, law.log_weight(m)) for law, m in zip(laws, found, strict=False)]
    return np.array(weights).reshape(len(laws), found.shape[1])


def _fails(column: Column) -> NDArray[np.bool_]:
    fails = column.values == 0
    return np.asarray(fails if column.codes is None else fails | (column.codes > 0))


class _Ends:
    """Counts the weight of the trials whose draws lie at the ends of their ranges.

    Weights are kept as shares of the largest so far, so that none is lost where all are small. Assumptions whose
    parameters vary, or that take few values, have no such ends.
    """

    def __init__(self, model: Model) -> None:
        quantiles = model.quantiles([OUTER, 1.0 - OUTER])
        fixed = [a for a in model.live if model.draws[a.name].fixed and model.draws[a.name].ties() is None]
        self._limits: dict[str, tuple[str, float, float]] = {}
        for a in fixed:
            low, high = map(float, quantiles[a.name])
            if low < high:
                self._limits[a.name] = a.name, low, high
        self._low, self._high = dict.fromkeys(self._limits, 0.0), dict.fromkeys(self._limits, 0.0)
        self._all, self._largest = 0.0, -np.inf

    def add(self, draws: Mapping[str, Floats], log_weights: Floats) -> None:
        """Count the trials of a block: `(n,)` each."""
        largest = float(log_weights.max())
        if largest == -np.inf:
            return
        if largest > self._largest:
            shrunk = float(np.exp(self._largest - largest))
            self._all, self._largest = self._all * shrunk, largest
            self._low = {name: found * shrunk for name, found in self._low.items()}
            self._high = {name: found * shrunk for name, found in self._high.items()}
        weights = np.exp(log_weights - self._largest)
        self._all += float(weights.sum())
        for name, (key, low, high) in self._limits.items():
            self._low[name] += float(weights[draws[key] <= low].sum())
            self._high[name] += float(weights[draws[key] >= high].sum())

    @property
    def shares(self) -> dict[str, tuple[float, float]]:
        """Assumption -> the share at its lower end, and at its upper end; none where no trial has a weight."""
        if not self._all:
            return {}
        return {name: (self._low[name] / self._all, self._high[name] / self._all) for name in self._limits}
