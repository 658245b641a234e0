"""Until so many trials are accepted: the run ends with the trial that is the last of them.

The accepted trials are then a plain sample of that size. The number of trials is random, with a negative binomial
distribution, so that the share of accepted trials is estimated otherwise: see `statistics.inverse_proportion`.
"""

from __future__ import annotations

from xlmc.definitions.stopping import AcceptedTrials
from xlmc.run.stopping.rule import Columns, Observed

__all__ = ["UntilAccepted"]


class UntilAccepted:
    """See `Rule`."""

    key = AcceptedTrials.key

    def __init__(self, asked: AcceptedTrials) -> None:
        self._wanted, self._seen = asked.number, 0

    @property
    def goal(self) -> str:
        return f"{self._wanted:,} trials were accepted"

    @property
    def share(self) -> float:
        return min(1.0, self._seen / self._wanted)

    def counting(self, block: Observed, start: int) -> int:
        missing = self._wanted - self._seen
        if block.accepted.size < missing:
            return block.trials
        return int(block.accepted[missing - 1]) - start + 1

    def reached(self, block: Observed, columns: Columns) -> bool:
        self._seen += block.accepted.size
        return self._seen >= self._wanted
