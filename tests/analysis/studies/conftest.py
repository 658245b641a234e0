from __future__ import annotations

from pathlib import Path

import pytest

from xlmc.montecarlo.model.loading import load

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


@pytest.fixture(scope="session")
def planar():
    """The paper's case study: momentum, rotation, restitution filters."""
    return load(EXAMPLES / "intersection.xlsx")


@pytest.fixture(scope="session")
def momentum():
    """The same crash without rotation."""
    return load(EXAMPLES / "intersection-momentum.xlsx")
