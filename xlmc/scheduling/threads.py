"""Runners over threads: each runs a block at a time."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from queue import SimpleQueue
from typing import Final

from xlmc.blocks import Block, Runner, Task

__all__ = ["in_order"]

_AHEAD: Final = 8
"""Blocks for each runner that may be finished before their turn: while their columns are written, nobody waits."""


def in_order(runners: Sequence[Runner], tasks: Iterable[Task]) -> Iterator[Block]:
    """The blocks in the order of their tasks, a few of which run ahead; tasks are taken as they are needed."""
    if len(runners) == 1:
        yield from map(runners[0].run, tasks)
        return
    idle: SimpleQueue[Runner] = SimpleQueue()
    for runner in runners:
        idle.put(runner)

    def run(task: Task) -> Block:
        runner = idle.get()
        try:
            return runner.run(task)
        finally:
            idle.put(runner)

    pool = ThreadPoolExecutor(len(runners))
    try:
        waiting: deque[Future[Block]] = deque()
        for task in tasks:
            waiting.append(pool.submit(run, task))
            if len(waiting) > _AHEAD * len(runners):
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)
