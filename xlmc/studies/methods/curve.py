"""Error against work: what a method's runs of growing length are off by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from statistics import median
from typing import Final

import numpy as np

from xlmc.studies.methods.answer import STATISTICS, Method, MethodResult
from xlmc.studies.methods.reference import Reference
from xlmc.studies.methods.rms import Rms, line, rms_of

__all__ = ["Curve", "Rung", "in_order", "rung_of"]

_SETTLED: Final = 20.0
"""Accepted trials of a run, about; of fewer, quantiles lie between the same few numbers however they are drawn."""


@dataclass(frozen=True, slots=True, eq=False)
class Rung:
    """The runs of one length.

    Attributes:
        budget: evaluations that each run might spend.
        seconds: of the fastest run: the others waited for something else that the machine did. No more than of the
            fastest longer run, which does all that this one does (`in_order`).
        usual: seconds, the median of the runs.
        evaluations: that a run spent, the median.
        errors: (forecast, attribute of `Answer`) -> in the forecast's units.
        shares: attribute of `Answer` -> the same over the forecasts' 5–95 % ranges, root mean square over the
            forecasts in which it converges: one number without units.
        acceptance: of the share of accepted trials; None where the method gives none.
        effective: accepted trials that count fully, the median; None where all weigh alike.
        failed: runs without any number.
        settled: whether so many trials are accepted that errors fall as theory says; fewer are not carried on.
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
    settled: bool = True
    measured: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """A method's rungs, the shortest runs first; a single one where it has no budget to spend.

    Attributes:
        method: whose.
        rungs: of it.
        setup: seconds of its first run beyond those of the next, in which things are compiled or imported.
        remarks: of its last run.
        ranges: forecast -> the bounds it gives, for methods that give bounds.
        ends: of bounds, the points that they are reached at (`MethodResult.ends`).
        apart: of an engine, by how many standard deviations its answers differ at most from those of the engine
            `numpy` at the same trials.
    """

    method: Method
    rungs: tuple[Rung, ...]
    setup: float
    remarks: tuple[str, ...]
    ranges: Mapping[str, tuple[float, float]]
    apart: float = 0.0
    ends: Mapping[tuple[str, str], Mapping[str, float]] = field(default_factory=dict)

    @property
    def answers(self) -> bool:
        """Whether it gives mean, standard deviation and range, and not only bounds."""
        return any(np.isfinite(value) for value in self.rungs[-1].shares.values())

    @property
    def settled(self) -> tuple[Rung, ...]:
        """The rungs that errors are carried on from; the longest where too few trials are accepted even there."""
        return tuple(rung for rung in self.rungs if rung.settled) or self.rungs[-1:]

    def slope(self, statistic: str, against: str = "seconds") -> float:
        """Of the error in logarithms, against `seconds`, `evaluations` or `budget`; NaN where these hardly differ."""
        across = [float(getattr(rung, against)) for rung in self.settled]
        weights = [max(max(error.n for error in rung.errors.values()) - 1.0, 1.0) for rung in self.settled]
        return line(across, [rung.shares[statistic] for rung in self.settled], weights)[0]


def in_order(rungs: Sequence[Rung]) -> tuple[Rung, ...]:
    """The rungs with times that never fall as runs grow longer.

    A longer run does all that a shorter one does. Where its fastest took less time, every shorter run was held up by
    something else that the machine did, and would take no longer than it.
    """
    found: list[Rung] = []
    least = np.inf
    for rung in reversed(rungs):
        least = min(least, float(np.nan_to_num(rung.seconds, nan=np.inf)))
        found.append(replace(rung, seconds=least if np.isfinite(least) else np.nan))
    return tuple(reversed(found))


def rung_of(budget: int, results: Sequence[MethodResult], reference: Reference) -> Rung:
    """What runs of one length are off by."""
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
    return Rung(
        budget=budget,
        seconds=min(timed, default=np.nan),
        usual=median(timed) if timed else np.nan,
        evaluations=median(result.evaluations for result in results),
        errors=errors,
        shares=_shares(errors, reference),
        acceptance=rms_of(np.array(accepted) - reference.acceptance.value) if accepted else None,
        effective=median(effective) if effective else None,
        failed=lost,
        settled=budget * reference.acceptance.value >= _SETTLED,
    )


def _shares(errors: Mapping[tuple[str, str], Rms], reference: Reference) -> dict[str, float]:
    found = {}
    for statistic in STATISTICS:
        parts = [
            errors[name, statistic].value / width
            for name, width in reference.widths.items()
            if width > 0.0 and statistic not in reference.heavy.get(name, ())
        ]
        known = [part for part in parts if np.isfinite(part)]
        found[statistic] = float(np.sqrt(np.mean(np.square(known)))) if known else np.nan
    return found
