"""Ctrl-C as a wish to end the run, rather than as an error in the middle of something."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any

__all__ = ["Interruption"]


class Interruption:
    """Notes a first Ctrl-C while there is something to keep; any other is a `KeyboardInterrupt` as ever.

    Python hears signals in its main thread alone: elsewhere, or where Ctrl-C is ignored, this does nothing.

    Args:
        wanted: whether to note anything.

    Attributes:
        asked: whether the run is to end.
        keeping: whether there is something to keep; to be set by whoever has it.
    """

    def __init__(self, *, wanted: bool) -> None:
        self._wanted = wanted
        self._before: Any = None
        self.asked = self.keeping = False

    def __enter__(self) -> Interruption:
        usual = self._wanted and threading.current_thread() is threading.main_thread()
        if usual and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            self._before = signal.signal(signal.SIGINT, self._heard)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _heard(self, number: int, frame: FrameType | None) -> None:
        if self.asked or not self.keeping:
            raise KeyboardInterrupt
        self.asked = True
