"""A process that runs blocks for another, seen from inside.

It is told what makes its runner, with the path to import from: it answers None. Then it is given tasks, and answers
each lot by its blocks. What goes wrong is an answer too. Told None, it lets go of the runner and waits for the next.

It imports what the runner is made of and no more: a process that is late brings little.
"""

from __future__ import annotations

import os
import pickle
import sys
from typing import TYPE_CHECKING, Any, BinaryIO

if TYPE_CHECKING:
    from xlmc.blocks import Block, Portable, Runner, Task

__all__ = ["Order", "send", "serve"]

Order = tuple[list[str], bytes]
"""The path to import from, and a `Portable`, pickled."""


def send(pipe: Any, message: object) -> None:
    """To the other side."""
    pickle.dump(message, pipe, protocol=5)
    pipe.flush()


def serve() -> None:
    """Until nobody asks any more."""
    source, answers = sys.stdin.buffer, _answers()
    runner: Runner | None = None
    try:
        while True:
            message: Order | list[Task] | None = pickle.load(source)
            if message is None:
                runner = None
                continue
            try:
                if isinstance(message, tuple):
                    runner = None
                    runner, answer = _runner(message), None
                else:
                    answer = _blocks(runner, message)
            except Exception as error:
                send(answers, error)
            else:
                send(answers, answer)
    except EOFError:
        return


def _runner(order: Order) -> Runner:
    sys.path[:], packed = order
    portable: Portable = pickle.loads(packed)
    return portable.runner()


def _blocks(runner: Runner | None, tasks: list[Task]) -> list[Block]:
    assert runner is not None, "tasks before a runner"
    return [runner.run(task) for task in tasks]


def _answers() -> BinaryIO:
    """The pipe for answers; whatever is printed goes to stderr."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return answers
