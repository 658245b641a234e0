"""When a run ends: what a person may ask for beside a number of trials, and how it is written."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.errors import SimulationError

__all__ = [
    "LIMIT",
    "MOST_DIGITS",
    "MOST_TRIALS",
    "NO_GOAL",
    "RARE",
    "Precision",
    "Stopping",
    "as_confidence",
    "as_numbers",
    "as_seconds",
    "as_tolerance",
    "stopping",
]

LIMIT: Final = 10**9
"""Trials after which a run that goes on until something gives up, where nobody says otherwise."""

MOST_DIGITS: Final = 6
MOST_TRIALS: Final = 10**12

RARE: Final = ("auto", "never", "always")
"""Whether accepted trials are looked for where they are rare: `auto`, where plain trials would reach the limit."""

USUAL_NUMBERS: Final = ("mean", "range")
"""What a run is quoted by."""

USUAL_CONFIDENCE: Final = 0.95

_PERCENTILE = re.compile(r"p(\d+(?:\.\d+)?)")
_TIME = re.compile(r"(?:(\d+(?:\.\d+)?)\s*h)?\s*(?:(\d+(?:\.\d+)?)\s*m(?:in)?)?\s*(?:(\d+(?:\.\d+)?)\s*s?)?")


@dataclass(frozen=True, slots=True)
class Precision:
    """How well numbers of forecasts must be known.

    Attributes:
        tolerance: the largest half width of their intervals, in the forecast's units; or, where `relative`, over the
            number itself.
        numbers: `mean`, `sd`, `range` (both ends of the forecast's central range) or a percentile such as `p75.5`.
        confidence: of each interval, a share.
    """

    tolerance: float
    relative: bool = False
    numbers: tuple[str, ...] = USUAL_NUMBERS
    confidence: float = USUAL_CONFIDENCE


@dataclass(frozen=True, slots=True)
class Stopping:
    """What a run goes on until, and how long at most. At most one of the first three is there.

    Attributes:
        accepted: so many accepted trials.
        precision: numbers known so well.
        digits: significant digits of the standard deviation that are stable (JCGM 101, 7.9).
        forecasts: names of those that `precision` or `digits` look at; empty for all.
        seconds: how long at most.
        rare: one of `RARE`; None for `auto`.

    Raises:
        SimulationError: two goals, or forecasts for none.
    """

    accepted: int | None = None
    precision: Precision | None = None
    digits: int | None = None
    forecasts: tuple[str, ...] = ()
    seconds: float | None = None
    rare: str | None = None

    def __post_init__(self) -> None:
        goals = {"accepted trials": self.accepted, "a precision": self.precision, "stable digits": self.digits}
        asked = [name for name, goal in goals.items() if goal is not None]
        if len(asked) > 1:
            raise SimulationError(f"{' and '.join(asked)} were both asked for", hint="Ask for one of them")
        if self.forecasts and self.precision is None and self.digits is None:
            message = "forecasts to look at are named, but not what for"
            raise SimulationError(message, hint="Ask for a precision or for stable digits too, or name no forecasts")

    @property
    def has_goal(self) -> bool:
        """Whether the run goes on until something is reached; the number of trials is then its limit."""
        return not (self.accepted is None and self.precision is None and self.digits is None)

    @property
    def asked(self) -> bool:
        """Whether anything but the number of trials may end the run."""
        return self.has_goal or self.seconds is not None


def stopping(
    accepted: int | None = None,
    tolerance: str | float | None = None,
    numbers: str | Sequence[str] | None = None,
    confidence: str | float | None = None,
    digits: int | None = None,
    forecasts: str | Sequence[str] = (),
    seconds: str | float | None = None,
    rare: str | None = None,
) -> Stopping:
    """What was asked for, as typed or as given in Python.

    Raises:
        SimulationError: something of it cannot be meant.
    """
    if accepted is not None and accepted < 2:
        raise SimulationError(f"{accepted:,} accepted trials were asked for", hint="Give 2 or more")
    if digits is not None and not 1 <= digits <= MOST_DIGITS:
        message = f"{digits} significant digits were asked for"
        raise SimulationError(message, hint=f"Give 1 to {MOST_DIGITS}; 1 or 2 are usual")
    if tolerance is None and (numbers is not None or confidence is not None):
        message = "how well numbers must be known is not said"
        raise SimulationError(message, hint="Give a precision too, such as 1% or 0.1")
    if rare is not None and rare not in RARE:
        message = f"{rare!r} is no way to look for rare trials"
        raise SimulationError(message, hint=f"Choose one of {', '.join(RARE)}")
    precision = None
    if tolerance is not None:
        chosen = USUAL_NUMBERS if numbers is None else as_numbers(numbers)
        sure = USUAL_CONFIDENCE if confidence is None else as_confidence(confidence)
        precision = Precision(*as_tolerance(tolerance), chosen, sure)
    named = (forecasts,) if isinstance(forecasts, str) else tuple(forecasts)
    return Stopping(accepted, precision, digits, named, None if seconds is None else as_seconds(seconds), rare)


def as_tolerance(given: str | float) -> tuple[float, bool]:
    """A half width, and whether it is a share of the number itself: `1%` is, `0.1` is not.

    Raises:
        SimulationError: it is neither.

    >>> as_tolerance("1 %"), as_tolerance(0.1)
    ((0.01, True), (0.1, False))
    """
    text = str(given).strip()
    relative = text.endswith("%")
    value = _number(text.removesuffix("%"))
    if value is None or not 0.0 < value < math.inf:
        message = f"{text!r} is no precision"
        raise SimulationError(message, hint="Give a percentage such as 1%, or a number in the forecast's units")
    return (value / 100.0 if relative else value), relative


def as_numbers(given: str | Sequence[str]) -> tuple[str, ...]:
    """Names of statistics, separated by commas: `mean`, `sd`, `range`, `p75.5`.

    Raises:
        SimulationError: one of them is none of these.

    >>> as_numbers("Mean, p75.5")
    ('mean', 'p75.5')
    """
    parts = given.split(",") if isinstance(given, str) else given
    names = tuple(dict.fromkeys(part.strip().casefold() for part in parts))
    for name in names:
        found = _PERCENTILE.fullmatch(name)
        if name not in ("mean", "sd", "range") and not (found and 0.0 < float(found[1]) < 100.0):
            hint = "Choose from mean, sd, range, and percentiles above 0 and below 100 such as p75.5"
            raise SimulationError(f"{name!r} is no number whose precision can be asked for", hint=hint)
    if not names:
        raise SimulationError("no number was named whose precision counts", hint="Name one, such as mean")
    return names


def as_confidence(given: str | float) -> float:
    """A share, from a percentage: `95%`, `95` or 0.95.

    Raises:
        SimulationError: it is not between 0 and 100 %.

    >>> as_confidence("95%"), as_confidence(0.99)
    (0.95, 0.99)
    """
    text = str(given).strip()
    value = _number(text.removesuffix("%"))
    if value is not None and (text.endswith("%") or value >= 1.0):
        value /= 100.0
    if value is None or not 0.0 < value < 1.0:
        raise SimulationError(f"{text!r} is no confidence", hint="Give a percentage such as 95")
    return value


def as_seconds(given: str | float) -> float:
    """A duration: `60s`, `5m`, `1h30m`, or a number of seconds.

    Raises:
        SimulationError: it is none.

    >>> as_seconds("1h30m"), as_seconds("90"), as_seconds(0.5)
    (5400.0, 90.0, 0.5)
    """
    text = str(given).strip().casefold()
    found = _TIME.fullmatch(text)
    parts = found.groups("0") if found else ()
    value = sum(float(part) * unit for part, unit in zip(parts, (3600.0, 60.0, 1.0), strict=False))
    if not 0.0 < value < math.inf:
        raise SimulationError(f"{text!r} is no time", hint="Give seconds, or a duration such as 60s, 5m or 1h30m")
    return value


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


NO_GOAL: Final = Stopping()
"""Nothing but the number of trials ends the run."""
