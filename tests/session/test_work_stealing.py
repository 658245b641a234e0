from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from work_stealing import SHORT, in_parts


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
