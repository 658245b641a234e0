from __future__ import annotations

from functools import cache

import pytest
from fewer_sheets import SENSITIVITY, leave_out

from xlmc.analysis.results.saved import opening


@pytest.fixture(scope="module", autouse=True)
def _short_books():
    """The sheets on sensitivity take longest to write, and no test here looks at them."""
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, *SENSITIVITY)
        yield


@pytest.fixture
def read_once(monkeypatch):
    """Saved runs of one workbook are opened with one model: most of the time goes into reading the workbook."""
    read, build = opening.read_workbook, opening.build_model
    monkeypatch.setattr(opening, "read_workbook", lambda data, name, functions: (data, name))
    monkeypatch.setattr(opening, "build_model", cache(lambda book, path, python: build(read(*book), path)))
