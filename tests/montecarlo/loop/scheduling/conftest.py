from __future__ import annotations

from pathlib import Path

import pytest

from xlmc.montecarlo.simulation import simulate as module


@pytest.fixture
def model(book):
    """Errors, dynamic parameters, two filters."""
    cells = {"A1": 1.0, "A2": 1.0, "B1": "=SQRT(A1)", "B2": "=1/(A2-B1)+A1", "C1": "=A2<1.5"}
    given = {"a": {"cell": "A1", "low": -0.01, "high": 1}, "b": {"cell": "A2", "low": "A1", "high": 2}}
    return book(cells, given, {"x": "B2", "y": "A2"}, {"f": "C1", "g": {"cell": "B1", "above": 0.1}})


@pytest.fixture(scope="session")
def case_study():
    return Path(__file__).resolve().parents[4] / "examples" / "intersection.xlsx"


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch):
    monkeypatch.setattr(module, "BLOCK", 100)


@pytest.fixture(scope="session")
def bits():
    """All that a run found, to compare to the last bit."""

    def result(run):
        parts = (run.inputs, run.prior, run.forecasts)
        arrays = [run.trial_index.tobytes(), *(values.tobytes() for part in parts for values in part.values())]
        tally = run.tally
        counts = [tally.rejected.tolist(), tally.only.tolist(), tally.together.tolist(), tally.errors, tally.by_error]
        return arrays, counts, run.faults, run.invalid, run.error_trials, run.trials

    return result
