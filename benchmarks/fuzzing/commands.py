"""The command line on hostile input, in this process: its exit codes, its messages and what it prints."""

from __future__ import annotations

import io
import re
import sys
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final
from unittest.mock import patch

from fuzzing.inputs import Disagreement, Reached

__all__ = ["commanded"]

_CODES: Final = (0, 1, 2)
_RESULTS: Final = "out-of-command.xlsx"


def commanded(book: Path, steps: tuple[str, ...]) -> Reached:
    """Give a book to `xlmc check` where that is a step, and to `xlmc simulate -n 100` where that is one.

    Raises:
        Disagreement: an exit code that is not documented, no message with code 2, or characters that steer a terminal.
    """
    code = 0
    if "check" in steps:
        code = _run("check", str(book))
    if "simulate" in steps:
        (book.parent / _RESULTS).unlink(missing_ok=True)
        code = max(code, _run("simulate", str(book), "-n", "100", "-o", str(book.parent / _RESULTS)))
    return Reached.REFUSED if code == 2 else Reached.RAN


def _run(*arguments: str) -> int:
    from xlmc.cli import main

    with _captured(arguments) as (out, err):
        try:
            main()
            code: object = 0
        except SystemExit as ended:
            code = ended.code or 0
        printed, message = (_text(stream) for stream in (out, err))
    if code not in _CODES:
        raise Disagreement(f"xlmc {arguments[0]}, exit code: {code!r}")
    if code == 2 and not any(re.match(r"(xlmc|problem): \S", line) for line in message.splitlines()):
        raise Disagreement(f"xlmc {arguments[0]}, no message: {message[:300]!r}")
    if "Traceback (most" in message:
        raise Disagreement(f"xlmc {arguments[0]}, a traceback: {message[:300]!r}")
    for text in (printed, message):
        steering = next((one for one in text if one not in "\n" and unicodedata.category(one) in ("Cc", "Cs")), None)
        if steering is not None:
            at = text.index(steering)
            raise Disagreement(f"xlmc {arguments[0]}, a control character: {text[max(0, at - 60) : at + 20]!r}")
    return int(str(code))


@contextmanager
def _captured(arguments: tuple[str, ...]) -> Iterator[tuple[io.TextIOWrapper, io.TextIOWrapper]]:
    """Standard output and error as files in UTF-8, and the arguments as typed."""
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", newline="\n") for _ in range(2))
    typed = ["xlmc", *arguments]
    with patch.object(sys, "stdout", out), patch.object(sys, "stderr", err), patch.object(sys, "argv", typed):
        yield out, err


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    return stream.buffer.getvalue().decode()  # type: ignore[attr-defined,no-any-return]  # it is a BytesIO
