"""Threads of this process that run blocks: for engines whose blocks are native code without Python's lock."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile
from queue import SimpleQueue
from threading import Thread
from typing import TYPE_CHECKING

from xlmc.errors import SimulationError
from xlmc.run.scheduling.batches import Answers, Sharing, Worker, discard, run_batch

if TYPE_CHECKING:
    from xlmc.run.blocks import Block, Runner, Task

__all__ = ["by_threads"]


def by_threads(runners: Sequence[Runner], blocks: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """The blocks in the order of their tasks.

    Args:
        runners: one for each thread; the first is for this thread.
        blocks: how many there will be at most.
        tasks: taken as they are needed.

    Raises:
        SimulationError: a thread cannot be started.
    """
    own, *others = runners
    if not others:
        for task in tasks:
            yield own.run(task)
        return
    answers = Answers()
    workers = [_WorkerThread(runner, answers) for runner in others]
    try:
        for worker in workers:
            worker.start()
        yield from Sharing(own, workers, answers, blocks, tasks).in_order()
    finally:
        for worker in workers:
            worker.stop()
        for worker in workers:
            worker.join()
        discard(answers)


class _WorkerThread(Worker):
    """A thread, for one run."""

    def __init__(self, runner: Runner, answers: Answers) -> None:
        super().__init__()
        self._runner, self._answers = runner, answers
        self._batches: SimpleQueue[Sequence[Task] | None] = SimpleQueue()
        self._stopped = False
        # A daemon: a program may end without closing a run that it left half-way.
        self._thread = Thread(target=self._serve, daemon=True)

    def start(self) -> None:
        """Start the thread.

        Raises:
            SimulationError: the system has no thread left.
        """
        try:
            self._thread.start()
        except RuntimeError as error:
            raise SimulationError(f"no thread can be started: {error}", hint="Ask for fewer with -j") from error
        self._ready = True

    def _take(self, tasks: Sequence[Task]) -> None:
        self._batches.put(tasks)

    def _serve(self) -> None:
        try:
            while (tasks := self._batches.get()) is not None:
                wanted = takewhile(lambda _: not self._stopped, tasks)
                self._answers.put((self, run_batch(self._runner, wanted)))
        except BaseException as error:  # of any kind: else the run would wait for an answer for ever
            self._answers.put((self, error))

    def stop(self) -> None:
        """Have the thread end after the block that it is running."""
        self._stopped = True
        self._batches.put(None)

    def join(self) -> None:
        """Wait until the thread has ended, if it was started."""
        if self._thread.is_alive():
            self._thread.join()
