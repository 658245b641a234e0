"""Watches a run: its goal, its number of trials, its time."""

from __future__ import annotations

from collections.abc import Callable

from xlmc.run.stopping.rule import Columns, Observed, Rule
from xlmc.run.stopping.stopped import Stopped
from xlmc.run.stopping.wording import duration

__all__ = ["Watch"]


class Watch:
    """Looks at the blocks of a run in their order, and says what ends it.

    Args:
        rule: what it goes on until; None where it is to run its trials.
        trials: how many at most.
        seconds: how long at most; None for as long as it takes.
        clock: seconds from any moment on; read for the first time now.
    """

    def __init__(self, rule: Rule | None, trials: int, seconds: float | None, clock: Callable[[], float]) -> None:
        self._rule, self._trials, self._seconds, self._clock = rule, trials, seconds, clock
        self._began = clock()
        self._seen = 0

    @property
    def share(self) -> float:
        """How much of the run is done, 0 to 1; an estimate where it goes on until something is reached."""
        shares = [self._seen / self._trials]
        if self._rule is not None:
            shares.append(self._rule.share)
        if self._seconds is not None:
            shares.append(min(1.0, (self._clock() - self._began) / self._seconds))
        return max(shares)

    @property
    def goal_reached(self) -> Stopped:
        """What is said of a run that came to its goal; it has one."""
        assert self._rule is not None
        return Stopped(self._rule.key, self._rule.goal, self._rule.goal)

    def counting(self, block: Observed) -> int:
        """How many of the block's trials count; if fewer than it has, they are the run's last."""
        return block.trials if self._rule is None else self._rule.counting(block, self._seen)

    def after(self, block: Observed, columns: Columns, *, interrupted: bool = False) -> Stopped | None:
        """What ends the run with this block, cut to the trials that count; None if nothing does."""
        self._seen += block.trials
        goal = None if self._rule is None else self._rule.goal
        if self._rule is not None and self._rule.reached(block, columns):
            return Stopped(self._rule.key, self._rule.goal, goal)
        if self._seen >= self._trials:
            limit = "all trials were run" if goal is None else f"the limit of {self._trials:,} trials was reached"
            return Stopped("trials", limit, goal)
        return self.meanwhile(interrupted=interrupted)

    def meanwhile(self, *, interrupted: bool = False) -> Stopped | None:
        """What ends the run where no block was run: somebody, or the time; None if nothing does."""
        goal = None if self._rule is None else self._rule.goal
        if interrupted:
            return Stopped("interruption", "it was interrupted", goal)
        if self._seconds is not None and self._clock() - self._began >= self._seconds:
            return Stopped("time", f"the time limit of {duration(self._seconds)} was reached", goal)
        return None
