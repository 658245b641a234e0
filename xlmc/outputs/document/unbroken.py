"""Spaces at which no line is broken: between a number and its percent sign, its unit, its money or its error."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

__all__ = ["in_units", "unbroken"]

_SPACE: Final = "\u00a0"
_WHERE: ContextVar[re.Pattern[str] | None] = ContextVar("spaces at which no line is broken", default=None)


@contextmanager
def in_units(units: Iterable[str]) -> Iterator[None]:
    r"""Keep numbers in one line with these units, percent signs and signs of money until the end of the block.

    >>> with in_units(["mph"]):
    ...     unbroken("51 % lie below 34.5 ± 0.3 mph or 20 €").split(" ")
    ['51\xa0%', 'lie', 'below', '34.5', '±\xa00.3\xa0mph', 'or', '20\xa0€']
    """
    known = "|".join(map(re.escape, sorted({each.strip() for each in units} - {""}, key=len, reverse=True)))
    behind = rf"(?<=[0-9]) (?=(?:[%€£$¥]|days?|h|min|s{f'|{known}' if known else ''})(?!\w))"
    token = _WHERE.set(re.compile(rf"{behind}|(?<=[±€£$¥]) (?=[0-9])"))
    try:
        yield
    finally:
        _WHERE.reset(token)


def unbroken(text: str) -> str:
    """Return a text of a page or of paper in which no line ends between a number and what belongs to it."""
    where = _WHERE.get()
    return text if where is None else where.sub(_SPACE, text)
