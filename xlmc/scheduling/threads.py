"""Runners over threads: a thread runs a block, or waits for the process that does."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from queue import SimpleQueue
from threading import Thread
from typing import Final, NoReturn, Protocol

from xlmc.blocks import Block, Runner, Task

__all__ = ["Late", "in_order"]

_AHEAD: Final = 8
"""Blocks for each runner that may be finished before their turn: while their columns are written, nobody waits."""


class Late(Runner, Protocol):
    """A runner that takes a while to start, and then some tasks at once, so that it need not wait for the next.

    Attributes:
        at_once: so many.
    """

    at_once: int

    def start(self) -> None:
        """Returns when it can run blocks."""


def in_order(runners: Sequence[Runner], tasks: Iterable[Task], late: Sequence[Late] = ()) -> Iterator[Block]:
    """The blocks in the order of their tasks, a few of which run ahead; tasks are taken as they are needed.

    Args:
        runners: those that are ready.
        tasks: what to run.
        late: more of them, which join as soon as they have started.
    """
    count = len(runners) + sum(runner.at_once for runner in late)
    if count == 1 and runners:
        yield from map(runners[0].run, tasks)
        return
    idle: SimpleQueue[Runner] = SimpleQueue()
    for runner in runners:
        idle.put(runner)
    for starting in late:
        # Nobody waits for these threads: the run may be over before a runner has started.
        Thread(target=_start, args=(starting, idle), daemon=True).start()

    def run(task: Task) -> Block:
        runner = idle.get()
        try:
            return runner.run(task)
        finally:
            idle.put(runner)

    pool = ThreadPoolExecutor(count)
    try:
        waiting: deque[Future[Block]] = deque()
        for task in tasks:
            waiting.append(pool.submit(run, task))
            if len(waiting) > _AHEAD * count:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)


def _start(runner: Late, idle: SimpleQueue[Runner]) -> None:
    try:
        runner.start()
    except Exception as error:
        idle.put(_Failed(error))
    else:
        for _ in range(runner.at_once):
            idle.put(runner)


class _Failed:
    """In place of a runner that did not start: whoever asks it for a block is told why."""

    def __init__(self, error: Exception) -> None:
        self._error = error

    def run(self, task: Task) -> NoReturn:
        raise self._error
