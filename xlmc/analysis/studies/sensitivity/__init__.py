"""What the answers of a run depend on: influences among accepted trials, Sobol indices, tornado, spider, filter limits.

`sensitivities(simulation)` is the way in.
"""

from xlmc.analysis.studies.sensitivity.analysis import sensitivities
from xlmc.analysis.studies.sensitivity.measures import (
    PERCENTS,
    Bar,
    FilterLimit,
    ForecastSensitivity,
    Influence,
    LimitAnswer,
    LimitPoint,
    Sensitivities,
    Slope,
)

__all__ = [
    "PERCENTS",
    "Bar",
    "FilterLimit",
    "ForecastSensitivity",
    "Influence",
    "LimitAnswer",
    "LimitPoint",
    "Sensitivities",
    "Slope",
    "sensitivities",
]
