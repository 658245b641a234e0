"""How people spell names: what of a spelling does not count, and near misses, which are offered."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches
from functools import lru_cache
from typing import Protocol, TypeVar

__all__ = ["by_names", "did_you_mean", "name_key", "nearest", "plain"]

_SEPARATORS = re.compile(r"[\s_\-]+")


def name_key(name: str) -> str:
    """Return the spelling that two names share where they are one: case and outer blanks do not count.

    Within a workbook, everything goes by the names as defined. This is for names that people type, and for the names
    of two workbooks.

    >>> name_key(" Speed in ") == name_key("speed in")
    True
    """
    return name.strip().casefold()


class _Named(Protocol):
    @property
    def name(self) -> str: ...
    @property
    def names(self) -> tuple[str, ...]: ...


_Row = TypeVar("_Row", bound=_Named)


def by_names(those: Iterable[_Row]) -> dict[str, _Row]:
    """Return what each name means, by its key: a row's own name, and others that people may call it by where no row has
    them as its own.
    """
    rows = tuple(those)
    result = {name_key(each.name): each for each in rows}
    for each in rows:
        for name in each.names:
            result.setdefault(name_key(name), each)
    return result


@lru_cache(maxsize=2048)
def plain(text: str) -> str:
    """Return the spelling two names share when they differ only in case, blanks, underscores or hyphens.

    >>> plain(" Std-Dev ") == plain("std dev") == plain("STD_DEV")
    True
    """
    return _SEPARATORS.sub("", text).casefold()


def nearest(text: str, known: Iterable[str], closeness: float = 0.6) -> str | None:
    """Return the known name most like `text`, or None if none is alike.

    >>> nearest("Unifrom", ["Normal", "Uniform"])
    'Uniform'
    """
    spellings = {plain(name): name for name in known}
    result = get_close_matches(plain(text), spellings, n=1, cutoff=closeness)
    return spellings[result[0]] if result else None


def did_you_mean(text: str, known: Iterable[str]) -> str:
    """Make a hint: the nearest known name, or all of them where none is alike.

    >>> did_you_mean("xyz", ["Normal", "Uniform"])
    'Use one of Normal, Uniform'
    """
    known = tuple(" ".join(name.split()) for name in known)  # a name may have a line break
    result = nearest(text, known)
    return f"Did you mean {result}?" if result else f"Use one of {', '.join(known)}"
