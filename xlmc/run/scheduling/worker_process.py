"""A worker process, seen from the process that started it.

It is a fresh interpreter that is sent requests, and answers, through pipes. It is not forked, which is unsafe beside
threads, and it does not import the caller's main module, so a script needs no `if __name__ == "__main__"`.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from threading import Thread
from typing import IO, TYPE_CHECKING, Any, Final

from xlmc.errors import SimulationError
from xlmc.run.scheduling.batches import Answers, Worker
from xlmc.run.scheduling.serving import send

if TYPE_CHECKING:
    from xlmc.run.blocks import Task

__all__ = ["WorkerProcess"]

_START = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from xlmc.run.scheduling.serving import serve
serve()
"""

_PIPE: Final = 1 << 20
"""Bytes; the most that Linux lets everybody have, unless it is set up otherwise."""


class WorkerProcess(Worker):
    """The process, for one run after another.

    Raises:
        SimulationError: it cannot be started.
    """

    def __init__(self) -> None:
        super().__init__()
        self._answers = Answers()
        # It gets a session or group of its own: Ctrl-C reaches this process alone, which then ends it.
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", _START],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=os.name == "posix",
                creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
            )
        except OSError as error:
            hint = "Ask for fewer with -j, or use --scheduler threads"
            raise SimulationError(f"no process can be started: {error.strerror or error}", hint=hint) from error
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._requests, self._replies = self._process.stdin, self._process.stdout
        _widen(self._replies)
        self._send(sys.path)
        # A daemon, for the run may be over before the process has started.
        Thread(target=self._listen, daemon=True).start()

    def begin(self, packed: bytes, answers: Answers) -> None:
        """Have it make a runner from a pickled `Portable`; its answers go to `answers` from now on."""
        self._answers, self._ready = answers, False
        if not self.alive:  # it said so to the run before
            answers.put((self, self._ended()))
        # From a thread: a process that is still starting reads no more of a long message than the pipe holds.
        Thread(target=self._send, args=((sys.path, packed),), daemon=True).start()

    @property
    def alive(self) -> bool:
        """Whether the process has not ended."""
        return self._process.poll() is None

    def rest(self) -> bool:
        """Have it let its runner go; False where it has not answered everything, or has failed."""
        rests = self._ready and not self._asked and self.alive
        if rests:
            self._send(None)
        return rests

    def _take(self, tasks: Sequence[Task]) -> None:
        self._send(tasks)

    def _send(self, message: Any) -> None:
        with suppress(OSError, ValueError):  # it has ended: `_listen` tells the run
            send(self._requests, message)

    def _listen(self) -> None:
        """Put each answer into `_answers`, the last of which is why there will be no more."""
        try:
            while True:
                answer = pickle.load(self._replies)
                self._answers.put((self, answer))
        except (EOFError, pickle.UnpicklingError):
            self._answers.put((self, self._ended()))
        except Exception as error:  # of any kind: else the run would wait for an answer for ever
            if not self._replies.closed:  # else `end` closed it, and nobody waits
                self._answers.put((self, error))

    def _ended(self) -> SimulationError:
        code = self._process.wait()
        hint = "It may have run out of memory: ask for fewer with -j"
        return SimulationError(f"a process ended before its time (exit code {code})", hint=hint)

    def end(self) -> None:
        """Stop the process, whatever it is doing."""
        self._process.kill()
        for pipe in (self._requests, self._replies):
            with suppress(OSError):  # it had not read everything
                pipe.close()
        self._process.wait()


def _widen(pipe: IO[bytes]) -> None:
    """Let a pipe hold many blocks, as far as the system allows: a full one stops the process that writes."""
    if sys.platform == "linux":
        import fcntl

        with suppress(OSError):  # more than this system allows
            fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, _PIPE)
