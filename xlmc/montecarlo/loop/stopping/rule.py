"""What every rule that ends a run can do, and the simplest: until so many trials are accepted.

The run then ends with the trial that is the last of them, and the accepted trials are a plain sample of that size. The
number of trials is random, with a negative binomial distribution, so that the share of accepted trials is estimated
otherwise: see `statistics.inverse_proportion`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.definitions.stopping import AcceptedTrials
from xlmc.montecarlo.number_text import counted_text

__all__ = ["Columns", "Observed", "StopRule", "UntilAccepted"]

Floats = NDArray[np.float64]

Columns = Callable[[int], Floats]
"""A forecast's number -> its accepted trials so far, `(m,)`, NaN where it has no number."""


class Observed(Protocol):
    """What a rule sees of a block of trials.

    Attributes:
        trials: how many there are.
        accepted: `(m,)` the accepted ones, numbered from the run's first trial.
        forecasts: one a forecast, `(m,)`, NaN where it has no number.
    """

    @property
    def trials(self) -> int: ...

    @property
    def accepted(self) -> NDArray[np.int64]: ...

    @property
    def forecasts(self) -> Sequence[Floats]: ...


class StopRule(Protocol):
    """Looks at the blocks of a run, each once, in their order.

    Attributes:
        key: of its goal: see `definitions.stopping`.
        goal: what must come to pass, in words: `1,000 trials were accepted`.
        share: how far it is on the way there, 0 to 1; an estimate.
    """

    @property
    def key(self) -> str: ...

    @property
    def goal(self) -> str: ...

    @property
    def share(self) -> float: ...

    def counting(self, block: Observed, start: int) -> int:
        """How many of the block's trials count, the run's trial `start` being its first; fewer only in the last one."""

    def reached(self, block: Observed, columns: Columns) -> bool:
        """Whether the run may end with this block, cut to the trials that count."""


class UntilAccepted:
    """See `Rule`."""

    key = AcceptedTrials.key

    def __init__(self, asked: AcceptedTrials) -> None:
        self._wanted, self._seen = asked.number, 0

    @property
    def goal(self) -> str:
        return f"{counted_text(self._wanted, 'trial')} {'was' if self._wanted == 1 else 'were'} accepted"

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
