"""One forecast's accepted trials, their statistics, and what a person should hear of those with long tails."""

from __future__ import annotations

import math
import warnings
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from numbers import Real
from typing import Final

import numpy as np
from numpy.typing import NDArray

from xlmc.errors import Notice, SimulationError
from xlmc.montecarlo import statistics
from xlmc.montecarlo.columns import numbers
from xlmc.montecarlo.definitions.definitions import Forecast
from xlmc.montecarlo.definitions.forms import Form, kind_of_format
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.model.plain_words import list_of
from xlmc.montecarlo.number_text import count_text, number_text, styled_text
from xlmc.montecarlo.statistics import Description, Estimate, Sample, errors_from_trials, too_short

__all__ = ["FARTHEST_PART", "TELLING", "ForecastResult", "Replicates", "interval_notices", "tail_notices"]

TELLING: Final = 1_000
"""Accepted trials from which on a single one can make up little of a variance, if there is one."""

FARTHEST_PART: Final = 0.1
"""If one trial has more than this part of the sum of squares, mean and standard deviation depend on it."""

LEAST_BEYOND: Final = 10.0
"""Effective trials that must lie beyond a quantile, if it is to be given where trials are weighted."""

_MOST_NAMED: Final = 4

_OF_TAILS = (
    "Of a ratio whose denominator passes 0 they do not exist, whatever their errors say: use the median and "
    "percentiles, which do"
)

Floats = NDArray[np.float64]
Replicates = NDArray[np.int64]


