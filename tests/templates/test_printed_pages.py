"""How many pages the reports of the largest books have."""

from __future__ import annotations

from pathlib import Path

import pytest
from simulated import simulated

from xlmc.api import Simulation
from xlmc.montecarlo.model.loading import load

pypdf = pytest.importorskip("pypdf")
pytest.importorskip("typst")

ROOT = Path(__file__).parents[2]
LARGEST = ("templates/planar-impact", "templates/crush-energy", "templates/planar-forward", "examples/crush-balance")
MOST = 10


@pytest.mark.parametrize("book", LARGEST)
def test_a_report_has_ten_pages_at_most(book, tmp_path):
    run = simulated(load(ROOT / f"{book}.xlsx"), trials=20_000)
    path = Simulation(run).save_report(tmp_path / "report.pdf")
    assert len(pypdf.PdfReader(path).pages) <= MOST
