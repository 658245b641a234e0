"""What a person should hear of the errors of forecasts with long tails."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from xlmc.errors import Notice
from xlmc.run.stopping.wording import list_of
from xlmc.statistics import Sample, errors_from_trials, too_short

__all__ = ["tail_notices"]

_MOST_NAMED: Final = 4


def tail_notices(samples: Mapping[str, Sample], method: str) -> list[Notice]:
    """Which numbers have an interval that may be too short, and which the error of independent trials.

    Args:
        samples: forecast -> its accepted trials.
        method: the sampling method in words.
    """
    found = []
    if short := _named(samples, too_short):
        found.append(
            f"the interval of {short} may be too short: a few trials far out in the tail decide such a number, and "
            "more of their kind may be missing. More trials help; percentiles and shares have intervals that hold"
        )
    if plain := _named(samples, _only_from_trials):
        found.append(
            f"the error of {plain} is that of independent trials: a few trials far out in the tail decide such a "
            f"number, and the replicates are too few to show its error. By {method} it may vary less than that"
        )
    return [Notice(message) for message in found]


def _only_from_trials(sample: Sample) -> list[str]:
    """Of a number whose interval may be too short it is not said that it may vary less."""
    short = too_short(sample)
    return [number for number in errors_from_trials(sample) if number not in short]


def _named(samples: Mapping[str, Sample], concerned: Callable[[Sample], list[str]]) -> str:
    """Such as "the mean of 'x' and the standard deviation of 'y'"; empty where there is none."""
    numbers = [f"the {number} of {name!r}" for name, sample in samples.items() for number in concerned(sample)]
    more = [f"{len(numbers) - _MOST_NAMED} more"] if len(numbers) > _MOST_NAMED else []
    return list_of([*numbers[:_MOST_NAMED], *more]) if numbers else ""
