"""Characters by their codes, letters large and small, and what is no letter at all."""

from __future__ import annotations

import math
import re
from typing import Final
from urllib.parse import quote

from xlmc.errors import ErrorCode
from xlmc.functions.per_element import per_element
from xlmc.functions.registry import Kind, Number, Text, excel

__all__: list[str] = []

_WINDOWS: Final = "cp1252"
_CONTROLS: Final = re.compile("[\x00-\x1f]")
_SPACES: Final = re.compile(" +")
_UNKNOWN: Final = 63
"""The code of the question mark."""


@excel("CHAR", Number, returns=Kind.TEXT)
@per_element
def char(code: float) -> object:
    """The character of a code from 1 to 255 in the Windows character set."""
    number = math.trunc(code)
    if not 1 <= number <= 255:
        return ErrorCode.VALUE
    try:
        return bytes([number]).decode(_WINDOWS)
    except UnicodeDecodeError:
        return chr(number)  # five codes that the set leaves free


@excel("CODE", Text)
@per_element
def code(text: str) -> object:
    """The code of the first character in the Windows character set; 63 for what is not in it."""
    if not text:
        return ErrorCode.VALUE
    try:
        return float(text[0].encode(_WINDOWS)[0])
    except UnicodeEncodeError:
        return float(ord(text[0])) if 0x80 <= ord(text[0]) <= 0x9F else float(_UNKNOWN)


@excel("UNICHAR", Number, returns=Kind.TEXT)
@per_element
def unichar(code: float) -> object:
    """The character of a Unicode code point; `#N/A` for halves of pairs and what is no character."""
    number = math.trunc(code)
    if not 1 <= number <= 0x10FFFF:
        return ErrorCode.VALUE
    return ErrorCode.NA if 0xD800 <= number <= 0xDFFF or number & 0xFFFE == 0xFFFE else chr(number)


@excel("UNICODE", Text)
@per_element
def unicode(text: str) -> object:
    """The Unicode code point of the first character."""
    return float(ord(text[0])) if text else ErrorCode.VALUE


def _large(character: str) -> str:
    """The capital of a letter, unless it is more than one character, as of ß."""
    return character.upper() if len(character.upper()) == 1 else character


def _small(character: str) -> str:
    return character.lower() if len(character.lower()) == 1 else character


@excel("UPPER", Text, returns=Kind.TEXT)
@per_element
def upper(text: str) -> str:
    """In capitals."""
    return "".join(map(_large, text))


@excel("LOWER", Text, returns=Kind.TEXT)
@per_element
def lower(text: str) -> str:
    """In small letters."""
    return "".join(map(_small, text))


@excel("PROPER", Text, returns=Kind.TEXT)
@per_element
def proper(text: str) -> str:
    """A capital for each letter that follows no letter, small letters for the others."""
    pairs = zip(" " + text, text, strict=False)
    return "".join(_small(letter) if before.isalpha() else _large(letter) for before, letter in pairs)


@excel("TRIM", Text, returns=Kind.TEXT)
@per_element
def trim(text: str) -> str:
    """Without spaces at its ends, and one for several between words; no-break spaces stay."""
    return _SPACES.sub(" ", text).strip(" ")


@excel("CLEAN", Text, returns=Kind.TEXT)
@per_element
def clean(text: str) -> str:
    """Without the control characters, 0 to 31."""
    return _CONTROLS.sub("", text)


@excel("ENCODEURL", Text, returns=Kind.TEXT)
@per_element
def encode_url(text: str) -> str:
    """As part of a web address: all but letters, digits and `-._~` by their UTF-8 bytes, `%20`."""
    return quote(text, safe="", errors="replace")
