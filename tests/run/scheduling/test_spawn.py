"""Where no process can be forked, as on Windows; what a process starts does not run the caller's main module again."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
SCRIPT = """
import multiprocessing, os, sys
multiprocessing.set_start_method("spawn")
def refuse(*_):
    raise OSError("no fork here")
os.fork = refuse
import xlmc
model = xlmc.load("examples/intersection.xlsx")
runs = [model.simulate(70_000, jobs=2, scheduler="processes"), model.simulate(70_000)]
print(all((first == second).all() for first, second in zip(*(run.forecasts.values() for run in runs), strict=True)))
"""


def test_processes_need_no_fork_and_no_guarded_main_module(tmp_path):
    (tmp_path / "script.py").write_text(SCRIPT, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(tmp_path / "script.py")], capture_output=True, text=True, cwd=ROOT, check=False
    )
    assert (done.stdout, done.stderr) == ("True\n", "")
