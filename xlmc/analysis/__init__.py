"""Which model is enough: two books of one scene compared, and what a book could do without."""

from __future__ import annotations

from xlmc.analysis.comparison import Cause, Comparison, ForecastComparison, compare
from xlmc.analysis.differences import Acceptance, Change, Difference, difference
from xlmc.analysis.screening import Cost, Screening, screen
from xlmc.analysis.tolerances import Judgement, Verdict, judge

__all__ = [
    "Acceptance",
    "Cause",
    "Change",
    "Comparison",
    "Cost",
    "Difference",
    "ForecastComparison",
    "Judgement",
    "Screening",
    "Verdict",
    "compare",
    "difference",
    "judge",
    "screen",
]
