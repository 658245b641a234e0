"""Two runs over the same trials: how far their answers lie apart, each number with the error of the difference."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from xlmc.run.simulation import Simulation
from xlmc.statistics import Estimate
from xlmc.studies.comparison.distances import kolmogorov, wasserstein
from xlmc.studies.comparison.influences import (
    Accepted,
    Pair,
    Statistic,
    mean_of,
    quantile_of,
    share_above,
    standard_deviation_of,
)
from xlmc.studies.comparison.tolerances import chance_tolerance

__all__ = ["Acceptance", "Change", "Difference", "acceptance", "difference"]


@dataclass(frozen=True, slots=True)
class Change:
    """One statistic in two runs.

    Attributes:
        first, second: in either run.
        difference: second less first, with its own error: the runs share their draws, so it is mostly smaller than the
            errors of the two.
    """

    first: Estimate
    second: Estimate
    difference: Estimate


@dataclass(frozen=True, slots=True)
class Difference:
    """A forecast in two runs, in the first one's unit.

    Attributes:
        share: of the trials, held by the central range from `low` to `high`.
        threshold: of the forecast; None where it has none.
        above: P(> threshold); None where there is none.
        kolmogorov, wasserstein: distances of the two distributions; see `distances`.
        largest: the largest difference in a trial that both accept; nan where there is none.
    """

    mean: Change
    standard_deviation: Change
    low: Change
    high: Change
    share: float
    kolmogorov: Estimate
    wasserstein: Estimate
    largest: float
    threshold: float | None = None
    above: Change | None = None

    @property
    def changes(self) -> Iterator[tuple[str, Change]]:
        """The numbers that an answer is judged by, each with its name: four, and the probability where one is asked."""
        yield "mean", self.mean
        yield "SD", self.standard_deviation
        yield "lower end", self.low
        yield "upper end", self.high
        if self.above is not None:
            yield f"P(> {self.threshold:.15g})", self.above

    def tolerances(self, tolerance: float, chance: float | None) -> Mapping[str, float]:
        """Number -> its tolerance.

        Args:
            tolerance: of mean, SD and central range, in the forecast's unit.
            chance: of the probability; None for `chance_tolerance` of it.
        """
        found = dict.fromkeys((name for name, _ in self.changes), tolerance)
        if self.above is not None:
            found[f"P(> {self.threshold:.15g})"] = (
                chance_tolerance(self.above.first.value) if chance is None else chance
            )
        return found


@dataclass(frozen=True, slots=True)
class Acceptance:
    """What two runs over the same trials accept.

    Attributes:
        both, first_only, second_only: trials.
        relative: second over first, less 1.
    """

    both: int
    first_only: int
    second_only: int
    first: Estimate
    second: Estimate
    relative: Estimate


def acceptance(first: Simulation, second: Simulation) -> Acceptance:
    """Compare what is accepted; the error of the ratio comes from the trials that one run alone accepts."""
    both = int(np.intersect1d(first.trial_index, second.trial_index, assume_unique=True).size)
    mine, theirs = first.accepted - both, second.accepted - both
    return Acceptance(both, mine, theirs, first.acceptance, second.acceptance, _relative(both, mine, theirs))


def _relative(both: int, mine: int, theirs: int) -> Estimate:
    """(both + theirs)/(both + mine) − 1; its error by the delta method, never less than that of one trial more."""
    first, second = both + mine, both + theirs
    if not first:
        return Estimate(np.nan)
    if not second:
        return Estimate(-1.0, 1.0 / first, n=first)
    ratio = second / first
    square = mine / first**2 + theirs / second**2 + both * (1.0 / second - 1.0 / first) ** 2
    return Estimate(ratio - 1.0, max(ratio * square**0.5, 1.0 / first), n=first)


def difference(first: Accepted, second: Accepted, share: float, threshold: float | None = None) -> Difference:
    """Compare a forecast in two runs over the same trials.

    Args:
        first: the accepted trials of one run.
        second: those of the other, in the same unit.
        share: of the trials, held by the central range.
        threshold: what P(> threshold) is compared for; None for no such number.
    """
    pair = Pair(first, second)
    tail = (1.0 - share) / 2.0

    def change(mine: Statistic, theirs: Statistic) -> Change:
        return Change(mine.estimate, theirs.estimate, pair.difference(mine, theirs))

    return Difference(
        mean=change(mean_of(first), mean_of(second)),
        standard_deviation=change(standard_deviation_of(first), standard_deviation_of(second)),
        low=change(quantile_of(first, tail), quantile_of(second, tail)),
        high=change(quantile_of(first, 1.0 - tail), quantile_of(second, 1.0 - tail)),
        share=share,
        kolmogorov=kolmogorov(pair),
        wasserstein=wasserstein(pair),
        largest=float(np.abs(pair.apart).max()) if pair.apart.size else float("nan"),
        threshold=threshold,
        above=None if threshold is None else change(share_above(first, threshold), share_above(second, threshold)),
    )
