"""How results look on a terminal or in a pipe."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

from xlmc.cli.table import laid_out
from xlmc.cli.terminal import degraded, on_terminal, paragraph, put, say, width
from xlmc.workbook.printable import printable

if TYPE_CHECKING:
    from xlmc.errors import Notice

__all__ = ["notices", "table", "telling", "warnings"]

_PIPE_WIDTH: Final = 160
_BOLD: Final = "\x1b[1m", "\x1b[0m"


def table(title: str, headings: Sequence[str], rows: Sequence[Sequence[str]], *, right: Sequence[int] = ()) -> None:
    """Print rows under headings; the columns of `right` are numbers, aligned to the right.

    No line is longer than the terminal is wide, and none in a pipe longer than `_PIPE_WIDTH`.
    """
    widest = width() if on_terminal() else _PIPE_WIDTH
    shown = [[_one_line(cell) for cell in row] for row in rows]
    lines = laid_out([_one_line(heading) for heading in headings], shown, right, widest, degraded("─"))
    put("\n".join((_bold(paragraph(_one_line(title))), "", *lines)) + "\n\n")


def notices(found: Sequence[Notice]) -> None:
    """Print what the person should know, to stderr."""
    for notice in found:
        say(f"note: {notice}", err=True)


def warnings(found: Sequence[str]) -> None:
    """Print why an answer must not be used, to stderr."""
    for warning in found:
        say(f"warning: {warning}; the answer must not be used as it stands.", err=True)


def _one_line(cell: str) -> str:
    return degraded(" ".join(printable(cell).splitlines()))


def _bold(text: str) -> str:
    plain = not on_terminal() or os.name != "posix" or "NO_COLOR" in os.environ or os.environ.get("TERM") == "dumb"
    return text if plain else text.join(_BOLD)


@contextmanager
def telling(quiet: bool) -> Iterator[Callable[[str], None] | None]:
    """On stderr, what is running, while it runs; None where there is no terminal to say it on."""
    if quiet or not on_terminal(err=True):
        yield None
        return
    from rich.console import Console
    from rich.markup import escape

    with Console(stderr=True).status("", spinner="line") as status:
        yield lambda what: status.update(escape(degraded(printable(f"running: {what}"), err=True)))
