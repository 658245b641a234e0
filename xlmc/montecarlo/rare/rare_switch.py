"""The switch from plain trials to a search, if they would reach their limit before enough are accepted, or need more
trials than a search may take. Looks are taken at numbers of trials that are known before, and see nothing but counts:
the decision is the same however the blocks are divided, and whatever the clock says.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from xlmc.engine.engines import ENGINES
from xlmc.errors import SimulationError
from xlmc.montecarlo.number_text import count_text

if TYPE_CHECKING:
    from xlmc.montecarlo.definitions.definitions import Settings
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = [
    "ALWAYS_FIRST",
    "COSTLY_FROM",
    "FIRST_LOOK",
    "LEAST_LIMIT",
    "SEARCH_PART",
    "RareSwitch",
    "rare_switch",
    "search_limit",
]

FIRST_LOOK: Final = 1 << 20
"""Trials after which the first look is taken: few beside the limit, and enough to know a share of 10⁻⁵ to a third."""

ALWAYS_FIRST: Final = 1 << 16
"""Plain trials before a search that was asked for in any case: to count what filters reject, and to show the prior."""

COSTLY_FROM: Final = 1 << 23
"""Plain trials from which on a search is also made where it may take fewer trials than they still need."""

SEARCH_PART: Final = 16
_LEAST_PART: Final = 1 << 25
"""The part of the limit of trials that a search may take, and the trials that it may take in any case: what is
described well needs far less, and what is not is known by then."""

LEAST_LIMIT: Final = 1 << 22
"""The smallest limit of a run that leaves trials for a search."""

MOST_WANTED: Final = 1_000_000
"""Accepted trials of a search: they are in memory, and kept anew with every batch."""

MOST_ASSUMPTIONS: Final = 500
"""Drawn in a search: its populations take 0.5 MB of memory for each, several times over."""


def search_limit(limit: int, plain: int) -> int:
    """Trials that a search may take, after so many plain ones, of the limit of a run."""
    return min(limit - plain, max(limit // SEARCH_PART, _LEAST_PART))


class RareSwitch:
    """Watches the plain trials of a run.

    Args:
        wanted: accepted trials; None if no search may be made.
        limit: trials at most.
        certain: whether the search is made in any case.
    """

    def __init__(self, wanted: int | None, limit: int, *, certain: bool = False) -> None:
        self._wanted, self._limit, self.certain = wanted, limit, certain
        self._next = ALWAYS_FIRST if certain else FIRST_LOOK

    def should_search(self, trials: int, accepted: int) -> bool:
        """Whether so many plain trials, with so many accepted, say that a search is to be made.

        One more counts as accepted than was: none of a million is no proof of none.
        """
        if self._wanted is None or trials < self._next:
            return False
        while self._next <= trials:
            self._next *= 2
        return self.certain or not self.will_do(trials, accepted) or self._is_costly(trials, accepted)

    def will_do(self, trials: int, accepted: int) -> bool:
        """Whether plain trials, going on as so many have, would reach what is wanted within their limit."""
        return self._wanted is None or self._wanted * trials <= self._limit * (accepted + 1)

    def _is_costly(self, trials: int, accepted: int) -> bool:
        """Whether the plain trials that are still needed are more than a search may take."""
        if self._wanted is None or trials < COSTLY_FROM:
            return False
        still = max(self._wanted - accepted, 0) * trials
        return still > search_limit(self._limit, trials) * (accepted + 1)

    def give_up(self) -> None:
        """Take no more looks: a search has failed."""
        self._wanted = None


def rare_switch(model: CompiledModel, settings: Settings) -> RareSwitch:
    """Whether, and when, a run turns to a search.

    Raises:
        SimulationError: a search was asked for, and cannot be made.
    """
    asked, wanted = settings.stopping.rare, settings.stopping.accepted
    if asked is not None and wanted is None:
        message = "a method to find rare trials was given, but not how many trials are to be accepted"
        raise SimulationError(message, hint="Give a number of accepted trials too, with --until-accepted")
    fault = _fault(model, settings)
    if fault is not None and asked == "always":
        raise SimulationError(f"rare accepted trials cannot be searched for: {fault}", hint="Use --rare never")
    possible = fault is None and asked != "never"
    return RareSwitch(wanted if possible else None, settings.trials, certain=asked == "always")


def _fault(model: CompiledModel, settings: Settings) -> str | None:
    if not model.filters:
        return "the workbook has no filters, so every trial is accepted"
    if not model.live:
        return "no assumption is drawn"
    if not ENGINES[settings.engine].searches:
        return "the search is computed by the engine numpy"
    if len(model.live) > MOST_ASSUMPTIONS:
        return (
            f"{count_text(len(model.live))} assumptions are drawn, and a search takes at most "
            f"{count_text(MOST_ASSUMPTIONS)}"
        )
    if (wanted := settings.stopping.accepted or 0) > MOST_WANTED:
        return f"{count_text(wanted)} were asked for, and a search gives at most {count_text(MOST_WANTED)}"
    if settings.trials < LEAST_LIMIT:
        return f"it takes up to {count_text(LEAST_LIMIT)} trials, and the limit is {count_text(settings.trials)}"
    return None
