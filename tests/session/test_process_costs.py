from __future__ import annotations

import pytest

TESTS = """
import gc, subprocess, sys

def test_a():
    assert gc.isenabled()
    assert gc.get_freeze_count() > 1000
    assert gc.get_threshold()[0] > 10_000
    told = subprocess.run([sys.executable, "-c", "import sys; print(sys.dont_write_bytecode)"], capture_output=True)
    assert told.stdout.split() == [b"False"]
"""


THREADS = """
import os

def test_a():
    assert [os.environ.get(name) for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")] == ["1", "7"]
"""


@pytest.mark.parametrize(("processes", "code"), [([], 1), (["-n", "1"], 0)])
def test_processes_that_share_the_tests_have_one_thread_each_unless_told_otherwise(
    run_tests, processes, code, monkeypatch
):
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    found, shown = run_tests(THREADS, *processes, plugin="process_costs", OMP_NUM_THREADS="7")
    assert found == code, shown


@pytest.mark.parametrize("processes", [[], ["-n", "1"]])
def test_what_a_test_starts_keeps_what_it_compiled_and_garbage_is_still_collected(run_tests, processes):
    code, shown = run_tests(TESTS, *processes, plugin="process_costs", PYTHONDONTWRITEBYTECODE="1")
    assert code == 0, shown
