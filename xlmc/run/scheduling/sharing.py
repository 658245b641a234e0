"""Shares the tasks of a run between this thread and helpers, which are other threads or processes.

This thread hands out tasks, runs blocks of its own in between, and puts all in order. A thread that did nothing but
listen would take Python's lock, and a processor, from the others at every block.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from queue import SimpleQueue
from time import perf_counter
from typing import Final

from xlmc.run.blocks import Block, Runner, Task

__all__ = ["Answer", "Answers", "Helper", "Sharing", "forget"]

_LOTS: Final = 2
"""That a helper is given: while one is answered, the next is at hand."""

_MOST: Final = 4
"""Blocks in a lot: few messages. The first lots are smaller, so that the first blocks come soon, and so are the last
ones, so that nobody waits long for the end."""

_AHEAD: Final = 12
"""Blocks for each runner that may be finished or under way before their turn."""

_LONG: Final = 0.1
"""Seconds that a lot of several blocks may take: they are looked at when all are done."""

Answer = list[Block | Exception] | BaseException | None
Answers = SimpleQueue[tuple["Helper", Answer]]
"""A helper and what it said: None that its runner is made, the blocks of a lot of tasks, the last of which is what went
wrong if something did, or why it will say no more."""


class Helper(ABC):
    """Runs lots of tasks, one after another, and puts an `Answer` to each into `Answers`."""

    def __init__(self) -> None:
        self._ready = False
        self._asked: deque[int] = deque()

    @property
    def wants(self) -> bool:
        """Whether it would take a lot of tasks."""
        return self._ready and len(self._asked) < _LOTS

    def ask(self, first: int, tasks: Sequence[Task]) -> None:
        """Give it tasks, the first of which has that number."""
        self._asked.append(first)
        self._take(tasks)

    def answered(self, answer: Answer) -> tuple[int, list[Block | Exception]]:
        """The number of the first block, and the blocks, of its next answer.

        Raises:
            BaseException: it will give none.
        """
        if isinstance(answer, BaseException):
            self._ready = False
            raise answer
        if answer is None:
            self._ready = True
            return 0, []
        return self._asked.popleft(), answer

    @abstractmethod
    def _take(self, tasks: Sequence[Task]) -> None:
        """Run them some time."""


class Sharing:
    """The tasks of a run, shared out.

    Args:
        own: runs blocks in this thread.
        blocks: how many there will be at most.
        tasks: taken as they are needed.
    """

    def __init__(
        self, own: Runner, helpers: Sequence[Helper], answers: Answers, blocks: int, tasks: Iterable[Task]
    ) -> None:
        self._own, self._helpers, self._answers = own, helpers, answers
        self._blocks, self._tasks = blocks, iter(tasks)
        self._given = self._turn = 0
        self._seconds = 0.0  # that this thread's last block took
        self._done: dict[int, Block | Exception] = {}

    def in_order(self) -> Iterator[Block]:
        """The blocks in the order of their tasks; what goes wrong in one is raised in its turn.

        Raises:
            BaseException: what went wrong, or why a helper will say no more.
        """
        while True:
            while not self._answers.empty():
                self._listen()
            for helper in self._helpers:
                while helper.wants and (lot := self._some(self._lot)):
                    helper.ask(self._given - len(lot), lot)
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
        start = perf_counter()
        try:
            return self._own.run(task)
        except Exception as error:  # whatever it is, it is told in its turn
            return error
        finally:
            self._seconds = perf_counter() - start

    @property
    def _runners(self) -> int:
        return len(self._helpers) + 1

    @property
    def _lot(self) -> int:
        """Blocks in the next lot."""
        begun, left = self._turn // self._runners, (self._blocks - self._given) // (4 * self._runners)
        most = _MOST if _MOST * self._seconds <= _LONG else int(_LONG / self._seconds)
        return max(1, min(most, 1 + begun, left))

    def _some(self, wanted: int) -> list[Task]:
        """The next tasks; none where there are none, or where too many are ahead."""
        room = _AHEAD * self._runners - (self._given - self._turn)
        found = list(islice(self._tasks, max(0, min(wanted, room))))
        self._given += len(found)
        return found

    def _listen(self) -> None:
        """To the next answer."""
        helper, answer = self._answers.get()
        first, blocks = helper.answered(answer)
        self._done.update(enumerate(blocks, first))


def forget(answers: Answers) -> None:
    """What nobody has taken: a helper knows its answers, and they know it, with all that it holds."""
    while not answers.empty():
        answers.get()


def _unless_failed(block: Block | Exception) -> Block:
    """A block whose turn has come: what went wrong in a later one is not told before."""
    if isinstance(block, Exception):
        raise block
    return block
