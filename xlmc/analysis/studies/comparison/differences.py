"""Two runs over the same trials: how far their answers lie apart, each number with the error of the difference.

Two distances of the whole distributions are among them. Neither can be negative, so that two runs of one model with
trials of their own lie apart, too, by about the error.

**Kolmogorov's distance** D = max |G(x) − F(x)| is the largest difference of the two distribution functions (Smirnov
1939 for two samples). Its error is that of G − F where the maximum lies (Raghavachari 1973).

**Wasserstein's distance** W₁ = ∫ |G(x) − F(x)| dx, in the forecast's unit, is the least mean distance by which the
trials of one run must be moved to lie as those of the other (Kantorovich 1942; this form Vallender 1974). It is the
difference of the means of a potential whose slope is the sign of F − G, and its error is that of this difference (del
Barrio, Giné & Matrán 1999).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import isnan

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.comparison.paired_statistics import (
    Accepted,
    Pair,
    Statistic,
    in_one_code,
    mean_of,
    named_shares,
    quantile_of,
    share_above,
    share_of,
    standard_deviation_of,
)
from xlmc.analysis.studies.comparison.tolerances import chance_tolerance
from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.simulation.simulation import RunResult
from xlmc.montecarlo.statistics import Estimate
from xlmc.montecarlo.statistics.estimate import with_error
from xlmc.montecarlo.statistics.proportions import least_error

__all__ = ["Acceptance", "Change", "Difference", "acceptance", "difference"]

Floats = NDArray[np.float64]


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
        threshold: of the forecast; None if it has none.
        above: P(> threshold); None without a threshold.
        kolmogorov, wasserstein: distances of the two distributions, as above.
        largest: the largest difference in a trial that both accept, 1 between two texts; nan without such trials.
        typical: the root mean square of these differences; nan without such trials.
        shares: `yes`, or each text -> its share, where the answers are counted; of texts there is nothing else.
        form: how the numbers are written.
    """

    mean: Change
    standard_deviation: Change
    low: Change
    high: Change
    share: float
    kolmogorov: Estimate
    wasserstein: Estimate
    largest: float
    typical: float
    threshold: float | None = None
    above: Change | None = None
    shares: Mapping[str, Change] = field(default_factory=dict)
    form: Form = PLAIN

    @property
    def changes(self) -> Iterator[tuple[str, Change]]:
        """The numbers that an answer is judged by, each with its name: four, and the probability where one is asked;
        where answers are counted, their shares alone.
        """
        if self.shares:
            yield from ((f"P({label})", change) for label, change in self.shares.items())
            return
        yield "mean", self.mean
        yield "SD", self.standard_deviation
        yield "lower end", self.low
        yield "upper end", self.high
        if self.above is not None and self.threshold is not None:
            yield f"P(> {self.form.number(self.threshold)})", self.above

    def tolerances(self, tolerance: float, chance: float | None) -> Mapping[str, float]:
        """Return number -> its tolerance.

        Args:
            tolerance: of mean, SD and central range, in the forecast's unit; of shares, nan where none is stated.
            chance: of a probability, and of such shares; None for `chance_tolerance` of it.
        """

        def of_chance(change: Change) -> float:
            return chance_tolerance(change.first.value) if chance is None else chance

        if self.shares:
            return {name: of_chance(each) if isnan(tolerance) else tolerance for name, each in self.changes}
        return {name: of_chance(each) if each is self.above else tolerance for name, each in self.changes}


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


def acceptance(first: RunResult, second: RunResult) -> Acceptance:
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


def difference(
    first: Accepted,
    second: Accepted,
    share: float,
    threshold: float | None = None,
    form: Form = PLAIN,
    *,
    distances: bool = True,
) -> Difference:
    """Compare a forecast in two runs over the same trials.

    Args:
        first: the accepted trials of one run.
        second: those of the other, in the same unit.
        share: of the trials, held by the central range.
        threshold: what P(> threshold) is compared for; None for no such number.
        form: how the first's numbers are written.
        distances: whether those of the distribution functions are wanted, which take most of the time; NaN if not.
    """
    first, second = in_one_code(first, second)
    pair = Pair(first, second)
    tail = (1.0 - share) / 2.0

    def change(mine: Statistic, theirs: Statistic) -> Change:
        return Change(mine.estimate, theirs.estimate, pair.difference(mine, theirs))

    shares = {
        label: change(*(share_of(each, positions) for each in (first, second)))
        for label, positions in named_shares(first, second).items()
    }
    if Kind.CATEGORY in (first.kind, second.kind):
        return _of_texts(pair, share, shares, form)
    mean = change(mean_of(first), mean_of(second))
    deviation = change(standard_deviation_of(first), standard_deviation_of(second))
    yes_no = first.sample.yes_no and second.sample.yes_no
    curves = None if yes_no or not distances else _Curves.of(pair)
    apart = _distance_of_shares(mean.difference) if yes_no else Estimate(np.nan)
    return Difference(
        mean=mean,
        standard_deviation=replace(deviation, difference=_of_deviations(deviation)) if yes_no else deviation,
        low=change(quantile_of(first, tail), quantile_of(second, tail)),
        high=change(quantile_of(first, 1.0 - tail), quantile_of(second, 1.0 - tail)),
        share=share,
        kolmogorov=apart if curves is None else _kolmogorov(pair, curves),
        wasserstein=apart if curves is None else _wasserstein(pair, curves),
        largest=float(np.abs(pair.apart).max()) if pair.apart.size else float("nan"),
        typical=float(np.sqrt(np.mean(pair.apart**2))) if pair.apart.size else float("nan"),
        threshold=threshold,
        above=None if threshold is None else change(share_above(first, threshold), share_above(second, threshold)),
        shares=shares,
        form=form,
    )


