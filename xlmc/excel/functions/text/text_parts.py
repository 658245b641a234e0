"""Parts of texts by position and length; finding and replacing a text in another.

Positions count from 1; fractions are dropped. Excel counts texts in UTF-16 units, two for a character beyond the first
65,536.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import lru_cache, wraps
from typing import Final

import numpy as np

from xlmc.errors import ErrorCode
from xlmc.excel.functions.per_element import per_element
from xlmc.excel.functions.registry import Kind, Number, Text, excel

__all__ = ["LONGEST", "fits_in_a_cell", "from_units", "in_units", "to_units"]

LONGEST: Final = 32767
"""The most UTF-16 units of a text; Excel makes none longer."""


def fits_in_a_cell(text: str) -> bool:
    """Whether a text is no longer than Excel allows."""
    return len(text) <= LONGEST // 2 or (len(text) <= LONGEST and len(to_units(text)) <= LONGEST)


def to_units(text: str) -> str:
    """Return the text with a character for each of its UTF-16 units, so that Python counts as Excel does."""
    if text.isascii() or max(text) < "\U00010000":
        return text
    return "".join(map(chr, np.frombuffer(text.encode("utf-16-le", "surrogatepass"), "<u2")))


def from_units(text: str) -> str:
    """Return the text with its pairs of surrogates joined again; half a pair becomes U+FFFD."""
    if text.isascii() or not any("\ud800" <= character < "\ue000" for character in text):
        return text
    return text.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")


def in_units(function: Callable[..., object]) -> Callable[..., object]:
    """Wrap a function: it gets its texts in UTF-16 units, and its result is joined again."""

    @wraps(function)
    def counted(*arguments: object) -> object:
        result = function(*(to_units(item) if isinstance(item, str) else item for item in arguments))
        return from_units(result) if isinstance(result, str) else result

    return counted


# The functions with a B at the end count bytes in Chinese, Japanese and Korean; elsewhere they are the same.


@excel("LEN", Text, aliases=("LENB",))
@per_element
@in_units
def length(text: str) -> float:
    """How many characters a text has."""
    return float(len(text))


@excel("LEFT", Text, Number(default=1.0), returns=Kind.TEXT, aliases=("LEFTB",))
@per_element
@in_units
def left(text: str, count: float) -> object:
    """Return the first characters."""
    return ErrorCode.VALUE if count < 0 else text[: math.trunc(count)]


@excel("RIGHT", Text, Number(default=1.0), returns=Kind.TEXT, aliases=("RIGHTB",))
@per_element
@in_units
def right(text: str, count: float) -> object:
    """Return the last characters."""
    return ErrorCode.VALUE if count < 0 else text[max(len(text) - math.trunc(count), 0) :]


@excel("MID", Text, Number, Number, returns=Kind.TEXT, aliases=("MIDB",))
@per_element
@in_units
def middle(text: str, start: float, count: float) -> object:
    """Return a number of characters from a position on."""
    if start < 1 or count < 0:
        return ErrorCode.VALUE
    first = math.trunc(start) - 1
    return text[first : first + math.trunc(count)]


@excel("REPLACE", Text, Number, Number, Text, returns=Kind.TEXT, aliases=("REPLACEB",))
@per_element
@in_units
def replace(text: str, start: float, count: float, new: str) -> object:
    """Return the text with so many characters from a position on replaced."""
    if start < 1 or count < 0:
        return ErrorCode.VALUE
    first = math.trunc(start) - 1
    result = f"{text[:first]}{new}{text[first + math.trunc(count) :]}"
    return result if len(result) <= LONGEST else ErrorCode.VALUE


@excel("REPT", Text, Number, returns=Kind.TEXT)
@per_element
@in_units
def repeat(text: str, count: float) -> object:
    """Return the text so many times over; `#VALUE!` beyond 32,767 characters."""
    times = math.trunc(count)
    if count < 0 or times * len(text) > LONGEST:
        return ErrorCode.VALUE
    return text * min(times, LONGEST)


_WILDCARD: Final = re.compile(r"~.|~$|.", re.DOTALL)


@excel("FIND", Text, Text, Number(default=1.0), aliases=("FINDB",))
@per_element
@in_units
def find(wanted: str, text: str, start: float) -> object:
    """Return the position of a text in another one, searched from a position on; capitals count."""
    first = math.trunc(start) - 1
    value = text.find(wanted, first) if 0 <= first <= len(text) else -1
    return ErrorCode.VALUE if value < 0 else value + 1.0


@excel("SEARCH", Text, Text, Number(default=1.0), aliases=("SEARCHB",))
@per_element
@in_units
def search(wanted: str, text: str, start: float) -> object:
    """As `FIND`, but case does not count, and `?` and `*` are wildcards; `~` takes the next character as it is."""
    first = math.trunc(start) - 1
    value = _first_fit(wanted, text, first) if 0 <= first <= len(text) else None
    return ErrorCode.VALUE if value is None else value + 1.0


def _first_fit(wanted: str, text: str, start: int) -> int | None:
    """Return the first position where the pattern fits.

    Each piece between stars is looked for behind the piece before. If that fails after the first position of the first
    piece, it fails after every later one.
    """
    pieces = _pieces(wanted)
    head = pieces[0].search(text, start)
    if head is None:
        return None
    position = head.end()
    for piece in pieces[1:]:
        match = piece.search(text, position)
        if match is None:
            return None
        position = match.end()
    return head.start()


@lru_cache(maxsize=1024)
def _pieces(wanted: str) -> tuple[re.Pattern[str], ...]:
    """Cut the pattern at its stars, each piece compiled."""
    pieces = [""]
    for token in _WILDCARD.findall(wanted):
        if token == "*":
            pieces.append("")
        else:
            pieces[-1] += "." if token == "?" else re.escape(token[-1]) if token != "~" else ""
    return tuple(re.compile(piece, re.IGNORECASE | re.DOTALL) for piece in pieces)


@excel("SUBSTITUTE", Text, Text, Text, Number(default=None), returns=Kind.TEXT)
@per_element
def substitute(text: str, old: str, new: str, which: float | None) -> object:
    """Return the text with `new` for every `old`, or for the occurrence `which` alone; capitals count."""
    if which is not None and which < 1:
        return ErrorCode.VALUE
    if not old:
        return text
    if which is None:
        if len(text) + text.count(old) * (len(new) - len(old)) > LONGEST:
            return ErrorCode.VALUE
        return _unless_too_long(text.replace(old, new))
    parts = text.split(old)
    count = math.trunc(which)
    if count >= len(parts):
        return text
    return _unless_too_long(old.join(parts[:count]) + new + old.join(parts[count:]))


def _unless_too_long(text: str) -> object:
    return text if len(to_units(text)) <= LONGEST else ErrorCode.VALUE


@excel("EXACT", Text, Text, returns=Kind.LOGICAL)
@per_element
def exact(one: str, other: str) -> bool:
    """Whether two texts are the same; capitals count."""
    return from_units(one) == from_units(other)
