"""Forecasts two at a time: how probable it is that both are high, or one above the other, and how they are correlated.

Probabilities are counted over all accepted trials in which both are numbers. A rank correlation needs both columns
sorted: of independent trials the first 65,536 are enough, with an error of 0.004 at most.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, islice
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.results.statements.significant_digits import rounded_value
from xlmc.montecarlo.columns import parts
from xlmc.montecarlo.statistics import Estimate, proportion, rank_correlation, replicated_proportion

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Forecast
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["PAIRS", "Pair", "pairs_of"]

Floats = NDArray[np.float64]
Replicates = NDArray[np.int64]

PAIRS: Final = 15
"""The most that are looked at unless asked otherwise: all of six forecasts."""

_RANKED: Final = 1 << 16
_RANKED_OF_REPLICATES: Final = 1 << 20
"""Replicates follow each other, so that the first trials belong to few of them."""


@dataclass(frozen=True, slots=True)
class Pair:
    """Two forecasts over the accepted trials in which both are numbers.

    Attributes:
        first, second: the forecasts.
        limits: what each is compared with: its threshold, or where it has none its median, in the digits that its error
            supports.
        thresholds: whether each limit is a threshold.
        limit_texts: each forecast with its limit, in words.
        trials: in which both are numbers.
        both_above: P(first > its limit and second > its limit).
        either_above: P(first > its limit or second > its limit).
        first_greater: P(first > second); None if their units differ or are not given.
        correlation: Spearman's.
        ranked: the trials that the correlation comes from.
    """

    first: Forecast
    second: Forecast
    limits: tuple[float, float]
    thresholds: tuple[bool, bool]
    limit_texts: tuple[str, str]
    trials: int
    both_above: Estimate
    either_above: Estimate
    first_greater: Estimate | None
    correlation: Estimate
    ranked: int


def pairs_of(simulation: RunResult, most: int = PAIRS) -> list[Pair]:
    """Return the first `most` pairs of forecasts that vary and have trials in common, in the order of the workbook."""
    results = simulation.results
    forecasts = [each for each in simulation.model.forecasts if results[each.name].statistics.range_width.value > 0.0]
    result = (_pair(simulation, *two) for two in combinations(forecasts, 2))
    return list(islice((pair for pair in result if pair is not None), most))


def _pair(simulation: RunResult, first: Forecast, second: Forecast) -> Pair | None:
    columns = (simulation.forecasts[first.name], simulation.forecasts[second.name])
    limits, replicate = (_limit(simulation, first), _limit(simulation, second)), simulation.replicate
    counts = _count_trials(columns, limits, replicate)
    trials = int(counts.trials.sum())
    if not trials:
        return None
    alike = bool(first.units) and first.units.strip() == second.units.strip()
    correlation, ranked = _correlation(columns, replicate)
    return Pair(
        first=first,
        second=second,
        limits=limits,
        thresholds=(first.threshold is not None, second.threshold is not None),
        limit_texts=(_limit_text(simulation, first, limits[0]), _limit_text(simulation, second, limits[1])),
        trials=trials,
        both_above=counts.share(counts.both),
        either_above=counts.share(counts.either),
        first_greater=counts.share(counts.greater) if alike else None,
        correlation=correlation,
        ranked=ranked,
    )


def _limit(simulation: RunResult, forecast: Forecast) -> float:
    if forecast.threshold is not None:
        return forecast.threshold
    result = simulation.results[forecast.name]
    if result.yes is not None:
        return 0.0  # above it is a yes
    median = result.statistics.median
    return median.value if math.isnan(median.value) else rounded_value(median, forecast.report_to, result.form)[0]


def _limit_text(simulation: RunResult, forecast: Forecast, limit: float) -> str:
    result = simulation.results[forecast.name]
    if forecast.threshold is None and result.yes is not None:
        return f"{forecast.name}, yes"
    units = f" {forecast.units}" if forecast.units else ""
    what = "median" if forecast.threshold is None else "threshold"
    return f"{forecast.name}, {what} {result.form.number(limit)}{units}"


@dataclass(frozen=True, slots=True)
class _Counts:
    """Trials of each replicate, `(R,)`, or of all in one number where the trials themselves are independent."""

    trials: Replicates
    both: Replicates
    either: Replicates
    greater: Replicates
    replicated: bool

    def share(self, hits: Replicates) -> Estimate:
        if not self.replicated:
            return proportion(int(hits.sum()), int(self.trials.sum()))
        known = self.trials > 0
        return replicated_proportion(hits[known], self.trials[known])


def _count_trials(columns: tuple[Floats, Floats], limits: tuple[float, float], replicate: Replicates | None) -> _Counts:
    size = 1 if replicate is None or not replicate.size else int(replicate[-1]) + 1
    counts = np.zeros((4, size), np.int64)
    for where, first, second in _together(columns):
        known = ~(np.isnan(first) | np.isnan(second))
        above = first > limits[0], second > limits[1]
        hits = known, known & above[0] & above[1], known & (above[0] | above[1]), known & (first > second)
        for row, hit in zip(counts, hits, strict=True):
            row += _by_replicate(hit, None if replicate is None else replicate[where], size)
    trials, both, either, greater = counts
    return _Counts(trials, both, either, greater, replicate is not None)


def _by_replicate(hit: NDArray[np.bool_], replicate: Replicates | None, size: int) -> Replicates:
    if replicate is None:
        return np.full(1, np.count_nonzero(hit), np.int64)
    return np.bincount(replicate[hit], minlength=size)


def _together(columns: tuple[Floats, Floats]) -> Iterator[tuple[slice, Floats, Floats]]:
    """Both columns, one part at a time, because they may be on disk."""
    start = 0
    for first, second in zip(*map(parts, columns), strict=True):
        where = slice(start, start + first.size)
        yield where, first, second
        start = where.stop


def _correlation(columns: tuple[Floats, Floats], replicate: Replicates | None) -> tuple[Estimate, int]:
    most = _RANKED if replicate is None else _RANKED_OF_REPLICATES
    first, second = (column[:most] for column in columns)
    known = ~(np.isnan(first) | np.isnan(second))
    if not known.any():
        return Estimate(math.nan), 0
    of = None if replicate is None else replicate[:most][known]
    estimate = rank_correlation(first[known], second[known], of)
    return estimate, estimate.n
