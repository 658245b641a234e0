"""Estimates and differences as JSON holds them: no infinities, no NaNs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.statistics import Estimate
    from xlmc.studies.comparison import Acceptance, Change, Difference

__all__ = ["acceptance_json", "difference_json", "estimate_json", "finite"]


def finite(value: float | None) -> float | None:
    """The number; None where it is none."""
    return value if value is not None and math.isfinite(value) else None


def estimate_json(estimate: Estimate) -> dict[str, float | None]:
    """Value and standard error."""
    return {"value": finite(estimate.value), "error": finite(estimate.error)}


def difference_json(found: Difference) -> dict[str, object]:
    """The four numbers of a forecast in two runs, and the distances."""
    return {
        "mean": _change(found.mean),
        "standard_deviation": _change(found.standard_deviation),
        "central_range": {"share": found.share, "low": _change(found.low), "high": _change(found.high)},
        **({} if found.above is None else {"above_threshold": {"threshold": found.threshold, **_change(found.above)}}),
        "kolmogorov": estimate_json(found.kolmogorov),
        "wasserstein_1": estimate_json(found.wasserstein),
        "largest_in_one_trial": finite(found.largest),
    }


def _change(change: Change) -> dict[str, object]:
    return {
        "first": estimate_json(change.first),
        "second": estimate_json(change.second),
        "difference": estimate_json(change.difference),
    }


def acceptance_json(found: Acceptance) -> dict[str, object]:
    """How many trials both accept, and each alone."""
    return {
        "both": found.both,
        "first_only": found.first_only,
        "second_only": found.second_only,
        "first": estimate_json(found.first),
        "second": estimate_json(found.second),
        "relative_change": estimate_json(found.relative),
    }
