from __future__ import annotations

from pathlib import Path

import pytest
from methods_study import small_study, timed_study

from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[4]


@pytest.fixture(scope="session")
def case_study():
    return load(ROOT / "examples" / "intersection.xlsx")


@pytest.fixture(scope="session")
def small(case_study):
    return small_study(case_study)


@pytest.fixture(scope="session")
def timed(small):
    return timed_study(small)


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
