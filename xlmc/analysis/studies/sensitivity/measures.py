"""What a sensitivity analysis finds: plain numbers and names, ready for a sheet, a page or a file.

Nothing here is an array. Every number that comes from trials is an `Estimate`: value, standard error, 95 % interval.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from xlmc.montecarlo.definitions.forms import PLAIN, Form
from xlmc.montecarlo.definitions.stating import Kind
from xlmc.montecarlo.number_text import styled_text
from xlmc.montecarlo.statistics import Estimate

__all__ = [
    "PERCENTS",
    "Bar",
    "FilterLimit",
    "ForecastSensitivity",
    "Influence",
    "LimitAnswer",
    "LimitPoint",
    "Noise",
    "Sensitivities",
    "Slope",
    "noise",
]

PERCENTS = (10.0, 25.0, 50.0, 75.0, 90.0)
"""The percentiles of its own distribution at which tornado (the first and the last) and spider (all) put an assumption.
"""

_CHANCE: Final = 0.05
"""The probability that noise alone counts as an influence, in any of a forecast's assumptions."""


@dataclass(frozen=True, slots=True)
class Influence:
    """What one assumption has to do with one forecast, among the accepted trials.

    Attributes:
        assumption, units: its name and unit.
        rank_correlation: Spearman's, −1 to 1; its value is nan where one of the two does not vary.
        contribution: Crystal Ball's "contribution to variance": its squared rank correlation over the sum of all
            assumptions' (a share, 0.25 for 25 %), with the sign of the correlation. Approximate, and wrong where
            assumptions are correlated, by request or by filters, or where the effect is not monotonic.
        explained: Var(E[forecast | assumption]) / Var(forecast), a share: how much of the forecast's variance would go,
            on average, if the assumption's true value were known. Right with correlated assumptions and among
            accepted trials; it counts what the assumption tells of others that go with it. Shares need not add up to 1.
            May be a little below 0: the estimate has no bias, and noise has either sign.
        explained_at_least: whether `explained` is a lower bound only, because the forecast jumps or bends more finely
            than the trials show, or a few trials decide it.
        explained_floor: what noise alone reaches: with no influence of any assumption, the largest of all of a
            forecast's shares stays below it with 95 % probability.
        dependence: the Cramér–von Mises index, 0 to 1: 0 only where the forecast's whole distribution does not depend
            on the assumption, 1 where it is a function of it. It also sees what `explained` cannot: an assumption that
            widens the forecast without moving its mean, or acts only together with others.
        dependence_floor: as `explained_floor`.
        first_order, total: Sobol's indices, of all trials; None if they are not given, see
            `Sensitivities.sobol_reason`. `first_order` is what `explained` estimates too, by other means; `total` adds
            what the assumption does together with others.
    """

    assumption: str
    units: str
    rank_correlation: Estimate
    contribution: Estimate
    explained: Estimate
    explained_floor: float
    dependence: Estimate
    dependence_floor: float
    first_order: Estimate | None = None
    total: Estimate | None = None
    explained_at_least: bool = False

    @property
    def seen(self) -> bool:
        """Whether either given-data measure is above what noise alone would reach."""
        return self.explained.value > self.explained_floor or self.dependence.value > self.dependence_floor


@dataclass(frozen=True, slots=True)
class Bar:
    """One assumption moved alone, all others at their base values: no probability, and no filter is applied.

    Attributes:
        assumption, units: its name and unit.
        base: its base value.
        inputs: `(5,)` its values at `PERCENTS` of its own distribution, before filtering.
        answers: `(5,)` the forecast there, in its unit; None if it is no number.
        rejected: `(5,)` whether the filters would reject that case.
        monotonic: whether the forecast only rises or only falls over `inputs`; None if a value is missing. Where it
            is False, a bar from the first to the last value hides what lies between.
        form: how numbers of the assumption are written.
    """

    assumption: str
    units: str
    base: float
    inputs: tuple[float, ...]
    answers: tuple[float | None, ...]
    rejected: tuple[bool, ...]
    monotonic: bool | None
    form: Form = PLAIN

    @property
    def low(self) -> float | None:
        """The forecast at the assumption's 10th percentile."""
        return self.answers[0]

    @property
    def high(self) -> float | None:
        """The forecast at the assumption's 90th percentile."""
        return self.answers[-1]

    @property
    def span(self) -> float:
        """The width from the smallest to the largest of the five answers; otherwise 0."""
        known = [answer for answer in self.answers if answer is not None]
        return max(known) - min(known) if known else 0.0


