"""What can be undone in a window: the states that it went through, with the scenarios that were kept then."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

from xlmc.montecarlo.definitions.run_options import RunOptions
from xlmc.outputs.live.adjustments import Adjustments

__all__ = ["History", "Moment"]

_MOST: Final = 500
"""States that can be gone back to."""


@dataclass(frozen=True, slots=True)
class Moment:
    """What undoing brings back.

    Attributes:
        adjustments: what differed from the workbook.
        stored: scenarios by name.
        shown: the scenario that was shown; empty for none.
        asked: trials and seed, where they are not those of the workbook.
    """

    adjustments: Adjustments
    stored: Mapping[str, Adjustments]
    shown: str = field(compare=False)
    asked: RunOptions = field(default_factory=RunOptions)


class History:
    """The moments before and after the present one, the nearest last."""

    def __init__(self) -> None:
        self._before: list[Moment] = []
        self._after: list[Moment] = []
        self._dragged: tuple[str, ...] | None = None

    @property
    def goes(self) -> tuple[bool, bool]:
        """Return whether there is something to undo, and something to redo."""
        return bool(self._before), bool(self._after)

    def note(self, before: Moment, now: Moment, dragged: tuple[str, ...] | None) -> None:
        """Take a change.

        Args:
            before: the moment before it.
            now: the moment after it.
            dragged: what a handle that is held moves; None where none is held, or it was let go. All that it moves
                until then is one step.
        """
        going_on, self._dragged = self._dragged, dragged
        if before != now and (going_on is None or (dragged is not None and dragged != going_on)):
            self._before = [*self._before, before][-_MOST:]
            self._after = []
        if dragged is None and self._before and self._before[-1] == now:
            self._before.pop()  # it was brought back to where it was

    def learn(self, more: Mapping[str, Adjustments]) -> None:
        """Take scenarios that another window on this workbook kept: undoing must not take them away."""
        for those in (self._before, self._after):
            those[:] = [replace(each, stored={**each.stored, **more}) for each in those]

    def undo(self, now: Moment, fitting: Callable[[Moment], Moment]) -> Moment | None:
        """Return the last moment that differs from now, as `fitting` makes it of what was noted; otherwise None."""
        return self._go(self._before, self._after, now, fitting)

    def redo(self, now: Moment, fitting: Callable[[Moment], Moment]) -> Moment | None:
        """Return the moment that was undone last; see `undo`."""
        return self._go(self._after, self._before, now, fitting)

    def _go(
        self, there: list[Moment], back: list[Moment], now: Moment, fitting: Callable[[Moment], Moment]
    ) -> Moment | None:
        self._dragged = None
        while there:
            moment = fitting(there.pop())
            if moment != now:
                back.append(now)
                return moment
        return None
