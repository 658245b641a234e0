"""What the differential methods share: moments of the assumptions, and derivatives of the forecasts at the means."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.derivatives import derivatives
from xlmc.engine.passes.derivatives import Derivative, Derivatives
from xlmc.errors import SimulationError
from xlmc.montecarlo.distributions.base import Member
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text
from xlmc.montecarlo.sampling.draws import Draw
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan

__all__ = ["Expansion", "Moments", "draw_assumptions", "expansion_of"]

Floats = NDArray[np.float64]

_DRAWN: Final = 65_536
_STEPS: Final = 1 << 16
"""Points of the midpoint rule over the quantile function of a distribution with cutoffs."""


@dataclass(frozen=True, slots=True, eq=False)
class Expansion:
    """The forecasts about the means of the assumptions.

    Attributes:
        moments: of the assumptions.
        forecasts: name -> value and derivatives there, of one point.
        remarks: on the point, in words.
    """

    moments: Moments
    forecasts: Mapping[str, Derivative]
    remarks: tuple[str, ...]


def expansion_of(model: CompiledModel, seed: int, order: int) -> Expansion:
    """Expand a model's forecasts.

    Raises:
        SimulationError: a mean or a standard deviation of an assumption is infinite.
    """
    moments = _moments_of(model, seed)
    names = [a.name for a in model.live]
    result = derivatives(model, dict(zip(names, moments.mean, strict=True)), order=order)
    remarks = ("about the means of the assumptions", *moments.remarks, *_remarks(result))
    return Expansion(moments, result.forecasts, remarks)


def _remarks(result: Derivatives) -> list[str]:
    sentences = [f"no derivative: {each.why} ({each.function} in {each.cell})" for each in result.undefined]
    if result.numerical:
        names = ", ".join(f"{each.function} in {each.cell}" for each in result.numerical)
        sentences.append(f"derivatives from differences, because there is no rule for {names}")
    lost = [name for name, each in result.forecasts.items() if np.isnan(each.gradient).any()]
    if lost:
        sentences.append(f"no answer for {', '.join(lost)}: a derivative is missing")
    return sentences


@dataclass(frozen=True, slots=True, eq=False)
class Moments:
    """Moments of `k` assumptions, in the order of the model's.

    Attributes:
        mean: `(k,)`.
        covariance: `(k, k)`.
        remarks: where they are not exact, in words.
    """

    mean: Floats
    covariance: Floats
    remarks: tuple[str, ...]


def _moments_of(model: CompiledModel, seed: int) -> Moments:
    """Return the moments of a model's assumptions.

    Raises:
        SimulationError: a mean or a standard deviation is infinite.
    """
    values = np.array([_of_draw(model.draws[a.name]) for a in model.live]).reshape(-1, 2)
    varying = [index for index, (mean, _) in enumerate(values) if np.isnan(mean)]
    for index, assumption in enumerate(model.live):
        if index not in varying and not np.isfinite(values[index]).all():
            message = f"{assumption.name!r} has no finite mean and standard deviation to start from"
            raise SimulationError(message, hint="give it cutoffs, or use a method that draws")
    correlations = np.eye(len(model.live))
    remarks = []
    if varying or model.groups:
        draws = np.concatenate([*draw_assumptions(model, seed)])
        for index in varying:
            values[index] = np.nanmean(draws[:, index]), np.nanvar(draws[:, index])
        correlations = _correlations(model, draws, varying)
        remarks.append(f"correlations are those of {count_text(len(draws))} draws")
        if varying:
            names = ", ".join(model.live[index].name for index in varying)
            remarks.append(f"parameters vary, so mean and SD are those of {count_text(len(draws))} draws: {names}")
    sd = np.sqrt(values[:, 1])
    return Moments(values[:, 0], correlations * np.outer(sd, sd), tuple(remarks))


def draw_assumptions(model: CompiledModel, seed: int) -> Iterator[Floats]:
    """65,536 Sobol draws of the assumptions, before any filter, `(n, k)` block by block."""
    plan = SamplingPlan.of("sobol", _DRAWN)
    made = model.sampler(seed, plan.size, plan=plan)
    for start in range(0, plan.trials, plan.size):
        block = made.draw(start)
        yield np.column_stack([block[a.name] for a in model.live])


def _of_draw(draw: Draw) -> tuple[float, float]:
    """Mean and variance; NaN where parameters vary."""
    if not draw.fixed:
        return np.nan, np.nan
    if isinstance(draw.distribution, Member):
        return float(draw.distribution.mean()), float(draw.distribution.variance())
    middles = (np.arange(_STEPS) + 0.5) / _STEPS
    draw.fill(middles, {})
    return float(np.mean(middles)), float(np.var(middles))


def _correlations(model: CompiledModel, draws: Floats, varying: list[int]) -> Floats:
    """Pearson's, where something correlates; 0 elsewhere."""
    names = [a.name for a in model.live]
    sound = draws[~np.isnan(draws).any(axis=1)]
    with np.errstate(invalid="ignore"):
        every = np.nan_to_num(np.corrcoef(sound, rowvar=False)).reshape(len(names), len(names))
    related = np.eye(len(names), dtype=bool)
    for group in model.groups:
        indices = [names.index(name) for name in group.names]
        related[np.ix_(indices, indices)] = True
    related[varying, :] = related[:, varying] = True
    values = np.where(related, every, 0.0)
    np.fill_diagonal(values, 1.0)
    return values