@dataclass(frozen=True, slots=True)
class ForecastSensitivity:
    """Everything about one forecast.

    Attributes:
        forecast, units: its name and unit.
        trials: accepted trials that the influences rest on, in which it is a number.
        influences: by the variance explained, the largest first; empty where the trials are too few, or
            the forecast or every assumption does not vary. Of more than 20 assumptions, the 20 that a first look finds.
        omitted: live assumptions that were not measured, because the first look found less influence.
        base: the forecast with every assumption at its base value; None where that is no number.
        bars: tornado and spider, by `span`, the widest first; of more than 20 assumptions, the widest 20.
        form: how its numbers are written.
    """

    forecast: str
    units: str
    trials: int
    influences: tuple[Influence, ...]
    omitted: int
    base: float | None
    bars: tuple[Bar, ...]
    form: Form = PLAIN

    @property
    def change_units(self) -> str:
        """The units of a change of it: of dates days, of money its sign; empty where it has none."""
        if self.form.kind is Kind.DATE:
            return "days"
        if self.form.kind is Kind.YES_NO:
            return "%"
        return self.units or "".join(self.form.affixes).strip()

    @property
    def change_form(self) -> Form:
        """How a change of it is written, beside its units."""
        return PLAIN if self.form.kind is Kind.DATE else self.form

    @property
    def base_text(self) -> str:
        """The forecast at the base case, with its units; empty where that is no number."""
        if self.base is None:
            return ""
        if self.form.kind is Kind.YES_NO:
            return "yes" if self.base else "no"
        return f"{self.form.number(self.base)} {self.units}".rstrip()


@dataclass(frozen=True, slots=True)
class LimitAnswer:
    """A forecast with a filter's limit at another value, all else as it is, in the forecast's unit.

    Attributes:
        change: of the mean from that at the limit as it is; its error is that of the difference, from trials that both
            have in common.
        low, high: the ends of the central range.
    """

    forecast: str
    mean: Estimate
    change: Estimate
    low: Estimate
    high: Estimate


@dataclass(frozen=True, slots=True)
class LimitPoint:
    """One value of a limit.

    Attributes:
        limit: the value.
        trials: accepted then, of the `trials` of the `FilterLimit`; where the limit is loosened, an estimate from
            fewer, rounded.
        acceptance: the share of all trials that are accepted then.
        answers: one a forecast, in the order of the workbook; of very many, of the first ones.
    """

    limit: float
    trials: int
    acceptance: Estimate
    answers: tuple[LimitAnswer, ...]


@dataclass(frozen=True, slots=True)
class Slope:
    """How fast a forecast's mean moves with a limit: d mean / d limit, forecast units per unit of the filter's cell."""

    forecast: str
    mean: Estimate


@dataclass(frozen=True, slots=True)
class FilterLimit:
    """How the answers move as one limit of one filter moves.

    Attributes:
        filter, cell: its name, and the cell it looks at.
        relation: `at least`, `at most`, `above` or `below`.
        limit: as the workbook has it.
        points: in ascending order of the limit; the one with the limit as it is is among them. Empty where no
            accepted trial says how far the limit may be moved.
        slopes: one a forecast; from the points next to the limit as it is.
        trials: of the run's trials, those whose accepted ones the points rest on.
        loosened_trials: those that were evaluated again to find the ones that only this limit rejects.
        form: how the numbers of the cell are written.
    """

    filter: str
    cell: str
    relation: str
    limit: float
    points: tuple[LimitPoint, ...]
    slopes: tuple[Slope, ...]
    trials: int
    loosened_trials: int
    form: Form = PLAIN


