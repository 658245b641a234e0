"""How results look on a terminal or in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from rich.console import Console

    from xlmc.errors import Notice

__all__ = ["console", "notices", "table", "telling"]

_PIPE_WIDTH = 160


def console() -> Console:
    """The terminal; a pipe is wide enough that nothing is cut."""
    from rich.console import Console

    return Console(width=None if sys.stdout.isatty() else _PIPE_WIDTH, highlight=False)


def table(title: str, headings: Sequence[str], rows: Sequence[Sequence[str]], *, right: Sequence[int] = ()) -> None:
    """Print rows under headings; the columns of `right` are aligned to the right."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    made = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD, pad_edge=False)
    for place, heading in enumerate(headings):
        made.add_column(heading, justify="right" if place in right else "left")
    for row in rows:
        made.add_row(*(Text(cell) for cell in row))
    console().print(made)


def notices(found: Sequence[Notice]) -> None:
    """Print what the person should know, to stderr."""
    for notice in found:
        click.echo(f"note: {notice}", err=True)


@contextmanager
def telling(quiet: bool) -> Iterator[Callable[[str], None] | None]:
    """On stderr, what is running, while it runs; None where there is no terminal to say it on."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.markup import escape

    with Console(stderr=True).status("") as status:
        yield lambda what: status.update(escape(f"running: {what}"))
