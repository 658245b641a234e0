"""What ended a run, in words, for the screen, the record and warnings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

__all__ = ["ALL_TRIALS", "WITHOUT_GOAL", "Stopped"]

WITHOUT_GOAL: Final = ("trials", "time", "interruption", "search")
"""What ends a run that has not reached its goal."""


@dataclass(frozen=True, slots=True)
class Stopped:
    """What ended a run.

    Attributes:
        by: the key of the goal that was reached, `trials` (there were no more to run), `time`, `interruption` or
            `search` (no accepted trials were found where they are rare).
        because: in words, without a full stop.
        goal: in words, what the run was to go on until; None if it was to run its trials.
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
