"""A further question on a workbook, asked of xlmc's own command in a process of its own, which can be ended."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from xlmc.excel.workbook.printable import printable
from xlmc.outputs.live.protocol import Message

__all__ = ["OF_THE_FILE", "STUDIES", "StudyRun"]

STUDIES: Final = {
    "verify": (),
    "stability": (),
    "screen": (),
    "methods": ("--quick",),
    "compare": (),
}
"""Command -> what it is given beside the workbook."""

OF_THE_FILE: Final = frozenset({"verify"})
"""The studies that examine the file itself, not the state that is shown."""

_COLUMNS: Final = "108"
_STEP: Final = re.compile(r"running: ([^\x1b\r\n]+)")
_MOST: Final = 400_000
"""Characters of an answer."""

_GRACE: Final = 3.0
"""Seconds that a command has to end in order."""


class StudyRun:
    """See the module.

    Args:
        what: a key of `STUDIES`.
        books: the workbook, and another to compare it with.
        tell: takes a message whenever there is something new.
        of: the changes that it is asked with, in words.
        data: the file of the workbook with these changes; None to take the workbook's own.
    """

    def __init__(
        self,
        what: str,
        books: Sequence[Path],
        tell: Callable[[Message], None],
        of: Sequence[str] = (),
        data: bytes | None = None,
    ) -> None:
        self.what = what
        self._books, self._send, self._of, self._data = books, tell, of, data
        self._step, self._begun, self._cancelled = "", time.monotonic(), False
        self._process: asyncio.subprocess.Process | None = None
        self.last: Message = self._message("running", "")

    async def run(self) -> None:
        """Wait until the study is done, or cancelled."""
        if self._data is None:
            await self._run(self._books)
            return
        with tempfile.TemporaryDirectory(prefix="xlmc-window-") as folder:
            copy = Path(folder) / self._books[0].name
            copy.write_bytes(self._data)
            await self._run([copy, *self._books[1:]])

    async def _run(self, books: Sequence[Path]) -> None:
        command = [sys.executable, "-m", "xlmc", self.what, *map(str, books), *STUDIES[self.what]]
        given = {**os.environ, "COLUMNS": _COLUMNS, "NO_COLOR": "1", "PYTHONIOENCODING": "utf-8", "TERM": "dumb"}
        steps = _Steps(self._note_step)
        try:
            self._process = await asyncio.create_subprocess_exec(
                *command,
                stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.PIPE,
                stderr=steps.of_command,
                env=given,
            )
        finally:
            steps.begin()
        self._say("running", "")
        telling = asyncio.create_task(self._tick())
        try:
            out, _ = await self._process.communicate()
        except asyncio.CancelledError:
            await self.cancel()
            raise
        finally:
            telling.cancel()
            steps.end()
        output = out.decode("utf-8", "replace")[:_MOST] or steps.noted[-_MOST:]
        state = "cancelled" if self._cancelled else "done" if self._process.returncode in (0, 1) else "failed"
        self._say(state, "\n".join(map(printable, output.splitlines())))

    @property
    def is_running(self) -> bool:
        """Return whether it is going on."""
        return bool(self.last["state"] == "running")

    async def cancel(self) -> None:
        """End it."""
        self._cancelled = True
        if self._process is None or self._process.returncode is not None:
            return
        with contextlib.suppress(ProcessLookupError):  # it has just ended
            self._process.send_signal(signal.SIGTERM)
            try:
                await asyncio.wait_for(self._process.wait(), _GRACE)
            except TimeoutError:
                self._process.kill()

    async def _tick(self) -> None:
        while True:
            await asyncio.sleep(1.0)
            self._say("running", "")

    def _note_step(self, step: str) -> None:
        if step != self._step:
            self._step = step
            self._say("running", "")

    def _message(self, state: str, text: str) -> Message:
        seconds = time.monotonic() - self._begun
        known = {
            "what": self.what,
            "of": "; ".join(self._of),
            "state": state,
            "step": printable(self._step),
            "text": text,
        }
        return {"kind": "study", **known, "seconds": round(seconds, 1)}

    def _say(self, state: str, text: str) -> None:
        self.last = self._message(state, text)
        self._send(self.last)


class _Steps:
    """Open the command's standard error: a terminal, if the system has such, so that it tells what it is doing.

    Args:
        note: takes each step.
    """

    def __init__(self, note: Callable[[str], None]) -> None:
        self._note, self.noted = note, ""
        self._ours: int | None = None
        self.of_command: int = asyncio.subprocess.STDOUT
        if hasattr(os, "openpty"):
            self._ours, self.of_command = os.openpty()

    def begin(self) -> None:
        """Listen; the command has its end now."""
        if self._ours is not None:
            os.close(self.of_command)
            asyncio.get_running_loop().add_reader(self._ours, self._read)

    def end(self) -> None:
        """Listen no more."""
        if self._ours is not None:
            asyncio.get_running_loop().remove_reader(self._ours)
            os.close(self._ours)

    def _read(self) -> None:
        assert self._ours is not None
        try:
            text = os.read(self._ours, 1 << 16).decode("utf-8", "replace")
        except OSError:  # the command has closed its end
            asyncio.get_running_loop().remove_reader(self._ours)
            return
        self.noted += text
        for step in _STEP.findall(text):
            self._note(step.strip())
