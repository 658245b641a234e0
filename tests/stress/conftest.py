from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT), str(ROOT / "benchmarks")]


@pytest.fixture(scope="session")
def forms_book():
    """The printed and the rewritten forms as a workbook that was written, read and compiled."""
    from stressing.workbook import forms_book

    return forms_book()


@pytest.fixture(scope="session")
def sweep(forms_book):
    """`sweep("light")`: what was measured at every third place to the worst, by numpy and jit; each is run once."""
    from stressing.rounding import measured
    from stressing.sweeps import SWEEPS
    from stressing.workbook import FORMS_ENGINES

    result = {}

    def measure(name):
        if name not in result:
            result[name] = measured(forms_book, SWEEPS[name].points()[::-3][::-1], FORMS_ENGINES)
        return result[name]

    return measure
