"""How far each accepted trial pulls a statistic: from this come the errors of differences between runs.

A statistic's error is the root of the sum of its squared influences, one an independent trial (Hampel 1974; the
infinitesimal jackknife). Where two runs share their trials, a trial that both accept pulls both, and the error of
the difference is the root of the sum of squares of the differences of these pulls: what the runs have in common then
cancels, however many trials only one of the runs accepts.

A share is the exception, and so is the mean of a forecast that is 0 or 1 in every trial: that no trial changed sides
does not prove that none can. Of n trials that both runs accept, those that change to one side and those that change to
the other are two counts; each has the interval of `proportions`, and the interval of their difference lies as far from
it as the ends of both together (Newcombe 1998, method 10, for shares of the same trials).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo import statistics
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.statistics import Estimate, Sample
from xlmc.montecarlo.statistics.estimate import with_error
from xlmc.montecarlo.statistics.proportions import least_error

if TYPE_CHECKING:
    from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = [
    "Accepted",
    "Influence",
    "Pair",
    "Statistic",
    "in_one_code",
    "mean_of",
    "named_shares",
    "quantile_of",
    "range_of",
    "share_above",
    "share_of",
    "standard_deviation_of",
]

_ROUNDING: Final = 1e-13
"""The part of two numbers up to which their difference, or its error, is what rounding left of 0."""

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Accepted:
    """The accepted trials of one run in which a forecast has an answer.

    Attributes:
        trials: `(m,)` their indices, ascending.
        values: `(m,)` the forecast: a number, 1 for yes and 0 for no, or the position of its text in `texts`.
        kind: what the answers are.
        texts: all texts that there are, where the answers are texts.
    """

    trials: NDArray[np.int64]
    values: Floats
    kind: Kind = Kind.NUMBER
    texts: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        trials: NDArray[np.int64],
        values: Floats,
        kind: Kind = Kind.NUMBER,
        texts: tuple[str, ...] = (),
    ) -> Accepted:
        """Leave out the trials in which the forecast has no answer, NaN; any number but 0 is a yes."""
        known = ~np.isnan(values)
        result = np.asarray(values)[known]
        return cls(
            np.asarray(trials)[known],
            (result != 0.0).astype(np.float64) if kind is Kind.YES_NO else result,
            kind,
            texts,
        )

    @classmethod
    def of_run(cls, run: RunResult, name: str, factor: float = 1.0) -> Accepted:
        """Return the answers of a forecast in a run, its numbers multiplied by a factor."""
        texts = run.labels.get(name)
        values = run.forecasts[name] if texts is not None else run.forecasts[name] * factor
        return cls.of(run.trial_index, values, run.results[name].kind, tuple(texts or ()))

    @cached_property
    def sample(self) -> Sample:
        """The values in ascending order."""
        return Sample.of(self.values, two_valued=self.kind is Kind.YES_NO)

    @cached_property
    def order(self) -> Indices:
        """`(m,)` the trials' positions in ascending order of their values."""
        return np.argsort(self.values)

    @property
    def is_share(self) -> bool:
        """Whether the answers are counted: of yes and no, and of texts."""
        return self.kind in (Kind.YES_NO, Kind.CATEGORY) or self.sample.yes_no

    @property
    def m(self) -> int:
        return int(self.values.size)

    @property
    def scale(self) -> float:
        """The standard deviation, of texts that of the most frequent one; of yes in all trials, or of no, and of one
        text in all, the largest that a share can have.
        """
        if self.kind is Kind.CATEGORY:
            share = float(np.bincount(self.values.astype(np.intp)).max() / self.m) if self.m else 0.0
            return (share * (1.0 - share)) ** 0.5 or 0.5
        value = statistics.standard_deviation(self.sample).value
        return 0.5 if value == 0.0 and self.sample.yes_no else value

    def says(self, positions: tuple[float, ...]) -> Bools:
        """`(m,)` whether the answer is one of these."""
        return np.isin(self.values, positions)


_MOST_TEXTS: Final = 6
"""Texts of one forecast that are compared each for itself."""


def in_one_code(first: Accepted, second: Accepted) -> tuple[Accepted, Accepted]:
    """Return both with the same texts in the same positions; as they are where either has numbers."""
    if first.kind is not Kind.CATEGORY or second.kind is not Kind.CATEGORY:
        return first, second
    texts = tuple(dict.fromkeys((*first.texts, *second.texts)))
    where = np.array([float(texts.index(each)) for each in second.texts])
    values = where[second.values.astype(np.intp)] if second.m else second.values
    return replace(first, texts=texts), replace(second, values=values, texts=texts)


