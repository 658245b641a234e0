from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT), str(ROOT / "benchmarks")]


@pytest.fixture(scope="session")
def hand_written():
    import hand_written

    return hand_written
