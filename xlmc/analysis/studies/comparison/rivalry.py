"""Two models that answer one question from different inputs: which of them knows the answer better.

Neither is the other made simpler, so a tolerance is not what decides between them. The one whose answer is spread less
tells more: by its standard deviation, and by its central range where a heavy tail makes the standard deviation
uncertain, as that of a speed from momentum at near-parallel approaches is.

If both are right, the difference of their answers is 0 in the crash that happened. So 0 must not lie in the tail of the
differences, trial by trial, of the trials that both accept. Inputs that both draw are drawn alike there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.analysis.studies.comparison.differences import Change
from xlmc.analysis.studies.comparison.paired_statistics import (
    Accepted,
    Pair,
    Statistic,
    range_of,
    standard_deviation_of,
)
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.diagnostics.agreement import INCONSISTENT, STRAINED
from xlmc.montecarlo.distributions.spelling import name_key
from xlmc.montecarlo.model.needed import upstream
from xlmc.montecarlo.simulation.simulation import RunResult

__all__ = ["RivalVerdict", "Rivalry", "rivalry"]

_CERTAINTY: Final = 3.0
"""Errors by which the spreads must differ, if one is to be called the smaller."""

_FEWEST: Final = {STRAINED: 1_000, INCONSISTENT: 10_000}
"""Trials that both accept, without which a chance below these cannot be distinguished from one above."""


class RivalVerdict(Enum):
    """What the trials say of two answers to one question; the worst comes last.

    The chances below which they are strained, and contradict each other, are those of a reading of evidence.
    """

    AGREE = "agree"
    TOO_FEW = "too few trials"
    STRAINED = "strained"
    CONTRADICT = "contradict"


@dataclass(frozen=True, slots=True)
class Rivalry:
    """Two models of one answer.

    Attributes:
        own: for either book, the assumptions that its answer takes and the other's does not.
        deviation: the standard deviations.
        width: those of the central ranges.
        sharper: 0 or 1, the book whose answer is spread less; None if these trials cannot tell, or where the two
            spreads contradict each other.
        chance: of a difference as far from 0 as that of the two answers, or farther; nan without trials that both
            accept.
        both: trials that both accept with a number.
    """

    own: tuple[tuple[str, ...], tuple[str, ...]]
    deviation: Change
    width: Change
    sharper: int | None
    chance: float
    both: int

    @property
    def agreement(self) -> RivalVerdict:
        """Whether the two answers agree."""
        if np.isnan(self.chance):
            return RivalVerdict.TOO_FEW
        for limit, verdict in ((INCONSISTENT, RivalVerdict.CONTRADICT), (STRAINED, RivalVerdict.STRAINED)):
            if self.chance < limit and self.both >= _FEWEST[limit]:
                return verdict
        return RivalVerdict.AGREE if self.chance >= STRAINED else RivalVerdict.TOO_FEW

    @property
    def contrary(self) -> bool:
        """Whether one answer has the smaller standard deviation, and the other the smaller central range."""
        sides = _smaller(self.deviation), _smaller(self.width)
        return None not in sides and sides[0] != sides[1]

    @property
    def by_range(self) -> bool:
        """Whether the central ranges decide, because the standard deviations do not."""
        return self.sharper is not None and _smaller(self.deviation) is None


def _own_inputs(run: RunResult, forecast: Forecast) -> Mapping[str, str]:
    """Return the drawn assumptions that a forecast is computed from: key -> name. Filters are not asked."""
    model = run.model
    reached = upstream(model.needed.graph, [forecast.cell], model.lowering.led_to)
    return {name_key(a.name): a.name for a in model.live if a.cell in reached}


def rivalry(
    runs: tuple[RunResult, RunResult],
    forecasts: tuple[Forecast, Forecast],
    answers: tuple[Accepted, Accepted],
) -> Rivalry | None:
    """How two books rival for an answer; None if one is computed from no other assumptions than the other.

    Args:
        runs: over the same trials.
        forecasts: of either book.
        answers: the accepted trials of either, in one unit.
    """
    mine, theirs = (_own_inputs(*each) for each in zip(runs, forecasts, strict=True))
    own = (
        tuple(name for key, name in mine.items() if key not in theirs),
        tuple(name for key, name in theirs.items() if key not in mine),
    )
    if not all(own):
        return None
    pair = Pair(*answers)
    share = forecasts[0].central
    deviation = _change(pair, *(standard_deviation_of(each) for each in answers))
    width = _change(pair, *(range_of(each, share) for each in answers))
    sides = {side for side in (_smaller(deviation), _smaller(width)) if side is not None}
    return Rivalry(
        own=own,
        deviation=deviation,
        width=width,
        sharper=sides.pop() if len(sides) == 1 else None,
        chance=_chance_of_zero(pair.apart),
        both=int(pair.apart.size),
    )


def _change(pair: Pair, first: Statistic, second: Statistic) -> Change:
    return Change(first.estimate, second.estimate, pair.difference(first, second))


def _smaller(spread: Change) -> int | None:
    """Return the book with the smaller spread; None if the difference does not clear its error, or has none."""
    value, error = spread.difference.value, spread.difference.error
    if error is None or not abs(value) > _CERTAINTY * error:
        return None
    return int(value < 0.0)


def _chance_of_zero(apart: NDArray[np.float64]) -> float:
    """How far out 0 lies among the differences `(c,)`: the share on the thinner side of it, doubled."""
    if not apart.size:
        return float("nan")
    below, above = float(np.mean(apart < 0.0)), float(np.mean(apart > 0.0))
    return 2.0 * min(below, above) + (1.0 - below - above)