def named_shares(first: Accepted, second: Accepted) -> dict[str, tuple[float, ...]]:
    """Return what two runs are compared by where their answers are counted: `yes`, or each text -> its positions.

    Nothing where either has numbers other than 0 and 1. Of many texts the rarer ones stand together.

    Args:
        first: of one run.
        second: of the other, in one code with the first; see `in_one_code`.
    """
    if first.kind is Kind.CATEGORY and second.kind is Kind.CATEGORY:
        count = len(first.texts)
        often = [np.bincount(each.values.astype(np.intp), minlength=count) for each in (first, second)]
        order = [
            p for p in sorted(range(count), key=lambda p: (-often[0][p], -often[1][p])) if often[0][p] + often[1][p]
        ]
        result = {first.texts[p] or "(empty)": (float(p),) for p in order[:_MOST_TEXTS]}
        rest = tuple(map(float, order[_MOST_TEXTS:]))
        return result | ({"any other text": rest} if rest else {})
    kinds = {first.kind, second.kind}
    if Kind.CATEGORY in kinds or Kind.YES_NO not in kinds:
        return {}
    return {"yes": (1.0,)} if all(bool(np.isin(each.values, (0.0, 1.0)).all()) for each in (first, second)) else {}


@dataclass(frozen=True)
class Influence:
    """How far each accepted trial pulls a statistic.

    Attributes:
        pulls: `(m,)` in the statistic's unit; they sum to about 0.
        spacing: the statistic moves in steps of this size, where it has steps; 0 where it has none.
    """

    pulls: Floats
    spacing: float = 0.0


@dataclass(frozen=True)
class Statistic:
    """A statistic of one run.

    Attributes:
        estimate: of it.
        influence: of the trials; None if they are too few for one.
        hits: `(m,)` the trials that it is the share of; None if it is no share.
    """

    estimate: Estimate
    influence: Influence | None
    hits: Bools | None = None


def mean_of(run: Accepted) -> Statistic:
    """Estimate the mean; a trial pulls it by (x − mean)/m."""
    estimate = statistics.mean(run.sample)
    if estimate.error is None:
        return Statistic(estimate, None)
    pulls = (run.values - estimate.value) / run.m
    return Statistic(estimate, Influence(pulls), run.values > 0.5 if run.sample.yes_no else None)


def standard_deviation_of(run: Accepted) -> Statistic:
    """Estimate the standard deviation; a trial pulls it by ((x − mean)² − s²)/(2 s m)."""
    estimate = statistics.standard_deviation(run.sample)
    if estimate.error is None:
        return Statistic(estimate, None)
    if estimate.value == 0.0:
        return Statistic(estimate, Influence(np.zeros(run.m)))
    z = (run.values - statistics.mean(run.sample).value) / estimate.value
    return Statistic(estimate, Influence((z * z - 1.0) * (estimate.value / (2.0 * run.m))))


def share_above(run: Accepted, threshold: float) -> Statistic:
    """Estimate the share p of trials above a threshold; a trial pulls it by ([x > threshold] − p)/m."""
    return _share(run, run.values > threshold)


def _share(run: Accepted, hits: Bools) -> Statistic:
    if run.m < 2:
        return Statistic(Estimate(float(hits.mean()) if run.m else np.nan), None)
    estimate = statistics.proportion(int(hits.sum()), run.m)
    return Statistic(estimate, Influence((hits - float(hits.mean())) / run.m), hits)


def share_of(run: Accepted, positions: tuple[float, ...]) -> Statistic:
    """Estimate the share p of trials whose answer is one of these; a trial pulls it by ([it is] − p)/m."""
    return _share(run, run.says(positions))


def quantile_of(run: Accepted, p: float) -> Statistic:
    """Estimate the quantile q at p; a trial pulls it by (p − [x ≤ q])/(m f(q)), in steps of 1/(m f(q)).

    The density f(q) is the one that gives the quantile's own standard error, which comes from order statistics.
    """
    estimate = statistics.percentile(run.sample, 100.0 * p)
    if estimate.error is None:
        return Statistic(estimate, None)
    below = run.values <= estimate.value
    if below.all():  # the quantile is the largest value, which many trials have: the first of them count as below
        below[np.argsort(run.values, kind="stable")[max(1, int(p * run.m)) :]] = False
    share = float(below.mean())
    step = estimate.error / (run.m * share * (1.0 - share)) ** 0.5
    return Statistic(estimate, Influence((share - below) * step, step))


def range_of(run: Accepted, share: float) -> Statistic:
    """Estimate the width of the central range that holds a share of the trials: its ends pull in opposite
    directions.
    """
    low, high = (quantile_of(run, (1.0 + side * share) / 2.0) for side in (-1.0, 1.0))
    width = high.estimate.value - low.estimate.value
    if low.influence is None or high.influence is None:
        return Statistic(Estimate(width, n=run.m), None)
    pulls = high.influence.pulls - low.influence.pulls
    estimate = with_error(width, float(np.sum(pulls * pulls)) ** 0.5, run.m - 1.0, 0.95, run.m)
    return Statistic(estimate, Influence(pulls, max(low.influence.spacing, high.influence.spacing)))


