"""Who runs the blocks, for what a person asks; the schedulers themselves have tests of their own."""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import pytest

from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.scheduling import cluster, worker_pool
from xlmc.montecarlo.loop.scheduling.worker_pool import WorkerPool


@pytest.fixture
def chosen(monkeypatch):
    """Run a pool without its workers: what was chosen, for how many besides this thread, and the number of blocks."""
    result = []
    runner = SimpleNamespace(borrow=lambda task, memory: ("borrowed", task, memory))

    def by_threads(runners, blocks, tasks):
        result.append(("threads", len(runners) - 1, blocks))
        return tasks

    def by_processes(_, own, others, blocks, tasks):
        result.append(("processes", others, blocks))
        return tasks

    def by_cluster(_, address, workers, blocks, tasks):
        result.append((address, workers, blocks))
        return tasks

    monkeypatch.setattr(worker_pool, "model_runner", lambda *_: runner)
    monkeypatch.setattr(worker_pool, "RunSpec", SimpleNamespace(of=lambda *_: "spec"))
    monkeypatch.setattr(worker_pool, "by_threads", by_threads)
    monkeypatch.setattr(worker_pool, "by_processes", by_processes)
    monkeypatch.setattr(cluster, "by_cluster", by_cluster)

    def run(pool, trials, engine="numpy", python=()):
        result.clear()
        model = SimpleNamespace(definitions=SimpleNamespace(python=python))
        settings, plan = SimpleNamespace(engine=engine, seed=1), SimpleNamespace(trials=trials)
        blocks = list(pool.blocks(model, None, settings, plan, 100, iter("ab"), "memory"))
        here = [("borrowed", task, "memory") for task in "ab"]
        assert blocks == (list("ab") if result else here)
        return result[0] if result else "this thread"

    return run


@pytest.mark.parametrize(
    ("pool", "trials", "engine", "expected"),
    [
        (WorkerPool(), 100_000, "numpy", "this thread"),
        (WorkerPool(1, "threads"), 100_000, "numpy", "this thread"),
        (WorkerPool(4), 100, "numpy", "this thread"),  # one block
        (WorkerPool(4), 101, "numpy", ("threads", 1, 2)),
        (WorkerPool(4), 12_700, "numpy", ("threads", 3, 127)),
        (WorkerPool(4), 12_701, "numpy", ("processes", 3, 128)),
        (WorkerPool(2), 12_701, "numpy", ("processes", 1, 128)),
        (WorkerPool(1), 12_800, "numpy", "this thread"),
        (WorkerPool(4, "threads"), 12_800, "numpy", ("threads", 3, 128)),
        (WorkerPool(4, "processes"), 200, "numpy", ("processes", 1, 2)),
        (WorkerPool(1, "processes"), 200, "numpy", ("processes", 0, 2)),
        (WorkerPool(3), 300, "formulas", ("threads", 2, 3)),
        (WorkerPool(3), 301, "formulas", ("processes", 2, 4)),
        (WorkerPool(3), 100_000_000, "jit", ("threads", 2, 1_000_000)),
        (WorkerPool(1, "local", 5), 300, "numpy", ("local", 5, 3)),
        (WorkerPool(1, "tcp://10.0.0.5:8786"), 300, "numpy", ("tcp://10.0.0.5:8786", None, 3)),
    ],
)
def test_who_runs_the_blocks(chosen, pool, trials, engine, expected):
    assert chosen(pool, trials, engine) == expected


@pytest.mark.parametrize("scheduler", [None, "threads"])
def test_a_function_of_python_is_called_in_threads_alone(chosen, scheduler):
    assert chosen(WorkerPool(4, scheduler), 100_000, python=("f",)) == ("threads", 3, 1000)


@pytest.mark.parametrize("scheduler", ["processes", "local", "tcp://10.0.0.5:8786"])
def test_a_function_of_python_is_called_in_no_other_process(chosen, scheduler):
    with pytest.raises(SimulationError, match="in this process alone"):
        chosen(WorkerPool(4, scheduler), 100_000, python=("f",))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ((0,), "0 jobs were asked for"),
        ((1, "local", 0), "0 workers were asked for"),
        ((1, None, 1), "can be set for a local cluster only"),
        ((1, "processes", 2), "can be set for a local cluster only"),
        ((1, "thread"), "There is no scheduler 'thread'"),
    ],
)
def test_contradictions_are_refused(given, message):
    with pytest.raises(SimulationError, match=message) as caught:
        WorkerPool(*given)
    assert caught.value.hint


def test_what_may_be_asked_for():
    for jobs, (scheduler, workers) in itertools.product((1, 2), ((None, None), ("local", 1), ("local", None))):
        assert WorkerPool(jobs, scheduler, workers).jobs == jobs