def _of_texts(pair: Pair, share: float, shares: Mapping[str, Change], form: Form) -> Difference:
    """Return what there is of answers that are texts; nothing where only one run has texts."""
    none = Estimate(np.nan)
    nothing, apart = Change(none, none, none), pair.apart != 0.0
    known = apart.size and bool(shares)
    return Difference(
        mean=nothing,
        standard_deviation=nothing,
        low=nothing,
        high=nothing,
        share=share,
        kolmogorov=none,
        wasserstein=none,
        largest=float(apart.max()) if known else float("nan"),
        typical=float(apart.mean()) ** 0.5 if known else float("nan"),
        shares=shares,
        form=form,
    )


def _of_deviations(change: Change) -> Estimate:
    """Return the difference of the standard deviations of yes/no forecasts, known no better than either is after one
    more yes.

    The deviation of shares p is √(p(1 − p)); a share is never known better than `least_error`.
    """
    estimate = change.difference
    if estimate.error is None:
        return estimate
    variance = min(change.first.value, change.second.value) ** 2
    share = 0.5 - max(0.25 - variance, 0.0) ** 0.5
    moved = min(share + least_error(estimate.n), 0.5)
    least = (moved * (1.0 - moved)) ** 0.5 - (share * (1.0 - share)) ** 0.5
    return with_error(estimate.value, max(estimate.error, least), estimate.n - 1.0, 0.95, estimate.n)


def _distance_of_shares(apart: Estimate) -> Estimate:
    """Both distances of two yes/no forecasts: the shares of yes differ by so much, in either direction."""
    if apart.interval is None:
        return replace(apart, value=abs(apart.value))
    low, high = sorted(abs(end) for end in apart.interval)
    crosses = apart.interval[0] < 0.0 < apart.interval[1]
    return replace(apart, value=abs(apart.value), interval=(0.0 if crosses else low, high))


@dataclass(frozen=True, slots=True, eq=False)
class _Curves:
    """The distribution functions of both runs.

    Attributes:
        points: `(p,)` all values, ascending.
        gaps: `(p,)` how far the second function lies above the first at each.
    """

    points: Floats
    gaps: Floats

    @classmethod
    def of(cls, pair: Pair) -> _Curves:
        first, second = pair.first.sample.x, pair.second.sample.x
        points = np.union1d(first, second)
        if not first.size or not second.size:
            return cls(points, np.full(points.size, np.nan))
        return cls(points, _share_below(second, points) - _share_below(first, points))


def _kolmogorov(pair: Pair, curves: _Curves) -> Estimate:
    """Return the largest difference of the distribution functions, 0 to 1."""
    first, second, n = pair.first, pair.second, _fewest(pair)
    if n == 0:
        return Estimate(np.nan)
    points, gaps = curves.points, curves.gaps
    most = int(np.argmax(np.abs(gaps)))
    pulls = [
        ((run.values <= points[most]) - _share_below(run.sample.x, points[most])) / run.m for run in (first, second)
    ]
    return with_error(abs(float(gaps[most])), pair.error(*pulls), n - 1.0, 0.95, n)


def _wasserstein(pair: Pair, curves: _Curves) -> Estimate:
    """Return the area between the distribution functions, in the unit of the values."""
    first, second, n = pair.first, pair.second, _fewest(pair)
    if n == 0:
        return Estimate(np.nan)
    points, gaps = curves.points, curves.gaps[:-1]
    widths = np.diff(points)
    potential = np.concatenate([[0.0], -np.cumsum(np.sign(gaps) * widths)])
    potentials = [_in_order_of(run, potential[np.searchsorted(points, run.sample.x)]) for run in (first, second)]
    pulls = [(g - g.mean()) / g.size for g in potentials]
    return with_error(float(np.sum(np.abs(gaps) * widths)), pair.error(*pulls), n - 1.0, 0.95, n)


def _in_order_of(run: Accepted, ascending: Floats) -> Floats:
    """Return what belongs to the values in ascending order in the order of the trials: ascending values are looked up
    several times as fast.
    """
    result = np.empty(ascending.size)
    result[run.order] = ascending
    return result


def _fewest(pair: Pair) -> int:
    return min(pair.first.m, pair.second.m)


def _share_below(ascending: Floats, points: Floats) -> Floats:
    """Return the share of the values that are not above each point."""
    return np.asarray(np.searchsorted(ascending, points, side="right") / ascending.size)
