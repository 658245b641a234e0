"""Processes that have done their part of a run wait for the next one: who runs again need not start them again."""

from __future__ import annotations

import atexit
import os
from collections.abc import Iterable
from threading import Lock, Timer
from time import monotonic
from typing import Final

from xlmc.run.scheduling.child import Child

__all__ = ["children", "end", "give_back"]

_PATIENCE: Final = 60.0
"""Seconds they wait."""


class _Standby:
    """Those that wait, the one that came last taken first: those that too many runs do without are ended."""

    def __init__(self) -> None:
        self._waiting: list[tuple[Child, float]] = []  # each with the time at which its patience ends
        self._lock = Lock()
        self._timer: Timer | None = None

    def take(self, count: int) -> list[Child]:
        """Up to so many of them."""
        with self._lock:
            found = [self._waiting.pop()[0] for _ in range(min(count, len(self._waiting)))]
        ready = [child for child in found if child.lives]
        for child in found:
            if child not in ready:
                child.end()
        return ready

    def put(self, children: list[Child]) -> None:
        """More of them."""
        with self._lock:
            self._waiting += [(child, monotonic() + _PATIENCE) for child in children]
            if self._timer is None:
                self._wake_after(_PATIENCE)

    def _wake_after(self, seconds: float) -> None:
        self._timer = Timer(seconds, self._end_overdue)
        self._timer.daemon = True
        self._timer.start()

    def _end_overdue(self) -> None:
        now = monotonic()
        with self._lock:
            overdue = [child for child, until in self._waiting if until <= now]
            self._waiting = [(child, until) for child, until in self._waiting if until > now]
            self._timer = None
            if self._waiting:
                self._wake_after(min(until for _, until in self._waiting) - now)
        for child in overdue:
            child.end()

    def end(self) -> None:
        """End them."""
        with self._lock:
            ended, self._waiting = self._waiting, []
            if self._timer is not None:
                self._timer.cancel()
                self._timer = None
        for child, _ in ended:
            child.end()

    def forget(self) -> None:
        """In a process that was forked: they work for the other one. The lock may be held by a thread that is there."""
        self._lock, self._of_parent, self._waiting, self._timer = Lock(), self._waiting, [], None


_standby = _Standby()
end = _standby.end
atexit.register(end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_standby.forget)


def children(count: int) -> list[Child]:
    """So many of them, started where too few wait.

    Raises:
        SimulationError: one cannot be started.
    """
    found = _standby.take(count)
    try:
        while len(found) < count:
            found.append(Child())
    except BaseException:
        give_back(found)
        raise
    return found


def give_back(used: Iterable[Child]) -> None:
    """Those at rest wait; others are ended."""
    resting = []
    for child in used:
        if child.rest():
            resting.append(child)
        else:
            child.end()
    if resting:
        _standby.put(resting)
