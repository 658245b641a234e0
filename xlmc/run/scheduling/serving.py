"""A process that runs blocks for another, seen from inside.

It is told what makes its runner, with the path to import from: it answers None. Then it is given tasks, and answers
each lot by its blocks, the last of which is what went wrong, if something did. Told None, it lets go of the runner and
waits for the next.

It imports what the runner is made of and no more: a process that is late brings little.
"""

from __future__ import annotations

import os
import pickle
import sys
from typing import TYPE_CHECKING, Any, BinaryIO

from xlmc.run.scheduling.lots import run_lot

if TYPE_CHECKING:
    from xlmc.run.blocks import Block, Portable, Runner, Task

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
            if isinstance(message, list):
                send(answers, _blocks(runner, message))
                continue
            runner = None
            if message is not None:
                runner, failure = _runner(message)
                send(answers, failure)
    except (EOFError, BrokenPipeError):
        return


def _runner(order: Order) -> tuple[Runner | None, Exception | None]:
    sys.path[:], packed = order
    try:
        portable: Portable = pickle.loads(packed)
        return portable.runner(), None
    except Exception as error:  # whatever it is, it is told on the other side
        return None, _portable(error)


def _blocks(runner: Runner | None, tasks: list[Task]) -> list[Block | Exception]:
    assert runner is not None, "tasks before a runner"
    return [_portable(each) if isinstance(each, Exception) else each for each in run_lot(runner, tasks)]


def _portable(error: Exception) -> Exception:
    """The error, or its words where it cannot be sent."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # an exception may hold anything, and take any arguments to be made again
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _answers() -> BinaryIO:
    """The pipe for answers; whatever is printed goes to stderr."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return answers
