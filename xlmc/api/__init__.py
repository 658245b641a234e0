"""What people use in Python: the model of a workbook, its runs, and all that can be asked of either.

What docs/python.md lists stays as it is from version to version.
"""

from __future__ import annotations

from xlmc.analysis.studies.shown import Shown
from xlmc.api.books import check, convert, replay, seek, verify
from xlmc.api.models import Model, Simulation, load, model, open_run
from xlmc.api.studies import (
    compare,
    decide,
    fit,
    methods,
    optimise,
    screen,
    sensitivities,
    stability,
    stress,
    uncertainty,
)
from xlmc.outputs.studies import StudyDocuments

__all__ = [
    "Model",
    "Simulation",
    "check",
    "compare",
    "convert",
    "decide",
    "fit",
    "load",
    "methods",
    "model",
    "open_run",
    "optimise",
    "replay",
    "screen",
    "seek",
    "sensitivities",
    "stability",
    "stress",
    "uncertainty",
    "verify",
]

Shown.documents = StudyDocuments()
