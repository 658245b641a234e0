"""The ways to write numbers among which the setting Number style chooses: which signs thousands and decimals have."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from operator import attrgetter
from typing import Final, ParamSpec, TypeVar

__all__ = ["STYLES", "USUAL_STYLE", "as_programs_read", "in_style", "in_style_of", "style_asked", "style_key"]

Given = ParamSpec("Given")
Made = TypeVar("Made")

USUAL_STYLE: Final = "1,234.5"

STYLES: Final = {
    USUAL_STYLE: (",", "."),
    "1.234,5": (".", ","),
    "1 234,5": ("\u00a0", ","),
    "1 234.5": ("\u00a0", "."),
    "1'234.5": ("'", "."),
    "1234.5": ("", "."),
    "1234,5": ("", ","),
}
"""An example -> the signs of thousands and of decimals; a space there ends no line."""


def style_key(typed: str) -> str:
    """Return what the spellings of a style share: those of its space, and of its apostrophe.

    >>> [style_key(each) for each in ("1\u202f234,5", "1’234.5")]
    ['1 234,5', "1'234.5"]
    """
    return " ".join(typed.replace("’", "'").split())


_ASKED: ContextVar[str] = ContextVar("number style that a command was asked for", default="")


@contextmanager
def style_asked(style: str) -> Iterator[None]:
    """Write all numbers in a style until the end of the block, whatever style workbooks ask for."""
    token = _ASKED.set(style)
    try:
        with in_style(style):
            yield
    finally:
        _ASKED.reset(token)


@contextmanager
def in_style(style: str) -> Iterator[None]:
    """Write all numbers in a style, one of `STYLES`, until the end of the block; empty is the usual one. A style that
    the command was asked for goes before it.
    """
    from xlmc.montecarlo.number_text import in_signs  # not for those who only ask what styles there are

    with in_signs(*STYLES[_ASKED.get() or style or USUAL_STYLE]):
        yield


@contextmanager
def as_programs_read() -> Iterator[None]:
    """Write all numbers in the usual style until the end of the block, whatever was asked for."""
    from xlmc.montecarlo.number_text import in_signs

    with in_signs(*STYLES[USUAL_STYLE]):
        yield


def in_style_of(path: str) -> Callable[[Callable[Given, Made]], Callable[Given, Made]]:
    """Make a function write all numbers in the style that its first argument names.

    Args:
        path: where that argument has it, as `settings.number_style`.
    """
    style = attrgetter(path)

    def made(function: Callable[Given, Made]) -> Callable[Given, Made]:
        @wraps(function)
        def styled(*args: Given.args, **named: Given.kwargs) -> Made:
            with in_style(style(args[0])):
                return function(*args, **named)

        return styled

    return made
