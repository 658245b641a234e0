"""Ways from the ranges of the assumptions to what they make of the forecasts, and what each costs and misses.

One small file a method; all follow `answer.Method`. `study` runs them on one workbook and measures their errors against
a converged reference, `recommendation` says in words which of them to use.
"""

from __future__ import annotations

from xlmc.studies.methods.answer import STATISTICS, Answer, Method, MethodResult
from xlmc.studies.methods.converged_reference import Reference
from xlmc.studies.methods.corners import Corners
from xlmc.studies.methods.curve import Curve, Rms, Runs
from xlmc.studies.methods.differential import FirstOrder, SecondOrder, WorstCase
from xlmc.studies.methods.importance_grid import ImportanceGrid
from xlmc.studies.methods.need import Need, need
from xlmc.studies.methods.optimised import Optimised
from xlmc.studies.methods.recommendation import recommendation
from xlmc.studies.methods.sampled import Sampled
from xlmc.studies.methods.study import ACCURACY, REPLICATES, Study, quick_settings, study
from xlmc.studies.methods.surrogate import Surrogate

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
