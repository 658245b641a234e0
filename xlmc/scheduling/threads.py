"""Threads of this process that run blocks: for engines whose blocks are native code, and hold no lock of Python's."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile
from queue import SimpleQueue
from threading import Thread

from xlmc.blocks import Block, Runner, Task
from xlmc.scheduling.lots import run_lot
from xlmc.scheduling.sharing import Answers, Helper, Sharing

__all__ = ["by_threads"]


def by_threads(runners: Sequence[Runner], blocks: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """The blocks in the order of their tasks.

    Args:
        runners: one a thread; this thread is the first.
        blocks: how many there will be at most.
        tasks: taken as they are needed.
    """
    own, *others = runners
    if not others:
        yield from map(own.run, tasks)
        return
    answers = Answers()
    threads = [_Thread(runner, answers) for runner in others]
    try:
        yield from Sharing(own, threads, answers, blocks, tasks).in_order()
    finally:
        for thread in threads:
            thread.end()
        for thread in threads:
            thread.join()


class _Thread(Helper):
    """A thread, for one run."""

    def __init__(self, runner: Runner, answers: Answers) -> None:
        super().__init__()
        self._ready = True
        self._runner, self._answers = runner, answers
        self._lots: SimpleQueue[Sequence[Task] | None] = SimpleQueue()
        self._ended = False
        # A program may end without closing a run that it left half-way.
        self._thread = Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _take(self, tasks: Sequence[Task]) -> None:
        self._lots.put(tasks)

    def _serve(self) -> None:
        while (tasks := self._lots.get()) is not None:
            wanted = takewhile(lambda _: not self._ended, tasks)
            self._answers.put((self, run_lot(self._runner, wanted)))

    def end(self) -> None:
        """Have it end after the block it is at."""
        self._ended = True
        self._lots.put(None)

    def join(self) -> None:
        """Wait until it has ended."""
        self._thread.join()
