"""How long the runs of a workbook take, and so how many trials there is time for while a state moves."""

from __future__ import annotations

from typing import Final

from xlmc.montecarlo.simulation.simulate import BLOCK
from xlmc.outputs.live.jobs import MOVING_TRIALS
from xlmc.outputs.live.moving_models import MANY_FORMULAS

__all__ = ["Pace"]

_QUICK_TRIALS, _FEWEST_TRIALS = 2_000, 200
"""Trials of the first short run, before its time is known, and the fewest of any."""

_SLOW: Final = 0.1
"""Seconds that a run of `MOVING_TRIALS` may take; one that takes longer has a shorter one before it."""

_QUICK: Final = 0.03
"""Seconds that a short run may take."""

_PIECE: Final = 0.05
"""Seconds after which a longer run looks whether something newer is wanted."""

_SMALLEST_PIECE: Final = 16_384
"""Trials: with fewer, much of the time would go into what does not depend on their number. Runs that move have pieces
of this size whatever they take: draws are kept by the size of their block.
"""


class Pace:
    """See the module.

    Args:
        formulas: how many the workbook needs.
    """

    def __init__(self, formulas: int) -> None:
        self._formulas, self._many = formulas, formulas > MANY_FORMULAS
        self._seconds: dict[bool, float] = {}

    def of_saved(self, formulas: int) -> Pace:
        """Return what is expected of the workbook once it was saved, with so many formulas now."""
        pace, factor = Pace(formulas), max(formulas, 1) / max(self._formulas, 1)
        pace._seconds = {resting: factor * seconds for resting, seconds in self._seconds.items()}
        return pace

    def learn(self, seconds: float, *, resting: bool, quick: bool) -> None:
        """Take how long a run took for a trial; a quick one, which says little, where nothing else is known."""
        if not quick or not self._seconds:
            before = self._seconds.get(resting, seconds)
            self._seconds[resting] = min(seconds, 2.0 * before)  # other work on the machine only ever slows

    @property
    def is_slow(self) -> bool:
        """Return whether a run of `MOVING_TRIALS` takes long; before the first run, whether it looks so."""
        return self._many if False not in self._seconds else self._seconds[False] * MOVING_TRIALS > _SLOW

    @property
    def quick_trials(self) -> int:
        """Return the trials of a short run before a longer one."""
        return self._trials_in(_QUICK, resting=False)

    def piece(self, *, resting: bool) -> int:
        """Return the trials after which a run looks whether it is still wanted."""
        if not resting:
            return _SMALLEST_PIECE
        if not self.is_slow:
            return BLOCK
        return max(_SMALLEST_PIECE, self._trials_in(_PIECE, resting=resting))

    def _trials_in(self, seconds: float, *, resting: bool) -> int:
        """Return how many trials take so long, a power of two; of a run at rest, or of one that moves."""
        known = self._seconds.get(resting, self._seconds.get(False))
        return _QUICK_TRIALS if not known else 1 << max(_FEWEST_TRIALS, int(seconds / known)).bit_length() - 1
