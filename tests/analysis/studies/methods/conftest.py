from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest

from xlmc.analysis.studies.methods import study
from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[4]


@pytest.fixture(scope="session")
def case_study():
    return load(ROOT / "examples" / "intersection.xlsx")


@pytest.fixture(scope="session")
def small(case_study):
    """Few and short runs of everything; what takes half a second is not run again to see what it costs."""
    with pytest.MonkeyPatch.context() as patch:
        module = import_module("xlmc.analysis.studies.methods.study")
        patch.setattr(module, "_PATIENCE", 0.5)
        return study(case_study, reference_trials=1 << 18, trials=1 << 13, replicates=2, seed=5)


SECONDS = {"mc": 5e-7, "lhs": 6e-7, "sobol": 7e-7, "grid": 2e-6, "surrogate": 2e-6, "mc/jit": 1e-7, "mc/formulas": 4e-3}
"""Of a trial, by method, about as on a machine that does nothing else."""


@pytest.fixture(scope="session")
def timed(small):
    """The same with times that do not depend on the machine: what to choose follows from them."""

    def clocked(curve):
        each = SECONDS[curve.method.key]
        return replace(curve, lengths=tuple(replace(runs, seconds=each * runs.budget) for runs in curve.lengths))

    return replace(small, curves=tuple(map(clocked, small.curves)), engines=tuple(map(clocked, small.engines)))


@pytest.fixture
def sum_of_normals(book):
    """S = 1 + 2a − 3b, a and b normal with SD 1 and 0.5: mean −2, variance 4 + 2.25."""
    return book(
        {"A1": 3.0, "B1": 3.0, "C1": "=1+2*A1-3*B1"},
        {
            "a": {"cell": "A1", "distribution": "Normal", "mean": 3, "std_dev": 1},
            "b": {"cell": "B1", "distribution": "Normal", "mean": 3, "std_dev": 0.5},
        },
        {"S": "C1"},
    )


@pytest.fixture
def halved(book):
    """x uniform on 0 to 1, y = x², kept where x is above a half: of y, mean 7/12."""
    return book(
        {"A1": 0.5, "B1": "=A1^2", "C1": "=A1"},
        {"x": {"cell": "A1", "low": 0, "high": 1}},
        {"y": "B1"},
        {"upper half": {"cell": "C1", "above": 0.5}},
    )
