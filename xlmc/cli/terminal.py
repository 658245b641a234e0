"""The only module that writes to stdout and stderr.

A character that the terminal cannot show ends no run, none is taken for a command, and a closed pipe is no error.
"""

from __future__ import annotations

import codecs
import errno
import os
import re
import sys
import unicodedata
from collections.abc import Mapping
from textwrap import fill
from typing import Any, Final, TextIO

from xlmc.errors import WorkbookError
from xlmc.excel.workbook.printable import printable

__all__ = [
    "INTERRUPTED",
    "be_quiet",
    "encodable",
    "is_quiet",
    "on_terminal",
    "paragraph",
    "plain",
    "prepare",
    "put",
    "say",
    "say_json",
    "width",
    "words",
]

INTERRUPTED: Final = 130
"""The exit code after Ctrl-C."""

PIPE_WIDTH: Final = 100
"""Columns of text in a pipe or a file."""

_NARROWEST: Final = 20

_INSTEAD: Final[Mapping[str, str]] = {
    "±": "+/-",
    "–": "-",
    "—": "-",
    "−": "-",
    "─": "-",
    "…": "...",
    "Δ": "delta-",
    "∆": "delta-",
    "×": "x",
    "·": "*",
    "≤": "<=",
    "≥": ">=",
    "∞": "inf",
    "²": "^2",
    "³": "^3",
    "°": "deg",
    "µ": "u",
    "▸": ">",
    "‘": "'",
    "’": "'",
    "“": '"',
    "”": '"',
    "\xa0": " ",
    "\u202f": " ",
}
"""What stands for a character that the terminal's encoding lacks."""

_HANDLER: Final = "xlmc"
_READER_GONE: Final = (errno.EPIPE, errno.EINVAL)
"""The errors by which Linux and macOS, and Windows, say that nobody reads a pipe any more."""


def prepare() -> None:
    """Let stdout and stderr write something readable instead of what their encoding lacks, and print notes."""
    be_quiet(False)
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors=_HANDLER)


_quiet = False
_TOGETHER: Final = re.compile(r"(?<=[0-9]) (?=[%€£$¥])|(?<=[±€£$¥]) (?=[0-9])")
"""Spaces between a number and what belongs to it."""
_JOINED: Final = "\uffff"
"""Stands for such a space while a text wraps: what no printable text has."""
_NOTE: Final = "note: "
_RED: Final = ("xlmc: ", "problem: ")
"""What begins the messages about mistakes."""


def be_quiet(quiet: bool = True) -> None:
    """Print no notes any more, or print them again."""
    global _quiet
    _quiet = quiet


def is_quiet() -> bool:
    """Return whether notes and progress are not to be printed."""
    return _quiet


def say(text: object = "", *, err: bool = False, cure: str | None = None) -> None:
    """Print a text and a line feed; `err` to stderr, wrapped where that is a terminal.

    There a message about a mistake begins in red, and its `cure`, a part of the text, is green.

    Raises:
        WorkbookError: stdout is a file that cannot be written.
    """
    shown = printable(str(text))
    if err and _quiet and shown.startswith(_NOTE):
        return
    if err and on_terminal(err=True):
        shown = "\n".join(_wrap_note(line) for line in shown.split("\n"))
        if _is_coloured():
            shown = _in_red(_in_green(shown, cure))
    put(f"{shown}\n", err=err)


def _is_coloured() -> bool:
    return os.name == "posix" and not os.environ.get("NO_COLOR") and os.environ.get("TERM", "dumb") != "dumb"


def _in_red(text: str) -> str:
    begins = next((each for each in _RED if text.startswith(each)), None)
    return text if begins is None else f"\x1b[31m{begins}\x1b[0m{text.removeprefix(begins)}"


def _in_green(text: str, cure: str | None) -> str:
    """Return a message with its cure in green, on however many lines it stands."""
    if not cure:
        return text
    pattern = r"\s+".join(map(re.escape, printable(cure).split()))
    return re.sub(pattern, lambda match: f"\x1b[32m{match[0]}\x1b[0m", text, count=1, flags=re.IGNORECASE)


def _wrap_note(line: str) -> str:
    """Wrap a line to the terminal's width; words stay whole, so that a path or an address can be copied."""
    line = encodable(line, err=True)
    wide = _columns(sys.stderr)
    return _filled(line, wide, subsequent_indent="  ", break_long_words=False)


