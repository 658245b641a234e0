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


def difference_json(difference: Difference) -> dict[str, object]:
    """Return the four numbers of a forecast in two runs, and the distances; of texts their shares."""
    from xlmc.montecarlo.statistics.estimate import finite

    shares = (
        {"shares": {label: _change(each) for label, each in difference.shares.items()}} if difference.shares else {}
    )
    return {
        **shares,
        "mean": _change(difference.mean),
        "standard_deviation": _change(difference.standard_deviation),
        "central_range": {"share": difference.share, "low": _change(difference.low), "high": _change(difference.high)},
        **(
            {}
            if difference.above is None
            else {"above_threshold": {"threshold": difference.threshold, **_change(difference.above)}}
        ),
        "kolmogorov": estimate_json(difference.kolmogorov),
        "wasserstein_1": estimate_json(difference.wasserstein),
        "largest_in_one_trial": finite(difference.largest),
        "root_mean_square_in_one_trial": finite(difference.typical),
    }


def _change(change: Change) -> dict[str, object]:
    return {
        "first": estimate_json(change.first),
        "second": estimate_json(change.second),
        "difference": estimate_json(change.difference),
    }


def acceptance_json(acceptance: Acceptance) -> dict[str, object]:
    """How many trials both accept, and each alone."""
    return {
        "both": acceptance.both,
        "first_only": acceptance.first_only,
        "second_only": acceptance.second_only,
        "first": estimate_json(acceptance.first),
        "second": estimate_json(acceptance.second),
        "relative_change": estimate_json(acceptance.relative),
    }