@dataclass(frozen=True, slots=True, repr=False)
class Sensitivities:
    """What the answers of a run depend on.

    Attributes:
        accepted: trials that the run accepted.
        examined: accepted trials that the influences rest on, the first ones of the run (or of each of its
            replicates); fewer than `accepted` where all would take long.
        forecasts: one a forecast that was asked for, in the order of the workbook.
        omitted: live assumptions that are measured for no forecast.
        medians: assumptions without a base value, which tornado and spider hold at their median.
        sobol_reason: why there are no Sobol indices; empty where there are.
        sobol_trials: pairs of trials that the Sobol indices rest on; otherwise 0.
        filter_limits: one a limit, in the order of the workbook.
        omitted_limits: further ones that were left out, because there are very many.
        varying_limits: filters, by name, with a limit that varies with the assumptions and so cannot be moved.
        omitted_forecasts: further forecasts that are numbers, and were not asked for.
    """

    accepted: int
    examined: int
    forecasts: tuple[ForecastSensitivity, ...]
    omitted: int
    medians: tuple[str, ...]
    sobol_reason: str
    sobol_trials: int
    filter_limits: tuple[FilterLimit, ...]
    omitted_limits: int
    varying_limits: tuple[str, ...]
    omitted_forecasts: int = 0

    def __repr__(self) -> str:
        lines = []
        for each in self.forecasts:
            shares = "; ".join(
                f"{one.assumption} {styled_text(one.explained.value, '.1%')}" for one in each.influences[:5]
            )
            lines.append(f"{each.forecast}: {shares or 'no assumption moves it'}")
        return "\n".join(["Variance explained, the largest first", *lines])

    def __getitem__(self, forecast: str) -> ForecastSensitivity:
        """One forecast, by name whatever its case.

        Raises:
            KeyError: there is none of this name.
        """
        for each in self.forecasts:
            if each.forecast.casefold() == forecast.casefold():
                return each
        raise KeyError(f"there is no forecast {forecast!r}")


@dataclass(frozen=True, slots=True)
class Noise:
    """Whether each measure of one assumption's influence is no more than noise: what trials show where there is none.

    Variance explained and dependence have a floor of their own. A rank correlation, and the contribution made of it, is
    noise within as many errors of 0 as the largest of all assumptions' stays within by chance, with 95 % probability
    (Šidák 1967); a Sobol index likewise, on one side.

    Attributes:
        correlation: the rank correlation, and the contribution to variance that is made of it.
    """

    explained: bool
    dependence: bool
    correlation: bool
    first_order: bool
    total: bool


def noise(sensitivity: ForecastSensitivity) -> tuple[Noise, ...]:
    """Return the noise of the influences on a forecast, in their order."""
    count = max(len(sensitivity.influences) + sensitivity.omitted, 1)
    each = 1.0 - (1.0 - _CHANCE) ** (1.0 / count)
    return tuple(_noise(one, _errors(each / 2.0), _errors(each)) for one in sensitivity.influences)


def _errors(chance: float) -> float:
    """How many errors a normal number lies above 0 with some chance."""
    from scipy.special import ndtri

    return -float(ndtri(chance))


def _noise(influence: Influence, either: float, above: float) -> Noise:
    return Noise(
        explained=influence.explained.value <= influence.explained_floor,
        dependence=influence.dependence.value <= influence.dependence_floor,
        correlation=_is_small(influence.rank_correlation, either, abs(influence.rank_correlation.value)),
        first_order=influence.first_order is not None
        and _is_small(influence.first_order, above, influence.first_order.value),
        total=influence.total is not None and _is_small(influence.total, above, influence.total.value),
    )


def _is_small(estimate: Estimate, errors: float, size: float) -> bool:
    """Whether a number is within so many of its errors of 0; where it has no error, nothing is known of that."""
    return estimate.error is not None and math.isfinite(size) and size <= errors * estimate.error
