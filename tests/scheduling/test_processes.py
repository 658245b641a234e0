from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys

import pytest

from xlmc.blocks import Task
from xlmc.errors import SimulationError
from xlmc.scheduling import crew, processes
from xlmc.scheduling.processes import by_processes
from xlmc.scheduling.recipe import Recipe
from xlmc.scheduling.threads import in_order


@pytest.fixture
def children(monkeypatch):
    """Every process that is started."""
    started = []
    popen = subprocess.Popen

    def start(*arguments, **named):
        started.append(popen(*arguments, **named))
        return started[-1]

    monkeypatch.setattr(processes.subprocess, "Popen", start)
    return started


@pytest.mark.parametrize("jobs", [1, 2, 3])
def test_processes_change_no_bit(model, bits, children, jobs):
    run = model.simulate(950, jobs=jobs, scheduler="processes")
    assert bits(run) == bits(model.simulate(950))
    assert len(children) == jobs - 1  # this process is one of them
    assert all(child.returncode is not None for child in children)


@pytest.mark.parametrize(("trials", "started"), [(900, 0), (1000, 1)])
def test_a_long_run_with_jobs_starts_processes(model, monkeypatch, children, trials, started):
    monkeypatch.setattr(crew, "PROCESS_BLOCKS", {"numpy": 10})
    assert model.simulate(trials).trials == trials
    assert model.simulate(trials, jobs=2).trials == trials
    assert len(children) == started


def test_an_interruption_ends_the_processes(model, children):
    def stop(standing):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        model.simulate(10**6, jobs=2, scheduler="processes", progress=stop)
    assert len(children) == 1
    assert all(child.returncode is not None for child in children)


@pytest.mark.parametrize("count", [1, 2])
def test_blocks_of_other_processes_are_the_same(model, count):
    """Here no block is run in this process, as some are where processes are slow to start."""
    recipe = Recipe.of(model, "numpy", 1, 100)
    tasks = [Task(start, 100, start < 300, start < 600) for start in range(0, 1000, 100)]
    worker = recipe.worker(model, model.program("numpy"))
    others = [processes.Child(recipe.packed()) for _ in range(count)]
    for block, task in zip(in_order([], tasks, others), tasks, strict=True):
        assert pickle.dumps(block) == pickle.dumps(worker.run(task))
    for child in others:
        child.end()


def test_a_process_that_dies_is_told(model, children):
    recipe = Recipe.of(model, "numpy", 1, 100)
    worker = recipe.worker(model, model.program("numpy"))
    tasks = (Task(start, 100, False) for start in range(0, 10**9, 100))
    blocks = by_processes(recipe, worker, 1, tasks)
    next(blocks)
    os.kill(children[0].pid, signal.SIGTERM)
    with pytest.raises(SimulationError, match="a process ended before its time"):
        for _ in blocks:
            pass
    assert all(child.returncode is not None for child in children)


def test_a_process_that_cannot_be_started_is_told(model, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/there/is/no/python")
    with pytest.raises(SimulationError, match="no process can be started: No such file") as caught:
        model.simulate(1000, jobs=2, scheduler="processes")
    assert "--scheduler threads" in caught.value.hint


def test_an_error_in_a_process_is_raised_here(model):
    child = processes.Child(Recipe.of(model, "numpy", 1, 100).packed())
    with pytest.raises(TypeError, match="interpreted as an integer"):
        list(in_order([], [Task(0, "trials", False)], [child]))
    child.end()


def test_a_script_needs_no_guard(tmp_path, case_study):
    """What a process starts does not run the caller's main module again."""
    script = tmp_path / "script.py"
    script.write_text(
        "import xlmc\n"
        f"run = xlmc.load({str(case_study)!r}).simulate(70_000, jobs=2, scheduler='processes')\n"
        "print('once', run.accepted)\n"
    )
    where = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    found = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True, env=where)
    assert found.stdout.startswith("once ")
    assert found.stdout.count("once") == 1
    assert found.stderr == ""
