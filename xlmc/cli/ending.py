"""An end in order when another program asks for one: what is half done is cleared away before the process goes."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Final

__all__ = ["ending_in_order"]

_ASKING: Final = ("SIGTERM", "SIGHUP", "SIGBREAK")
_STDERR: Final = 2
_FROM_SIGNAL: Final = 128
"""Added to a signal's number, as shells do: 143 after SIGTERM, 129 after SIGHUP."""


@contextmanager
def ending_in_order() -> Iterator[None]:
    """Within this such a signal is an exit, on whose way temporary files are removed; one that is ignored stays so.

    Python hears signals in its main thread alone: elsewhere this does nothing.
    """
    ours = []
    if threading.current_thread() is threading.main_thread():
        numbers = [getattr(signal, name) for name in _ASKING if hasattr(signal, name)]
        ours = [number for number in numbers if signal.getsignal(number) is signal.SIG_DFL]
    for number in ours:
        signal.signal(number, _exit)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)


def _exit(number: int, frame: FrameType | None) -> None:
    signal.signal(number, signal.SIG_DFL)  # a second one ends it at once
    # Not by `click`: whoever was interrupted may be in the middle of printing.
    os.write(_STDERR, f"xlmc: ended by {signal.Signals(number).name}; no half file is left.\n".encode())
    raise SystemExit(_FROM_SIGNAL + number)
