from __future__ import annotations

import math

import pytest


def _normal(cell, mean=0.0, std_dev=1.0):
    return {"cell": cell, "distribution": "Normal", "mean": mean, "std_dev": std_dev}


@pytest.fixture(scope="session")
def normal():
    """`normal("A1", 0, 1)`: an assumption."""
    return _normal


@pytest.fixture(scope="session")
def ishigami(book):
    """Ishigami & Homma's function with a = 7, b = 0.1, of three uniforms on (−π, π)."""
    ends = {"low": -math.pi, "high": math.pi}
    return book(
        {"A1": 0.5, "A2": 1.0, "A3": 0.3, "B1": "=SIN(A1)+7*SIN(A2)^2+0.1*A3^4*SIN(A1)"},
        {f"x{n}": {"cell": f"A{n}", **ends} for n in (1, 2, 3)},
        {"y": "B1"},
    )
