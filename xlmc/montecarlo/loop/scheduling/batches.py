"""Share the tasks of a run between this thread and workers, which are other threads or processes.

This thread hands out tasks in batches, runs blocks of its own meanwhile, and puts all blocks in order. A thread that
only waited for answers would take Python's lock, and a processor, from the workers at every block.

Threads of this process are for engines whose blocks are native code without Python's lock.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from queue import SimpleQueue
from time import perf_counter
from typing import TYPE_CHECKING, Final, Union

if TYPE_CHECKING:  # a worker process reads this module: the less it imports, the sooner it runs blocks
    from xlmc.montecarlo.loop.blocks import Block, Runner, Task
from itertools import takewhile
from threading import Thread
from typing import TYPE_CHECKING

from xlmc.errors import SimulationError

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.blocks import Block, Runner, Task

__all__ = ["Answer", "Answers", "Sharing", "Worker", "by_threads", "discard", "run_batch"]

_QUEUED: Final = 2
"""Batches that a worker is given: while it runs one, the next is at hand."""

_MOST: Final = 4
"""Blocks in a batch, so that messages are few. The first batches are smaller, so that the first blocks come soon, and
so are the last, so that nobody waits long for the end."""

_AHEAD: Final = 12
"""Blocks for each runner that may be finished or under way before their turn."""

_LONG: Final = 0.1
"""Seconds that a batch of several blocks may take: its blocks are looked at when all are done."""

Answer = Union["list[Block | Exception]", BaseException, None]
"""None: the worker is ready. A list: the blocks of a batch, the last of which is what went wrong, if something did. An
exception: why the worker answers no more."""

Answers = SimpleQueue[tuple["Worker", Answer]]


class Worker(ABC):
    """Runs batches of tasks, one after another, and puts an `Answer` to each into `Answers`."""

    def __init__(self) -> None:
        self._ready = False
        self._asked: deque[int] = deque()

    @property
    def can_take(self) -> bool:
        """Whether it may be given a batch."""
        return self._ready and len(self._asked) < _QUEUED

    def ask(self, first: int, tasks: Sequence[Task]) -> None:
        """Give it a batch of tasks, the first of which has the number `first`."""
        self._asked.append(first)
        self._take(tasks)

    def answered(self, answer: Answer) -> tuple[int, list[Block | Exception]]:
        """Note its next answer; the number of the first block, and the blocks.

        Raises:
            BaseException: the answer says why there will be no more.
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
        """Run the tasks later, after those that it was given before."""


def run_batch(runner: Runner, tasks: Iterable[Task]) -> list[Block | Exception]:
    """Run tasks in order up to the first error; their blocks, and the error last."""
    done: list[Block | Exception] = []
    try:
        done += (runner.run(task) for task in tasks)  # `map` would take a StopIteration from a block for the end
    except Exception as error:  # of any kind: it is raised when its block's turn comes
        done.append(error)
    return done


class Sharing:
    """The tasks of one run, shared out.

    Args:
        own: runs blocks in this thread.
        blocks: how many there will be at most.
        tasks: taken as they are needed.
    """

    def __init__(
        self, own: Runner, workers: Sequence[Worker], answers: Answers, blocks: int, tasks: Iterable[Task]
    ) -> None:
        self._own, self._workers, self._answers = own, workers, answers
        self._blocks, self._tasks = blocks, iter(tasks)
        self._given = self._turn = 0
        self._seconds = 0.0  # that this thread's last block took
        self._done: dict[int, Block | Exception] = {}

    def in_order(self) -> Iterator[Block]:
        """Yield the blocks in the order of their tasks; what goes wrong in one is raised in its turn.

        Raises:
            BaseException: what went wrong, or why a worker answers no more.
        """
        while True:
            while not self._answers.empty():
                self._receive()
            for worker in self._workers:
                while worker.can_take and (batch := self._next_tasks(self._batch_size)):
                    worker.ask(self._given - len(batch), batch)
            while self._turn in self._done:
                block = self._done.pop(self._turn)
                if isinstance(block, Exception):
                    raise block
                yield block
                self._turn += 1
            if tasks := self._next_tasks(1):
                start = perf_counter()
                self._done |= enumerate(run_batch(self._own, tasks), self._given - 1)
                self._seconds = perf_counter() - start
            elif self._given > self._turn:
                self._receive()
            else:
                return

    @property
    def _runners(self) -> int:
        return len(self._workers) + 1

    @property
    def _batch_size(self) -> int:
        """Blocks in the next batch."""
        begun, left = self._turn // self._runners, (self._blocks - self._given) // (4 * self._runners)
        most = _MOST if _MOST * self._seconds <= _LONG else int(_LONG / self._seconds)
        return max(1, min(most, 1 + begun, left))

    def _next_tasks(self, wanted: int) -> list[Task]:
        """Take the next tasks; none where there are no more, or where too many blocks are ahead of their turn."""
        free = _AHEAD * self._runners - (self._given - self._turn)
        tasks = list(islice(self._tasks, max(0, min(wanted, free))))
        self._given += len(tasks)
        return tasks

    def _receive(self) -> None:
        """Wait for the next answer and keep its blocks until their turn."""
        worker, answer = self._answers.get()
        first, blocks = worker.answered(answer)
        self._done |= enumerate(blocks, first)


def discard(answers: Answers) -> None:
    """Drop the answers that nobody took: they and their workers hold each other, with all their arrays."""
    while not answers.empty():
        answers.get()


def by_threads(runners: Sequence[Runner], blocks: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """Yield the blocks in the order of their tasks.

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
