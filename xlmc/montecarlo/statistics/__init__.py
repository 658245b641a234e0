"""Statistics of accepted trials, each with its standard error and interval.

Pure functions of (values, weights=None, replicate=None). Errors come from independent trials, weighted trials or
independent replicates (Latin hypercube, scrambled Sobol), and are Monte Carlo error only, not reconstruction error.
"""

from xlmc.montecarlo.number_text import format_estimate
from xlmc.montecarlo.statistics.association import rank_correlation
from xlmc.montecarlo.statistics.describe import Description, describe, undescribed
from xlmc.montecarlo.statistics.estimate import Estimate, supported_digits
from xlmc.montecarlo.statistics.heavy_tails import farthest_part
from xlmc.montecarlo.statistics.mode import mode
from xlmc.montecarlo.statistics.proportions import (
    complement,
    inverse_proportion,
    probability_above,
    probability_between,
    proportion,
    replicated_proportion,
    share,
)
from xlmc.montecarlo.statistics.quantiles import (
    central_interval,
    maximum,
    median,
    minimum,
    percentile,
    percentiles,
    range_width,
)
from xlmc.montecarlo.statistics.sample import Sample
from xlmc.montecarlo.statistics.smooth import (
    coefficient_of_variation,
    errors_from_trials,
    kurtosis,
    mean,
    mean_standard_error,
    skewness,
    standard_deviation,
    too_short,
    variance,
)

__all__ = [
    "Description",
    "Estimate",
    "Sample",
    "central_interval",
    "coefficient_of_variation",
    "complement",
    "describe",
    "errors_from_trials",
    "farthest_part",
    "format_estimate",
    "inverse_proportion",
    "kurtosis",
    "maximum",
    "mean",
    "mean_standard_error",
    "median",
    "minimum",
    "mode",
    "percentile",
    "percentiles",
    "probability_above",
    "probability_between",
    "proportion",
    "range_width",
    "rank_correlation",
    "replicated_proportion",
    "share",
    "skewness",
    "standard_deviation",
    "supported_digits",
    "too_short",
    "undescribed",
    "variance",
]
