from __future__ import annotations

import pytest

TESTS = """
import gc, os, subprocess, sys

def test_modules_and_garbage():
    assert gc.isenabled()
    assert gc.get_freeze_count() > 1000
    assert gc.get_threshold()[0] > 10_000
    told = subprocess.run([sys.executable, "-c", "import sys; print(sys.dont_write_bytecode)"], capture_output=True)
    assert told.stdout.split() == [b"False"]

def test_threads():
    assert [os.environ.get(name) for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS")] == ["1", "7"]
"""


@pytest.mark.parametrize(("processes", "ends"), [([], "1 failed, 1 passed"), (["-n", "1"], "2 passed")])
def test_modules_are_kept_garbage_is_collected_and_processes_that_share_the_tests_have_one_thread(
    run_tests, processes, ends, monkeypatch
):
    """One thread each, unless told otherwise, and where the tests are shared only: alone, the test of threads fails."""
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    environment = {"PYTHONDONTWRITEBYTECODE": "1", "OMP_NUM_THREADS": "7"}
    code, shown = run_tests(TESTS, *processes, plugin="process_costs", **environment)
    assert ends in shown
    assert ("FAILED test_given.py::test_threads" in shown) == (code == 1) == (not processes), shown
