"""Excel's wildcards in texts: `?` for one character, `*` for any number of them, `~` before one taken as it is."""

from __future__ import annotations

import re
from functools import lru_cache

__all__ = ["has_wildcards", "wildcard_regex"]

_PIECE = re.compile(r"~([?*~])|([?*])|(.)", re.DOTALL)


def has_wildcards(text: str) -> bool:
    """Whether any character of it has a meaning as a wildcard."""
    return any(mark in text for mark in "?*~")


@lru_cache(maxsize=1024)
def wildcard_regex(text: str) -> re.Pattern[str]:
    """The text as a regular expression, without regard to case; a `~` before anything else stands for itself."""
    return re.compile("".join(map(_translated, _PIECE.finditer(text))), re.IGNORECASE | re.DOTALL)


def _translated(piece: re.Match[str]) -> str:
    escaped, wildcard, character = piece.groups()
    if wildcard:
        return "." if wildcard == "?" else ".*?"
    return re.escape(escaped or character)
