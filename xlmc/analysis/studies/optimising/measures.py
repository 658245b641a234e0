"""What is made large or small, and what is required: sums of statistics of forecasts and of decisions.

Each is measured on the trials of a candidate, with what every single trial adds to it. Of two candidates over the same
trials the error of the difference then comes from the differences trial by trial, whatever the statistic is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from xlmc.analysis.studies.optimising.pulled_statistics import Floats, Number
from xlmc.montecarlo.definitions.forms import Form
from xlmc.montecarlo.loop.candidates import Values
from xlmc.montecarlo.statistics import Estimate

__all__ = ["Goal", "Measure", "Measured", "Requirement", "Term", "apart"]

_LEAST_TRIALS: Final = 2

_NOISE: Final = 1e-13
"""Differences that are rounding, as a share of the numbers."""

_SLACK: Final = 1e-12
"""By how much decisions may miss what is required of them, by rounding, as a share of its terms."""


@dataclass(frozen=True, slots=True)
class Measured:
    """A number of one candidate.

    Attributes:
        value: of it; NaN where the trials do not give it.
        pulls: `(n,)` what each trial adds to its deviation, in its unit; None for a number without an error.
        least: the least error, where the number moves in steps.
    """

    value: float
    pulls: Floats | None = None
    least: float = 0.0

    @property
    def error(self) -> float:
        """The standard error; infinite where too few trials give the number."""
        if self.pulls is None:
            return 0.0 if math.isfinite(self.value) else math.inf
        return max(_error(self.pulls), self.least)


def _error(pulls: Floats) -> float:
    n = pulls.size
    return float(np.sqrt(np.sum(pulls * pulls) * n / max(n - 1, 1)))


def apart(first: Measured, second: Measured) -> tuple[float, float]:
    """Return how far the second lies above the first over the same trials, and the standard error of that."""
    difference = second.value - first.value
    noise = _NOISE * max(abs(first.value), abs(second.value))
    if abs(difference) <= noise:
        difference = 0.0
    if first.pulls is None or second.pulls is None:
        return difference, math.hypot(first.error, second.error)
    pulls = second.pulls - first.pulls
    error = _error(pulls)
    if error <= noise:
        return difference, 0.0
    return difference, max(error, min(first.least, second.least))


@dataclass(frozen=True, slots=True)
class Term:
    """A statistic of a column, or a decision by its number, times a factor."""

    factor: float
    number: Number | None
    at: int

    def of(self, columns: Floats, values: Values) -> Measured:
        if self.number is None:
            return Measured(self.factor * values[self.at])
        column = columns[self.at]
        known = ~np.isnan(column)
        count = int(np.count_nonzero(known))
        if count < _LEAST_TRIALS:
            return Measured(math.nan)
        whole = count == column.size
        value, result, least = self.number(column if whole else column[known])
        pulls = result if whole else np.zeros(column.size)
        if not whole:
            pulls[known] = result
        if self.factor != 1.0:
            pulls = self.factor * pulls
        return Measured(self.factor * value, pulls, abs(self.factor) * least)


@dataclass(frozen=True, slots=True)
class Measure:
    """A sum of statistics and decisions.

    Attributes:
        text: as it was said.
        terms: of the sum.
        constant: that is added.
        form: how it is written.
        spread: whether it is a spread, in the unit of its forecast.
        units: of the forecast that it is a number of.
    """

    text: str
    terms: tuple[Term, ...]
    constant: float
    form: Form
    spread: bool = False
    units: str = ""

    @property
    def exact(self) -> bool:
        """Whether decisions alone give it."""
        return all(each.number is None for each in self.terms)

    def of(self, columns: Floats, values: Values) -> Measured:
        """Measure it on the columns of a candidate, `(columns, n)`."""
        results = [each.of(columns, values) for each in self.terms]
        pulls = [each.pulls for each in results if each.pulls is not None]
        value = self.constant + sum(each.value for each in results)
        total = None if not pulls else np.sum(pulls, axis=0) if len(pulls) > 1 else pulls[0]
        return Measured(value, total, math.fsum(each.least for each in results))

    def shown(self, estimate: Estimate) -> str:
        """Write a value of it."""
        text = self.form.spread(estimate) if self.spread else self.form.estimate(estimate)
        return f"{text} {self.units}" if self.units else text


@dataclass(frozen=True, slots=True)
class Goal:
    """What is made as large as can be, or as small."""

    measure: Measure
    maximise: bool

    @property
    def sign(self) -> float:
        """The factor with which larger is better."""
        return 1.0 if self.maximise else -1.0

    @property
    def words(self) -> str:
        """`largest mean of NPV`."""
        return f"{'largest' if self.maximise else 'smallest'} {self.measure.text}"


@dataclass(frozen=True, slots=True)
class Requirement:
    """A sum, the limit moved to its side, that must be 0 or more.

    Attributes:
        text: as it was said.
        slack: how far it holds.
        left: the sum on its left, where the right side is a number; else the slack.
        strict: whether it must be above 0.
        equal: whether it must be 0; only of decisions.
    """

    text: str
    slack: Measure
    left: Measure
    strict: bool
    equal: bool = False

    def holds_for(self, values: Values) -> bool:
        """Whether decisions alone decide it, and meet it; True where statistics decide it."""
        if not self.slack.exact:
            return True
        value = self.slack.of(np.empty((0, 0)), values).value
        scale = _SLACK * (abs(self.slack.constant) + sum(abs(t.factor * values[t.at]) for t in self.slack.terms))
        if self.equal:
            return abs(value) <= scale
        return value > scale if self.strict else value >= -scale

    def measured(self, columns: Floats, values: Values) -> Measured:
        """Measure how far it holds: 0 or more where it does."""
        result = self.slack.of(columns, values)
        if not self.slack.exact:
            return result
        if self.holds_for(values):
            return Measured(0.0 if self.equal else max(result.value, 0.0))
        return Measured(-abs(result.value) or -_SLACK)
