"""Numbers of studies as JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from xlmc.analysis.studies.comparison import Acceptance, Change, Difference
    from xlmc.montecarlo.statistics import Estimate

__all__ = ["acceptance_json", "difference_json", "estimate_json"]


def estimate_json(estimate: Estimate) -> dict[str, float | None]:
    """Return the value and its standard error, and the ends of its interval where it has one."""
    from xlmc.montecarlo.statistics.estimate import finite

    ends = zip(("low", "high"), estimate.interval or (), strict=False)
    numbers = {"value": estimate.value, "error": estimate.error, **dict(ends)}
    return {name: finite(number) for name, number in numbers.items()}


def difference_json(found: Difference) -> dict[str, object]:
    """Return the four numbers of a forecast in two runs, and the distances; of texts their shares."""
    from xlmc.montecarlo.statistics.estimate import finite

    shares = {"shares": {label: _change(each) for label, each in found.shares.items()}} if found.shares else {}
    return {
        **shares,
        "mean": _change(found.mean),
        "standard_deviation": _change(found.standard_deviation),
        "central_range": {"share": found.share, "low": _change(found.low), "high": _change(found.high)},
        **({} if found.above is None else {"above_threshold": {"threshold": found.threshold, **_change(found.above)}}),
        "kolmogorov": estimate_json(found.kolmogorov),
        "wasserstein_1": estimate_json(found.wasserstein),
        "largest_in_one_trial": finite(found.largest),
        "root_mean_square_in_one_trial": finite(found.typical),
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
