"""The switch from plain trials to a search, if they would reach their limit before enough are accepted. Looks are taken
at numbers of trials that are known before, and see nothing but counts: the decision is the same however the blocks are
divided, and whatever the clock says.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.engine.engines import ENGINES
from xlmc.errors import SimulationError

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import Model

__all__ = ["ALWAYS_FIRST", "FIRST_LOOK", "LEAST_LIMIT", "RareSwitch", "rare_switch"]

FIRST_LOOK: Final = 1 << 20
"""Trials after which the first look is taken: few beside the limit, and enough to know a share of 10⁻⁵ to a third."""

ALWAYS_FIRST: Final = 1 << 16
"""Plain trials before a search that was asked for in any case: to count what filters reject, and to show the prior."""

LEAST_LIMIT: Final = 1 << 22
"""The smallest limit of a run that leaves room for a search."""


MOST_WANTED: Final = 1_000_000
"""Accepted trials of a search: they are in memory, and kept anew with every batch."""

MOST_ASSUMPTIONS: Final = 500
"""Drawn in a search: its populations take 0.5 MB of memory for each, several times over."""


class RareSwitch:
    """Watches the plain trials of a run.

    Args:
        wanted: accepted trials; None where no search may be made.
        limit: trials at most.
        certain: whether the search is made in any case.
    """

    def __init__(self, wanted: int | None, limit: int, *, certain: bool = False) -> None:
        self._wanted, self._limit, self.certain = wanted, limit, certain
        self._next = ALWAYS_FIRST if certain else FIRST_LOOK

    def should_search(self, trials: int, accepted: int) -> bool:
        """Whether so many plain trials, with so many accepted, say that their limit will not be enough.

        One more counts as accepted than was: none of a million is no proof of none.
        """
        if self._wanted is None or trials < self._next:
            return False
        while self._next <= trials:
            self._next *= 2
        return self.certain or self._wanted * trials > self._limit * (accepted + 1)


def rare_switch(model: Model, settings: Settings) -> RareSwitch:
    """Whether, and when, a run turns to a search.

    Raises:
        SimulationError: a search was asked for, and cannot be made.
    """
    asked, wanted = settings.stopping.rare, settings.stopping.accepted
    if asked is not None and wanted is None:
        message = "a way to find rare trials was given, but not how many trials are to be accepted"
        raise SimulationError(message, hint="Give a number of accepted trials too, with --until-accepted")
    fault = _fault(model, settings)
    if fault is not None and asked == "always":
        raise SimulationError(f"rare accepted trials cannot be searched for: {fault}", hint="Use --rare never")
    possible = fault is None and asked != "never"
    return RareSwitch(wanted if possible else None, settings.trials, certain=asked == "always")


def _fault(model: Model, settings: Settings) -> str | None:
    if not model.filters:
        return "the workbook has no filters, so every trial is accepted"
    if not model.live:
        return "no assumption is drawn"
    if not ENGINES[settings.engine].searches:
        return "the search is computed by the engine numpy"
    if len(model.live) > MOST_ASSUMPTIONS:
        return f"{len(model.live):,} assumptions are drawn, and there is room for {MOST_ASSUMPTIONS:,}"
    if (settings.stopping.accepted or 0) > MOST_WANTED:
        return f"{settings.stopping.accepted:,} were asked for, and there is room for {MOST_WANTED:,}"
    if settings.trials < LEAST_LIMIT:
        return f"it takes up to {LEAST_LIMIT:,} trials, and the limit is {settings.trials:,}"
    return None
