"""A process that runs blocks for this one, seen from here.

It is a fresh interpreter that talks through its pipes. It is neither forked, which is unsafe beside threads, nor does
it import the caller's main module again, so a script needs no `if __name__ == "__main__"`.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Sequence
from contextlib import suppress
from threading import Thread
from typing import IO, Any, Final

from xlmc.errors import SimulationError
from xlmc.run.blocks import Task
from xlmc.run.scheduling.serving import send
from xlmc.run.scheduling.sharing import Answers, Helper

__all__ = ["Child"]

_START = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from xlmc.run.scheduling.serving import serve
serve()
"""

_PIPE: Final = 1 << 20
"""Bytes; what Linux allows everybody, unless it is told otherwise."""


class Child(Helper):
    """The process, for one run after another.

    Raises:
        SimulationError: it cannot be started.
    """

    def __init__(self) -> None:
        super().__init__()
        self._answers = Answers()
        # A session of its own, where there are such: Ctrl-C is for us alone, and we end it.
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
        _widen(self._process.stdout)
        self._send(sys.path)
        # Nobody waits for this thread: the run may be over before the process has started.
        Thread(target=self._listen, daemon=True).start()

    def begin(self, packed: bytes, answers: Answers) -> None:
        """Have it make a runner.

        Args:
            packed: a `Portable`, pickled.
            answers: where its answers go from now on.
        """
        self._answers, self._ready = answers, False
        if not self.lives:  # whoever listened has told others
            answers.put((self, self._ended()))
        # It may still be starting, and read nothing of a long message until it has.
        Thread(target=self._send, args=((sys.path, packed),), daemon=True).start()

    @property
    def lives(self) -> bool:
        """Whether there is still a process."""
        return self._process.poll() is None

    def rest(self) -> bool:
        """Have it let go of its runner; False where it is not at rest, having been asked for more or having failed."""
        rests = self._ready and not self._asked and self.lives
        if rests:
            self._send(None)
        return rests

    def _take(self, tasks: Sequence[Task]) -> None:
        self._send(tasks)

    def _send(self, message: Any) -> None:
        """That it has ended is told by whoever listens."""
        try:
            send(self._process.stdin, message)
        except (OSError, ValueError):
            return

    def _listen(self) -> None:
        try:
            while True:
                answer = pickle.load(self._process.stdout)  # type: ignore[arg-type]  # there is a pipe
                self._answers.put((self, answer))
        except (EOFError, pickle.UnpicklingError):
            self._answers.put((self, self._ended()))
        except Exception as error:  # whatever it is, else the run would wait for an answer for ever
            if self._process.stdout is not None and not self._process.stdout.closed:  # else nobody waits for an answer
                self._answers.put((self, error))

    def _ended(self) -> SimulationError:
        code = self._process.wait()
        hint = "It may have run out of memory: ask for fewer with -j"
        return SimulationError(f"a process ended before its time (exit code {code})", hint=hint)

    def end(self) -> None:
        """Stop it, whatever it is doing."""
        self._process.kill()
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                try:
                    pipe.close()
                except OSError:  # what it had not read yet
                    continue
        self._process.wait()


def _widen(pipe: IO[bytes] | None) -> None:
    """To hold a lot of blocks, as far as the system lets us: else who writes them waits until they are read."""
    if pipe is None or sys.platform != "linux":
        return
    import fcntl

    with suppress(OSError):  # more than this system allows
        fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, _PIPE)
