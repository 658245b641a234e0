"""Workers take halves of the tests, and from each other at the end: what a folder's tests share is built once mostly.

The usual scheduler deals a folder's tests to all workers, and each builds the fixtures of the session for itself.

The tests of a worker end with many short ones, so that no worker is idle while another still has a long one to do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from xdist.remote import Producer
    from xdist.scheduler import Scheduling

SHORT = ("columns", "definitions", "distributions", "excel_answers", "formula", "functions", "sampling", "statistics")
"""Folders of tests that take some milliseconds each and share no long preparation."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> Scheduling | None:
    """That of `--dist worksteal`, unless another than the default was asked for."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log) if config.getoption("dist") == "load" else None


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """In each worker's part of the tests, put those of the folders `SHORT` at the end."""
    if (given := getattr(config, "workerinput", None)) is not None:
        items[:] = in_parts(items, given["workercount"], config)


def in_parts(items: list[pytest.Item], workers: int, config: pytest.Config) -> list[pytest.Item]:
    """The tests in as many parts of equal number as there are workers, long ones first in each."""
    folders = [config.rootpath / "tests" / name for name in SHORT]
    is_short = {path: any(path.is_relative_to(folder) for folder in folders) for path in {item.path for item in items}}
    kinds: dict[bool, list[pytest.Item]] = {False: [], True: []}
    for item in items:
        kinds[is_short[item.path]].append(item)
    found = []
    for worker in range(workers):
        for kind in kinds.values():
            found += kind[len(kind) * worker // workers : len(kind) * (worker + 1) // workers]
    return found
