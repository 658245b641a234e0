"""Texts found in texts, and what is found replaced. Places count from 1."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import Final

from xlmc.errors import ErrorCode
from xlmc.functions.per_element import per_element
from xlmc.functions.registry import Kind, Number, Text, excel
from xlmc.functions.text.utf16 import LONGEST, in_units, units, whole

__all__: list[str] = []

_WILDCARD: Final = re.compile(r"~[*?~]|.", re.DOTALL)


@excel("FIND", Text, Text, Number(default=1.0), aliases=("FINDB",))
@per_element
@in_units
def find(wanted: str, text: str, start: float) -> object:
    """Where a text first stands in another from a place on; capitals count."""
    first = math.trunc(start) - 1
    found = text.find(wanted, first) if 0 <= first <= len(text) else -1
    return ErrorCode.VALUE if found < 0 else found + 1.0


@excel("SEARCH", Text, Text, Number(default=1.0), aliases=("SEARCHB",))
@per_element
@in_units
def search(wanted: str, text: str, start: float) -> object:
    """As `FIND`, but whatever the case and with the wildcards `?` and `*`, which `~` makes plain."""
    first = math.trunc(start) - 1
    found = _first_fit(wanted, text, first) if 0 <= first <= len(text) else None
    return ErrorCode.VALUE if found is None else found + 1.0


def _first_fit(wanted: str, text: str, start: int) -> int | None:
    """The first place where the pattern fits.

    Its pieces between stars follow each other at their first places: if they do not do so from the first place of the
    first piece, they do so from no later one.
    """
    pieces = _pieces(wanted)
    head = pieces[0].search(text, start)
    if head is None:
        return None
    place = head.end()
    for piece in pieces[1:]:
        found = piece.search(text, place)
        if found is None:
            return None
        place = found.end()
    return head.start()


@lru_cache(maxsize=1024)
def _pieces(wanted: str) -> tuple[re.Pattern[str], ...]:
    """The pattern cut at its stars, each piece compiled."""
    pieces = [""]
    for token in _WILDCARD.findall(wanted):
        if token == "*":
            pieces.append("")
        else:
            pieces[-1] += "." if token == "?" else re.escape(token[-1])
    return tuple(re.compile(piece, re.IGNORECASE | re.DOTALL) for piece in pieces)


@excel("SUBSTITUTE", Text, Text, Text, Number(default=None), returns=Kind.TEXT)
@per_element
def substitute(text: str, old: str, new: str, which: float | None) -> object:
    """The text with another for every occurrence of one, or for that occurrence alone; capitals count."""
    if which is not None and which < 1:
        return ErrorCode.VALUE
    if not old:
        return text
    if which is None:
        if len(text) + text.count(old) * (len(new) - len(old)) > LONGEST:
            return ErrorCode.VALUE
        return _unless_too_long(text.replace(old, new))
    parts = text.split(old)
    place = math.trunc(which)
    if place >= len(parts):
        return text
    return _unless_too_long(old.join(parts[:place]) + new + old.join(parts[place:]))


def _unless_too_long(text: str) -> object:
    return text if len(units(text)) <= LONGEST else ErrorCode.VALUE


@excel("EXACT", Text, Text, returns=Kind.LOGICAL)
@per_element
def exact(one: str, other: str) -> bool:
    """Whether two texts are the same, capitals and all."""
    return whole(one) == whole(other)
