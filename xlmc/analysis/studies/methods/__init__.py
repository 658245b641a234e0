"""Ways from the ranges of the assumptions to what they make of the forecasts, and what each costs and misses.

One small file a method; all follow `answer.Method`. `study` runs them on one workbook and measures their errors against
a converged reference, `recommendation` says in words which of them to use.
"""

from __future__ import annotations

from xlmc.analysis.studies.methods.answer import STATISTICS, Answer, Method, MethodResult
from xlmc.analysis.studies.methods.converged_reference import Reference
from xlmc.analysis.studies.methods.corners import Corners
from xlmc.analysis.studies.methods.curve import Curve, Rms, Runs
from xlmc.analysis.studies.methods.differential import FirstOrder, SecondOrder, WorstCase
from xlmc.analysis.studies.methods.importance_grid import ImportanceGrid
from xlmc.analysis.studies.methods.need import Need, need
from xlmc.analysis.studies.methods.optimised import Optimised
from xlmc.analysis.studies.methods.recommendation import recommendation
from xlmc.analysis.studies.methods.sampled import Sampled
from xlmc.analysis.studies.methods.study import ACCURACY, REPLICATES, Study, quick_settings, study
from xlmc.analysis.studies.methods.surrogate import Surrogate

__all__ = [
    "ACCURACY",
    "REPLICATES",
    "STATISTICS",
    "Answer",
    "Corners",
    "Curve",
    "FirstOrder",
    "ImportanceGrid",
    "Method",
    "MethodResult",
    "Need",
    "Optimised",
    "Reference",
    "Rms",
    "Runs",
    "Sampled",
    "SecondOrder",
    "Study",
    "Surrogate",
    "WorstCase",
    "need",
    "quick_settings",
    "recommendation",
    "study",
]
