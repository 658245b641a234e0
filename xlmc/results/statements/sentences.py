"""What a run says in sentences to be quoted: each share with its error, and no digits that errors do not support."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from xlmc.results.statements.digits import RoundedRange, percent_text, rounded_range

if TYPE_CHECKING:
    from xlmc.run.simulation import ForecastResult, Simulation

__all__ = ["MEANING", "Statement", "statements"]

EVEN: Final = 0.5

MEANING: Final = (
    "Shares are of the accepted trials, counted for the ends as they stand here, with their standard error. “More "
    "probable than not” is said where the whole 95 % interval of the share lies above 50 %. All of it holds within "
    "the model and the ranges of its assumptions: Monte Carlo error is not reconstruction error."
)
"""What goes with the sentences."""


@dataclass(frozen=True, slots=True)
class Statement:
    """A sentence on a forecast.

    Attributes:
        forecast: its name.
        kind: `range` or `threshold`.
        text: the sentence, without a full stop.
    """

    forecast: str
    kind: str
    text: str


def statements(simulation: Simulation) -> list[Statement]:
    """Of every forecast where its central range lies, and how probable values above its threshold are."""
    return [each for result in simulation.results.values() for each in _of(result)]


def _of(result: ForecastResult) -> list[Statement]:
    definition, central = result.definition, result.statistics.central
    name, units = definition.name, f" {definition.units}" if definition.units else ""
    found = rounded_range(result.sample, central, definition.central)
    if found is None:
        return [Statement(name, "range", f"{name}: no accepted trial has a number")]
    part = _part_text(result)
    told = [Statement(name, "range", f"{name}: {_range_text(found, units)}{part}")]
    above = result.statistics.probability_above
    if definition.threshold is not None and above is not None:
        joined = ":" if above.value in (0.0, 1.0) else " ="
        text = f"P({name} > {definition.threshold:g}{units}){joined} {percent_text(above)}{part}"
        told.append(Statement(name, "threshold", text))
    return told


def _part_text(result: ForecastResult) -> str:
    """Which of the accepted trials the shares are of, where a forecast is not a number in all of them."""
    numbers, others = result.statistics.trials, result.faults.total()
    if not others:
        return ""
    return f"; counted in the {numbers:,} of {numbers + others:,} accepted trials in which it is a number"


def _range_text(found: RoundedRange, units: str) -> str:
    """`more probable than not (52.1 % ± 0.8 %) between 22.0 and 24.2 mph`, where that is so."""
    share, between = found.share, f"between {found.low_text} and {found.high_text}{units}"
    if found.low == found.high and share.value == 1.0:
        return f"{found.low_text}{units} in all {share.n:,} trials"
    if share.value == 1.0:
        return f"{percent_text(share)}, {between}"
    lowest = share.value if share.interval is None else share.interval[0]
    if lowest > EVEN:
        return f"more probable than not ({percent_text(share)}) {between}"
    if share.value > EVEN:
        return f"{percent_text(share)} {between}; too few trials to call it more probable than not"
    return f"{percent_text(share)} {between}"
