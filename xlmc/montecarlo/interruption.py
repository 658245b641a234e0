"""Lets long work be given up from outside: in between its pieces it looks whether it is still wanted.

Statistics, measures of sensitivity and tables call `checkpoint` many times a second. Who runs them in a thread, and may
want something else before they end, gives `looking` what raises an exception then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final

__all__ = ["checkpoint", "looking"]

_LOOK: Final[ContextVar[Callable[[], None] | None]] = ContextVar("look", default=None)


@contextmanager
def looking(look: Callable[[], None]) -> Iterator[None]:
    """While the block runs, `checkpoint` calls this, in this thread alone; what it raises ends the work.

    What was computed and kept by then stays; what was begun is not kept.
    """
    token = _LOOK.set(look)
    try:
        yield
    finally:
        _LOOK.reset(token)


def checkpoint() -> None:
    """Let the work be given up here, if somebody looks."""
    look = _LOOK.get()
    if look is not None:
        look()
