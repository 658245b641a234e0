"""Workers take halves of the tests, and from each other at the end: what a folder's tests share is built once mostly.

The usual scheduler deals a folder's tests to all workers, and each builds the fixtures of the session for itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from xdist.remote import Producer
    from xdist.scheduler import Scheduling


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> Scheduling | None:
    """That of `--dist worksteal`, unless another than the default was asked for."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getoption("dist") == "load" else None
