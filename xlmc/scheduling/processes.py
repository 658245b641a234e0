"""Processes of this machine that run blocks: no lock is shared, so they scale where threads wait for each other.

This process runs blocks too, from the start; the others join it when they are ready. One thread here hands out tasks,
runs blocks of its own in between, and puts all in order: more threads would wait for each other at every call.
"""

from __future__ import annotations

import pickle
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Final

from xlmc.blocks import Block, Portable, Runner, Task
from xlmc.scheduling import standby
from xlmc.scheduling.child import Answers, Child

__all__ = ["by_processes"]

_MOST: Final = 4
"""Blocks in a lot: few messages, and at the end nobody waits long for the last one."""

_AHEAD: Final = 12
"""Blocks for each process that may be finished or under way before their turn."""


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
        yield from _Shared(own, children, answers, blocks, iter(tasks)).in_order()
    finally:
        standby.give_back(children)


class _Shared:
    """The tasks of a run, shared out."""

    def __init__(
        self, own: Runner, children: list[Child], answers: Answers, blocks: int, tasks: Iterator[Task]
    ) -> None:
        self._own, self._children, self._answers = own, children, answers
        self._blocks, self._tasks = blocks, tasks
        self._given = self._turn = 0
        self._done: dict[int, Block | Exception] = {}

    def in_order(self) -> Iterator[Block]:
        """Run them."""
        while True:
            while not self._answers.empty():
                self._listen()
            for child in self._children:
                while child.wants and (lot := self._some((self._blocks - self._given) // (4 * self._runners))):
                    child.ask(self._given - len(lot), lot)
            while self._turn in self._done:
                yield _unless_failed(self._done.pop(self._turn))
                self._turn += 1
            if lot := self._some(1):
                self._done[self._given - 1] = self._run(lot[0])
            elif self._given > self._turn:
                self._listen()
            else:
                return

    def _run(self, task: Task) -> Block | Exception:
        try:
            return self._own.run(task)
        except Exception as error:  # whatever it is, it is told in its turn
            return error

    @property
    def _runners(self) -> int:
        return len(self._children) + 1

    def _some(self, wanted: int) -> list[Task]:
        """The next tasks; none where there are none, or where too many are ahead."""
        room = _AHEAD * self._runners - (self._given - self._turn)
        found = list(islice(self._tasks, max(0, min(max(1, wanted), _MOST, room))))
        self._given += len(found)
        return found

    def _listen(self) -> None:
        """To the next answer."""
        child, answer = self._answers.get()
        first, blocks = child.answered(answer)
        self._done.update(enumerate(blocks, first))


def _unless_failed(block: Block | Exception) -> Block:
    """A block whose turn has come: what went wrong in a later one is not told before."""
    if isinstance(block, Exception):
        raise block
    return block
