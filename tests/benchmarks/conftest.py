from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT))


@pytest.fixture(scope="session")
def hand_written():
    spec = importlib.util.spec_from_file_location("hand_written", ROOT / "benchmarks/hand_written.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
