"""The certainty of ranges: how many accepted trials lie below, between and above, as shares with their intervals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from xlmc.results.statements.digits import rounded_range
from xlmc.statistics import Estimate, probability_above, probability_between

if TYPE_CHECKING:
    from xlmc.run.simulation import ForecastResult

__all__ = ["Certainty", "certainties"]


@dataclass(frozen=True, slots=True)
class Certainty:
    """The share of a forecast's accepted trials in a range.

    Attributes:
        kind: `below`, `between` or `above` for the central range; `at most` or `over` for the threshold.
        low, high: its ends, infinite where it has none; those of `below`, `above` and `over` do not belong to it.
        words: the range in words, with units.
        share: with Wilson's 95 % interval.
    """

    kind: str
    low: float
    high: float
    words: str
    share: Estimate


def certainties(result: ForecastResult) -> list[Certainty]:
    """P below, between and above the central range as it is printed, and at most and above the threshold, if any."""
    definition, sample = result.definition, result.sample
    units = f" {definition.units}" if definition.units else ""
    found = []
    spoken = rounded_range(sample, result.statistics.central, definition.central)
    if spoken is not None:
        low, high = spoken.low, spoken.high
        under = probability_between(sample, -math.inf, math.nextafter(low, -math.inf))
        over = probability_above(sample, high)
        between = f"from {spoken.low_text} to {spoken.high_text}{units}"
        found = [
            Certainty("below", -math.inf, low, f"below {spoken.low_text}{units}", under),
            Certainty("between", low, high, between, spoken.share),
            Certainty("above", high, math.inf, f"above {spoken.high_text}{units}", over),
        ]
    threshold, above = definition.threshold, result.statistics.probability_above
    if threshold is not None and above is not None and sample.n:
        at_most = probability_between(sample, -math.inf, threshold)
        found.append(Certainty("at most", -math.inf, threshold, f"at most {threshold:g}{units}", at_most))
        found.append(Certainty("over", threshold, math.inf, f"above {threshold:g}{units}", above))
    return found
