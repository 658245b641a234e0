"""An importance grid: assumptions are drawn more often where a pilot run's trials were accepted, and weighted for it.

Every assumption has a histogram of the uniforms behind its draws in the accepted pilot trials. It is mixed with a flat
one: by a tenth, so that no part of the range is left out and no weight grows without bound (Hesterberg 1995, defensive
mixture); and further where it differs from flat by no more than chance makes it (James and Stein's shrinkage of the χ²
distance), or the noise of seventeen histograms would cost more than the grid gains. A trial's weight is the product of
what its draws are too frequent by, inverted; estimates divide by the sum of the weights.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.methods.answer import Errors, Extreme, MethodResult, answer_of, extremes_of
from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.loop.scheduling.run_spec import model_runner
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text, counted_text, fixed_text
from xlmc.montecarlo.sampling.sampling_methods import Margin
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.sampling.streams import Stream
from xlmc.montecarlo.simulation.simulate import simulate

__all__ = ["BINS", "DEFENSIVE", "ImportanceGrid"]

BINS: Final = 16
DEFENSIVE: Final = 0.1
"""The share of trials that is drawn as if there were no grid, for each assumption."""

_PILOT_SHARE: Final = 8
_LEAST_PILOT, _MOST_PILOT = 4_096, 65_536
_OWN: Final[Mapping[str, str]] = MappingProxyType({})
_APART: Final = 1 << 40
"""Between the seeds of the pilot and of the weighted run, so that their streams are independent."""

_BLOCK: Final = 32_768

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ImportanceGrid:
    """Pilot run, grid, weighted run; the budget counts both runs."""

    key: str = "grid"
    name: str = "Importance grid"
    errors: Errors = "weighted"
    cannot: str = "looks at one assumption at a time, so it gains less where only combinations are accepted"

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """See `Method`.

        Raises:
            SimulationError: the pilot run has no accepted trial to learn from.
        """
        started = time.perf_counter()
        pilot = min(max(_LEAST_PILOT, budget // _PILOT_SHARE), _MOST_PILOT, max(1, budget // 2))
        grids = _learned(model, pilot, seed)
        trials = max(1, budget - pilot)
        weights, columns, ends = _weighted(model, grids, trials, seed + _APART)
        answers = {f.name: answer_of(c, weights, f.central) for f, c in zip(model.forecasts, columns, strict=True)}
        total, squares = float(weights.sum()), float(np.sum(weights**2))
        effective = total**2 / squares if squares else 0.0
        remark = (
            f"of {counted_text(weights.size, 'accepted trial')}, {fixed_text(effective, 0)} count "
            "fully (effective sample size)"
        )
        seconds = time.perf_counter() - started
        return MethodResult(seconds, pilot + trials, answers, total / trials, effective, (remark,), extremes=ends)


def _learned(model: CompiledModel, trials: int, seed: int) -> dict[str, Floats]:
    """Name of an assumption -> density of its uniforms in each bin, `(BINS,)`, 1 where it is as without a grid."""
    run = simulate(model, trials=trials, seed=seed, sampling="mc", engine="numpy", keep_inputs=0)
    if not run.accepted:
        message = f"the filters accept none of {count_text(trials)} trials, so there is nothing to learn a grid from"
        raise SimulationError(message, hint="run more trials, or see whether the filters contradict the assumptions")
    result = {}
    for name, stream in ((a.name, a.stream or a.name) for a in model.live):
        uniforms = np.empty(trials)
        Stream(seed, stream).uniforms(0, uniforms)
        counts = np.bincount((uniforms[run.trial_index] * BINS).astype(np.intp), minlength=BINS)
        result[name] = _density(counts.astype(np.float64))
    return result


def _density(counts: Floats) -> Floats:
    """Return the density that counts in bins speak for, shrunk towards the flat one."""
    expected = counts.sum() / counts.size
    distance = float(np.sum((counts - expected) ** 2)) / expected
    trusted = max(0.0, 1.0 - (counts.size - 1) / distance) if distance > 0.0 else 0.0
    return np.asarray(1.0 + (1.0 - DEFENSIVE) * trusted * (counts / expected - 1.0))


def _weighted(
    model: CompiledModel, grids: dict[str, Floats], trials: int, seed: int
) -> tuple[Floats, list[Floats], tuple[Extreme, ...]]:
    """Return the weights of the accepted trials `(m,)`, the forecasts, `(m,)` each, and their extremes."""
    program = model.program("numpy")
    block = min(_BLOCK, program.largest_block)
    plan = _GridPlan("mc", trials, grids=grids, weights=np.empty(block))
    runner = model_runner(model, program, "numpy", seed, block, plan)
    weights, columns, accepted = [], [], []
    for start in range(0, trials, block):
        result = runner.run(Task(start, min(block, trials - start), prior=False, inputs=False))
        weights.append(plan.weights[result.accepted - start])
        columns.append(result.forecasts)
        accepted.append(result.accepted)
    forecasts = [np.concatenate(parts) for parts in zip(*columns, strict=True)]
    named = {f.name: column for f, column in zip(model.forecasts, forecasts, strict=True)}
    return np.concatenate(weights), forecasts, extremes_of(named, np.concatenate(accepted), seed, plan)


@dataclass(frozen=True, slots=True)
class _GridPlan(SamplingPlan):
    """Independent trials, denser where the grids say.

    Attributes:
        grids: name of an assumption -> density in each bin.
        weights: of the trials of the block drawn last.
    """

    grids: dict[str, Floats] = field(default_factory=dict)
    weights: Floats = field(default_factory=lambda: np.empty(0))

    def margins(self, seed: int, names: Sequence[str], streams: Mapping[str, str] = _OWN) -> list[Margin]:
        """See `SamplingPlan`."""
        return [
            _Bent(Stream(seed, streams.get(name, name)), self.grids[name], self.weights, index == 0)
            for index, name in enumerate(names)
        ]


class _Bent:
    """A stream whose uniforms fall into the bins of a grid as often as their densities say.

    Args:
        stream: of plain uniforms.
        density: in each bin, 1 on the average.
        weights: multiplied by what each uniform is too frequent by, inverted; set to that by the first margin.
    """

    def __init__(self, stream: Stream, density: Floats, weights: Floats, first: bool) -> None:
        self._stream, self._density, self._weights, self._first = stream, density, weights, first
        self._flat = bool(np.all(density == 1.0))
        self._shares = np.concatenate([[0.0], np.cumsum(density / density.size)])
        self._shares[-1] = 1.0
        self._edges = np.linspace(0.0, 1.0, density.size + 1)

    def uniforms(self, start: int, out: Floats) -> None:
        """See `Margin`; the weights are those of the block that begins here."""
        self._stream.uniforms(start, out)
        if self._first:
            self._weights[...] = 1.0
        if self._flat:
            return
        out[...] = np.minimum(np.interp(out, self._shares, self._edges), 1.0 - 2.0**-53)
        self._weights /= self._density[(out * self._density.size).astype(np.intp)]
