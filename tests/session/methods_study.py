"""A study of methods with few and short runs, and times that do not depend on the machine."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module

import pytest

from xlmc.analysis.studies.methods import study

SECONDS = {"mc": 5e-7, "lhs": 6e-7, "sobol": 7e-7, "grid": 2e-6, "surrogate": 2e-6, "mc/jit": 1e-7, "mc/formulas": 4e-3}
"""Of a trial, by method, about as on a machine that does nothing else."""


def small_study(model):
    """Few and short runs of everything; what takes half a second is not run again to see what it costs."""
    with pytest.MonkeyPatch.context() as patch:
        module = import_module("xlmc.analysis.studies.methods.study")
        patch.setattr(module, "_PATIENCE", 0.5)
        return study(model, reference_trials=1 << 18, trials=1 << 13, replicates=2, seed=5)


def timed_study(result):
    """Return the study with the times of `SECONDS`: what to choose follows from them."""

    def clocked(curve):
        each = SECONDS[curve.method.key]
        return replace(curve, lengths=tuple(replace(runs, seconds=each * runs.budget) for runs in curve.lengths))

    return replace(result, curves=tuple(map(clocked, result.curves)), engines=tuple(map(clocked, result.engines)))
