"""What every method is asked for: mean, standard deviation, both ends of the central range, share accepted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from xlmc.montecarlo import statistics
from xlmc.montecarlo.model.model import CompiledModel
from xlmc.montecarlo.number_text import count_text, fixed_text, number_text, styled_text
from xlmc.montecarlo.sampling.sampling_plan import SamplingPlan
from xlmc.montecarlo.statistics import Sample

__all__ = [
    "STATISTICS",
    "Answer",
    "Errors",
    "Extreme",
    "Method",
    "MethodResult",
    "answer_of",
    "extremes_of",
    "percent_words",
    "rounded_text",
    "seconds_text",
    "statistic_words",
    "trials_text",
]

STATISTICS: Final[Mapping[str, str]] = {
    "mean": "Mean",
    "sd": "SD",
    "low": "Lower end",
    "high": "Upper end",
}
"""Attribute of an `Answer` -> what people call it."""

Errors = Literal["independent", "consistent", "weighted", "floor", "once"]
"""How a method's errors fall with its trials: as those of independent trials; to zero, at least as fast; likewise, with
weights; as those of independent trials, down to a floor; or there is one answer, and nothing falls."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Answer:
    """One forecast, in its units; NaN where a method gives no number.

    Attributes:
        mean, sd: of the accepted trials, or of all where the method does not see filters.
        low, high: the ends of the forecast's central range.
        least, most: bounds, for methods that give them instead of a distribution.
    """

    mean: float = np.nan
    sd: float = np.nan
    low: float = np.nan
    high: float = np.nan
    least: float = np.nan
    most: float = np.nan


@dataclass(frozen=True, slots=True, eq=False)
class Extreme:
    """The lowest or highest accepted trial of a forecast in one run.

    Attributes:
        forecast, end: whose, `least` or `most`.
        value: of the forecast.
        seed, plan, trial: what draws it again.
    """

    forecast: str
    end: str
    value: float
    seed: int
    plan: SamplingPlan
    trial: int


def extremes_of(
    forecasts: Mapping[str, Floats], trials: NDArray[np.int64], seed: int, plan: SamplingPlan
) -> tuple[Extreme, ...]:
    """Return the extremes of every forecast `(m,)` over accepted trials `(m,)`; none of a forecast that is nowhere a
    number.
    """
    extremes = []
    for name, values in forecasts.items():
        if np.isnan(values).all():
            continue
        for end, row in (("least", np.nanargmin(values)), ("most", np.nanargmax(values))):
            extremes.append(Extreme(name, end, float(values[row]), seed, plan, int(trials[row])))
    return tuple(extremes)


@dataclass(frozen=True, slots=True)
class MethodResult:
    """What one run of a method gave.

    Attributes:
        seconds: of the whole run, with what it learned from.
        evaluations: of the workbook.
        answers: forecast -> answer.
        acceptance: the share of trials that all filters accept; None if the method does not see filters.
        effective: how many equally weighted accepted trials carry as much; None if all weigh alike.
        remarks: on this run, in words: its point, its limits, what it left out.
        ends: (forecast, `least` or `most`) -> the point that the bound is reached at, by the assumptions' names; of
            methods whose bounds are forecasts of points that the workbook accepts.
        extremes: the lowest and highest accepted trials, of methods that draw.
    """

    seconds: float
    evaluations: int
    answers: Mapping[str, Answer]
    acceptance: float | None = None
    effective: float | None = None
    remarks: tuple[str, ...] = field(default=())
    ends: Mapping[tuple[str, str], Mapping[str, float]] = field(default_factory=dict)
    extremes: tuple[Extreme, ...] = field(default=())


class Method(Protocol):
    """A way from ranges of the assumptions to what they make of the forecasts.

    Attributes:
        key: short, for JSON and colours.
        name: for people.
        errors: how they fall with its trials.
        cannot: what it cannot do, in words; may be empty.
    """

    @property
    def key(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def errors(self) -> Errors: ...
    @property
    def cannot(self) -> str: ...

    def run(self, model: CompiledModel, budget: int, seed: int) -> MethodResult:
        """Run it once.

        Args:
            model: the workbook.
            budget: evaluations of the workbook that it may spend, about; methods that know how many they need spend
                those.
            seed: of whatever it draws.

        Raises:
            SimulationError: this method cannot be used on this workbook, and why.
        """


def answer_of(values: Floats, weights: Floats | None, central: float) -> Answer:
    """Return the answer that `(m,)` accepted trials give, NaNs left out; all NaN where too few are numbers."""
    known = ~np.isnan(values)
    if np.count_nonzero(known) < 2:
        return Answer()
    sample = Sample.of(values[known], None if weights is None else weights[known])
    tails = np.array([(1.0 - central) / 2.0, (1.0 + central) / 2.0])
    low, high = sample.quantile(tails)
    return Answer(statistics.mean(sample).value, statistics.standard_deviation(sample).value, float(low), float(high))


def statistic_words(statistic: str) -> str:
    """Return the statistic as it is written in a sentence: `lower end`, `SD`."""
    name = STATISTICS[statistic]
    return name if name.isupper() else name.lower()


def percent_words(share: float) -> str:
    """`1.8 %`: three significant digits.

    >>> percent_words(0.0175)
    '1.75 %'
    """
    return f"{number_text(100.0 * share, 3)} %" if abs(share) < 10.0 else f"{fixed_text(100.0 * share, 0)} %"


def rounded_text(value: float) -> str:
    """Two significant digits."""
    return number_text(value, 2) if 0.001 <= abs(value) < 1e4 or value == 0.0 else styled_text(value, ".1e")


def trials_text(trials: float) -> str:
    """`1,200,000`: two significant digits.

    >>> trials_text(1_234_567.0)
    '1,200,000'
    """
    if not np.isfinite(trials):
        return "infinitely many"
    size = 10 ** max(len(f"{trials:.0f}") - 2, 0)
    return count_text(round(trials / size) * size)


def seconds_text(seconds: float) -> str:
    """`0.35 s`, `12 s`, `4 min`, `3 h`; a dash where no run came to an end.

    >>> seconds_text(0.0123), seconds_text(250.0), seconds_text(9_000.0)
    ('0.012 s', '4.2 min', '2.5 h')
    """
    if not np.isfinite(seconds):
        return "–"
    for length, name, top in ((1.0, "s", 120.0), (60.0, "min", 7_200.0), (3_600.0, "h", 172_800.0)):
        if seconds < top:
            return f"{number_text(float(f'{seconds / length:.2g}'))} {name}"
    return f"{number_text(float(f'{seconds / 86_400.0:.2g}'))} days"
