from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys

import pytest

from xlmc.errors import SimulationError
from xlmc.run.blocks import Task
from xlmc.run.scheduling import processes, worker_pool
from xlmc.run.scheduling.batches import Answers
from xlmc.run.scheduling.processes import WorkerProcess, by_processes, idle_pool
from xlmc.run.scheduling.run_spec import RunSpec, model_runner


@pytest.fixture(autouse=True)
def none_wait():
    """Each test starts its own processes."""
    idle_pool.end()
    yield
    idle_pool.end()


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


@pytest.mark.parametrize("jobs", [1, 3])
def test_processes_change_no_bit(model, bits, children, jobs):
    run = model.simulate(950, jobs=jobs, scheduler="processes")
    assert bits(run) == bits(model.simulate(950))
    assert len(children) == jobs - 1  # this process is one of them


@pytest.mark.parametrize(("trials", "started"), [(900, 0), (1000, 1)])
def test_a_long_run_with_jobs_starts_processes(model, monkeypatch, children, trials, started):
    monkeypatch.setitem(worker_pool.ENGINES, "numpy", worker_pool.ENGINES["numpy"]._replace(process_blocks=10))
    assert model.simulate(trials).trials == trials
    assert model.simulate(trials, jobs=2).trials == trials
    assert len(children) == started


def test_an_interruption_ends_the_processes(model, children):
    def stop(standing):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        model.simulate(10**6, jobs=2, scheduler="processes", progress=stop)
    assert len(children) == 1
    assert all(one.returncode is not None for one in children)


@pytest.fixture(scope="module")
def process():
    """One for several tests, which is not among those that wait."""
    one = WorkerProcess()
    yield one
    one.end()


def answers_of(one, portable, batches):
    """What a process answers that is given these batches of tasks."""
    answers = Answers()
    one.begin(pickle.dumps(portable), answers)
    found = []
    for number in range(len(batches) + 1):
        of, answer = answers.get()
        assert of is one
        found += one.answered(answer)[1]
        if number < len(batches):
            one.ask(number, batches[number])
    return found


@pytest.mark.parametrize(("engine", "size"), [("numpy", 100), ("jit", 100), ("formulas", 10)])
def test_blocks_of_another_process_are_the_same(model, process, engine, size):
    """Whether it is sent a runner or a run spec; of a run its share is left to chance, here it runs all blocks."""
    tasks = [Task(block * size, size, block < 3, block < 6) for block in range(10)]
    runner = model_runner(model, model.program(engine), engine, 1, size)
    portable = runner if engine == "numpy" else RunSpec.of(model, engine, 1, size)
    found = answers_of(process, portable, [tasks[:3], tasks[3:4], tasks[4:]])
    assert [pickle.dumps(block) for block in found] == [pickle.dumps(runner.run(task)) for task in tasks]


def test_processes_wait_for_the_next_run(model, bits, children):
    """Another model, and other settings, get what they asked for."""
    expected = [bits(model.simulate(950, seed=seed)) for seed in (1, 2)]
    for seed in (1, 2, 1):
        run = model.simulate(950, seed=seed, jobs=2, scheduler="processes")
        assert bits(run) == expected[seed - 1]
    assert len(children) <= 3  # one that had no time to start before the run was over is ended
    assert all(one.returncode is not None for one in children[:-1])


def rested(model):
    """A process that has had part in a run."""
    idle_pool.end()
    (one,) = idle_pool.take(1)
    answers = Answers()
    one.begin(pickle.dumps(model_runner(model, model.program("numpy"), "numpy", 1, 100)), answers)
    one.answered(answers.get()[1])
    idle_pool.give_back([one])
    return one


def test_one_that_died_while_it_waited_is_not(model, children):
    one = rested(model)
    children[-1].kill()
    children[-1].wait()
    (other,) = idle_pool.take(1)
    assert other is not one
    other.end()


def test_nobody_waits_for_ever(model, monkeypatch, children):
    monkeypatch.setattr(processes, "_PATIENCE", 0.01)
    rested(model)
    assert children[-1].wait(timeout=120) is not None


class HandTimer:
    """A timer that is over when the test says so."""

    def __init__(self, seconds, do, given):
        self.do, self.given, self.waits = do, given, False

    def start(self):
        self.waits = True

    def cancel(self):
        self.waits = False

    def end(self):
        if self.waits:
            self.do(*self.given)


def test_one_that_is_not_needed_is_ended_though_others_are(model, monkeypatch, children):
    """A run with many processes is over; those that follow, every few moments, need one of them."""
    timers = []
    monkeypatch.setattr(processes, "Timer", lambda *given: timers.append(HandTimer(*given)) or timers[-1])
    started = idle_pool.take(2)
    answers = Answers()
    for one in started:
        one.begin(pickle.dumps(model_runner(model, model.program("numpy"), "numpy", 1, 100)), answers)
    for _ in started:
        one, answer = answers.get()
        one.answered(answer)
    idle_pool.give_back(started)
    after_the_first = len(timers)
    for _ in range(3):
        idle_pool.give_back(idle_pool.take(1))
    for timer in timers[:after_the_first]:
        timer.end()
    assert [one.poll() is None for one in children] == [False, True]


def test_one_that_waits_is_taken_again_and_told_of_if_it_dies_as_its_run_begins(model, children):
    one = rested(model)
    (again,) = idle_pool.take(1)
    assert again is one
    children[-1].kill()
    children[-1].wait()
    answers = Answers()
    again.begin(b"", answers)
    with pytest.raises(SimulationError, match="ended before its time"):
        again.answered(answers.get(timeout=120)[1])
    again.end()


def test_a_process_that_dies_is_told(model, children):
    runner = model_runner(model, model.program("numpy"), "numpy", 1, 100)
    tasks = (Task(start, 100, False) for start in range(0, 10**9, 100))
    blocks = by_processes(runner, runner, 1, 10**7, tasks)
    next(blocks)
    os.kill(children[0].pid, signal.SIGTERM)
    with pytest.raises(SimulationError, match="a process ended before its time"):
        for _ in blocks:
            pass
    assert all(one.returncode is not None for one in children)


def test_a_process_that_cannot_be_started_is_told(model, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/there/is/no/python")
    with pytest.raises(SimulationError, match="no process can be started: No such file") as caught:
        model.simulate(1000, jobs=2, scheduler="processes")
    assert "--scheduler threads" in caught.value.hint


def test_an_error_in_a_process_comes_after_the_blocks_before_it(model, process):
    runner = model_runner(model, model.program("numpy"), "numpy", 1, 100)
    (block, error) = answers_of(
        process, runner, [[Task(0, 100, False), Task(100, "trials", False), Task(200, 100, False)]]
    )
    assert block.trials == 100
    assert isinstance(error, TypeError)
    assert "integers" in str(error)


KILLED = """
import os, signal, sys, xlmc
def kill(standing):
    if standing.trials > 150_000:
        os.kill(os.getpid(), signal.SIGKILL)
xlmc.load(sys.argv[1]).simulate(10**9, jobs=2, scheduler="processes", progress=kill)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's")
def test_a_program_that_is_killed_leaves_no_process(case_study):
    """Its processes hold the pipe of its errors, which is at its end when all are gone."""
    where = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", KILLED, case_study]
    found = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False, env=where, timeout=120)
    assert found.returncode == -signal.SIGKILL
    assert found.stderr == ""
