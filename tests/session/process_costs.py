"""What tests pay for without looking at it: compiling modules, garbage, idle threads, borders, the disk."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Generator, Iterator
from functools import cached_property
from pathlib import Path

import pytest
from _pytest.doctest import DoctestModule
from openpyxl.reader.workbook import WorkbookParser
from openpyxl.worksheet.merge import MergedCellRange

_NOT_KEPT = "PYTHONDONTWRITEBYTECODE"
_BETWEEN_COLLECTIONS = 500_000
"""New objects between two collections of garbage; Python's own 700 cost a fifteenth of the suite's time."""
_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")


def pytest_configure(config: pytest.Config) -> None:
    """Modules are compiled once, and not by every process that a test starts; native code is kept for no later run.

    Where processes share the tests, each has one thread for linear algebra. With more threads than processors, those
    that wait for work keep a processor busy: `tests/studies/methods/test_bounds.py`, run twice at once on two
    processors, took 18 s of each, and takes 10 s.
    """
    if config.getoption("numprocesses", None):  # the workers start after this, with this environment
        for name in _THREADS:
            os.environ.setdefault(name, "1")
    os.environ["XLMC_KEEP_CODE"] = "0"
    os.environ.pop(_NOT_KEPT, None)
    sys.dont_write_bytecode = False


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Modules and tests stay until the end: no collection of garbage goes through them, now or later, and few begin."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(_BETWEEN_COLLECTIONS)
        gc.enable()


def pytest_sessionstart() -> None:
    """Leave out what costs time and what no test can see.

    openpyxl works out the border of a merged range, and draws it anew for each of its cells, which is more than half
    the time it takes to read a result workbook, and reads all pivot tables anew for each sheet; and the disk need not
    hold what a test has written.
    """
    MergedCellRange.format = lambda self: None
    MergedCellRange._get_borders = _find_first_cell
    WorkbookParser.pivot_caches = kept = cached_property(WorkbookParser.pivot_caches.fget)
    kept.__set_name__(WorkbookParser, "pivot_caches")
    os.fsync = lambda descriptor: None


def _find_first_cell(merged: MergedCellRange) -> None:
    merged.start_cell = merged.ws.cell(merged.min_row, merged.min_col)


@pytest.hookimpl(wrapper=True)
def pytest_collect_file(file_path: Path) -> Generator[None, list[pytest.Collector], list[pytest.Collector]]:
    """Look for examples in docstrings where there are any: to look into every module takes seconds."""
    found = yield
    if any(isinstance(each, DoctestModule) for each in found) and b">>>" not in file_path.read_bytes():
        return [each for each in found if not isinstance(each, DoctestModule)]
    return found
