"""Error against work: what a method's runs of growing length are off by.

Errors are root mean squares over replicates, that is, over runs with seeds of their own; in logarithms they lie
about on a straight line over the length of the runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import median
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from xlmc.analysis.studies.methods.answer import STATISTICS, Method, MethodResult
from xlmc.analysis.studies.methods.converged_reference import Reference

__all__ = ["NORMAL_95", "Curve", "Rms", "Runs", "in_order", "rms_of", "runs_of", "slope_of"]

NORMAL_95: Final = 1.959964
"""95 of 100 runs lie within so many root mean square errors."""

_BEYOND_CHANCE: Final = 4.0
"""Standard errors from which on a mean error counts as more than chance: many numbers are looked at."""

_APART: Final = 1.5
"""The longest run of a line takes at least so many times what the shortest takes; of less, a slope is noise. Short runs
all take the same time."""

_CONVERGED: Final = 20.0
"""Accepted trials of a run, about; of fewer, quantiles lie between the same few numbers however they are drawn."""


@dataclass(frozen=True, slots=True)
class Rms:
    """The root mean square error of a number, over `n` replicates, without the error of what it is measured against.

    Attributes:
        value: in the units of the number; NaN where no replicate gave one. The spread of the replicates about their own
            mean, and the mean error with it where that is more than chance and the reference's error explain.
        error: its standard error; of a single answer, the reference's own error.
        bias: the mean error: what more replicates would not average away. It has the reference's error in it.
        spread: standard deviation of the errors about their mean; NaN of a single answer.
        n: replicates that gave a number.
    """

    value: float
    error: float
    bias: float
    spread: float
    n: int

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval of the true root mean square error (χ² of as many replicates).

        Of a single answer, within 1.96 standard errors of the reference.
        """
        if self.n < 2 or not self.value > 0.0:
            reach = NORMAL_95 * float(np.nan_to_num(self.error))
            return max(self.value - reach, 0.0), self.value + reach
        from scipy.special import chdtri

        free = self.n - 1
        low, high = (float(np.sqrt(free / chdtri(free, p))) for p in (0.025, 0.975))
        return low * self.value, high * self.value


def rms_of(errors: ArrayLike, reference: float = 0.0) -> Rms:
    """Return the root mean square of errors, NaNs left out.

    Args:
        errors: the differences from a reference.
        reference: its standard error.

    >>> rms_of([3.0, -4.0, 1.0, float("nan")]).value
    3.605551275463989
    """
    values = np.asarray(errors, np.float64)
    values = values[~np.isnan(values)]
    known = float(np.nan_to_num(reference))
    if not values.size:
        return Rms(np.nan, np.nan, np.nan, np.nan, 0)
    bias = float(np.mean(values))
    if values.size == 1:
        return Rms(abs(bias), known, bias, np.nan, 1)
    spread = float(np.std(values, ddof=1))
    chance = spread**2 / values.size + known**2
    more = max(bias**2 - chance, 0.0) if bias**2 > _BEYOND_CHANCE**2 * chance else 0.0
    value = float(np.sqrt(spread**2 + more))
    return Rms(value, value / float(np.sqrt(2.0 * (values.size - 1))), bias, spread, int(values.size))


