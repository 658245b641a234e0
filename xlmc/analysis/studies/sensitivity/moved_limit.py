"""How the answers move as one limit moves, from the trials that decide it.

Tightened, a limit keeps some of the accepted trials. Loosened, it also lets in trials that nothing else rejects; these
are known of fewer of the run's trials, so each of them stands for several: it has a larger weight.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.sensitivity.measures import LimitAnswer, LimitPoint, Slope
from xlmc.analysis.studies.sensitivity.pull_errors import Units
from xlmc.montecarlo.statistics import Estimate, Sample, central_interval, proportion
from xlmc.montecarlo.statistics.estimate import with_error
from xlmc.montecarlo.statistics.sample import MOST_GROUPS

__all__ = ["LimitTrials", "grid", "holds_to", "moved_limit"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_STEPS = 3
"""Steps on either side of the limit as it is; the last on the tight side leaves about half of the accepted trials."""

_ROUND = (1.0, 2.0, 2.5, 5.0)


@dataclass(frozen=True)
class LimitTrials:
    """The trials that decide one limit.

    Attributes:
        relation: `>=`, `<=`, `>` or `<`.
        limit: as it is.
        values: `(n,)` of the filter's cell.
        accepted: `(n,)` whether the run accepted the trial; the others only this limit rejects.
        forecasts: `(f, n)`, NaN where one has no number.
        replicate: `(n,)` ids; None if trials are independent.
        trials: of which the accepted ones are known.
        loosened: of which the others are known, the first of these; 0 where none is.
    """

    relation: str
    limit: float
    values: Floats
    accepted: Bools
    forecasts: Floats
    replicate: NDArray[np.int64] | None
    trials: int
    loosened: int

    @property
    def weights(self) -> Floats:
        """`(n,)` how many trials each stands for."""
        return np.where(self.accepted, 1.0, self.trials / max(self.loosened, 1))

    def inside(self, limit: float) -> Bools:
        """`(n,)` the trials accepted with the limit at this value."""
        if limit == self.limit:
            return self.accepted
        accepted_now = holds_to(self.relation, self.values, limit)
        looser = (limit < self.limit) == self.relation.startswith(">")
        return accepted_now | self.accepted if looser else accepted_now & self.accepted


def holds_to(relation: str, values: Floats, limit: float | Floats) -> Bools:
    """Whether values hold to a limit; False where one is NaN."""
    compare = {">=": np.greater_equal, "<=": np.less_equal, ">": np.greater, "<": np.less}[relation]
    return np.asarray(compare(values, limit))


def grid(limit: float, values: Floats) -> tuple[float, ...]:
    """Limits to try, ascending, in round steps about the limit as it is; none where the accepted values tell no step.

    Up to half of the accepted trials are cut off by `_STEPS` steps on the tight side.
    """
    apart = np.abs(values[np.isfinite(values)] - limit)
    spacing = float(np.median(apart)) if apart.size else 0.0
    if not (math.isfinite(spacing) and spacing > 1e-9 * abs(limit) and spacing > 1e-300):
        return ()
    step = _round_below(spacing / _STEPS)
    return tuple(float(f"{limit + count * step:.12g}") if count else limit for count in range(-_STEPS, _STEPS + 1))


def _round_below(size: float) -> float:
    """Round down to the largest of 1, 2, 2.5 and 5 times a power of ten that is no larger."""
    mantissa, _, exponent = f"{size:.6e}".partition("e")
    return float(f"{max(each for each in _ROUND if each <= float(mantissa))}e{exponent}")


def moved_limit(
    trials: LimitTrials, limits: Sequence[float], names: Sequence[str], central: Sequence[float]
) -> tuple[tuple[LimitPoint, ...], tuple[Slope, ...]]:
    """Return the answers at every one of these limits, ascending, the limit as it is among them; and their slopes
    there.

    Args:
        trials: the trials.
        limits: as `grid` gives them.
        names: of the `f` forecasts.
        central: their central ranges' shares.
    """
    inside = [trials.inside(limit) for limit in limits]
    table = [
        _answers_at(trials, row, inside, limits, share) for row, share in zip(trials.forecasts, central, strict=True)
    ]
    points = tuple(
        LimitPoint(
            limit=limit,
            trials=round(float(trials.weights[mask].sum())),
            acceptance=_acceptance(trials, mask),
            answers=tuple(LimitAnswer(name, *answers[index]) for name, (answers, _) in zip(names, table, strict=True)),
        )
        for index, (limit, mask) in enumerate(zip(limits, inside, strict=True))
    )
    return points, tuple(Slope(name, slope) for name, (_, slope) in zip(names, table, strict=True))


def _acceptance(trials: LimitTrials, inside: Bools) -> Estimate:
    """Return the share of all trials; the two parts have errors of their own."""
    more = int(np.count_nonzero(inside & ~trials.accepted))
    known = proportion(int(np.count_nonzero(inside & trials.accepted)), trials.trials)
    if not more:
        return known
    loose = proportion(more, trials.loosened)
    error = math.hypot(known.error or 0.0, loose.error or 0.0)
    return with_error(known.value + loose.value, error, math.inf, 0.95, trials.trials)


def _answers_at(
    trials: LimitTrials, forecast: Floats, inside: Sequence[Bools], limits: Sequence[float], central: float
) -> tuple[list[tuple[Estimate, Estimate, Estimate, Estimate]], Estimate]:
    """Mean, its change, and both ends of the central range of a forecast `(n,)` at every limit; and the slope."""
    order = np.argsort(forecast)[: int(np.count_nonzero(~np.isnan(forecast)))]
    y, weights, accepted = forecast[order], trials.weights[order], trials.accepted[order]
    units = Units.of(y.size, None if trials.replicate is None else trials.replicate[order])
    now = _mean(y, weights, accepted, units)
    made: dict[bytes, _Moved] = {}  # many limits may keep the same trials
    moved = []
    for mask in inside:
        accepted_now = mask[order]
        key = accepted_now.tobytes()
        if key not in made:
            made[key] = _move(y, weights, accepted_now, units, now, central)
        moved.append(made[key])
    slope = _slope(trials, [(each.value, each.pulls) for each in moved], limits, units, accepted)
    return [each.estimates for each in moved], slope


class _Moved(NamedTuple):
    """A mean with its `(n,)` pulls; and the mean, its change, and both ends of the central range as estimates."""

    value: float
    pulls: Floats
    estimates: tuple[Estimate, Estimate, Estimate, Estimate]


def _move(
    y: Floats, weights: Floats, accepted_now: Bools, units: Units, now: tuple[float, Floats], central: float
) -> _Moved:
    """Return the result of a moved limit, from the trials held, in ascending order; `now` is the mean of the accepted
    ones.
    """
    mean, pulls = _mean(y, weights, accepted_now, units)
    change = _estimate(mean - now[0], pulls - now[1], units, accepted_now)
    low, high = central_interval(_sample(y, weights, accepted_now, units), central)
    return _Moved(mean, pulls, (_estimate(mean, pulls, units, accepted_now), change, low, high))


def _slope(
    trials: LimitTrials,
    means: Sequence[tuple[float, Floats]],
    limits: Sequence[float],
    units: Units,
    accepted_now: Bools,
) -> Estimate:
    """Return the slope of the mean, over one step on either side."""
    index = list(limits).index(trials.limit)
    (before, pulls), (after, more) = means[index - 1], means[index + 1]
    width = limits[index + 1] - limits[index - 1]
    return _estimate((after - before) / width, (more - pulls) / width, units, accepted_now)


def _mean(y: Floats, weights: Floats, accepted_now: Bools, units: Units) -> tuple[float, Floats]:
    """Return the weighted mean, nan of no trial, and how each of the `(n,)` trials pulls it, times n."""
    w = np.where(accepted_now, weights, 0.0)
    total = float(w.sum())
    if total == 0.0:
        return math.nan, np.zeros(y.size)
    w = w / total  # first, so that the sum cannot overflow
    mean = float(np.sum(w * y))
    return mean, w * (y - mean) * units.n


def _estimate(value: float, pulls: Floats, units: Units, accepted_now: Bools) -> Estimate:
    if np.count_nonzero(accepted_now) < 2:
        return Estimate(value)
    return units.estimate(value, units.error(pulls))


def _sample(y: Floats, weights: Floats, accepted_now: Bools, units: Units) -> Sample:
    """Make a sample of ascending values; it is made directly, because they are in order."""
    w = weights[accepted_now]
    even = bool(np.all(w == w[0])) if w.size else True
    group, groups = None, 0
    if units.replicate is not None:
        group = np.unique(units.replicate[accepted_now] % MOST_GROUPS, return_inverse=True)[1].astype(np.intp)
        groups = int(group.max(initial=-1)) + 1
    return Sample(y[accepted_now], None if even else w / w.sum(), group, groups)