def _filled(text: str, width: int, **how: Any) -> str:
    """Wrap a text; no line ends between a number and its percent sign, its sign of money or its error."""
    return fill(_TOGETHER.sub(_JOINED, text), width, break_on_hyphens=False, **how).replace(_JOINED, " ")


def words(text: str) -> list[str]:
    """Return the parts of a text that stay whole where it wraps.

    >>> words("in 52.9 % of 1,587 trials")
    ['in', '52.9 %', 'of', '1,587', 'trials']
    """
    return [each.replace(_JOINED, " ") for each in _TOGETHER.sub(_JOINED, text).split()]


def say_json(value: object) -> None:
    """Print JSON; what the terminal cannot show, or would take for a command, is written as an escape of JSON.

    Raises:
        WorkbookError: as for `say`.
    """
    import json

    from xlmc.montecarlo.statistics.estimate import finite_json

    text = json.dumps(finite_json(value), indent=2, ensure_ascii=not _is_unicode(sys.stdout), allow_nan=False)
    if printable(text) != text:
        text = "".join(one if printable(one) == one else json.dumps(one)[1:-1] for one in text)
    put(f"{text}\n")


def put(text: str, *, err: bool = False) -> None:
    """Write text that is `printable` but for commands of our own.

    Raises:
        WorkbookError: as for `say`.
    """
    stream = sys.stderr if err else sys.stdout
    if stream is None:
        return  # started without one
    try:
        stream.write(text)
        stream.flush()
    except OSError as error:
        _silence(stream)
        if not err and error.errno not in _READER_GONE:
            raise WorkbookError(f"the output cannot be written ({error.strerror})") from error


def paragraph(text: str, *, indent: str = "", hanging: str | None = None) -> str:
    """Wrap the text to the width; `hanging` indents every line but the first, by default as `indent`."""
    after = indent if hanging is None else hanging
    lines = text.split("\n")
    wide = width()
    return "\n".join(_filled(printable(line), wide, initial_indent=indent, subsequent_indent=after) for line in lines)


def width() -> int:
    """Columns of the terminal; `PIPE_WIDTH` where stdout is none."""
    return _columns(sys.stdout) if on_terminal() else PIPE_WIDTH


def _columns(stream: TextIO) -> int:
    """Columns of the terminal behind a stream; `COLUMNS` where that is set."""
    try:
        own = os.get_terminal_size(stream.fileno()).columns or PIPE_WIDTH
    except (OSError, ValueError):
        own = PIPE_WIDTH
    wanted = os.environ.get("COLUMNS", "")
    return max(_NARROWEST, int(wanted) if wanted.isdecimal() and int(wanted) > 0 else own)


def on_terminal(*, err: bool = False) -> bool:
    """Whether a person looks at stdout, or `err` at stderr."""
    stream = sys.stderr if err else sys.stdout
    return stream is not None and stream.isatty()


def encodable(text: str, *, err: bool = False) -> str:
    """Write the text as the stream's encoding can show it, so that columns can be measured."""
    encoding = getattr(sys.stderr if err else sys.stdout, "encoding", None) or "utf-8"
    return text.encode(encoding, _HANDLER).decode(encoding)


def _is_unicode(stream: TextIO | None) -> bool:
    return (getattr(stream, "encoding", None) or "utf-8").casefold().startswith("utf")


def _silence(stream: TextIO) -> None:
    """Discard all further output, also what Python flushes when it ends."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, stream.fileno())
    finally:
        os.close(nowhere)


def _readable_instead(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(_readable(one) for one in lacking), error.end


def _readable(character: str) -> str:
    r"""Replace a character: by our spelling, a Greek letter's name, a letter without its marks, or `\u4e2d`."""
    if character in _INSTEAD:
        return _INSTEAD[character]
    words = unicodedata.name(character, "").split()
    if words[:1] == ["GREEK"] and "LETTER" in words:
        return words[words.index("LETTER") + 1].lower()
    bare = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return bare or character.encode("ascii", "backslashreplace").decode()


codecs.register_error(_HANDLER, _readable_instead)


def plain(value: object) -> object:
    """Return a value as JSON and CSV hold it: an error as its text."""
    from xlmc.errors import ErrorCode

    return value.text if isinstance(value, ErrorCode) else value