class ForecastResult:
    """One forecast's accepted trials and their statistics. Estimates carry their standard error.

    Attributes:
        faults: error, `text` or `blank` -> accepted trials in which it is none.
        discards: filter of its own -> accepted trials that it discards.

    Args:
        still: no draw reaches it.
        labels: the texts that its numbers stand for; None where its answers are numbers.
        code: the number format of its cell.
        date1904: whether the workbook counts days from 1904.
        two_valued: its formula gives TRUE and FALSE, or 1 and 0, and nothing else.
    """

    def __init__(
        self,
        definition: Forecast,
        column: Callable[[], Floats],
        faults: Counter[str],
        replicate: Callable[[], Replicates | None] = lambda: None,
        discards: Counter[str] | None = None,
        weights: Callable[[], Floats | None] = lambda: None,
        *,
        still: bool = False,
        labels: Sequence[str] | None = None,
        code: str = "General",
        date1904: bool = False,
        two_valued: bool = False,
    ) -> None:
        self.definition, self.faults, self._still = definition, faults, still
        self._labels, self._code, self._date1904, self._two_valued = labels, code, date1904, two_valued
        self.discards: Counter[str] = Counter() if discards is None else discards
        self._column, self._replicate, self._weights = column, replicate, weights

    @cached_property
    def values(self) -> Floats:
        """`(m,)` accepted trials in which it is a number, in their order."""
        return numbers(self._column())

    @cached_property
    def sample(self) -> Sample:
        """The same in ascending order with their weights and replicates, from which the statistics come."""
        replicate, weights, column = self._replicate(), self._weights(), self._column()
        known = None if replicate is None and weights is None else ~np.isnan(column)
        return Sample.of(
            self.values,
            None if weights is None else weights[known],
            None if replicate is None else replicate[known],
            still=self._still,
            two_valued=self._two_valued or self.definition.kind is Kind.YES_NO,
        )

    @cached_property
    def yes(self) -> Estimate | None:
        """The share of the trials in which a yes/no answer is a yes; None of other forecasts, and without a trial.

        Its row says that it is one or, where the row says nothing, it is 0 or 1 in all trials. Any number but 0 is a
        yes, as in Excel.
        """
        if not self.sample.n or self.kind is not Kind.YES_NO:
            return None
        return statistics.complement(statistics.probability_between(self.sample, 0.0, 0.0))

    @cached_property
    def kind(self) -> Kind:
        """What its answers are: what its row says; else texts; yes and no where its formula gives nothing else; a date,
        a percentage or an amount of money where the format of its cell shows one; yes and no where both 1 and 0 occur
        and nothing else; whole numbers where all are, in a cell that shows no decimals; else a number.
        """
        if self._labels is not None:
            return Kind.CATEGORY
        if self.definition.kind is not None:
            return self.definition.kind
        if self._two_valued and (self.sample.yes_no_at_most or not self.sample.n):
            return Kind.YES_NO
        if (shown := kind_of_format(self._code)) is not None:
            return shown
        if self.sample.yes_no and self.sample.x[0] < self.sample.x[-1]:
            return Kind.YES_NO
        return Kind.WHOLE if self.sample.whole else Kind.NUMBER

    @cached_property
    def form(self) -> Form:
        """How its numbers are written."""
        form = Form(self.kind, self._code, self.definition.report_to, self._date1904)
        return form.beside_units(self.definition.units)

    @cached_property
    def categories(self) -> dict[str, Estimate]:
        """Text -> the share of the trials that have it, the most frequent first; nothing where answers are numbers."""
        shares = {
            text: statistics.probability_between(self.sample, float(number), float(number))
            for number, text in enumerate(self._labels or ())
        }
        result = {text: share for text, share in shares.items() if share.value > 0.0}
        return dict(sorted(result.items(), key=lambda each: -each[1].value))

    @property
    def numbers_of_texts(self) -> tuple[float, ...]:
        """What stands for each of its texts in its column, in the order of `categories`."""
        numbers = {text: float(number) for number, text in enumerate(self._labels or ())}
        return tuple(numbers[text] for text in self.categories)

    @property
    def column(self) -> Floats:
        """`(m,)` all accepted trials; NaN where it is no number."""
        return self._column()

    def between(self, low: float, high: float) -> ForecastResult:
        """Return the part of the values from one number to another, both included."""

        def part() -> Floats:
            column = self._column()
            return np.where((column >= low) & (column <= high), column, np.nan)

        return ForecastResult(self.definition, part, Counter(), self._replicate)

    def mean_interval(self, confidence: float) -> tuple[float, float] | None:
        """Both ends of the interval that holds the mean with this probability; None if the trials are too few."""
        return statistics.mean(self.sample, confidence=confidence).interval

    def __repr__(self) -> str:
        return f"<{self.definition.name}: {self.values.size} accepted trials>"

    @cached_property
    def statistics(self) -> Description:
        """Every statistic at once; trials with hardly any weight, which a sample leaves out, are counted, too."""
        d = self.definition
        if self._labels is not None:
            return statistics.undescribed(int(self.values.size))
        description = statistics.describe(self.sample, central=d.central, threshold=d.threshold)
        if self.sample.w is None:
            return description
        low, high = description.central
        tail = (1.0 - d.central) / 2.0
        return replace(
            description,
            trials=int(self.values.size),
            median=self._if_known(description.median, 0.5),
            percentiles={key: self._if_known(each, key / 100.0) for key, each in description.percentiles.items()},
            central=(self._if_known(low, tail), self._if_known(high, tail)),
        )

    def _if_known(self, estimate: Estimate, share: float) -> Estimate:
        """Return a quantile; nan where trials are weighted and too few lie beyond it in effect."""
        few = self.sample.w is not None and self.sample.effective * min(share, 1.0 - share) < LEAST_BEYOND
        return Estimate(math.nan, n=estimate.n) if few else estimate

    @property
    def mean(self) -> Estimate:
        return statistics.mean(self.sample) if self._labels is None else Estimate(math.nan)

    @property
    def median(self) -> Estimate:
        return self.percentile_at(50.0)

    @property
    def standard_deviation(self) -> Estimate:
        return statistics.standard_deviation(self.sample) if self._labels is None else Estimate(math.nan)

    def percentile(self, percent: float) -> Estimate:
        """Return the value that `percent` (0 to 100) of the trials do not exceed, as Excel's PERCENTILE.INC.

        A percentage between 0 and 1 is warned of: `quantile` takes shares.

        Raises:
            SimulationError: it is no number from 0 to 100.
        """
        percent = _number(percent, "a percentage", 100.0)
        if 0.0 < percent < 1.0:
            message = f"percentile({percent:g}) is below the first percent; quantile({percent:g}) takes a share"
            warnings.warn(message, stacklevel=2)
        return self.percentile_at(percent)

    def percentile_at(self, percent: float) -> Estimate:
        """Return the percentile of any percentage from 0 to 100, below the first percent, too."""
        if self._labels is not None:
            return Estimate(math.nan)
        return self._if_known(statistics.percentile(self.sample, percent), percent / 100.0)

    def quantile(self, share: float) -> Estimate:
        """Return the value that this share (0 to 1) of the trials do not exceed: `quantile(0.95)` is `percentile(95)`.

        Raises:
            SimulationError: it is no number from 0 to 1.
        """
        return self.percentile_at(100.0 * _number(share, "a share", 1.0))

    def central(self, share: float | None = None) -> tuple[Estimate, Estimate]:
        """Return both ends of the central range that holds `share` of the trials; by default the forecast's own share.

        Raises:
            SimulationError: the share is no number from 0 to 1.
        """
        share = self.definition.central if share is None else _number(share, "a share", 1.0)
        if self._labels is not None:
            return Estimate(math.nan), Estimate(math.nan)
        low, high = statistics.central_interval(self.sample, share)
        return self._if_known(low, (1.0 - share) / 2.0), self._if_known(high, (1.0 - share) / 2.0)

    @cached_property
    def certainty(self) -> Estimate | None:
        """The share of the trials in the range that was asked for; None if none was, or no trial has a number."""
        asked = self.definition.asked
        return (
            None
            if asked is None or not self.sample.n or self._labels is not None
            else statistics.probability_between(self.sample, *asked)
        )

    def probability_above(self, threshold: float) -> Estimate:
        """P(forecast > threshold).

        Raises:
            SimulationError: the threshold is no number.
        """
        return statistics.probability_above(self.sample, _number(threshold, "a threshold"))


