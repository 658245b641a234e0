"""When a run ends: the goals that it may go on until, and what else a person may ask for beside a number of trials.

A goal is a class whose attributes are its row; `GOALS` lists them. How to add a stop rule: write its goal here, with
its option and its setting, and put it into `GOALS`. It is a `WholeGoal` where one whole number says it all, else a
`Goal` with fields of its own, which it checks. Write its rule in a module of `xlmc/montecarlo/loop/stopping/` (see
`rule.StopRule`), under the goal's key, and put it into `RULES` in `watch.py` there. Describe the option in
docs/command-line.md and the setting in docs/workbooks.md. The command line, `xlmc_settings`, `Model.simulate`, the
record, saved runs and `xlmc replay` read all that they need here; `test_new_rule.py` in
`tests/montecarlo/loop/stopping/` adds a rule in this way.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any, ClassVar, Final, NamedTuple, Self

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.amounts import as_confidence, as_numbers, as_seconds, as_tolerance

__all__ = [
    "GOALS",
    "LIMIT",
    "MOST_TRIALS",
    "NO_GOAL",
    "RARE",
    "AcceptedTrials",
    "Goal",
    "Option",
    "Precision",
    "StableDigits",
    "Stopping",
    "WholeGoal",
    "only_one",
    "stopping",
]

LIMIT: Final = 10**9
"""Trials after which a run that goes on until something gives up, where nobody says otherwise."""

RARE: Final = ("auto", "never", "always")
"""Whether accepted trials are looked for where they are rare: `auto`, where plain trials would reach the limit."""

MOST_TRIALS: Final = 10**12

USUAL_NUMBERS: Final = ("mean", "range")
"""What a run is quoted by."""

USUAL_CONFIDENCE: Final = 0.95


class Option(NamedTuple):
    """Something that a person says of a goal.

    Attributes:
        name: in Python; `until_accepted` is `--until-accepted` on the command line.
        setting: its row of `xlmc_settings`.
        metavar: what stands for it in the help of the command line.
        help: a sentence there.
        takes: the least and the largest whole number that it may be; or `float`, or `str`, what a cell holds.
        read: its value, from what was typed or given; raises SimulationError.
    """

    name: str
    setting: str
    metavar: str
    help: str
    takes: tuple[int, int] | type[float] | type[str]
    read: Callable[[Any], Any] = str


@dataclass(frozen=True, slots=True)
class Goal(ABC):
    """What a run goes on until. The fields of a goal are what is recorded and saved of it: numbers and texts.

    Attributes:
        key: what its rule, records, JSON and saved runs know it by.
        noun: what was asked for, in a message.
        options: how it is asked for: the first says it, the others say more of it.
        labels: in the record: (key, label) of each field.
        of_forecasts: whether it looks at forecasts; at all of them, where none is named.
        saved_as: what saved runs know it by, where that is not its key.
    """

    key: ClassVar[str]
    noun: ClassVar[str]
    options: ClassVar[tuple[Option, ...]]
    labels: ClassVar[tuple[tuple[str, str], ...]]
    of_forecasts: ClassVar[bool] = False
    saved_as: ClassVar[str] = ""

    @classmethod
    @abstractmethod
    def of(cls, given: Mapping[str, Any]) -> Self:
        """Make the goal from options: name of an option -> what was typed or given.

        Raises:
            SimulationError: it cannot be meant.
        """


@dataclass(frozen=True, slots=True)
class WholeGoal(Goal):
    """A goal that is one whole number, within the limits of its option.

    Attributes:
        number: so many.
        things: what it counts, in a message.
        hint: what to give instead of a number beyond the limits.
    """

    number: int
    things: ClassVar[str]
    hint: ClassVar[str]

    def __post_init__(self) -> None:
        limits = self.options[0].takes
        assert isinstance(limits, tuple)
        least, most = limits
        if isinstance(self.number, bool) or not isinstance(self.number, Real):
            raise SimulationError(f"{self.number!r} {self.things} were asked for", hint=self.hint)
        if not least <= self.number <= most or self.number != int(self.number):
            raise SimulationError(f"{self.number:,} {self.things} were asked for", hint=self.hint)

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> Self:
        """See `Goal`."""
        checked = cls(given[cls.options[0].name])  # before `int`, which would make 50 of 50.5
        return cls(int(checked.number))


class AcceptedTrials(WholeGoal):
    """The goal: a number of accepted trials."""

    __slots__ = ()
    key = "accepted"
    noun = things = "accepted trials"
    hint = f"Give 2 to {MOST_TRIALS:,}"
    options = (
        Option(
            name="until_accepted",
            setting="Until accepted",
            metavar="N",
            help="Run until N trials are accepted, -n at most.",
            takes=(2, MOST_TRIALS),
        ),
    )
    labels = (("until_accepted", "Until so many are accepted"),)


@dataclass(frozen=True, slots=True)
class Precision(Goal):
    """Numbers of forecasts that are known so well.

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

    key = "precision"
    noun = "a precision"
    options = (
        Option(
            name="precision",
            setting="Precision",
            metavar="WIDTH",
            help="Run until numbers are known to 1% of themselves, or 0.1 in their units.",
            takes=float,
            read=as_tolerance,
        ),
        Option(
            name="precision_of",
            setting="Precision of",
            metavar="NAMES",
            help="Which: mean,sd,range,p75.5.  [default: mean,range]",
            takes=str,
            read=as_numbers,
        ),
        Option(
            name="confidence",
            setting="Confidence %",
            metavar="PERCENT",
            help="Confidence of --precision.  [default: 95]",
            takes=float,
            read=as_confidence,
        ),
    )
    labels = (
        ("precision", "Precision"),
        ("relative", "It is a share of the number"),
        ("precision_of", "Of these numbers"),
        ("confidence", "At this confidence"),
    )
    of_forecasts = True

    def __post_init__(self) -> None:
        as_tolerance(self.tolerance)
        as_numbers(self.numbers)
        if not 0.0 < self.confidence < 1.0:
            raise SimulationError(f"{self.confidence!r} is not a confidence level", hint="Give a share such as 0.95")

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> Self:
        """See `Goal`."""
        if "precision" not in given:
            message = "no precision was given"
            raise SimulationError(message, hint="Give a precision too, such as 1% or 0.1")
        numbers = as_numbers(given.get("precision_of", USUAL_NUMBERS))
        confidence = as_confidence(given.get("confidence", USUAL_CONFIDENCE))
        return cls(*as_tolerance(given["precision"]), numbers, confidence)


