"""The inside of a worker process: it runs blocks for the process that started it, its parent.

The parent sends three kinds of message. A job names the import path and holds a pickled `Portable`: the process makes
its runner and answers None. A list of tasks is answered by their blocks (see `run_batch`). None lets the runner go.

Only what a runner is made of is imported: the sooner a process is ready, the more blocks it runs.
"""

from __future__ import annotations

import os
import pickle
import sys
from typing import TYPE_CHECKING, Any, BinaryIO

from xlmc.montecarlo.loop.scheduling.batches import run_batch

if TYPE_CHECKING:
    from xlmc.montecarlo.loop.blocks import Block, Portable, Runner, Task

__all__ = ["send", "serve"]


def send(pipe: Any, message: object) -> None:
    """Write a message into a pipe."""
    pickle.dump(message, pipe, protocol=5)
    pipe.flush()


def serve() -> None:
    """Serve requests until the parent closes the pipe."""
    requests, answers = sys.stdin.buffer, _answers()
    runner: Runner | None = None
    try:
        while True:
            message: tuple[list[str], bytes] | list[Task] | None = pickle.load(requests)
            if isinstance(message, list):
                send(answers, _blocks(runner, message))
                continue
            runner = None
            if message is not None:
                runner, failure = _runner(*message)
                send(answers, failure)
    except (EOFError, BrokenPipeError):
        return


def _runner(path: list[str], packed: bytes) -> tuple[Runner | None, Exception | None]:
    sys.path[:] = path
    try:
        portable: Portable = pickle.loads(packed)
        return portable.runner(), None
    except Exception as error:  # of any kind: it is raised in the parent
        return None, _portable(error)


def _blocks(runner: Runner | None, tasks: list[Task]) -> list[Block | Exception]:
    assert runner is not None, "tasks before a runner"
    return [_portable(each) if isinstance(each, Exception) else each for each in run_batch(runner, tasks)]


def _portable(error: Exception) -> Exception:
    """Return the error, or its words where it cannot be pickled and made again."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:  # an exception may hold anything, and its class may want any arguments
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _answers() -> BinaryIO:
    """Return the pipe for answers; what anybody prints goes to stderr instead."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return answers
