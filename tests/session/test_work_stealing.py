from __future__ import annotations

from itertools import pairwise

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
