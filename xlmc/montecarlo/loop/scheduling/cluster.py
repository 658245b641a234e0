"""Run blocks on a Dask cluster: an existing one, or one of this machine.

The `RunSpec` is a Dask task of its own, so Dask sends it to each worker once, and again to a worker that replaces a
lost one. A few blocks are one Dask task; where a worker dies, Dask gives its blocks to another. Only as many are
under way as keep the workers busy, and results are taken in order, so memory stays flat here and there.
"""

from __future__ import annotations

import hashlib
import logging
import signal
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from functools import lru_cache
from itertools import islice
from multiprocessing import resource_tracker
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.blocks import Block, ModelRunner, Task
from xlmc.montecarlo.loop.scheduling.run_spec import LIBRARIES, RunSpec, check_software, software, unpack

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["by_cluster"]

MOST_BLOCKS = 8
"""Blocks in one Dask task: enough that the scheduler's milliseconds do not count beside them."""

PATIENCE = 30.0
"""Seconds to wait for a scheduler, and for its first worker."""

_DEAF = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"
"""Run by each worker of a local cluster first: Ctrl-C is for this process, which then ends the workers."""

MODELS = 4
"""Models that a worker keeps: a cluster may serve several people."""


def by_cluster(
    spec: RunSpec, scheduler: str, workers: int | None, blocks: int, tasks: Iterable[Task]
) -> Iterator[Block]:
    """Yield the blocks in the order of their tasks.

    Args:
        spec: what to run.
        scheduler: `local`, or the address of a scheduler.
        workers: how many a local cluster has; by default one a processor.
        blocks: how many there will be.
        tasks: taken as they are needed.

    Raises:
        SimulationError: Dask is not installed, the cluster cannot be reached, has no workers or other software, or
            lost the same block again and again.
    """
    with _client(scheduler, workers) as client:
        _check_workers(client, scheduler)
        yield from _blocks(client, spec.pack(), blocks, iter(tasks))


@contextmanager
def _client(scheduler: str, workers: int | None) -> Iterator[Client]:
    try:
        from distributed import Client, LocalCluster
    except ImportError as error:
        hint = 'pip install "dask[distributed]>=2024.8", or leave out --scheduler'
        raise SimulationError("Dask is not installed", hint=hint) from error
    if scheduler == "local":
        silent = {"silence_logs": logging.CRITICAL}  # what matters to a run comes as an exception
        settings = {"threads_per_worker": 1, "dashboard_address": ":0", "preload": _DEAF, **silent}
        with ExitStack() as ended:
            with _interrupts_later():
                cluster = ended.enter_context(LocalCluster(n_workers=workers, **settings))
            yield ended.enter_context(Client(cluster, set_as_default=False))
        return

    class Closing(Client):  # type: ignore[misc]  # Dask tells mypy nothing of its types
        """A cluster that closes itself if it cannot start: an open one that is deleted may wait for a lock of the next
        one.
        """

        def start(self, **options: Any) -> None:
            try:
                super().start(**options)
            except BaseException:
                self.close()
                raise

    try:
        client = Closing(scheduler, timeout=PATIENCE, set_as_default=False)
    except (OSError, TimeoutError, ValueError, TypeError) as error:  # TypeError: no certificates for tls
        hint = "Start one with `dask scheduler`, and give the address it prints"
        raise SimulationError(f"no scheduler answers: {error}", where=scheduler, hint=hint) from error
    with client:
        yield client


@contextmanager
def _interrupts_later() -> Iterator[None]:
    """Start processes that Ctrl-C does not reach, for they inherit what is blocked; this process hears it afterwards.

    Windows has no such thing: there a worker that is just starting hears Ctrl-C, too.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # where it must be started first, Python would end the blocking
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _check_workers(client: Client, scheduler: str) -> None:
    """Wait for the first worker, and refuse workers with other software before anything is sent to them."""
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError as error:
        hint = f"Start some: dask worker {scheduler}"
        raise SimulationError("the scheduler has no workers", where=scheduler, hint=hint) from error
    ours = {name: software()[name] for name in ("xlmc", *LIBRARIES)}
    value = client.get_versions(packages=["xlmc", *LIBRARIES])["workers"]
    for address, of_worker in value.items():
        theirs = {name: version for name, version in of_worker["packages"].items() if version}
        check_software(ours, theirs, f"worker {address}")


def _blocks(client: Client, packed: bytes, blocks: int, tasks: Iterator[Task]) -> Iterator[Block]:
    from distributed import CancelledError, KilledWorker

    threads = sum(client.nthreads().values())
    size = max(1, min(MOST_BLOCKS, blocks // (4 * threads)))
    spec = client.submit(_spec, packed, key=f"xlmc-{hashlib.sha256(packed).hexdigest()}")
    waiting: deque[Future[list[Block]]] = deque()
    try:
        while some := list(islice(tasks, size)):
            waiting.append(client.submit(_run, spec, some, pure=False))
            if len(waiting) > 2 * threads + 2:
                yield from waiting.popleft().result()
        while waiting:
            yield from waiting.popleft().result()
    except KilledWorker as error:
        hint = "They may have run out of memory: see their logs"
        raise SimulationError("every worker that was given one of the blocks died", hint=hint) from error
    except CancelledError as error:
        raise SimulationError("the cluster was closed while it ran", hint="Run again") from error
    finally:
        client.cancel(list(waiting))


def _spec(packed: bytes) -> bytes:
    return packed


def _run(packed: bytes, tasks: list[Task]) -> list[Block]:
    """Run blocks in order, on a worker of the cluster."""
    runners = _runners(packed)
    runner = runners.take()
    try:
        return [runner.run(task) for task in tasks]
    finally:
        runners.give(runner)


class _Runners:
    """The runners of one run on a worker: as many as its threads use at once."""

    def __init__(self, packed: bytes) -> None:
        self._spec = unpack(packed)
        self._model = self._spec.model()
        self._program = self._model.program(self._spec.engine)
        self._idle: SimpleQueue[ModelRunner] = SimpleQueue()

    def take(self) -> ModelRunner:
        try:
            return self._idle.get_nowait()
        except Empty:
            return self._spec.runner_of(self._model, self._program)

    def give(self, runner: ModelRunner) -> None:
        self._idle.put(runner)


@lru_cache(MODELS)
def _runners(packed: bytes) -> _Runners:
    return _Runners(packed)
