"""Threads of this process that run blocks: for engines whose blocks are native code, and hold no lock of Python's."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile
from queue import SimpleQueue
from threading import Thread

from xlmc.errors import SimulationError
from xlmc.run.blocks import Block, Runner, Task
from xlmc.run.scheduling.lots import run_lot
from xlmc.run.scheduling.sharing import Answers, Helper, Sharing, forget

__all__ = ["by_threads"]


def by_threads(runners: Sequence[Runner], blocks: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """The blocks in the order of their tasks.

    Args:
        runners: one a thread; this thread is the first.
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
    threads = [_Thread(runner, answers) for runner in others]
    try:
        for thread in threads:
            thread.start()
        yield from Sharing(own, threads, answers, blocks, tasks).in_order()
    finally:
        for thread in threads:
            thread.end()
        for thread in threads:
            thread.join()
        forget(answers)


class _Thread(Helper):
    """A thread, for one run."""

    def __init__(self, runner: Runner, answers: Answers) -> None:
        super().__init__()
        self._runner, self._answers = runner, answers
        self._lots: SimpleQueue[Sequence[Task] | None] = SimpleQueue()
        self._ended = False
        # A program may end without closing a run that it left half-way.
        self._thread = Thread(target=self._serve, daemon=True)

    def start(self) -> None:
        """Have it take lots.

        Raises:
            SimulationError: the system has no thread left.
        """
        try:
            self._thread.start()
        except RuntimeError as error:
            raise SimulationError(f"no thread can be started: {error}", hint="Ask for fewer with -j") from error
        self._ready = True

    def _take(self, tasks: Sequence[Task]) -> None:
        self._lots.put(tasks)

    def _serve(self) -> None:
        try:
            while (tasks := self._lots.get()) is not None:
                wanted = takewhile(lambda _: not self._ended, tasks)
                self._answers.put((self, run_lot(self._runner, wanted)))
        except BaseException as error:  # whatever it is, else the run would wait for an answer for ever
            self._answers.put((self, error))

    def end(self) -> None:
        """Have it end after the block it is at."""
        self._ended = True
        self._lots.put(None)

    def join(self) -> None:
        """Wait until it has ended, if it was started."""
        if self._thread.is_alive():
            self._thread.join()
