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


def printable(text: str) -> str:
    r"""The text with such characters written as Python writes them; line feeds and tabs stay.

    >>> printable("Speed\x1b[2J")
    'Speed\\x1b[2J'
    """
    return _STEERING.sub(_escape, text)


def label(text: str) -> str:
    r"""A text from a workbook as everything shows it: `printable`, with the line breaks of Windows as line feeds.

    >>> label("Initial\r\nspeed")
    'Initial\nspeed'
    """
    return printable(text.replace("\r\n", "\n"))


def _escape(found: re.Match[str]) -> str:
    code = ord(found[0])
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
