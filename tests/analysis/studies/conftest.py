from __future__ import annotations

import importlib.util
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


@pytest.fixture(scope="session")
def unknown_mean(tmp_path_factory):
    """The book of examples/unknown_mean.py, and the lower ends of the bands of its speed in a short run."""
    import xlmc

    spec = importlib.util.spec_from_file_location("unknown_mean", EXAMPLES / "unknown_mean.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    path = tmp_path_factory.mktemp("unknown") / "unknown-mean.xlsx"
    script.write(path)
    result = xlmc.uncertainty(xlmc.load(path), outer=40, inner=50, seed=5)
    return path, [band.low.value for band in result["Speed"].bands]
