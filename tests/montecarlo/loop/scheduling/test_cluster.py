from __future__ import annotations

import builtins
import gc
import signal
import subprocess
import sys
import time
from threading import Timer

import pytest
from distributed import Client, LocalCluster
from psutil import STATUS_ZOMBIE, Process
from simulated import simulated

from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.scheduling import cluster as scheduling
from xlmc.montecarlo.simulation import simulate as module

# What Dask itself leaves open when it closes is not ours to warn of.
pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::DeprecationWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


def in_one_process(workers, threads=1, **more):
    return LocalCluster(n_workers=workers, threads_per_worker=threads, processes=False, dashboard_address=":0", **more)


@pytest.fixture(scope="module")
def cluster():
    """The address of a scheduler with a worker here and one in a process of its own, and that process."""
    with in_one_process(1, protocol="tcp") as result:
        command = [sys.executable, "-m", "distributed.cli.dask_worker", result.scheduler_address, "--no-nanny"]
        options = ["--nthreads", "1", "--no-dashboard"]
        with subprocess.Popen([*command, *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as other:
            try:
                with Client(result, set_as_default=False) as client:
                    client.wait_for_workers(2, timeout=120)
                yield result.scheduler_address, other
            finally:
                other.kill()


@pytest.mark.parametrize(("workers", "threads"), [(3, 1), (1, 3)])
def test_workers_change_no_bit(model, bits, workers, threads):
    with in_one_process(workers, threads) as result:
        run = simulated(model, 3050, scheduler=result.scheduler_address)
    assert bits(run) == bits(simulated(model, 3050))


def test_processes_change_no_bit(model, bits, cluster):
    seen = []
    run = simulated(model, 3050, scheduler=cluster[0], progress=seen.append)
    assert bits(run) == bits(simulated(model, 3050))
    assert [standing.trials for standing in seen] == [*range(100, 3001, 100), 3050]


def test_ctrl_c_in_a_local_cluster_keeps_what_was_accepted(model, bits, capfd):
    """A terminal tells all processes of Ctrl-C; its workers go on until this process ends them."""
    before, expected, alive = {*Process().children(recursive=True)}, [], []

    def press(standing):
        if standing.trials >= 300 and not expected:
            expected.extend({*Process().children(recursive=True)} - before)
            for worker in expected:
                worker.send_signal(signal.SIGINT)
            time.sleep(0.2)  # for one that ends
            alive.extend(worker for worker in expected if worker.is_running() and worker.status() != STATUS_ZOMBIE)
            signal.raise_signal(signal.SIGINT)

    run = simulated(model, 10**9, scheduler="local", workers=1, keep_interrupted=True, progress=press)
    assert run.stopped.by == "interruption"
    assert run.trials >= 300
    assert bits(run) == bits(simulated(model, run.trials))
    assert alive == expected != []
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="this system cannot stop a process for a while")
def test_a_slow_worker_costs_only_time(model, bits, cluster):
    """It stands still for a second with blocks of its own, which the others wait for in their order."""
    address, other = cluster
    stopped = []

    def stop(standing):
        if standing.trials > 300 and not stopped:
            other.send_signal(signal.SIGSTOP)
            stopped.append(Timer(1.0, other.send_signal, [signal.SIGCONT]))
            stopped[0].start()

    run = simulated(model, 8000, scheduler=address, progress=stop)
    stopped[0].join()
    assert other.poll() is None
    assert bits(run) == bits(simulated(model, 8000))


def test_a_worker_that_is_killed_costs_only_time(model, bits, cluster):
    address, other = cluster
    assert other.poll() is None

    def kill(standing):
        if standing.trials > 300:
            other.kill()

    run = simulated(model, 8000, scheduler=address, progress=kill)
    assert other.wait(timeout=120) != 0
    assert bits(run) == bits(simulated(model, 8000))


def test_few_tasks_are_under_way_at_once(model, monkeypatch):
    """They are taken as results come in: of an endless run only so many are ever made."""
    with in_one_process(2) as result:
        seen, made = [], []
        task = module.Task
        monkeypatch.setattr(module, "Task", lambda *given: made.append(given) or task(*given))
        simulated(model, 10_000, scheduler=result.scheduler_address, progress=lambda *_: seen.append(len(made)))
    ahead = [there - done for done, there in enumerate(seen, 1)]
    assert max(ahead) <= 8 * scheduling.MOST_BLOCKS
    assert len(made) == 100


def test_the_workbook_is_understood_once_a_worker(model, monkeypatch):
    made = []
    runners = scheduling._Runners
    monkeypatch.setattr(scheduling, "_Runners", lambda packed: made.append(packed) or runners(packed))
    scheduling._runners.cache_clear()
    with in_one_process(1) as result:
        simulated(model, 3000, seed=4, scheduler=result.scheduler_address)
        simulated(model, 2000, seed=4, scheduler=result.scheduler_address)
    assert len(made) == 1


@pytest.mark.parametrize("name", ["numpy", "xlmc"])
def test_workers_with_other_software_are_refused(model, monkeypatch, name):
    own = scheduling.software()
    monkeypatch.setattr(scheduling, "software", lambda: own | {name: "0.0.1"})
    with in_one_process(1) as result, pytest.raises(SimulationError, match=f"worker .*{name} is .* and 0.0.1 here"):
        simulated(model, 1000, scheduler=result.scheduler_address)


def test_a_worker_that_joins_later_is_asked_too(model, monkeypatch):
    """What it is sent says what it was packed with."""
    monkeypatch.setattr(scheduling, "_check_workers", lambda *_: None)
    packed = scheduling.RunSpec.pack
    own = scheduling.software()
    with monkeypatch.context() as patch:
        patch.setattr("xlmc.montecarlo.loop.scheduling.run_spec.software", lambda: own | {"numpy": "0.0.1"})
        other = packed(scheduling.RunSpec.of(model, "numpy", 999, 100))
    monkeypatch.setattr(scheduling.RunSpec, "pack", lambda _: other)
    with in_one_process(1) as result, pytest.raises(SimulationError, match=r"numpy is .* there and 0\.0\.1 here"):
        simulated(model, 1000, scheduler=result.scheduler_address)


def test_no_scheduler(model, monkeypatch):
    monkeypatch.setattr(scheduling, "PATIENCE", 0.05)
    for scheme in ("tcp", "tls", "http"):
        with pytest.raises(SimulationError, match=rf"{scheme}://127\.0\.0\.1:9: No scheduler answers") as caught:
            simulated(model, 1000, scheduler=f"{scheme}://127.0.0.1:9")
        assert "dask scheduler" in caught.value.hint
    clients = [thing for thing in gc.get_objects() if type(thing).__name__ == "Closing"]
    assert all(client.status in ("closed", "newly-created") for client in clients)


def test_no_workers(model, monkeypatch):
    monkeypatch.setattr(scheduling, "PATIENCE", 0.1)
    with in_one_process(0) as result, pytest.raises(SimulationError, match="The scheduler has no workers") as caught:
        simulated(model, 1000, scheduler=result.scheduler_address)
    assert f"dask worker {result.scheduler_address}" in caught.value.hint


def test_without_dask(model, monkeypatch):
    real = builtins.__import__

    def without(name, *rest):
        if name == "distributed":
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(SimulationError, match="Dask is not installed") as caught:
        simulated(model, 1000, scheduler="local", workers=1)
    assert 'pip install "dask[distributed]' in caught.value.hint


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="Windows blocks no signals")
def test_ctrl_c_while_workers_start_reaches_this_process_alone_and_later():
    asked = [sys.executable, "-SEc", "import signal; print(signal.SIGINT in signal.pthread_sigmask(0, ()))"]
    message = []

    def start():
        with scheduling._interrupts_later():
            signal.raise_signal(signal.SIGINT)
            message.append(subprocess.run(asked, capture_output=True, text=True, check=True).stdout)

    with pytest.raises(KeyboardInterrupt):
        start()
    assert message == ["True\n"]
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())
