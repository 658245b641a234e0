"""Every statistic of one forecast, from one sort."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

from numpy.typing import ArrayLike

from xlmc.montecarlo.statistics import quantiles, smooth
from xlmc.montecarlo.statistics.estimate import Estimate
from xlmc.montecarlo.statistics.mode import mode
from xlmc.montecarlo.statistics.proportions import probability_above
from xlmc.montecarlo.statistics.quantiles import maximum, minimum, range_width
from xlmc.montecarlo.statistics.sample import Sample, Values

__all__ = ["Description", "describe", "undescribed"]

PERCENTS = tuple(float(percent) for percent in range(0, 101, 5))
"""Crystal Ball's deciles, and the percentiles halfway between them."""


@dataclass(frozen=True, slots=True)
class Description:
    """The statistics of one forecast's accepted trials, in their usual order.

    Attributes:
        trials: how many values there are; with weights, how many have a weight above 0.
        percentiles: percent -> estimate.
        central: the lower and upper end of the central range.
        probability_above: P(> threshold), None if no threshold was given.
    """

    trials: int
    mean: Estimate
    median: Estimate
    mode: Estimate
    standard_deviation: Estimate
    variance: Estimate
    skewness: Estimate
    kurtosis: Estimate
    coefficient_of_variation: Estimate
    minimum: Estimate
    maximum: Estimate
    range_width: Estimate
    mean_standard_error: Estimate
    percentiles: Mapping[float, Estimate]
    central: tuple[Estimate, Estimate]
    probability_above: Estimate | None = None


def undescribed(trials: int) -> Description:
    """Return the description of so many answers that are no numbers: each statistic is nan."""
    nothing = Estimate(math.nan, n=trials)
    given = {"trials": trials, "percentiles": dict.fromkeys(PERCENTS, nothing), "central": (nothing, nothing)}
    rest = {each.name: nothing for each in fields(Description) if each.name not in (*given, "probability_above")}
    return Description(**given, **rest)  # type: ignore[arg-type]


def describe(
    values: Values,
    weights: ArrayLike | None = None,
    replicate: ArrayLike | None = None,
    *,
    percentiles: Sequence[float] = PERCENTS,
    central: float = 0.51,
    threshold: float | None = None,
    confidence: float = 0.95,
) -> Description:
    """All statistics of (n,) values, each with its standard error and interval; see the single functions.

    Raises:
        ValueError: a value or weight is not finite, a weight is negative, the lengths differ, or a setting is out of
            its range.

    >>> describe([1.0, 2.0, 3.0, 6.0]).mean.value
    3.0
    """
    sample = Sample.of(values, weights, replicate)
    return Description(
        trials=sample.n,
        mean=smooth.mean(sample, confidence=confidence),
        median=quantiles.median(sample, confidence=confidence),
        mode=mode(sample, confidence=confidence),
        standard_deviation=smooth.standard_deviation(sample, confidence=confidence),
        variance=smooth.variance(sample, confidence=confidence),
        skewness=smooth.skewness(sample, confidence=confidence),
        kurtosis=smooth.kurtosis(sample, confidence=confidence),
        coefficient_of_variation=smooth.coefficient_of_variation(sample, confidence=confidence),
        minimum=minimum(sample),
        maximum=maximum(sample),
        range_width=range_width(sample),
        mean_standard_error=smooth.mean_standard_error(sample, confidence=confidence),
        percentiles=quantiles.percentiles(sample, percentiles, confidence=confidence),
        central=quantiles.central_interval(sample, central, confidence=confidence),
        probability_above=None if threshold is None else probability_above(sample, threshold, confidence=confidence),
    )
