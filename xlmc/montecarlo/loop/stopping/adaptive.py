"""The rule that ends a run when the results are stable to a number of significant digits: the adaptive procedure of
JCGM 101:2008, 7.9.

Accepted trials are taken in sequences of M = max(J, 10,000), J being the least whole number from 100/(1 − p) up and p
the share of the central range. Each gives a mean, a standard deviation and the two ends of the range; the run is stable
when twice the standard deviation of the average of each of these is no more than the numerical tolerance δ = ½·10^l,
where the standard deviation of all trials is c·10^l with a whole number c of so many digits.

The standard looks after every sequence from the second on. The deviation of two numbers is often small by luck: an
average is then within δ in 80 to 92 % of the runs rather than in 95 % (docs/stress.md; cf. Wübbeler, Harris, Cox &
Elster 2010). So there are 20 sequences at least, with which it is 94.8 % or more.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo.definitions.stopping import StableDigits
from xlmc.montecarlo.loop.stopping.progress import RunningMoments
from xlmc.montecarlo.loop.stopping.rule import Columns, Observed
from xlmc.montecarlo.model.plain_words import be, list_of

__all__ = ["LEAST_SEQUENCES", "Sequences", "UntilStable", "numerical_tolerance", "sequence_length"]

Floats = NDArray[np.float64]

LEAST_SEQUENCES: Final = 20


def sequence_length(share: float) -> int:
    """M, for a range that holds that share of the trials.

    >>> sequence_length(0.51), sequence_length(0.999)
    (10000, 100000)
    """
    return max(math.ceil(round(100.0 / (1.0 - share), 6)), 10_000)


def numerical_tolerance(deviation: float, digits: int) -> float:
    """δ of JCGM 101, 7.9.2: half a unit in the last of the deviation's significant digits.

    >>> numerical_tolerance(0.35, 2), numerical_tolerance(0.996, 2), numerical_tolerance(0.0, 2)
    (0.005, 0.05, 0.0)
    """
    if deviation == 0.0 or not math.isfinite(deviation):
        return 0.0
    exponent = int(f"{deviation:.{digits - 1}e}".partition("e")[2])  # rounded first: 0.996 is 1.0, not 0.99
    return float(f"0.5e{exponent - digits + 1}")


class Sequences:
    """The sequences of one forecast.

    Args:
        share: of the forecast's central range.
    """

    def __init__(self, share: float) -> None:
        self._length, tail = sequence_length(share), (1.0 - share) / 2.0
        self._ends = (tail, 1.0 - tail)
        self._waiting: list[Floats] = []
        self._waiting_count = self.count = 0
        self._average, self._squares = np.zeros(4), np.zeros(4)
        self._all = RunningMoments(spread=False)

    def add(self, column: Floats) -> None:
        """Take `(m,)` more; NaN is no number."""
        self._all.add(column)
        self._waiting.append(column[~np.isnan(column)])
        self._waiting_count += self._waiting[-1].size
        if self._waiting_count < self._length:
            return
        waiting = np.concatenate(self._waiting)
        whole = waiting.size // self._length
        for sequence in waiting[: whole * self._length].reshape(whole, self._length):
            self._take(sequence)
        self._waiting = [waiting[whole * self._length :].copy()]
        self._waiting_count = self._waiting[0].size

    def _take(self, sequence: Floats) -> None:
        values = np.array([sequence.mean(), sequence.std(ddof=1), *np.quantile(sequence, self._ends)])
        self.count += 1
        apart = values - self._average
        self._average += apart / self.count
        self._squares += apart * (values - self._average)

    def excess(self, digits: int) -> float:
        """Return the largest 2s over δ; infinite before there are two sequences."""
        if self.count < 2:
            return math.inf
        twice = 2.0 * math.sqrt(float(self._squares.max()) / (self.count - 1) / self.count)
        tolerance = numerical_tolerance(self._all.deviation, digits)
        return twice / tolerance if tolerance else (0.0 if twice == 0.0 else math.inf)


class UntilStable:
    """See `StopRule`.

    Args:
        asked: how many significant ones.
        forecasts: (index, name, share of the central range) of those that count.
    """

    key = StableDigits.key

    def __init__(self, asked: StableDigits, forecasts: Sequence[tuple[int, str, float]]) -> None:
        self._digits, self._names = asked.number, [name for _, name, _ in forecasts]
        self._sequences = {index: Sequences(share) for index, _, share in forecasts}
        self._share = 0.0

    @property
    def goal(self) -> str:
        digits = "1 significant digit" if self._digits == 1 else f"{self._digits} significant digits"
        return f"{list_of(self._names)} {be(len(self._names))} stable to {digits} (JCGM 101, 7.9)"

    @property
    def share(self) -> float:
        return self._share

    def counting(self, block: Observed, start: int) -> int:
        return block.trials

    def reached(self, block: Observed, columns: Columns) -> bool:
        shares = []
        for index, sequences in self._sequences.items():
            sequences.add(block.forecasts[index])
            excess = sequences.excess(self._digits)
            shares.append(min(sequences.count / LEAST_SEQUENCES, 1.0 / max(excess, 1e-9) ** 2, 1.0))
        self._share = min(shares)
        return self._share >= 1.0
