"""What ended a run, in words, for the screen, the record and warnings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

__all__ = ["ALL_TRIALS", "WITHOUT_GOAL", "Stopped", "be", "duration", "list_of"]

WITHOUT_GOAL: Final = ("trials", "time", "interruption", "search")
"""What ends a run that has not come to its goal."""


@dataclass(frozen=True, slots=True)
class Stopped:
    """What ended a run.

    Attributes:
        by: the key of the goal that was reached, `trials` (there were no more to run), `time`, `interruption` or
            `search` (no accepted trials were found where they are rare).
        because: in words, without a full stop.
        goal: in words, what the run was to go on until; None where it was to run its trials.
    """

    by: str
    because: str
    goal: str | None = None

    @property
    def reached(self) -> bool:
        """Whether the run came to what it was to go on until."""
        return self.goal is None or self.by not in WITHOUT_GOAL

    @property
    def interrupted(self) -> bool:
        """Whether somebody ended it."""
        return self.by == "interruption"

    @property
    def sentence(self) -> str:
        """What ended it, and before what."""
        return self.because if self.reached else f"{self.because} before {self.goal}"


ALL_TRIALS: Final = Stopped("trials", "all trials were run")


def list_of(words: Sequence[str]) -> str:
    """Words in a row.

    >>> list_of(["mean"]), list_of(["mean", "sd", "range"])
    ('mean', 'mean, sd and range')
    """
    if len(words) == 1:
        return words[0]
    return f"{', '.join(words[:-1])} and {words[-1]}"


def be(things: int) -> str:
    """`was` of one thing, `were` of several."""
    return "was" if things == 1 else "were"


def duration(seconds: float) -> str:
    """A duration in the largest units in which it is whole.

    >>> duration(60), duration(5400), duration(0.5), duration(3661)
    ('1 min', '1 h 30 min', '0.5 s', '1 h 1 min 1 s')
    """
    minutes, rest = divmod(seconds, 60)
    hours, minutes = divmod(int(minutes), 60)
    parts = [f"{hours} h" * (hours > 0), f"{minutes} min" * (minutes > 0), f"{rest:.6g} s" * (rest > 0)]
    return " ".join(part for part in parts if part)
