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
import multiprocessing, os, signal, sys, time
multiprocessing.set_start_method("spawn")
def refuse(*_):
    raise OSError("no fork here")
os.fork = refuse
signal.signal(signal.SIGINT, signal.default_int_handler)
import xlmc
from xlmc.run import simulate
from xlmc.run.scheduling.processes import WorkerProcess
simulate.BLOCK = 100
answered, other = WorkerProcess.answered, []
def noted(process, answer):
    found = answered(process, answer)
    if found[1]:
        other.append(simulate.BLOCK * (found[0] + len(found[1])))
    return found
WorkerProcess.answered = noted
def stop(standing):
    time.sleep(0.01)  # so that the other process is soon ready
    if other and standing.trials >= other[0]:  # a block of the other process is kept
        other[:] = [10**10]  # once
        signal.raise_signal(signal.SIGINT)
model = xlmc.load(sys.argv[1])
shared = model.simulate(10**9, jobs=2, scheduler="processes", keep_interrupted=True, progress=stop)
alone = model.simulate(shared.trials)
same = [a.tobytes() == b.tobytes() for a, b in zip(shared.forecasts.values(), alone.forecasts.values(), strict=True)]
print(*same, flush=True)
def kill(standing):
    if other:  # it is at work
        os.kill(os.getpid(), signal.SIGKILL)
other.clear()
model.simulate(10**9, jobs=2, scheduler="processes", progress=kill)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_processes_need_no_fork_and_no_guarded_main_module_and_end_with_the_program(small_book, tmp_path):
    """The processes hold the pipe of the program's errors, which is at its end when all are gone."""
    (tmp_path / "script.py").write_text(SCRIPT, encoding="utf-8")
    where = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, str(tmp_path / "script.py"), small_book]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=where, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGKILL, "True True\n", "")
