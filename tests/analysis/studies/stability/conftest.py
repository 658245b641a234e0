"""The case study as printed, and small books."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from xlmc.montecarlo.model.loading import load

ROOT = Path(__file__).resolve().parents[4]


@pytest.fixture(scope="module")
def few_points():
    """A quarter of the points are looked at: enough for digits that are lost in most of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("xlmc.analysis.studies.stability.extent._PRIOR", 512)
        patch.setattr("xlmc.analysis.studies.stability.extent._ACCEPTED", 256)
        yield


@pytest.fixture(scope="session")
def as_printed(tmp_path_factory):
    """`as_printed(ranges, formulas)`: the model of `examples/as_printed.py`, changed as asked."""
    spec = importlib.util.spec_from_file_location("as_printed", ROOT / "examples" / "as_printed.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)

    def make(ranges=None, formulas=None):
        path = tmp_path_factory.mktemp("books") / "as-printed.xlsx"
        script.write(path, ranges, formulas)
        return load(path)

    return make


@pytest.fixture(scope="session")
def case_study():
    return load(ROOT / "examples" / "intersection.xlsx")
