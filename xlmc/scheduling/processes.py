"""Processes of this machine that run blocks: no lock is shared, so they scale where threads wait for each other.

Each is a fresh interpreter that talks through its pipes. It neither forks, which is unsafe beside threads, nor imports
the caller's main module again, so a script needs no `if __name__ == "__main__"`.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Iterable, Iterator
from typing import Any, BinaryIO

from xlmc.blocks import Block, Task
from xlmc.errors import SimulationError
from xlmc.scheduling.recipe import Recipe, unpacked
from xlmc.scheduling.threads import in_order

__all__ = ["by_processes", "serve"]

_START = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); "
    "from xlmc.scheduling.processes import serve; serve()"
)


def by_processes(recipe: Recipe, jobs: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """The blocks in the order of their tasks.

    Raises:
        SimulationError: a process cannot be started, or ended before its time.
    """
    packed = recipe.packed()
    children: list[_Child] = []
    try:
        children += (_Child(packed) for _ in range(jobs))
        yield from in_order(children, tasks)
    finally:
        for child in children:
            child.end()


class _Child:
    """A process, seen from here; a `Runner`."""

    def __init__(self, packed: bytes) -> None:
        self._greeting: list[object] = [sys.path, packed]
        # A session of its own, where there are such: Ctrl-C is for us alone, and we end it.
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", _START],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=os.name == "posix",
            )
        except OSError as error:
            hint = "Ask for fewer with -j, or use --scheduler threads"
            raise SimulationError(f"no process can be started: {error.strerror or error}", hint=hint) from error

    def run(self, task: Task) -> Block:
        try:
            while self._greeting:
                _send(self._process.stdin, self._greeting.pop(0))
            _send(self._process.stdin, task)
            answer = pickle.load(self._process.stdout)  # type: ignore[arg-type]  # there is a pipe
        except (EOFError, BrokenPipeError, pickle.UnpicklingError) as error:
            code = self._process.wait()
            hint = "It may have run out of memory: ask for fewer with -j"
            raise SimulationError(f"a process ended before its time (exit code {code})", hint=hint) from error
        if isinstance(answer, BaseException):
            raise answer
        return answer  # type: ignore[no-any-return]  # a block

    def end(self) -> None:
        """Stop it, whatever it is doing."""
        self._process.kill()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                try:
                    pipe.close()
                except BrokenPipeError:  # what it had not read yet
                    continue
        self._process.wait()


def _send(pipe: Any, message: object) -> None:
    pickle.dump(message, pipe, protocol=5)
    pipe.flush()


def serve() -> None:
    """The process, seen from inside: a recipe, then task after task, each answered by a block or an error."""
    source, answers = sys.stdin.buffer, _answers()
    try:
        recipe = unpacked(pickle.load(source))
        model = recipe.model()
        worker = recipe.worker(model, model.program(recipe.engine, recipe.arithmetic))
        while True:
            task: Task = pickle.load(source)
            _send(answers, _answer(worker.run, task))
    except EOFError:
        return


def _answer(run: Any, task: Task) -> Block | Exception:
    try:
        return run(task)  # type: ignore[no-any-return]
    except Exception as error:
        return error


def _answers() -> BinaryIO:
    """The pipe for answers; whatever is printed goes to stderr."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return answers