def slope_of(x: Sequence[float], y: Sequence[float], weights: Sequence[float] | None = None) -> float:
    """Slope of the straight line through logarithms; NaN where the points do not lie apart (`_APART`).

    >>> round(slope_of([1, 100], [3, 0.3]), 6)
    -0.5
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        across, up = np.log(np.asarray(x, np.float64)), np.log(np.asarray(y, np.float64))
    known = np.isfinite(across) & np.isfinite(up)
    weigh = np.ones(across.shape) if weights is None else np.asarray(weights, np.float64)
    across, up, weigh = across[known], up[known], weigh[known]
    if across.size < 2 or np.ptp(across) < np.log(_APART):
        return np.nan
    left, right = across - np.average(across, weights=weigh), up - np.average(up, weights=weigh)
    return float(np.sum(weigh * left * right) / np.sum(weigh * left**2))


@dataclass(frozen=True, slots=True, eq=False)
class Runs:
    """The runs of one length.

    Attributes:
        budget: evaluations that each run might spend.
        seconds: of the fastest run, because other work of the machine held up the others; no more than those of the
            fastest longer run, which does all that this one does (`in_order`).
        usual: seconds, the median of the runs.
        evaluations: that a run spent, the median.
        errors: (forecast, attribute of `Answer`) -> in the forecast's units.
        shares: attribute of `Answer` -> the same over the forecasts' 5–95 % ranges, root mean square over the
            forecasts in which it converges: one number without units.
        acceptance: of the share of accepted trials; None if the method gives none.
        effective: accepted trials that count fully, the median; None if all weigh alike.
        failed: runs without any number.
        converged: whether so many trials are accepted that errors fall as theory says; only such runs are extrapolated.
        measured: whether the seconds were, and not worked out from the rate of a shorter run.
    """

    budget: int
    seconds: float
    usual: float
    evaluations: float
    errors: Mapping[tuple[str, str], Rms]
    shares: Mapping[str, float]
    acceptance: Rms | None
    effective: float | None = None
    failed: int = 0
    converged: bool = True
    measured: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """A method's runs, by length, the shortest first; of one length where it has no budget to spend.

    Attributes:
        method: whose.
        lengths: its runs.
        setup: seconds of its first run beyond those of the next, in which things are compiled or imported.
        remarks: of its last run.
        ranges: forecast -> the bounds it gives, for methods that give bounds.
        ends: of bounds, the points that they are reached at (`MethodResult.ends`).
        apart: of an engine, by how many standard deviations its answers differ at most from those of the engine
            `numpy` at the same trials.
    """

    method: Method
    lengths: tuple[Runs, ...]
    setup: float
    remarks: tuple[str, ...]
    ranges: Mapping[str, tuple[float, float]]
    apart: float = 0.0
    ends: Mapping[tuple[str, str], Mapping[str, float]] = field(default_factory=dict)

    @property
    def answers(self) -> bool:
        """Whether it gives mean, standard deviation and range, and not only bounds."""
        return any(np.isfinite(value) for value in self.lengths[-1].shares.values())

    @property
    def converged(self) -> tuple[Runs, ...]:
        """The runs that errors are extrapolated from; the longest where too few trials are accepted even there."""
        return tuple(runs for runs in self.lengths if runs.converged) or self.lengths[-1:]

    def slope(self, statistic: str, against: str = "seconds") -> float:
        """Return the slope of the error, in logarithms, against `seconds`, `evaluations` or `budget`; NaN where these
        hardly differ.
        """
        across = [float(getattr(runs, against)) for runs in self.converged]
        weights = [max(max(error.n for error in runs.errors.values()) - 1.0, 1.0) for runs in self.converged]
        return slope_of(across, [runs.shares[statistic] for runs in self.converged], weights)


def in_order(lengths: Sequence[Runs]) -> tuple[Runs, ...]:
    """Return the runs with times that never fall as they grow longer.

    A longer run does all that a shorter one does. Where its fastest took less time, every shorter run was held up by
    something else that the machine did, and would take no longer than it.
    """
    result: list[Runs] = []
    least = np.inf
    for runs in reversed(lengths):
        least = min(least, float(np.nan_to_num(runs.seconds, nan=np.inf)))
        result.append(replace(runs, seconds=least if np.isfinite(least) else np.nan))
    return tuple(reversed(result))


def runs_of(budget: int, results: Sequence[MethodResult], reference: Reference) -> Runs:
    """Return what runs of one length are off by."""
    errors = {
        (name, statistic): rms_of(
            [float(getattr(result.answers[name], statistic)) - float(getattr(truth, statistic)) for result in results],
            float(getattr(reference.errors[name], statistic)),
        )
        for name, truth in reference.answers.items()
        for statistic in STATISTICS
    }
    accepted = [result.acceptance for result in results if result.acceptance is not None]
    effective = [result.effective for result in results if result.effective is not None]
    lost = sum(all(np.isnan(answer.mean) for answer in result.answers.values()) for result in results)
    timed = [result.seconds for result in results if np.isfinite(result.seconds)]
    return Runs(
        budget=budget,
        seconds=min(timed, default=np.nan),
        usual=median(timed) if timed else np.nan,
        evaluations=median(result.evaluations for result in results),
        errors=errors,
        shares=_shares(errors, reference),
        acceptance=rms_of(np.array(accepted) - reference.acceptance.value) if accepted else None,
        effective=median(effective) if effective else None,
        failed=lost,
        converged=budget * reference.acceptance.value >= _CONVERGED,
    )


def _shares(errors: Mapping[tuple[str, str], Rms], reference: Reference) -> dict[str, float]:
    result = {}
    for statistic in STATISTICS:
        parts = [
            errors[name, statistic].value / width
            for name, width in reference.widths.items()
            if width > 0.0 and reference.asks(name, statistic)
        ]
        known = [part for part in parts if np.isfinite(part)]
        result[statistic] = float(np.sqrt(np.mean(np.square(known)))) if known else np.nan
    return result
