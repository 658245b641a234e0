from __future__ import annotations

import sys
from pathlib import Path

import pytest
from fewer_sheets import SHORT, keep_few_trials, keep_sheets, leave_out_fits

if sys.platform == "win32":
    pytest.skip("needs fork and kill", allow_module_level=True)

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT), str(ROOT / "benchmarks")]


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """What is written does not matter here, but that it is whole."""
    with pytest.MonkeyPatch.context() as patch:
        keep_sheets(patch, *SHORT)
        keep_few_trials(patch)
        leave_out_fits(patch)
        yield


@pytest.fixture(scope="module")
def writers():
    """Two short runs of a small book."""
    from faults import Writers

    return Writers(2_000, "skid-100-ft")
