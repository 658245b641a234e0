"""What every process of a run pays before it does anything: compiling modules, and looking for garbage in them."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterator

import pytest

_NOT_KEPT = "PYTHONDONTWRITEBYTECODE"


def pytest_configure() -> None:
    """Modules are compiled once, and not by every process that a test starts."""
    os.environ.pop(_NOT_KEPT, None)
    sys.dont_write_bytecode = False


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Modules and tests stay until the end: no collection of garbage goes through them, now or later."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()
