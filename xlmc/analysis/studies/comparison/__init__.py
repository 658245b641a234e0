"""Which model is enough: two books of one scene compared."""

from __future__ import annotations

from xlmc.analysis.studies.comparison.comparison import (
    Cause,
    CompareArguments,
    Comparison,
    ForecastComparison,
    compare,
)
from xlmc.analysis.studies.comparison.differences import Acceptance, Change, Difference, difference
from xlmc.analysis.studies.comparison.tolerances import Judgement, Verdict, judge

__all__ = [
    "Acceptance",
    "Cause",
    "Change",
    "CompareArguments",
    "Comparison",
    "Difference",
    "ForecastComparison",
    "Judgement",
    "Verdict",
    "compare",
    "difference",
    "judge",
]
