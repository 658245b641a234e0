from __future__ import annotations

import sys
from pathlib import Path

import pytest

if sys.platform == "win32":
    pytest.skip("needs fork and kill", allow_module_level=True)

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT), str(ROOT / "benchmarks")]


@pytest.fixture(scope="session")
def writers():
    """Two short runs of the case study."""
    from faults import Writers

    return Writers(2_000)
