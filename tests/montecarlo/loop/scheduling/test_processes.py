from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from threading import Event

import pytest
from light_runners import Adding
from simulated import simulated

from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.blocks import Task
from xlmc.montecarlo.loop.scheduling import processes, worker_pool
from xlmc.montecarlo.loop.scheduling.batches import Answers
from xlmc.montecarlo.loop.scheduling.processes import IdlePool, WorkerProcess, by_processes, idle_pool
from xlmc.montecarlo.loop.scheduling.run_spec import RunSpec, model_runner


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
    run = simulated(model, 950, jobs=jobs, scheduler="processes")
    assert bits(run) == bits(simulated(model, 950))
    assert len(children) == jobs - 1  # this process is one of them


@pytest.mark.parametrize(("trials", "started"), [(900, 0), (1000, 1)])
def test_a_long_run_with_jobs_starts_processes(model, monkeypatch, children, trials, started):
    monkeypatch.setitem(worker_pool.ENGINES, "numpy", worker_pool.ENGINES["numpy"]._replace(process_blocks=10))
    assert simulated(model, trials).trials == trials
    assert simulated(model, trials, jobs=2).trials == trials
    assert len(children) == started


def test_an_interruption_ends_the_processes(model, children):
    def stop(standing):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulated(model, 10**6, jobs=2, scheduler="processes", progress=stop)
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
    result = []
    for number in range(len(batches) + 1):
        of, answer = answers.get()
        assert of is one
        result += one.answered(answer)[1]
        if number < len(batches):
            one.ask(number, batches[number])
    return result


@pytest.mark.parametrize("engine", ["numpy", "jit"])
def test_blocks_of_another_process_are_the_same(model, process, engine):
    """Whether it is sent a runner or a run spec; of a run its share is left to chance, here it runs all blocks."""
    tasks = [Task(100 * block, 100, block < 3, block < 6) for block in range(10)]
    runner = model_runner(model, model.program(engine), engine, 1, 100)
    portable = runner if engine == "numpy" else RunSpec.of(model, engine, 1, 100)
    result = answers_of(process, portable, [tasks[:3], tasks[3:4], tasks[4:]])
    assert [pickle.dumps(block) for block in result] == [pickle.dumps(runner.run(task)) for task in tasks]


def test_processes_wait_for_the_next_run(model, bits, children):
    """Another model, and other settings, get what they asked for."""
    expected = [bits(simulated(model, 950, seed=seed)) for seed in (1, 2)]
    for seed in (1, 2, 1):
        run = simulated(model, 950, seed=seed, jobs=2, scheduler="processes")
        assert bits(run) == expected[seed - 1]
    assert len(children) <= 3  # one that had no time to start before the run was over is ended
    assert all(one.returncode is not None for one in children[:-1])


class Idle:
    """A process that has had part in a run, without the process."""

    def __init__(self):
        self.alive, self.ended = True, Event()

    def rest(self):
        return self.alive

    def end(self):
        self.ended.set()


def test_one_that_waits_is_taken_again_unless_it_died(monkeypatch):
    pool, one = IdlePool(), Idle()
    pool.give_back([one])
    assert pool.take(1) == [one]
    pool.give_back([one])
    one.alive = False
    monkeypatch.setattr(processes, "WorkerProcess", Idle)
    (other,) = pool.take(1)
    assert other is not one
    assert one.ended.is_set()
    assert not other.ended.is_set()


def test_nobody_waits_for_ever(monkeypatch):
    monkeypatch.setattr(processes, "_PATIENCE", 0.01)
    one = Idle()
    IdlePool().give_back([one])
    assert one.ended.wait(timeout=120)


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


def test_one_that_is_not_needed_is_ended_though_others_are(monkeypatch):
    """A run with many processes is over; those that follow, every few moments, need one of them."""
    timers, pool, both = [], IdlePool(), [Idle(), Idle()]
    monkeypatch.setattr(processes, "Timer", lambda *given: timers.append(HandTimer(*given)) or timers[-1])
    pool.give_back(both)
    after_the_first = len(timers)
    for _ in range(3):
        pool.give_back(pool.take(1))
    for timer in timers[:after_the_first]:
        timer.end()
    assert [one.ended.is_set() for one in both] == [True, False]


def test_one_that_rested_is_told_of_if_it_dies_as_its_run_begins(children):
    answers = Answers()
    for one in idle_pool.take(1):
        one.begin(pickle.dumps(Adding(0)), answers)
        one.answered(answers.get(timeout=120)[1])
        idle_pool.give_back([one])
    assert idle_pool.take(1) == [one]
    children[-1].kill()
    children[-1].wait()
    assert not one.alive
    one.begin(b"", answers)
    with pytest.raises(SimulationError, match="ended unexpectedly"):
        one.answered(answers.get(timeout=120)[1])
    one.end()


def test_a_process_that_dies_is_told(model, children):
    runner = model_runner(model, model.program("numpy"), "numpy", 1, 100)
    tasks = (Task(start, 100, False) for start in range(0, 10**9, 100))
    blocks = by_processes(runner, runner, 1, 10**7, tasks)
    next(blocks)
    os.kill(children[0].pid, signal.SIGTERM)
    with pytest.raises(SimulationError, match="A worker process ended unexpectedly"):
        for _ in blocks:
            pass
    assert all(one.returncode is not None for one in children)


def test_a_process_that_cannot_be_started_is_told(model, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/there/is/no/python")
    with pytest.raises(SimulationError, match="No process can be started: No such file") as caught:
        simulated(model, 1000, jobs=2, scheduler="processes")
    assert "--scheduler threads" in caught.value.hint


def test_an_error_in_a_process_comes_after_the_blocks_before_it(model, process):
    runner = model_runner(model, model.program("numpy"), "numpy", 1, 100)
    (block, error) = answers_of(
        process, runner, [[Task(0, 100, False), Task(100, "trials", False), Task(200, 100, False)]]
    )
    assert block.trials == 100
    assert isinstance(error, TypeError)
    assert "integers" in str(error)