def _number(given: object, what: str, most: float = math.inf) -> float:
    """Return a number that was given in Python.

    Args:
        given: by the person.
        what: it is, in words.
        most: the largest that it may be; where it has a limit, the least is 0.

    Raises:
        SimulationError: it is none, or lies outside.
    """
    limited = math.isfinite(most)
    hint = f"Give a number from 0 to {number_text(most)}" if limited else "Give a number, in the units of the forecast"
    number = math.nan if isinstance(given, bool) or not isinstance(given, Real) else float(given)
    if math.isnan(number) or (limited and not 0.0 <= number <= most):
        raise SimulationError(f"{given!r} is not {what}", hint=hint)
    return number


def tail_notices(samples: Mapping[str, Sample], method: str) -> list[Notice]:
    """Return cautions about forecasts with long tails.

    Args:
        samples: forecast -> its accepted trials.
        method: the sampling method in words.
    """
    hanging = {name: part for name, sample in samples.items() if sample.n >= TELLING and (part := _farthest(sample))}
    messages = (
        f"the mean and the standard deviation of {name!r} depend on a single trial, {part}. {_OF_TAILS}"
        for name, part in hanging.items()
    )
    others = {name: sample for name, sample in samples.items() if name not in hanging}
    return [*map(Notice, messages), *interval_notices(others, method)]


def interval_notices(samples: Mapping[str, Sample], method: str) -> list[Notice]:
    """Which numbers have an interval that may be too short, and which the error of independent trials.

    Args:
        samples: forecast -> its accepted trials.
        method: the sampling method in words.
    """
    result = []
    if short := _named(samples, too_short):
        result.append(
            f"the interval of {short} may be too short: a few trials far out in the tail decide such a number, and "
            "more of their kind may be missing. More trials help; percentiles and shares have intervals that hold"
        )
    if plain := _named(samples, _only_from_trials):
        result.append(
            f"the error of {plain} is that of independent trials: a few trials far out in the tail decide such a "
            f"number, and the replicates are too few to show its error. By {method} it may vary less than that"
        )
    return [Notice(message) for message in result]


def _only_from_trials(sample: Sample) -> list[str]:
    """Of a number whose interval may be too short it is not said that it may vary less."""
    short = too_short(sample)
    return [number for number in errors_from_trials(sample) if number not in short]


def _named(samples: Mapping[str, Sample], concerned: Callable[[Sample], list[str]]) -> str:
    """Return the numbers in words, such as "the mean of 'x' and the standard deviation of 'y'"; otherwise empty."""
    numbers = [f"the {number} of {name!r}" for name, sample in samples.items() for number in concerned(sample)]
    more = [f"{len(numbers) - _MOST_NAMED} more"] if len(numbers) > _MOST_NAMED else []
    return list_of([*numbers[:_MOST_NAMED], *more]) if numbers else ""


def _farthest(sample: Sample) -> str:
    """Say what part the farthest trial has; empty where no trial has too large a part."""
    part = 0.0 if sample.yes_no else statistics.farthest_part(sample)  # the interval of a share holds
    return (
        f"which makes up {styled_text(part, '.0%')} of the variance of {count_text(sample.n)}"
        if part > FARTHEST_PART
        else ""
    )
