"""Patterns that a whole text fits or not: `*` for any characters, `?` for one, `~` before one taken as it is.

A pattern is cut at its stars into pieces of fixed length, so that a text takes no more than one pass a piece: a chain
of stars in one regular expression could take for ever.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

__all__ = ["Pattern", "is_pattern", "pattern_of"]

_TOKEN = re.compile(r"~[*?~]|.", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Pattern:
    """A pattern cut at its stars.

    Attributes:
        pieces: each compiled, with its length.
    """

    pieces: tuple[tuple[re.Pattern[str], int], ...]

    def fits(self, text: str) -> bool:
        """Whether the whole text fits, whatever its case."""
        folded = text.casefold()
        head, length = self.pieces[0]
        if head.match(folded) is None:
            return False
        return self._rest_fits(folded, length) if len(self.pieces) > 1 else len(folded) == length

    def _rest_fits(self, text: str, place: int) -> bool:
        for piece, _ in self.pieces[1:-1]:
            found = piece.search(text, place)
            if found is None:
                return False
            place = found.end()
        tail, length = self.pieces[-1]
        return len(text) - length >= place and tail.match(text, len(text) - length) is not None


def is_pattern(text: str) -> bool:
    """Whether the text holds a wildcard or a `~`."""
    return any(mark in text for mark in "*?~")


@lru_cache(maxsize=4096)
def pattern_of(text: str, begins: bool = False) -> Pattern:
    """The pattern that a text stands for; with `begins` anything may follow it."""
    pieces: list[list[str]] = [[]]
    for token in _TOKEN.findall(text.casefold() + ("*" if begins else "")):
        if token == "*":
            pieces.append([])
        else:
            pieces[-1].append("." if token == "?" else re.escape(token[-1]))
    return Pattern(tuple((re.compile("".join(piece), re.DOTALL), len(piece)) for piece in pieces))
