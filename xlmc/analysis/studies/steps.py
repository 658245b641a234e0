"""The steps of a long study: counted, timed, told, and ended by Ctrl-C with what is known by then.

A study says how many steps are to come as soon as it knows (`expect`), announces each (`begin`), and asks before each
whether it is still wanted (`ended`, `each`). From `can_end` on, a first Ctrl-C ends it after the step that is running,
or at once where that is `left_at_once`; a second one, or one before that, is a `KeyboardInterrupt` as ever. Of a first
run that Ctrl-C ends (`first_run`), the trials that it has are what the study answers from.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from math import inf
from statistics import median
from time import perf_counter
from types import TracebackType
from typing import Final, TypeVar

from xlmc.montecarlo.loop.stopping.watch import Interruption
from xlmc.montecarlo.number_text import count_text
from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["Steps", "Tell", "ended_early"]

Tell = Callable[[str], None]
Item = TypeVar("Item")

_LAST: Final = 9
"""Steps whose usual time is taken for that of the next ones: the first of a study may be of another kind."""

_SOON: Final = 2.0
"""Seconds: of less it is not said how long it takes."""

_LONG: Final = 10.0
"""Seconds: what a longer study will do is said beforehand."""


class Steps:
    """The steps of one study; a context that hears Ctrl-C.

    Attributes:
        latest: the time of the clock at which no step runs any more.

    Args:
        tell: called before every step with what it is for, which of how many it is, and how long they may still take.
        clock: gives seconds.
        plan: called at most once, with what the study will do and about how long that takes, if it takes long.
    """

    def __init__(
        self, tell: Tell | None = None, clock: Callable[[], float] = perf_counter, plan: Tell | None = None
    ) -> None:
        self._tell, self._clock, self._plan = tell, clock, plan
        self._interruption = Interruption(wanted=True)
        self._begun = self._expected = 0
        self._since, self._last = 0.0, deque[float](maxlen=_LAST)
        self.latest = inf

    def __enter__(self) -> Steps:
        self._interruption.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._interruption.__exit__(kind, error, trace)

    def expect(self, more: int) -> None:
        """Count so many more steps, all about as long as the last ones, to those that have begun.

        What was expected before, and did not come, is expected no more.
        """
        if not self.ended:
            self._expected = self._begun + more

    def begin(self, what: str) -> None:
        """Announce a step."""
        now = self._clock()
        if self._begun:
            self._last.append(now - self._since)
        self._since, self._begun = now, self._begun + 1
        if self._tell is not None:
            self._tell(what + self._standing())

    def _standing(self) -> str:
        if self.ended:
            return " (interrupted: it ends with what is known as soon as it can)"
        if self._expected < self._begun:
            return ""
        left = (self._expected - self._begun + 1) * (median(self._last) if self._last else 0.0)
        left = min(left, max(self.latest - self._since, 0.0))
        soon = f", {_duration(left)} left" if left >= _SOON else ""
        return f" ({count_text(self._begun)} of about {count_text(self._expected)}{soon})"

    def can_end(self) -> None:
        """Say that there is something to answer by now."""
        self._interruption.keeping = True

    def say_plan(self, what: str, seconds: float) -> None:
        """Say what will be done, in so many seconds about; nothing of what is soon done, or was said before."""
        if self._plan is not None and seconds >= _LONG:
            self._plan(f"{what}, about {_duration(seconds)}. Ctrl-C ends it with what is known by then.")
            self._plan = None

    def first_run(self, run: Callable[[], RunResult]) -> RunResult:
        """Make a run that all else begins with, which may end by Ctrl-C with the trials that it has by then.

        Args:
            run: makes it, with `keep_interrupted`; Ctrl-C was not pressed yet.

        Raises:
            KeyboardInterrupt: Ctrl-C was pressed before there were any trials, or where they belong together.
        """
        self._interruption.__exit__(None, None, None)  # the run hears Ctrl-C itself
        try:
            result = run()
        finally:
            self._interruption.__enter__()
        self._interruption.asked = result.stopped.interrupted
        return result

    @contextmanager
    def left_at_once(self) -> Iterator[None]:
        """Leave what runs inside as soon as Ctrl-C is pressed for the first time; what it has by then is kept."""
        self._interruption.at_once = True
        try:
            yield
        except KeyboardInterrupt:
            if not self._interruption.left:
                raise
            self._interruption.left = False
        finally:
            self._interruption.at_once = False

    @property
    def ended(self) -> bool:
        """Whether no further step is to begin."""
        return self._interruption.asked

    def each(self, items: Iterable[Item]) -> Iterator[Item]:
        """Yield the items until the study is ended."""
        for item in items:
            if self.ended:
                return
            yield item

    @property
    def why_ended(self) -> str:
        """Why it ended early, as `it was interrupted after 12 of about 60 steps`; empty if it did not."""
        if not self.ended:
            return ""
        most = max(self._expected, self._begun)
        of = f" of about {count_text(most)}" if most > self._begun else ""
        return f"it was interrupted after {count_text(self._begun)}{of} steps"


def ended_early(study: str, why: str, left: str) -> str:
    """Say that a study ended early, why, and what that leaves out.

    >>> ended_early("screening", "it was interrupted after 3 of about 9 steps", "The rest was not run.")
    'The screening ended early, because it was interrupted after 3 of about 9 steps. The rest was not run.'
    """
    return f"The {study} ended early, because {why}. {left}"


def _duration(seconds: float) -> str:
    """Write a time that is known roughly: `40 s`, `3 min`, `2 h`."""
    for least, unit in ((5_400.0, 3_600.0), (90.0, 60.0)):
        if seconds >= least:
            return f"{seconds / unit:.0f} {'h' if unit == 3_600.0 else 'min'}"
    return f"{seconds:.0f} s"
