from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest
from work_stealing import SHORT, in_parts

TESTS = """
import os, pytest

@pytest.fixture(scope="session")
def shared(): return os.getpid()

@pytest.mark.parametrize("n", range(40))
def test_a(n, shared, tmp_path_factory):
    (tmp_path_factory.getbasetemp().parent / f"{n:02}-{shared}").touch()
"""


def test_each_of_two_workers_has_neighbouring_tests(run_tests, tmp_path):
    code, shown = run_tests(TESTS, "-n", "2", f"--basetemp={tmp_path / 'base'}", plugin="work_stealing")
    assert code == 0, shown
    who = [path.name.partition("-")[2] for path in sorted((tmp_path / "base").glob("??-*"))]
    assert len(who) == 40
    assert sum(a != b for a, b in pairwise(who)) <= 10


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_each_part_ends_with_short_tests_and_none_is_lost(workers, pytestconfig):
    folders = [*("cli", "live", "report", "run") * 9, *SHORT * 5]
    items = [
        SimpleNamespace(path=pytestconfig.rootpath / "tests" / folder / "test_a.py", number=number)
        for number, folder in enumerate(folders)
    ]
    found = in_parts(items, workers, pytestconfig)
    assert sorted(item.number for item in found) == list(range(len(items)))
    for worker in range(workers):
        part = found[len(items) * worker // workers : len(items) * (worker + 1) // workers]
        short = [item.path.parent.name in SHORT for item in part[1:-1]]  # a part may be a test longer than its share
        assert short == sorted(short)
        assert set(short) == {False, True}


def test_folders_of_short_tests_are_there(pytestconfig):
    assert [name for name in SHORT if not Path(pytestconfig.rootpath, "tests", name).is_dir()] == []
