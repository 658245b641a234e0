"""What the filters did to an assumption: its accepted draws beside those before filtering.

Filters keep only some of the combinations, so an input that they bear on is distributed differently afterwards,
although its range has not changed. (In statistics: conditioning; the draws before filtering are the prior, and an
assumption's draws on their own its marginal distribution.)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Final
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo import statistics
from xlmc.montecarlo.columns import RUN, ascending, numbers, on_disk
from xlmc.montecarlo.statistics import Estimate

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "DRAWN",
    "PERCENTS",
    "FilterEffect",
    "Marginal",
    "Shapes",
    "draws_of_prior",
    "filter_effect",
    "filter_effect_of",
    "marginal",
    "shapes",
    "shapes_of",
]

PERCENTS = (5.0, 50.0, 95.0)

DRAWN: Final = 100
"""The most assumptions whose shapes are drawn: more would make files slow to write and to open."""

_MOST_DRAWS: Final = 65_536 * DRAWN
_FEWEST_DRAWS: Final = 8_192
"""Draws before filtering that are summarised: of all assumptions together, and of each at least."""

_BINS = 24
_LONG = 1.3
"""If all draws cover more than this multiple of their middle 99.6 %, the chart leaves out their tails."""

_KNOWN: Final[WeakKeyDictionary[RunResult, dict[str, FilterEffect]]] = WeakKeyDictionary()
_SHAPES: Final[WeakKeyDictionary[RunResult, dict[str, Shapes | None]]] = WeakKeyDictionary()
"""By assumption. Sheets, page, document and JSON of one run want the same."""


@dataclass(frozen=True, slots=True)
class Marginal:
    """An assumption's draws on their own."""

    trials: int
    mean: Estimate
    standard_deviation: Estimate
    percentiles: Mapping[float, Estimate]


@dataclass(frozen=True)
class FilterEffect:
    """An assumption before and after filtering, each sorted when it is first asked for: without filters one is enough.

    Attributes:
        sort_prior, sort_accepted: give the two, and hold neither columns on disk nor the run.
    """

    sort_prior: Callable[[], Marginal]
    sort_accepted: Callable[[], Marginal]

    @cached_property
    def prior(self) -> Marginal:
        """The draws before filtering."""
        return self.sort_prior()

    @cached_property
    def accepted(self) -> Marginal:
        """The accepted draws."""
        return self.sort_accepted()

    @property
    def shift(self) -> Estimate:
        """How far the mean moved, in standard deviations before filtering."""
        return _shift(self.prior, self.accepted)

    @property
    def narrowing(self) -> Estimate:
        """The accepted standard deviation over that before filtering."""
        return _narrowing(self.prior, self.accepted)


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
    before, after = ascending(numbers(prior)), numbers(accepted)
    w = None if weights is None else weights[~np.isnan(accepted)]
    if not before.size or not after.size or (w is not None and not w.any()):
        return None
    low, high = _shown(before)
    if not (math.isfinite(high - low) and high > low):
        return None
    edges = np.linspace(low, high, _BINS + 1)
    shares = _counts(after, edges) / after.size if w is None else np.histogram(after, edges, weights=w)[0] / w.sum()
    cuts = [*np.searchsorted(before, edges[:-1]), np.searchsorted(before, edges[-1], side="right")]
    return Shapes(edges, np.diff(cuts) / before.size, shares)


def _counts(draws: NDArray[np.float64], edges: NDArray[np.float64]) -> NDArray[np.int64]:
    """Count draws in equal bins, by a division; given edges, NumPy would sort the draws.

    Bins that are no wider than the last digit of a number have to be given.
    """
    bins: Any = edges.size - 1 if (np.diff(edges) > 0.0).all() else edges
    return np.asarray(np.histogram(draws, bins, (edges[0], edges[-1]))[0])


def _shown(draws: NDArray[np.float64]) -> tuple[float, float]:
    """Return the ends of a picture of ascending draws: all of them, but without long tails, which would leave the rest
    in one bar.
    """
    low, high = (float(end) for end in np.quantile(draws, (0.002, 0.998)))
    least, most = float(draws[0]), float(draws[-1])
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
    if on_disk(values) and values.size <= RUN:  # a short one is sorted in memory: files would take longer
        values = values.copy()
    sample = statistics.Sample.of(values, w, ids)
    return Marginal(
        trials=int(values.size),
        mean=statistics.mean(sample),
        standard_deviation=statistics.standard_deviation(sample),
        percentiles=statistics.percentiles(sample, PERCENTS),
    )


def draws_of_prior(simulation: RunResult) -> int:
    """Return how many draws of each assumption before filtering are summarised: all that were kept; of more than
    `DRAWN` assumptions fewer, so that the work does not grow with them.
    """
    kept = next((values.size for values in simulation.prior.values()), 0)
    count = len(simulation.prior)
    return kept if count <= DRAWN else min(kept, max(_MOST_DRAWS // count, _FEWEST_DRAWS))


def filter_effect_of(simulation: RunResult, assumption: str) -> FilterEffect | None:
    """Return what the filters of a run did to one of its assumptions; None if the assumption is not drawn."""
    if assumption not in simulation.inputs:
        return None
    result = _KNOWN.setdefault(simulation, {})
    if assumption not in result:
        weights = None if simulation.weighting is None else simulation.weighting.weights
        replicate = partial(simulation.plan.replicate_of, simulation.trial_index)
        result[assumption] = FilterEffect(
            partial(_marginal_of, simulation.prior, assumption, lambda: None, None, draws_of_prior(simulation)),
            partial(_marginal_of, simulation.inputs, assumption, replicate, weights, None),
        )
    return result[assumption]


def _marginal_of(
    columns: Mapping[str, NDArray[np.float64]],
    assumption: str,
    replicate: Callable[[], NDArray[np.int64] | None],
    weights: NDArray[np.float64] | None,
    first: int | None,
) -> Marginal:
    """Return the marginal of an assumption's column, or of its first draws, with the replicates of the trials."""
    draws, ids = columns[assumption][:first], replicate()
    return marginal(draws, None if ids is None else ids[: draws.size], weights)


def shapes_of(simulation: RunResult, assumption: str) -> Shapes | None:
    """Return the shapes of one of a run's assumptions; None if it is not drawn, is one value, or is not among the first
    `DRAWN` of the workbook.
    """
    prior, accepted = simulation.prior.get(assumption), simulation.inputs.get(assumption)
    if prior is None or accepted is None:
        return None
    if all(each.name != assumption for each in simulation.model.assumptions[:DRAWN]):
        return None
    result = _SHAPES.setdefault(simulation, {})
    if assumption not in result:
        weighting = simulation.weighting
        result[assumption] = shapes(prior, accepted, None if weighting is None else weighting.weights)
    return result[assumption]


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
    return FilterEffect(partial(marginal, prior), partial(marginal, accepted, replicate, weights))


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
