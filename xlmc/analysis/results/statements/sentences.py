"""Sentences on a run that people quote, and the certainties that they rest on.

Each share stands with its error, and no number has more digits than its error supports.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.analysis.results.statements.significant_digits import RoundedRange, percent_text, rounded_range
from xlmc.montecarlo.distributions.parameters import range_text, show
from xlmc.montecarlo.statistics import Estimate, probability_above, probability_between

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.forecast_result import ForecastResult
    from xlmc.montecarlo.simulation.simulation import Simulation

__all__ = ["MEANING", "Certainty", "Statement", "certainties", "statements"]


_EVEN: Final = 0.5
MEANING: Final = (
    "Each share is a share of the accepted trials, counted for the range as it is printed here, and has its standard "
    "error beside it. “More probable than not” is said only where the whole 95 % interval of the share lies above "
    "50 %. All of this holds only if the model and the ranges of its assumptions are right: the error given is Monte "
    "Carlo error, not reconstruction error."
)
"""The note that stands below the sentences."""


@dataclass(frozen=True, slots=True)
class Statement:
    """A sentence on a forecast.

    Attributes:
        forecast: its name.
        kind: `range`, `threshold` or `certainty`.
        text: the sentence, without a full stop.
    """

    forecast: str
    kind: str
    text: str


def statements(simulation: Simulation) -> list[Statement]:
    """For every forecast: where its central range lies, and how probable are values above its threshold and in the
    range that was asked for.
    """
    return [each for result in simulation.results.values() for each in _of(result)]


def _of(result: ForecastResult) -> list[Statement]:
    definition, central = result.definition, result.statistics.central
    name, units = definition.name, f" {definition.units}" if definition.units else ""
    found = rounded_range(result.sample, central, definition.central)
    if found is None:
        why = "too few effective trials for its central range" if result.sample.n else "no accepted trial has a number"
        return [Statement(name, "range", f"{name}: {why}")]
    part = _part_text(result)
    told = [Statement(name, "range", f"{name}: {_range_text(found, units, result.statistics.trials)}{part}")]
    above = result.statistics.probability_above
    if definition.threshold is not None and above is not None:
        event = f"{name} > {show(definition.threshold)}{units}"
        told.append(Statement(name, "threshold", f"{_probability_text(event, above)}{part}"))
    if definition.asked is not None and result.certainty is not None:
        event = f"{name} {range_text(*definition.asked)}{units}"
        told.append(Statement(name, "certainty", f"{_probability_text(event, result.certainty)}{part}"))
    return told


def _probability_text(event: str, share: Estimate) -> str:
    """`P(Speed > 35 mph) = 1.6 % ± 0.3 %`."""
    joined = ":" if share.value in (0.0, 1.0) else " ="
    return f"P({event}){joined} {percent_text(share)}"


def _part_text(result: ForecastResult) -> str:
    """Which of the accepted trials the shares are of, where a forecast is not a number in all of them."""
    numbers, others, discarded = result.statistics.trials, result.faults.total(), result.discards.total()
    if discarded:
        return f"; counted in the {numbers:,} of {numbers + others + discarded:,} accepted trials that its filters keep"
    if not others:
        return ""
    return f"; counted in the {numbers:,} of {numbers + others:,} accepted trials in which it is a number"


def _range_text(found: RoundedRange, units: str, trials: int) -> str:
    """`more probable than not (52.1 % ± 0.8 %) between 22.0 and 24.2 mph`, where that is so."""
    share, between = found.share, f"between {found.low_text} and {found.high_text}{units}"
    if found.low == found.high:
        if share.value == 1.0:
            return f"{found.low_text}{units} in {f'all {trials:,} trials' if trials > 1 else 'the only trial'}"
        between = f"equal to {found.low_text}{units}"
    elif share.value == 1.0:
        return f"{percent_text(share)}, {between}"
    lowest = share.value if share.interval is None else share.interval[0]
    if lowest > _EVEN:
        return f"more probable than not ({percent_text(share)}) {between}"
    if share.value > _EVEN:
        return f"{percent_text(share)} {between}; there are too few trials to call it more probable than not"
    return f"{percent_text(share)} {between}"


@dataclass(frozen=True, slots=True)
class Certainty:
    """The share of a forecast's accepted trials in a range.

    Attributes:
        kind: `below`, `between` or `above` for the central range; `at most` or `over` for the threshold; `asked` for
            the range that was asked for.
        low, high: the ends of the range, infinite where it has none. The ends of `below`, `above` and `over` do not
            belong to the range.
        words: the range in words, with units.
        share: the share of the trials in it, with its 95 % interval (Wilson's).
    """

    kind: str
    low: float
    high: float
    words: str
    share: Estimate


def certainties(result: ForecastResult) -> list[Certainty]:
    """The certainties below, in and above the central range as it is printed; those of the threshold, if any, and of
    the range that was asked for, if any.
    """
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
        found.append(Certainty("at most", -math.inf, threshold, f"at most {show(threshold)}{units}", at_most))
        found.append(Certainty("over", threshold, math.inf, f"above {show(threshold)}{units}", above))
    if definition.asked is not None and result.certainty is not None:
        words = f"{range_text(*definition.asked)}{units}"
        found.append(Certainty("asked", *definition.asked, words, result.certainty))
    return found