class StableDigits(WholeGoal):
    """The goal: a number of significant digits of the results is stable (JCGM 101, 7.9)."""

    __slots__ = ()
    key = "adaptive"
    noun, things = "stable digits", "significant digits"
    hint = "Give 1 to 6; 1 or 2 are usual"
    options = (
        Option(
            name="adaptive",
            setting="Significant digits",
            metavar="DIGITS",
            help="Run until digits are stable (JCGM 101, 7.9).",
            takes=(1, 6),
        ),
    )
    labels = (("adaptive", "Stable digits"),)
    of_forecasts = True
    saved_as = "digits"


def only_one(goals: Sequence[Goal]) -> Goal | None:
    """Return the goal that was asked for, if any.

    Raises:
        SimulationError: there are several.
    """
    if len(goals) > 1:
        message = f"{' and '.join(goal.noun for goal in goals)} were both asked for"
        raise SimulationError(message, hint="Ask for one of them")
    return goals[0] if goals else None


GOALS: Final[dict[str, type[Goal]]] = {goal.key: goal for goal in (AcceptedTrials, Precision, StableDigits)}
"""Goal by its key, in the order in which options and records list them."""


@dataclass(frozen=True, slots=True)
class Stopping:
    """What a run goes on until, and how long at most.

    Attributes:
        goal: what it goes on until; None if it is to run its trials.
        forecasts: names of those that the goal looks at; empty for all.
        seconds: how long at most.
        rare: one of `RARE`; None for `auto`.

    Raises:
        SimulationError: forecasts for a goal that looks at none.
    """

    goal: Goal | None = None
    forecasts: tuple[str, ...] = ()
    seconds: float | None = None
    rare: str | None = None

    def __post_init__(self) -> None:
        if self.forecasts and not (self.goal and self.goal.of_forecasts):
            message = "forecasts are named, and no precision or stable digits are asked for of them"
            raise SimulationError(message, hint="Ask for a precision or for stable digits too, or name no forecasts")

    @property
    def accepted(self) -> int | None:
        """The accepted trials that the run goes on until, where that is its goal."""
        return self.goal.number if isinstance(self.goal, AcceptedTrials) else None

    @property
    def has_goal(self) -> bool:
        """Whether the run goes on until something is reached; the number of trials is then its limit."""
        return self.goal is not None

    @property
    def asked(self) -> bool:
        """Whether anything but the number of trials may end the run."""
        return self.has_goal or self.seconds is not None


def stopping(
    *,
    forecasts: str | Sequence[str] = (),
    time_limit: str | float | None = None,
    rare: str | None = None,
    **goals: Any,
) -> Stopping:
    """Read the goals that were asked for, as typed or as given in Python.

    Args:
        forecasts: names of those that the goal looks at.
        time_limit: how long at most: see `as_seconds`.
        rare: one of `RARE`.
        **goals: the options of `GOALS` by name; None for one that was not given.

    Raises:
        SimulationError: something of it cannot be meant.
        TypeError: no goal has such an option.
    """
    for name in goals.keys() - {option.name for goal in GOALS.values() for option in goal.options}:
        raise TypeError(f"simulate() got an unexpected keyword argument {name!r}")
    given = {name: value for name, value in goals.items() if value is not None}
    result = [goal.of(given) for goal in GOALS.values() if any(option.name in given for option in goal.options)]
    if rare is not None and rare not in RARE:
        message = f"{rare!r} is not a setting of rare"
        raise SimulationError(message, hint=f"Choose one of {', '.join(RARE)}")
    named = (forecasts,) if isinstance(forecasts, str) else tuple(forecasts)
    return Stopping(only_one(result), named, None if time_limit is None else as_seconds(time_limit), rare)


NO_GOAL: Final = Stopping()
"""Only the number of trials ends the run."""
