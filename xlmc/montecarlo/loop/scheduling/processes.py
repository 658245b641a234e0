"""Processes of this machine that run blocks: they share no lock, so they scale where threads wait for each other.

This process runs blocks too, from the start; the others join it when they are ready. After a run they wait for the
next one, which then need not start them.

A worker process is a fresh interpreter that is sent requests, and answers, through pipes. It is not forked, which is
unsafe beside threads, and it does not import the caller's main module, so a script needs no
`if __name__ == "__main__"`. Its inside is in `serving`.

Why no library does this: `python benchmarks/pools.py` runs the same blocks with loky's `get_reusable_executor` and with
`concurrent.futures.ProcessPoolExecutor` instead of `IdlePool` and `WorkerProcess` (loky 3.7.0, Python 3.11.7,
2026-11-23, two cores; benchmarks/results/pools.json). With `-j 2`, as a multiple of the speed of these modules in the
same turn, the median of the turns:

    case, engine numpy unless named                 loky   concurrent.futures
    case study, the process waits from before       1.00   0.98
    case study, the process is started in the run   0.93   0.97
    skid, which keeps every trial, waiting          0.81   0.84
    skid, started                                   0.92   0.88
    case study, engine formulas, waiting            1.04   1.01
    case study, a whole program with one run        0.86   0.92

So a process that waits is as fast where answers are small. Both lose where a program runs once, as every command does,
and where answers are large. After a SIGKILL of the program both leave their processes behind (they were still there
after 90 s); these end with it. `concurrent.futures` also needs a script to guard its main module.
"""

from __future__ import annotations

import atexit
import os
import pickle
import subprocess
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from threading import Lock, Thread, Timer
from typing import IO, TYPE_CHECKING, Any, Final

from xlmc.errors import SimulationError
from xlmc.montecarlo.loop.scheduling.batches import Answers, Sharing, Worker, discard
from xlmc.montecarlo.loop.scheduling.serving import send

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.blocks import Block, Portable, Runner, Task

__all__ = ["IdlePool", "WorkerProcess", "by_processes", "idle_pool"]

_PATIENCE: Final = 60.0
"""Seconds that a process waits for the next run."""

_START = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from xlmc.montecarlo.loop.scheduling.serving import serve
serve()
"""

_PIPE: Final = 1 << 20
"""Bytes; the most that Linux lets everybody have, unless it is set up otherwise."""


class IdlePool:
    """Processes between runs. The last used is taken first, so that those which few runs need are ended in time."""

    def __init__(self) -> None:
        self._idle: dict[WorkerProcess, Timer] = {}  # each with what will end it
        self._lock = Lock()

    def take(self, count: int) -> list[WorkerProcess]:
        """Take a number of processes: idle ones first, then new ones.

        Raises:
            SimulationError: one cannot be started.
        """
        taken: list[WorkerProcess] = []
        try:
            while len(taken) < count:
                taken.append(self._last_used() or WorkerProcess())
        except BaseException:
            self.give_back(taken)
            raise
        return taken

    def _last_used(self) -> WorkerProcess | None:
        with self._lock:
            while self._idle:
                worker, timer = self._idle.popitem()
                timer.cancel()
                if worker.alive:
                    return worker
                worker.end()
        return None

    def give_back(self, workers: Iterable[WorkerProcess]) -> None:
        """Keep the processes that are at rest, and end the others."""
        for worker in workers:
            if worker.rest():
                self._keep(worker)
            else:
                worker.end()

    def _keep(self, worker: WorkerProcess) -> None:
        timer = Timer(_PATIENCE, self._end_idle, [worker])
        timer.daemon = True
        with self._lock:
            self._idle[worker] = timer
        timer.start()

    def _end_idle(self, worker: WorkerProcess) -> None:
        """End a process, unless a run has it."""
        with self._lock:
            timer = self._idle.pop(worker, None)
        if timer is not None:
            worker.end()

    def end(self) -> None:
        """End all idle processes."""
        with self._lock:
            idle, self._idle = self._idle, {}
        for worker, timer in idle.items():
            timer.cancel()
            worker.end()

    def forget(self) -> None:
        """In a forked process: the idle ones are its parent's, and the lock may be held by a thread of the parent."""
        self._of_parent, self._idle, self._lock = self._idle, {}, Lock()


