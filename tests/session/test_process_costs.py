from __future__ import annotations

import pytest

TESTS = """
import gc, subprocess, sys

def test_a():
    assert gc.isenabled()
    assert gc.get_freeze_count() > 1000
    told = subprocess.run([sys.executable, "-c", "import sys; print(sys.dont_write_bytecode)"], capture_output=True)
    assert told.stdout.split() == [b"False"]
"""


@pytest.mark.parametrize("processes", [[], ["-n", "1"]])
def test_what_a_test_starts_keeps_what_it_compiled_and_garbage_is_still_collected(run_tests, processes):
    code, shown = run_tests(TESTS, *processes, plugin="process_costs", PYTHONDONTWRITEBYTECODE="1")
    assert code == 0, shown
