"""How a run stands, as whoever watches it is told after every block."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from xlmc.run.stopping.rule import Observed
from xlmc.run.stopping.running import RunningMoments
from xlmc.statistics import Estimate

__all__ = ["Standing", "Teller"]


@dataclass(frozen=True, slots=True)
class Standing:
    """How a run stands.

    Attributes:
        trials, accepted: so far.
        share: how much of the run is done, 0 to 1; an estimate where it goes on until something is reached.
        means: forecast -> its mean so far.
        searching: whether accepted trials are being looked for where they are rare; `accepted` counts none of these.
    """

    trials: int
    accepted: int
    share: float
    means: Mapping[str, Estimate]
    searching: bool = False


class Teller:
    """Keeps what is told of the forecasts.

    Args:
        forecasts: their names.
    """

    def __init__(self, forecasts: Sequence[str]) -> None:
        self._moments = {name: RunningMoments(spread=False) for name in forecasts}
        self._trials = self._accepted = 0

    def after(self, block: Observed, share: float) -> Standing:
        """How the run stands after this block too."""
        self._trials += block.trials
        self._accepted += block.accepted.size
        for moments, column in zip(self._moments.values(), block.forecasts, strict=True):
            moments.add(column)
        means = {name: moments.mean() for name, moments in self._moments.items()}
        return Standing(self._trials, self._accepted, share, means)
