"""Error against work: what a method's runs of growing length are off by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np

from xlmc.methods.answer import STATISTICS, Method, MethodResult
from xlmc.methods.reference import Reference
from xlmc.methods.rms import Rms, line, rms_of

__all__ = ["Curve", "Rung", "rung_of"]


@dataclass(frozen=True, slots=True, eq=False)
class Rung:
    """The runs of one length.

    Attributes:
        budget: evaluations that each run might spend.
        seconds: of the fastest run: the others waited for something else that the machine did.
        evaluations: that a run spent, the median.
        errors: (forecast, attribute of `Answer`) -> in the forecast's units.
        shares: attribute of `Answer` -> the same over the forecasts' standard deviations, root mean square over
            the forecasts: one number without units.
        acceptance: of the share of accepted trials; None where the method gives none.
        effective: accepted trials that count fully, the median; None where all weigh alike.
        failed: runs without any number.
        measured: whether the seconds were, and not worked out from the rate of a shorter run.
    """

    budget: int
    seconds: float
    evaluations: float
    errors: Mapping[tuple[str, str], Rms]
    shares: Mapping[str, float]
    acceptance: Rms | None
    effective: float | None = None
    failed: int = 0
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
    """

    method: Method
    rungs: tuple[Rung, ...]
    setup: float
    remarks: tuple[str, ...]
    ranges: Mapping[str, tuple[float, float]]

    @property
    def answers(self) -> bool:
        """Whether it gives mean, standard deviation and range, and not only bounds."""
        return any(np.isfinite(value) for value in self.rungs[-1].shares.values())

    def slope(self, statistic: str, against: str = "seconds") -> float:
        """Of the error in logarithms, against `seconds` or `evaluations`; NaN where these hardly differ."""
        across = [float(getattr(rung, against)) for rung in self.rungs]
        return line(across, [rung.shares[statistic] for rung in self.rungs])[0]


def rung_of(budget: int, results: Sequence[MethodResult], reference: Reference) -> Rung:
    """What runs of one length are off by."""
    errors = {
        (name, statistic): rms_of([
            float(getattr(result.answers[name], statistic)) - float(getattr(truth, statistic)) for result in results
        ])
        for name, truth in reference.answers.items()
        for statistic in STATISTICS
    }  # fmt: skip
    accepted = [result.acceptance for result in results if result.acceptance is not None]
    effective = [result.effective for result in results if result.effective is not None]
    lost = sum(all(np.isnan(answer.mean) for answer in result.answers.values()) for result in results)
    return Rung(
        budget=budget,
        seconds=min((r.seconds for r in results if np.isfinite(r.seconds)), default=np.nan),
        evaluations=median(result.evaluations for result in results),
        errors=errors,
        shares=_shares(errors, reference),
        acceptance=rms_of(np.array(accepted) - reference.acceptance.value) if accepted else None,
        effective=median(effective) if effective else None,
        failed=lost,
    )


def _shares(errors: Mapping[tuple[str, str], Rms], reference: Reference) -> dict[str, float]:
    found = {}
    for statistic in STATISTICS:
        parts = [
            errors[name, statistic].value / answer.sd for name, answer in reference.answers.items() if answer.sd > 0.0
        ]
        known = [part for part in parts if np.isfinite(part)]
        found[statistic] = float(np.sqrt(np.mean(np.square(known)))) if known else np.nan
    return found
