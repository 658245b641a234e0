"""A number with its error and interval as JSON holds it: no NaN and no infinity, but null and the reason."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from xlmc.statistics import Estimate

__all__ = ["EstimateJson", "estimate_json", "number_json"]

EstimateJson = dict[str, float | str | None]

NO_VALUE: Final = "not defined for these trials"
NO_ERROR: Final = "no standard error can be given"
UNBOUNDED: Final = "so few trials do not bound the interval"


def number_json(value: float | None) -> float | None:
    """The number; None where it is none."""
    return float(value) if value is not None and math.isfinite(value) else None


def estimate_json(found: Estimate) -> EstimateJson:
    """`{"value": …, "error": …, "low": …, "high": …}`, with a `reason` where one of them is null.

    >>> from xlmc.statistics import Estimate
    >>> estimate_json(Estimate(3.0, 0.5, (2.0, 4.0)))
    {'value': 3.0, 'error': 0.5, 'low': 2.0, 'high': 4.0}
    >>> estimate_json(Estimate(3.0))["reason"]
    'no standard error can be given'
    """
    low, high = found.interval or (None, None)
    numbers = [number_json(number) for number in (found.value, found.error, low, high)]
    told: EstimateJson = dict(zip(("value", "error", "low", "high"), numbers, strict=True))
    if None in numbers:
        told["reason"] = _reason(numbers[0], numbers[1], found.interval is not None)
    return told


def _reason(value: float | None, error: float | None, interval: bool) -> str:
    if value is None:
        return NO_VALUE
    return UNBOUNDED if interval and error is not None else NO_ERROR
