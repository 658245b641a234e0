"""What the filters did to an assumption: its accepted draws beside those before filtering.

Filters keep only some of the combinations, so an input that they bear on is distributed differently afterwards,
although its range has not changed. (In statistics: conditioning; the draws before filtering are the prior, and an
assumption's draws on their own its marginal distribution.)
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo import statistics
from xlmc.montecarlo.columns import numbers
from xlmc.montecarlo.statistics import Estimate

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "PERCENTS",
    "FilterEffect",
    "Marginal",
    "Shapes",
    "filter_effect",
    "filter_effect_of",
    "marginal",
    "shapes",
    "shapes_of",
]

PERCENTS = (5.0, 50.0, 95.0)

_BINS = 24
_LONG = 1.3
"""If all draws cover more than this multiple of their middle 99.6 %, the chart leaves out their tails."""

_FOUND: Final[WeakKeyDictionary[RunResult, dict[str, FilterEffect]]] = WeakKeyDictionary()
"""By assumption. Sheets, page, document and JSON of one run want the same."""


@dataclass(frozen=True, slots=True)
class Marginal:
    """An assumption's draws on their own."""

    trials: int
    mean: Estimate
    standard_deviation: Estimate
    percentiles: Mapping[float, Estimate]


@dataclass(frozen=True, slots=True)
class FilterEffect:
    """An assumption before and after filtering.

    Attributes:
        prior: before filtering.
        accepted: after it.
        shift: of the mean, in standard deviations before filtering.
        narrowing: the accepted standard deviation over that before filtering.
    """

    prior: Marginal
    accepted: Marginal
    shift: Estimate
    narrowing: Estimate


@dataclass(frozen=True, slots=True)
class Shapes:
    """How often an assumption has each value.

    Attributes:
        edges: `(n + 1,)` of the bins.
        before: `(n,)` shares of the draws before filtering.
        accepted: `(n,)` shares of the accepted draws.
    """

    edges: NDArray[np.float64]
    before: NDArray[np.float64]
    accepted: NDArray[np.float64]


def shapes(
    prior: NDArray[np.float64], accepted: NDArray[np.float64], weights: NDArray[np.float64] | None = None
) -> Shapes | None:
    """Return the shapes of `(n,)` draws before filtering and of `(m,)` accepted ones; None if they are one value."""
    before, after = numbers(prior), numbers(accepted)
    w = np.ones(after.size) if weights is None else weights[~np.isnan(accepted)]
    if not before.size or not after.size or not w.any():
        return None
    low, high = _shown(before)
    if not (math.isfinite(low) and math.isfinite(high) and high > low):
        return None
    edges = np.linspace(low, high, _BINS + 1)
    shares = np.histogram(after, edges, weights=w)[0] / w.sum()
    return Shapes(edges, np.histogram(before, edges)[0] / before.size, shares)


def _shown(draws: NDArray[np.float64]) -> tuple[float, float]:
    """Return the ends of a picture of draws: all of them, but without long tails, which would leave the rest in one
    bar.
    """
    low, high = (float(end) for end in np.quantile(draws, (0.002, 0.998)))
    least, most = float(draws.min()), float(draws.max())
    return (least, most) if most - least <= _LONG * (high - low) else (low, high)


def marginal(
    draws: NDArray[np.float64],
    replicate: NDArray[np.int64] | None = None,
    weights: NDArray[np.float64] | None = None,
) -> Marginal:
    """Return the marginal of `(n,)` draws; NaN, a trial whose parameters were no distribution, is left out."""
    ids = None if replicate is None else replicate[~np.isnan(draws)]
    w = None if weights is None else weights[~np.isnan(draws)]
    values = numbers(draws)
    sample = statistics.Sample.of(values, w, ids)
    return Marginal(
        trials=int(values.size),
        mean=statistics.mean(sample),
        standard_deviation=statistics.standard_deviation(sample),
        percentiles=statistics.percentiles(sample, PERCENTS),
    )


def filter_effect_of(simulation: RunResult, assumption: str) -> FilterEffect | None:
    """Return what the filters of a run did to one of its assumptions; None if the assumption is not drawn."""
    if assumption not in simulation.inputs:
        return None
    found = _FOUND.setdefault(simulation, {})
    if assumption not in found:
        accepted, replicate, weighting = simulation.inputs[assumption], simulation.replicate, simulation.weighting
        accepted_replicates = None if replicate is None else replicate[: accepted.size]
        weights = None if weighting is None else weighting.weights
        found[assumption] = filter_effect(simulation.prior[assumption], accepted, accepted_replicates, weights)
    return found[assumption]


def shapes_of(simulation: RunResult, assumption: str) -> Shapes | None:
    """Return the shapes of one of a run's assumptions; None if it is not drawn, or is one value."""
    prior, accepted = simulation.prior.get(assumption), simulation.inputs.get(assumption)
    if prior is None or accepted is None:
        return None
    return shapes(prior, accepted, None if simulation.weighting is None else simulation.weighting.weights)


def filter_effect(
    prior: NDArray[np.float64],
    accepted: NDArray[np.float64],
    replicate: NDArray[np.int64] | None = None,
    weights: NDArray[np.float64] | None = None,
) -> FilterEffect:
    """Compare `(n,)` draws before filtering with the `(m,)` accepted ones.

    Errors are those of independent samples; they are a little too large, because accepted draws may be among the
    others. With the `(m,)` replicates of the accepted draws, those of the accepted come from the replicates; with their
    `(m,)` weights, from the effective sample size.
    """
    before, after = marginal(prior), marginal(accepted, replicate, weights)
    return FilterEffect(before, after, _shift(before, after), _narrowing(before, after))


def _shift(before: Marginal, after: Marginal) -> Estimate:
    spread = before.standard_deviation
    if not spread.value > 0.0:  # a constant, or a single trial
        return Estimate(math.nan)
    value = (after.mean.value - before.mean.value) / spread.value
    errors = (after.mean.error, before.mean.error, spread.error)
    if any(error is None for error in errors):
        return Estimate(value)
    of_after, of_before, of_spread = (error / spread.value for error in errors if error is not None)
    return Estimate(value, math.hypot(of_after, of_before, value * of_spread))


def _narrowing(before: Marginal, after: Marginal) -> Estimate:
    spread, left = before.standard_deviation, after.standard_deviation
    if not spread.value > 0.0:
        return Estimate(math.nan)
    value = left.value / spread.value
    if left.error is None or spread.error is None or not left.value > 0.0:
        return Estimate(value)
    return Estimate(value, value * math.hypot(left.error / left.value, spread.error / spread.value))
