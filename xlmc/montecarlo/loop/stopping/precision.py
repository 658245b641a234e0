"""The rule that ends a run when numbers of forecasts are known well enough: half the width of every interval is small
enough. Such a rule may end a run because its numbers look known better than they are. With a tolerance that goes to 0
its intervals keep their confidence (Chow & Robbins 1965 for the mean; Glynn & Whitt 1992 for any number whose error is
estimated consistently). So that they keep it in runs as short as people make, the rule looks only after a growing
number of blocks, and only when there are 1,000 numbers or more of each forecast, or 10,000 where these are all the
same, for what is rare may not have come yet; and it stops only when all that was asked for is precise enough at one and
the same look.

A rule that looks after every block gets many chances to find its numbers known well by luck, and costs most. With
numbers of blocks that grow by a constant factor there are few looks, each at much more than the one before.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from xlmc.montecarlo.columns import numbers
from xlmc.montecarlo.definitions.stopping import Precision
from xlmc.montecarlo.loop.stopping.progress import RunningMoments
from xlmc.montecarlo.loop.stopping.rule import Columns, Observed
from xlmc.montecarlo.model.plain_words import be, list_of
from xlmc.montecarlo.number_text import number_text
from xlmc.montecarlo.statistics import Estimate, Sample, percentile

__all__ = [
    "LEAST_EQUAL",
    "LEAST_NUMBERS",
    "Checkpoints",
    "UntilPrecise",
    "Wanted",
    "half_width",
    "wanted_of",
]

LEAST_NUMBERS: Final = 1_000
"""The numbers that a forecast must have before the rule looks at it."""

LEAST_EQUAL: Final = 10_000
"""The numbers that a forecast must have if it has not varied. Of what comes in 1 of 1,000 trials, 1,000 numbers hold
none in 37 % of the runs, 10,000 in 1 of 22,000."""

_FIRST = 4
"""Blocks before the first look."""

_GROWTH = 1.25
"""Blocks of a look over those of the look before it: at most so many times the trials needed are run."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """One number to be known well.

    Attributes:
        index: the forecast's.
        percent: of a percentile; None for the mean or the standard deviation.
        spread: the standard deviation rather than the mean.
    """

    index: int
    percent: float | None = None
    spread: bool = False


def wanted_of(index: int, central: float, asked: Sequence[str]) -> list[Wanted]:
    """Return what is asked of a forecast, `range` being both ends of the range that holds the share `central`.

    >>> [wanted.percent for wanted in wanted_of(0, 0.5, ("mean", "range", "p90"))]
    [None, 25.0, 75.0, 90.0]
    """
    result: dict[Wanted, None] = {}
    for name in asked:
        if name == "range":
            tail = 50.0 * (1.0 - central)
            result |= {Wanted(index, tail): None, Wanted(index, 100.0 - tail): None}
        elif name in ("mean", "sd"):
            result[Wanted(index, spread=name == "sd")] = None
        else:
            result[Wanted(index, float(name[1:]))] = None
    return list(result)


class UntilPrecise:
    """See `StopRule`.

    Args:
        asked: how well which numbers must be known.
        forecasts: (index, name, share of the central range) of those that count.
    """

    key = Precision.key

    def __init__(self, asked: Precision, forecasts: Sequence[tuple[int, str, float]]) -> None:
        self._asked, self._names = asked, [name for _, name, _ in forecasts]
        results = [wanted for index, _, central in forecasts for wanted in wanted_of(index, central, asked.numbers)]
        self._wanted = sorted(results, key=lambda wanted: wanted.percent is not None)  # the cheap ones first
        spread = "sd" in asked.numbers
        self._moments = {index: RunningMoments(spread=spread) for index, _, _ in forecasts}
        self._checkpoints = Checkpoints()
        self._accepted, self._needed = 0, math.inf

    @property
    def goal(self) -> str:
        asked = self._asked
        width = number_text(asked.tolerance) if not asked.relative else f"{number_text(100.0 * asked.tolerance)} %"
        what = f"{list_of(asked.numbers)} of {list_of(self._names)}"
        return (
            f"{what} {be(len(self._wanted))} known to within {width} "
            f"({number_text(100.0 * asked.confidence)} % confidence)"
        )

    @property
    def share(self) -> float:
        return min(1.0, self._accepted / self._needed)

    def counting(self, block: Observed, start: int) -> int:
        return block.trials

    def reached(self, block: Observed, columns: Columns) -> bool:
        self._accepted += block.accepted.size
        for index, moments in self._moments.items():
            moments.add(block.forecasts[index])
        if not self._checkpoints.due() or any(each.n < _least(each) for each in self._moments.values()):
            return False
        for number, wanted in enumerate(self._wanted):
            excess = self._excess(wanted, columns)
            if not excess <= 1.0:
                self._needed = self._accepted * excess**2
                self._wanted.insert(0, self._wanted.pop(number))  # most likely the last to be precise enough
                return False
        self._needed = self._accepted
        return True

    def _excess(self, wanted: Wanted, columns: Columns) -> float:
        """Divide the half width by what it may be; infinite where there is no interval."""
        estimate = self._estimate(wanted, columns)
        half = half_width(estimate)
        allowed = self._asked.tolerance * (abs(estimate.value) if self._asked.relative else 1.0)
        if allowed == 0.0:
            same = self._moments[wanted.index].deviation == 0.0  # no share of 0 is ever known to a part of itself
            return 0.0 if half == 0.0 or same else math.inf
        return half / allowed

    def _estimate(self, wanted: Wanted, columns: Columns) -> Estimate:
        confidence, moments = self._asked.confidence, self._moments[wanted.index]
        if wanted.percent is not None:
            sample = Sample.of(numbers(columns(wanted.index)))
            return percentile(sample, wanted.percent, confidence=confidence)
        return moments.standard_deviation(confidence) if wanted.spread else moments.mean(confidence)


def _least(moments: RunningMoments) -> int:
    return LEAST_EQUAL if moments.deviation == 0.0 else LEAST_NUMBERS


def half_width(estimate: Estimate) -> float:
    """Return the longer side of its interval; infinite where it has none."""
    if estimate.interval is None:
        return math.inf
    low, high = estimate.interval
    return max(estimate.value - low, high - estimate.value)


class Checkpoints:
    """Counts blocks, and says after which to look: 4, 5, 7, 9, 12, 15, 19, 24, 30, …

    >>> checkpoints = Checkpoints()
    >>> [block for block in range(1, 31) if checkpoints.due()]
    [4, 5, 7, 9, 12, 15, 19, 24, 30]
    """

    def __init__(self) -> None:
        self._blocks, self._next = 0, _FIRST

    def due(self) -> bool:
        """Count a block; whether to look after it."""
        self._blocks += 1
        if self._blocks < self._next:
            return False
        self._next = max(self._blocks + 1, math.ceil(self._blocks * _GROWTH))
        return True
