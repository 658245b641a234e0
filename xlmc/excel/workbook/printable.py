"""Text without characters that steer a screen, or that no XML part can hold.

A workbook is untrusted: a name in it may hold an escape sequence, which would let it write anywhere on a terminal, or a
mark that turns the reading order of a line round, so that a number reads backwards.
"""

from __future__ import annotations

import re
from typing import Final

__all__ = ["label", "printable"]

_STEERING: Final = re.compile(
    "["
    "\x00-\x08\x0b-\x1f"  # control characters but tab and line feed; no XML part can hold them
    "\x7f-\x9f"  # more of them
    "\u2028\u2029"  # line and paragraph separators
    "\u202a-\u202e\u2066-\u2069"  # marks that turn the reading order round
    "\ud800-\udfff"  # halves of characters
    "\ufffe\uffff"  # no characters; no XML part can hold them
    "]"
)


_BYTES: Final = re.compile("[\udc80-\udcff]+")
"""What Python makes of a file's name in UTF-8 where the system's settings speak of ASCII."""


def printable(text: str) -> str:
    r"""Write such characters of the text as Python writes them; line feeds and tabs stay.

    Names of files are read as UTF-8, whatever encoding the system's settings speak of.

    >>> printable("Speed\x1b[2J")
    'Speed\\x1b[2J'
    >>> printable("Gr\udcc3\udcb6\udcc3\udc9fe")
    'Größe'
    """
    return _STEERING.sub(_escape, _BYTES.sub(_decoded, text))


def label(text: str) -> str:
    r"""Write a text from a workbook as everything shows it: `printable`, with the line breaks of Windows as line feeds.

    >>> label("Initial\r\nspeed")
    'Initial\nspeed'
    """
    return printable(text.replace("\r\n", "\n"))


def _decoded(match: re.Match[str]) -> str:
    return match[0].encode("ascii", "surrogateescape").decode("utf-8", "surrogateescape")


def _escape(match: re.Match[str]) -> str:
    code = ord(match[0])
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
