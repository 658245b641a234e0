"""Processes of this machine that run blocks: no lock is shared, so they scale where threads wait for each other.

This process runs blocks too, from the start; the others join it when they are ready.
"""

from __future__ import annotations

import pickle
from collections.abc import Iterable, Iterator

from xlmc.run.blocks import Block, Portable, Runner, Task
from xlmc.run.scheduling import standby
from xlmc.run.scheduling.sharing import Answers, Sharing, forget

__all__ = ["by_processes"]


def by_processes(portable: Portable, own: Runner, others: int, blocks: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """The blocks in the order of their tasks.

    Args:
        portable: what makes the runner of another process.
        own: what runs its blocks in this process.
        others: how many more processes.
        blocks: how many there will be at most.
        tasks: taken as they are needed.

    Raises:
        SimulationError: a process cannot be started, or ended before its time.
    """
    packed, answers = pickle.dumps(portable, protocol=5), Answers()
    children = standby.children(others)
    try:
        for child in children:
            child.begin(packed, answers)
        yield from Sharing(own, children, answers, blocks, tasks).in_order()
    finally:
        standby.give_back(children)
        forget(answers)
