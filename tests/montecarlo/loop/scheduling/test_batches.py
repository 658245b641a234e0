from __future__ import annotations

import gc
import itertools
import pickle
import threading
import time
import weakref
from concurrent.futures import ThreadPoolExecutor

import pytest
from light_runners import Adding, FailingLate, NumberTask, TwoWordsError

from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.scheduling import batches
from xlmc.montecarlo.loop.scheduling.batches import Answers, Sharing, Worker, by_threads
from xlmc.montecarlo.loop.scheduling.processes import by_processes, idle_pool


@pytest.fixture(autouse=True)
def none_wait():
    """Processes that other tests have started are not for these."""
    idle_pool.end()
    yield
    idle_pool.end()


class Numbers:
    """Blocks as numbers, in the order that they were run in."""

    def __init__(self):
        self.run_here = []

    def runner(self):
        return Numbers()

    def run(self, task):
        self.run_here.append(task.start)
        return task.start


class Slow:
    """So that the other has its part."""

    def __init__(self, runner):
        self.runner = runner

    def run(self, task):
        time.sleep(0.002)
        return self.runner.run(task)


def with_a_process(runner, tasks):
    return by_processes(runner, Slow(runner), 1, 1000, tasks)


def with_a_thread(runner, tasks):
    return by_threads([Slow(runner), runner], 1000, tasks)


def numbered():
    return (NumberTask(start) for start in range(1000))


@pytest.mark.parametrize(
    ("shared", "failing"),
    [
        (with_a_thread, FailingLate(300, ValueError, "no such")),
        (with_a_process, FailingLate(300, TwoWordsError, "no", "such")),
    ],
)
def test_what_goes_wrong_in_a_block_is_told_in_its_turn(shared, failing):
    """Though the other has met it long before: a run that ends earlier does not meet it at all."""
    result = []
    with pytest.raises((ValueError, RuntimeError, TwoWordsError), match="no such"):
        result.extend(shared(failing, numbered()))
    assert result == list(range(300))


def test_runs_in_several_threads_at_once_get_their_own_blocks():
    """Whichever idle process each of them takes; both have started before, and so have their part."""
    started, answers = idle_pool.take(2), Answers()
    for one in started:
        one.begin(pickle.dumps(Adding(0)), answers)
    for _ in started:
        one, answer = answers.get(timeout=120)
        one.answered(answer)
    idle_pool.give_back(started)

    def run(number):
        return list(by_processes(Adding(number), Slow(Adding(number)), 1, 1000, numbered()))

    with ThreadPoolExecutor(2) as pool:
        result = list(pool.map(run, [0, 1000, 2000, 3000]))
    for turn, blocks in enumerate(result):
        assert [value for value, _ in blocks] == list(range(1000 * turn, 1000 * turn + 1000))
    assert len({where for blocks in result for _, where in blocks}) > 1


def test_a_thread_has_its_part():
    own, other = Numbers(), Numbers()
    assert list(by_threads([Slow(own), other], 1000, numbered())) == list(range(1000))
    assert sorted([*own.run_here, *other.run_here]) == list(range(1000))
    assert own.run_here
    assert len(other.run_here) > len(own.run_here)  # it is the faster one


def test_tasks_are_taken_as_they_are_needed():
    """Else a run that ends early has computed what nobody wants."""
    taken = []
    tasks = (taken.append(task.start) or task for task in numbered())
    blocks = by_threads([Numbers(), Numbers(), Numbers()], 1000, tasks)
    for turn in range(500):
        assert next(blocks) == turn
        assert len(taken) <= turn + 3 * 12 + 1
    blocks.close()


def test_the_first_block_comes_soon():
    """However slow blocks are: before it a thread has not run a whole batch of many."""
    other = Numbers()
    blocks = by_threads([Slow(Numbers()), Slow(other)], 10**6, numbered())
    next(blocks)
    assert len(other.run_here) <= 3
    blocks.close()


class Recording(Worker):
    """Answers at once, and knows how large its batches were."""

    def __init__(self, answers):
        super().__init__()
        self.answers, self.batches = answers, []
        self._ready = True

    def _take(self, tasks):
        self.batches.append(len(tasks))
        self.answers.put((self, [task.start for task in tasks]))


@pytest.mark.parametrize(("seconds", "most"), [(0.001, 4), (0.025, 4), (0.03, 3), (0.06, 1), (5.0, 1)])
def test_batches_are_small_where_blocks_are_slow(monkeypatch, seconds, most):
    """Else a time limit, and whoever looks at the progress, would wait for a whole batch of them."""
    answers, clock = Answers(), itertools.count()
    monkeypatch.setattr(batches, "perf_counter", lambda: seconds * next(clock))
    worker = Recording(answers)
    assert list(Sharing(Numbers(), [worker], answers, 1000, numbered()).in_order()) == list(range(1000))
    assert worker.batches[0] == worker.batches[-1] == 1
    assert max(worker.batches) == most


class Ends(Numbers):
    def __init__(self, error):
        super().__init__()
        self.error = error

    def run(self, task):
        raise self.error


@pytest.mark.parametrize(
    ("error", "message"), [(SystemExit(3), SystemExit), (StopIteration(), RuntimeError), (MemoryError(), MemoryError)]
)
def test_whatever_ends_a_block_ends_the_run(error, message):
    """It does not wait for ever, nor pass for the end."""
    with pytest.raises(message):
        list(by_threads([Slow(Numbers()), Ends(error)], 1000, numbered()))
    with pytest.raises(message):
        list(by_threads([Ends(error)], 1000, numbered()))


def test_a_thread_that_cannot_be_started_is_told(monkeypatch):
    """And those that were are ended."""
    before, start, started = {*threading.enumerate()}, threading.Thread.start, []

    def failing(thread):
        if started:
            raise RuntimeError("can't start new thread")
        started.append(thread)
        start(thread)

    monkeypatch.setattr(threading.Thread, "start", failing)
    with pytest.raises(SimulationError, match="No thread can be started") as caught:
        list(by_threads([Numbers() for _ in range(4)], 1000, numbered()))
    assert "-j" in caught.value.hint
    assert {*threading.enumerate()} <= before


def test_a_run_that_is_left_keeps_no_runner():
    """Its arrays are large: they do not wait for the collector of cycles."""
    gc.disable()
    try:
        other = Numbers()
        alive = weakref.ref(other)
        blocks = by_threads([Numbers(), other], 1000, numbered())
        del other
        for _ in range(100):
            next(blocks)
        blocks.close()
        assert alive() is None
    finally:
        gc.enable()


class Held(Numbers):
    """Runs its first block until it is let go."""

    def __init__(self):
        super().__init__()
        self.begun, self.go = threading.Event(), threading.Event()

    def run(self, task):
        self.begun.set()
        assert self.go.wait(120)
        return super().run(task)


def test_a_run_that_is_left_ends_its_threads(monkeypatch):
    """After the block they are at: a thread runs no more of what it was given."""
    before, other, join = {*threading.enumerate()}, Held(), batches._WorkerThread.join

    def let_go(worker):
        other.go.set()
        join(worker)

    monkeypatch.setattr(batches._WorkerThread, "join", let_go)

    def tasks():
        yield from (NumberTask(start) for start in range(10))
        assert other.begun.wait(120)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        list(by_threads([Numbers(), other], 10**6, tasks()))
    assert other.run_here == [0]
    assert {*threading.enumerate()} <= before
