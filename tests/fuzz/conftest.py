from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT), str(ROOT / "benchmarks")]


@pytest.fixture
def small_blocks(monkeypatch):
    """As in a campaign: as many trials at once as are asked for, and not 32,768."""
    from fuzzing import BLOCK

    from xlmc.montecarlo.simulation import simulate

    monkeypatch.setattr(simulate, "BLOCK", BLOCK)
