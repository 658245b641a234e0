"""Characters and their codes, capital and small letters, spaces and control characters."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Final
from urllib.parse import quote

from xlmc.errors import ErrorCode
from xlmc.excel.functions.per_element import per_element
from xlmc.excel.functions.registry import Kind, Number, Text, excel
from xlmc.excel.functions.values import Floats, Objects, Value

__all__: list[str] = []

_CONTROLS: Final = re.compile("[\x00-\x1f]")
_SPACES: Final = re.compile(" +")
_UNKNOWN: Final = 63.0
"""The code of the question mark."""


@excel("CHAR", Number, returns=Kind.TEXT, macintosh=True)
def char(codes: Floats, *, macintosh: bool = False) -> Value:
    """Return the character of a code from 1 to 255 in the character set of Windows, or of the Macintosh."""
    return _CHARACTERS[macintosh](codes)


@excel("CODE", Text, macintosh=True)
def code(texts: Objects, *, macintosh: bool = False) -> Value:
    """Return the code of the first character in the character set of Windows, or of the Macintosh; 63 if it is not
    there.
    """
    return _CODES[macintosh](texts)


def _codes_to_characters(characters: str) -> Callable[..., Value]:
    """Make a body that gives the characters of codes; `characters` stand in the order of their codes."""
    return per_element(lambda code: characters[math.trunc(code)] if 1 <= code < 256 else ErrorCode.VALUE)


def _characters_to_codes(characters: str) -> Callable[..., Value]:
    """Make a body that gives the codes of first characters."""
    codes = {character: float(number) for number, character in enumerate(characters)}
    return per_element(lambda text: codes.get(text[0], _UNKNOWN) if text else ErrorCode.VALUE)


def _character_set(codec: str) -> str:
    """All 256 characters; a code that the set leaves free is the control character of that number."""
    decoded = [bytes([number]).decode(codec, "replace") for number in range(256)]
    return "".join(chr(number) if c == "\ufffd" else c for number, c in enumerate(decoded))


_SETS: Final = (_character_set("cp1252"), _character_set("mac_roman"))
_CHARACTERS: Final = tuple(map(_codes_to_characters, _SETS))
_CODES: Final = tuple(map(_characters_to_codes, _SETS))


@excel("UNICHAR", Number, returns=Kind.TEXT)
@per_element
def unichar(code: float) -> object:
    """Return the character of a Unicode code point; `#N/A` for surrogates and for code points without a character."""
    number = math.trunc(code)
    if not 1 <= number <= 0x10FFFF:
        return ErrorCode.VALUE
    return ErrorCode.NA if 0xD800 <= number <= 0xDFFF or number & 0xFFFE == 0xFFFE else chr(number)


@excel("UNICODE", Text)
@per_element
def unicode(text: str) -> object:
    """Return the Unicode code point of the first character."""
    return float(ord(text[0])) if text else ErrorCode.VALUE


def _upper(character: str) -> str:
    """Return the capital of a letter, unless it is more than one character, as of ß."""
    return character.upper() if len(character.upper()) == 1 else character


def _lower(character: str) -> str:
    return character.lower() if len(character.lower()) == 1 else character


@excel("UPPER", Text, returns=Kind.TEXT)
@per_element
def upper(text: str) -> str:
    """Return the text in capitals."""
    return "".join(map(_upper, text))


@excel("LOWER", Text, returns=Kind.TEXT)
@per_element
def lower(text: str) -> str:
    """Return the text in small letters."""
    return "".join(map(_lower, text))


@excel("ASC", Text, returns=Kind.TEXT)
@per_element
def half_width(text: str) -> str:
    """Return the text: only versions of Excel for Chinese, Japanese and Korean have full-width characters to change."""
    return text


@excel("PROPER", Text, returns=Kind.TEXT)
@per_element
def proper(text: str) -> str:
    """Write a capital for each letter that follows no letter, small letters for the others."""
    pairs = zip(" " + text, text, strict=False)
    return "".join(_lower(letter) if before.isalpha() else _upper(letter) for before, letter in pairs)


@excel("TRIM", Text, returns=Kind.TEXT)
@per_element
def trim(text: str) -> str:
    """Return the text without spaces at its ends, and with single spaces between words; no-break spaces stay."""
    return _SPACES.sub(" ", text).strip(" ")


@excel("CLEAN", Text, returns=Kind.TEXT)
@per_element
def clean(text: str) -> str:
    """Return the text without its control characters, 0 to 31."""
    return _CONTROLS.sub("", text)


@excel("ENCODEURL", Text, returns=Kind.TEXT)
@per_element
def encode_url(text: str) -> str:
    """Return the text as part of a web address: all but letters, digits and `-._~` become UTF-8 bytes such as `%20`."""
    return quote(text, safe="", errors="replace")
