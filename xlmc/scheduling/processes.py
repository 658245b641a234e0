"""Processes of this machine that run blocks: no lock is shared, so they scale where threads wait for each other.

This process runs blocks too, from the start; the others join it when they are ready. Each of them is a fresh
interpreter that talks through its pipes. It neither forks, which is unsafe beside threads, nor imports the caller's
main module again, so a script needs no `if __name__ == "__main__"`.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Iterable, Iterator
from threading import Event, Lock
from typing import Any, BinaryIO

from xlmc.blocks import Block, Runner, Task
from xlmc.errors import SimulationError
from xlmc.scheduling.recipe import Recipe, unpacked
from xlmc.scheduling.threads import in_order

__all__ = ["Child", "by_processes", "serve"]

_START = (
    "import pickle, sys; sys.path[:] = pickle.load(sys.stdin.buffer); "
    "from xlmc.scheduling.processes import serve; serve()"
)


def by_processes(recipe: Recipe, own: Runner, others: int, tasks: Iterable[Task]) -> Iterator[Block]:
    """The blocks in the order of their tasks.

    Args:
        recipe: of the run.
        own: what runs its blocks in this process.
        others: how many more processes.
        tasks: what to run.

    Raises:
        SimulationError: a process cannot be started, or ended before its time.
    """
    packed = recipe.packed()
    children: list[Child] = []
    try:
        children += (Child(packed) for _ in range(others))
        yield from in_order([own], tasks, children)
    finally:
        for child in children:
            child.end()


class Child:
    """A process, seen from here; a `Late` runner that several threads may ask at once."""

    at_once = 2

    def __init__(self, packed: bytes) -> None:
        self._packed = packed
        self._sending, self._answered = Lock(), Event()
        self._answered.set()
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

    def start(self) -> None:
        """Give it the recipe, and wait until it has made the model of it."""
        self._asked(sys.path, self._packed)

    def run(self, task: Task) -> Block:
        """See `Runner`."""
        return self._asked(task)  # type: ignore[no-any-return]  # a block

    def _asked(self, *messages: object) -> Any:
        """What it answers, in the order in which it was asked.

        Raises:
            SimulationError: it does not.
        """
        mine = Event()
        try:
            with self._sending:
                before, self._answered = self._answered, mine
                for message in messages:
                    _send(self._process.stdin, message)
            before.wait()
            answer = pickle.load(self._process.stdout)  # type: ignore[arg-type]  # there is a pipe
        except (EOFError, BrokenPipeError, pickle.UnpicklingError) as error:
            code = self._process.wait()
            hint = "It may have run out of memory: ask for fewer with -j"
            raise SimulationError(f"a process ended before its time (exit code {code})", hint=hint) from error
        finally:
            mine.set()
        if isinstance(answer, BaseException):
            raise answer
        return answer

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
        packed = pickle.load(source)
        worker = _worker(packed)
        _send(answers, worker if isinstance(worker, Exception) else None)
        while not isinstance(worker, Exception):
            task: Task = pickle.load(source)
            _send(answers, _answer(worker, task))
    except EOFError:
        return


def _worker(packed: bytes) -> Runner | Exception:
    try:
        recipe = unpacked(packed)
        model = recipe.model()
        return recipe.worker(model, model.program(recipe.engine, recipe.arithmetic))
    except Exception as error:
        return error


def _answer(worker: Runner, task: Task) -> Block | Exception:
    try:
        return worker.run(task)
    except Exception as error:
        return error


def _answers() -> BinaryIO:
    """The pipe for answers; whatever is printed goes to stderr."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    return answers
