"""Ways from the ranges of the assumptions to what they make of the forecasts, and what each costs and misses.

One small file a method; all follow `answer.Method`. `study` runs them on one workbook and measures their errors against
a converged reference, `recommendation` says in words which of them to use.
"""

from __future__ import annotations

from xlmc.methods.answer import STATISTICS, Answer, Method, MethodResult
from xlmc.methods.corners import Corners
from xlmc.methods.curve import Curve, Rung
from xlmc.methods.first_order import FirstOrder
from xlmc.methods.importance_grid import ImportanceGrid
from xlmc.methods.need import Need, need
from xlmc.methods.optimised import Optimised
from xlmc.methods.recommendation import recommendation
from xlmc.methods.reference import Reference
from xlmc.methods.rms import Rms
from xlmc.methods.sampled import Sampled
from xlmc.methods.second_order import SecondOrder
from xlmc.methods.study import ACCURACY, REPLICATES, Study, quick_settings, study
from xlmc.methods.surrogate import Surrogate
from xlmc.methods.worst_case import WorstCase

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
    "Rung",
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
