"""The options of a run: one value that goes from Python, the command line, a record or the live window to the run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from numbers import Integral, Real
from typing import Any, Final, TypedDict

from xlmc.errors import SimulationError
from xlmc.montecarlo.definitions.run_settings import SETTINGS, Setting, Settings, check_settings
from xlmc.montecarlo.definitions.stopping import LIMIT, NO_GOAL, Stopping, WholeGoal, stopping
from xlmc.montecarlo.sampling.sampling_methods import METHODS

__all__ = ["KEPT_INPUTS", "RunArguments", "RunOptions"]

KEPT_INPUTS: Final = 1 << 20
"""Accepted trials whose draws are kept, unless asked otherwise: more than a sheet has rows."""


_WHOLE: Final = frozenset({"trials", "seed", "detailed", "jobs", "workers", "keep_inputs"})
"""Options that are whole numbers."""


class RunArguments(TypedDict, total=False):
    """The arguments of `Model.simulate` beside trials and seed, which its documentation describes."""

    until_accepted: int | None
    rare: str | None
    precision: str | float | None
    precision_of: str | Sequence[str] | None
    confidence: str | float | None
    adaptive: int | None
    forecasts: str | Sequence[str]
    time_limit: str | float | None
    engine: str | None
    sampling: str | None
    evidence: str | None
    number_style: str | None
    scenarios: bool
    detailed: int | None
    jobs: int
    scheduler: str | None
    workers: int | None
    keep_inputs: int | None
    keep_interrupted: bool


@dataclass(frozen=True, slots=True)
class RunOptions:
    """The options of a run; None means what the workbook says. `Model.simulate` describes each.

    Attributes:
        keep_prior: whether the draws of the first trials are kept before filtering, which results show and no run of
            the live window that is soon followed by another.
        in_memory: bytes of the trials that are kept in memory, and not in a temporary folder; None for the usual half
            gigabyte.

    Raises:
        SimulationError: the number of draws to keep is negative.
    """

    trials: int | None = None
    seed: int | None = None
    sampling: str | None = None
    engine: str | None = None
    evidence: str | None = None
    number_style: str | None = None
    scenarios: bool = False
    detailed: int | None = None
    stopping: Stopping = NO_GOAL
    jobs: int = 1
    scheduler: str | None = None
    workers: int | None = None
    keep_inputs: int | None = KEPT_INPUTS
    keep_prior: bool = True
    keep_interrupted: bool = False
    in_memory: int | None = None

    def __post_init__(self) -> None:
        if self.keep_inputs is not None and self.keep_inputs < 0:
            message = f"the draws of {self.keep_inputs} trials were asked for"
            raise SimulationError(message, hint="Give 0 or more, or None for all")

    @classmethod
    def of(cls, **asked: Any) -> RunOptions:
        """Make options from what was typed, or given in Python; what ends the run by the names of its options.

        Raises:
            SimulationError: something of it cannot be meant.
            TypeError: there is no such option.
        """
        asked |= {name: _whole(name, asked[name]) for name in _WHOLE & asked.keys()}
        own = {each.name for each in fields(cls)} - {"stopping"}
        ends = {name: asked.pop(name) for name in asked.keys() - own}
        return cls(**asked, stopping=stopping(**ends))

    @classmethod
    def repeating(cls, settings: Settings, *, trials: int, by: str, weighable: bool) -> RunOptions:
        """Make the options that give a finished run again, whatever ended it.

        A run that waited for accepted trials waits again, within the same limit, for where it looks for them depends
        on that; methods whose trials belong together run all of them; any other run is one of so many trials.

        Args:
            settings: of the run.
            trials: that it ran.
            by: what ended it, see `Stopped`.
            weighable: whether the workbook has evidence that could be weighed; runs of earlier versions, which do not
                say how they used it, rejected.
        """
        waited = by in ("accepted", "search")
        whole = waited or not METHODS[settings.sampling].independent
        most = settings.trials if whole else trials
        return cls(
            **_of_settings(settings)
            | {
                "trials": None if waited and most == LIMIT else most,
                "evidence": settings.evidence or ("rejection" if weighable else None),
                "stopping": Stopping(settings.stopping.goal, rare=settings.stopping.rare) if waited else NO_GOAL,
            }
        )

    def settings(self, own: Settings) -> Settings:
        """Return the settings of a run: what is given here, else what the workbook says.

        A number of trials or a goal replaces all that the workbook says of the length of the run.

        Args:
            own: the workbook's.

        Raises:
            SimulationError: one is out of its range.
        """
        given = {key: value for key, value in _of_settings(self).items() if value is not None}
        result = replace(own, **given)
        if self.trials is not None or self.stopping.has_goal:
            result = replace(result, trials=LIMIT if self.trials is None else self.trials, stopping=self.stopping)
        else:
            ends = own.stopping
            seconds = ends.seconds if self.stopping.seconds is None else self.stopping.seconds
            rare = self.stopping.rare or ends.rare
            result = replace(result, stopping=replace(ends, seconds=seconds, rare=rare))
        check_settings(result)
        return result

    def arguments(self, own: Settings) -> list[str]:
        """Return the arguments that ask `xlmc simulate` for this, of a workbook with settings of its own."""
        return [part for row in SETTINGS.values() for part in self._arguments(row, own)]

    def _arguments(self, row: Setting, own: Settings) -> list[str]:
        value: Any = None if row.repeat == "never" else row.of(self)
        stated = value is not None and (value or not row.blank) and (row.repeat == "always" or value != row.of(own))
        words = row.kind.arguments(row.options[-1], value) if stated else []
        return [*words, *self._goal_arguments()] if row.key == "trials" else words

    def _goal_arguments(self) -> list[str]:
        goal = self.stopping.goal
        if not isinstance(goal, WholeGoal):
            return []
        return [f"--{goal.options[0].name.replace('_', '-')}", str(goal.number)]


def _whole(name: str, given: Any) -> int | None:
    """Return a whole number that was given in Python, `1e6` among them.

    Raises:
        SimulationError: it is none.
    """
    if given is None:
        return None
    if isinstance(given, Integral) and not isinstance(given, bool):
        return int(given)
    if not isinstance(given, Real) or isinstance(given, bool) or not float(given).is_integer():
        raise SimulationError(f"`{name}` is {given!r}", hint="Give a whole number")
    return int(float(given))


def _of_settings(result: Settings | RunOptions) -> dict[str, Any]:
    """Return the values of the settings that have a field of their own both in `Settings` and in `RunOptions`."""
    return {row.key: row.of(result) for row in SETTINGS.values() if row.options and not row.field}
