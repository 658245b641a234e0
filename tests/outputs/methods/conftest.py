from __future__ import annotations

import committed_books
import pytest
from methods_study import small_study, timed_study

from xlmc.montecarlo.model.loading import load


@pytest.fixture(scope="session")
def small():
    return small_study(load(committed_books.ROOT / "examples" / "intersection.xlsx"))


@pytest.fixture(scope="session")
def timed(small):
    return timed_study(small)


@pytest.fixture
def sum_of_normals(model_of):
    """S = 1 + 2a − 3b, a and b normal with SD 1 and 0.5: mean −2, variance 4 + 2.25."""
    return model_of(
        {"A1": 3.0, "B1": 3.0, "C1": "=1+2*A1-3*B1"},
        {
            "a": {"cell": "A1", "distribution": "Normal", "mean": 3, "std_dev": 1},
            "b": {"cell": "B1", "distribution": "Normal", "mean": 3, "std_dev": 0.5},
        },
        {"S": "C1"},
    )
