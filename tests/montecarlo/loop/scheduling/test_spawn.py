"""Where no process can be forked, as on Windows; what a process starts does not run the caller's main module again.

And where a program is killed, its processes end with it.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

SCRIPT = """
import multiprocessing, os, signal, time
multiprocessing.set_start_method("spawn")
def refuse(*_):
    raise OSError("no fork here")
os.fork = refuse
from itertools import count
from light_runners import Adding, NumberTask
from xlmc.montecarlo.loop.scheduling.processes import by_processes
class Own:
    def run(self, task):
        time.sleep(0.001)  # so that the other has its part
        return Adding(5).run(task)
of_others = 0
for number, (block, where) in enumerate(by_processes(Adding(5), Own(), 1, 10**9, map(NumberTask, count()))):
    assert block == number + 5
    of_others += where != os.getpid()
    if of_others == 20:  # and more are on their way
        print("killed", flush=True)
        os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_processes_need_no_fork_and_no_guarded_main_module_and_end_with_the_program(tmp_path):
    """The processes hold the pipe of the program's errors, which is at its end when all are gone."""
    (tmp_path / "script.py").write_text(SCRIPT, encoding="utf-8")
    where = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, str(tmp_path / "script.py")]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=where, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGKILL, "killed\n", "")