class Pair:
    """Two runs over the same trials, (seed, index) by (seed, index).

    Attributes:
        both: `(c, 2)` rows, in the first and in the second, of the trials that both accept.
        only: the rows of those that only the first accepts, and of those that only the second does.

    Args:
        first: the accepted trials of one run.
        second: those of the other.
        size: trials in a replicate, within which they depend on each other; 0 where the trials are independent.
        replicates: how many there are.
    """

    def __init__(self, first: Accepted, second: Accepted, size: int = 0, replicates: int = 0) -> None:
        self.first, self.second, self._size, self._replicates = first, second, size, replicates
        _, mine, theirs = np.intersect1d(first.trials, second.trials, assume_unique=True, return_indices=True)
        self.both: tuple[Indices, Indices] = (mine, theirs)
        self.only: tuple[Indices, Indices] = (_others(mine, first.m), _others(theirs, second.m))

    @cached_property
    def apart(self) -> Floats:
        """`(c,)` second less first, in the trials that both accept."""
        mine, theirs = self.both
        return np.asarray(self.second.values[theirs] - self.first.values[mine])

    def difference(self, first: Statistic, second: Statistic) -> Estimate:
        """Subtract the first's statistic from the second's, with the error of the difference.

        A quantile moves in steps. Where hardly a trial crosses it, the influences say nothing, and the error is taken
        to be one step, or the spread of the paired differences where that is smaller.
        """
        value, n = second.estimate.value - first.estimate.value, min(self.first.m, self.second.m)
        if first.influence is None or second.influence is None:
            return Estimate(value, n=n)
        error = self.error(first.influence.pulls, second.influence.pulls)
        step = max(first.influence.spacing, second.influence.spacing)
        if step and self.apart.size:
            error = max(error, min(step, float(self.apart.std())))
        noise = _ROUNDING * max(abs(first.estimate.value), abs(second.estimate.value))
        value, error = (0.0 if abs(each) <= noise else each for each in (value, error))
        units = min(n, self._replicates) if self._size else n
        estimate = with_error(value, error, units - 1.0, 0.95, n)
        if first.hits is None or second.hits is None or self._same_number:
            return estimate
        return self._of_shares(estimate, first.hits, second.hits)

    @property
    def _same_number(self) -> bool:
        """Whether both runs accept the same trials and give the same number in each, which is not only counted."""
        one_sided = any(rows.size for rows in self.only)
        return not (one_sided or np.any(self.apart) or self.first.is_share)

    def _of_shares(self, estimate: Estimate, first: Bools, second: Bools) -> Estimate:
        """Return the difference of two shares, never 0 ± 0; its interval is that of two counts where nothing else
        differs.
        """
        if estimate.error is None or estimate.interval is None:
            return estimate
        (mine, theirs), n = self.both, estimate.n
        if self._size or any(rows.size for rows in self.only):
            most = statistics.proportion(0, n).interval
            assert most is not None
            return replace(
                estimate,
                error=max(estimate.error, least_error(n)),
                interval=(
                    min(estimate.interval[0], estimate.value - most[1]),
                    max(estimate.interval[1], estimate.value + most[1]),
                ),
            )
        went, came = int(np.sum(first[mine] & ~second[theirs])), int(np.sum(second[theirs] & ~first[mine]))
        return replace(estimate, error=max(estimate.error, least_error(n)), interval=_interval_of_counts(went, came, n))

    def error(self, first: Floats, second: Floats) -> float:
        """Return the standard error of a difference, from the pulls `(m,)` on either side."""
        if self._size:
            sums = self._by_replicate(self.second.trials, second) - self._by_replicate(self.first.trials, first)
            return float((np.sum(sums * sums) * sums.size / max(sums.size - 1, 1)) ** 0.5)
        (mine, theirs), (mine_only, theirs_only) = self.both, self.only
        n = min(self.first.m, self.second.m)
        parts = second[theirs] - first[mine], first[mine_only], second[theirs_only]
        return float((sum(float(np.sum(part * part)) for part in parts) * n / max(n - 1, 1)) ** 0.5)

    def _by_replicate(self, trials: NDArray[np.int64], pulls: Floats) -> Floats:
        """`(replicates,)` the sums of the pulls."""
        return np.asarray(np.bincount(trials // self._size, pulls, self._replicates), np.float64)


def _interval_of_counts(went: int, came: int, n: int) -> tuple[float, float]:
    """Of (came − went)/n.

    >>> low, high = _interval_of_counts(0, 0, 1_000)
    >>> round(low, 5), round(high, 5)
    (-0.00383, 0.00383)
    """
    away, here = statistics.proportion(went, n), statistics.proportion(came, n)
    assert away.interval is not None
    assert here.interval is not None
    value = here.value - away.value
    low = value - float(np.hypot(here.value - here.interval[0], away.interval[1] - away.value))
    return low, value + float(np.hypot(here.interval[1] - here.value, away.value - away.interval[0]))


def _others(rows: Indices, m: int) -> Indices:
    left = np.ones(m, bool)
    left[rows] = False
    return np.flatnonzero(left)