idle_pool = IdlePool()
atexit.register(idle_pool.end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=idle_pool.forget)


def by_processes(portable: Portable, own: Runner, others: int, blocks: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """Yield the blocks in the order of their tasks.

    Args:
        portable: makes the runner of each other process.
        own: runs blocks in this process.
        others: how many more processes.
        blocks: how many there will be at most.
        tasks: taken as they are needed.

    Raises:
        SimulationError: a process cannot be started, or ended before its time.
    """
    packed, answers = pickle.dumps(portable, protocol=5), Answers()
    workers = idle_pool.take(others)
    try:
        for worker in workers:
            worker.begin(packed, answers)
        yield from Sharing(own, workers, answers, blocks, tasks).in_order()
    finally:
        idle_pool.give_back(workers)
        discard(answers)


class WorkerProcess(Worker):
    """The process, for one run after another.

    Raises:
        SimulationError: it cannot be started.
    """

    def __init__(self) -> None:
        super().__init__()
        self._answers = Answers()
        # It gets a session or group of its own: Ctrl-C reaches this process alone, which then ends it.
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", _START],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=os.name == "posix",
                creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
            )
        except OSError as error:
            hint = "Ask for fewer with -j, or use --scheduler threads"
            raise SimulationError(f"no process can be started: {error.strerror or error}", hint=hint) from error
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._requests, self._replies = self._process.stdin, self._process.stdout
        _widen(self._replies)
        self._send(sys.path)
        # A daemon, for the run may be over before the process has started.
        Thread(target=self._listen, daemon=True).start()

    def begin(self, packed: bytes, answers: Answers) -> None:
        """Have it make a runner from a pickled `Portable`; its answers go to `answers` from now on."""
        self._answers, self._ready = answers, False
        if not self.alive:  # it said so to the run before
            answers.put((self, self._ended()))
        # From a thread: a process that is still starting reads no more of a long message than the pipe holds.
        Thread(target=self._send, args=((sys.path, packed),), daemon=True).start()

    @property
    def alive(self) -> bool:
        """Whether the process has not ended."""
        return self._process.poll() is None

    def rest(self) -> bool:
        """Have it let its runner go; False where it has not answered everything, or has failed."""
        rests = self._ready and not self._asked and self.alive
        if rests:
            self._send(None)
        return rests

    def _take(self, tasks: Sequence[Task]) -> None:
        self._send(tasks)

    def _send(self, message: Any) -> None:
        with suppress(OSError, ValueError):  # it has ended: `_listen` tells the run
            send(self._requests, message)

    def _listen(self) -> None:
        """Put each answer into `_answers`, the last of which is why there will be no more."""
        try:
            while True:
                answer = pickle.load(self._replies)
                self._answers.put((self, answer))
        except (EOFError, pickle.UnpicklingError):
            self._answers.put((self, self._ended()))
        except Exception as error:  # of any kind: else the run would wait for an answer for ever
            if not self._replies.closed:  # else `end` closed it, and nobody waits
                self._answers.put((self, error))

    def _ended(self) -> SimulationError:
        code = self._process.wait()
        hint = "It may have run out of memory: ask for fewer with -j"
        return SimulationError(f"a worker process ended unexpectedly (exit code {code})", hint=hint)

    def end(self) -> None:
        """Stop the process, whatever it is doing."""
        self._process.kill()
        for pipe in (self._requests, self._replies):
            with suppress(OSError):  # it had not read everything
                pipe.close()
        self._process.wait()


def _widen(pipe: IO[bytes]) -> None:
    """Let a pipe hold many blocks, as far as the system allows: a full one stops the process that writes."""
    if sys.platform == "linux":
        import fcntl

        with suppress(OSError):  # more than this system allows
            fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, _PIPE)
