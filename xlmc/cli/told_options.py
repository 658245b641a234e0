"""`-o`, `--html` and `--overwrite` of the commands that find something and write it down where they are asked to."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from xlmc.cli.terminal import paragraph, say

if TYPE_CHECKING:
    from xlmc.report.told import Block

__all__ = ["show", "told_options"]

Command = TypeVar("Command", bound=Callable[..., Any])


def told_options(command: Command) -> Command:
    """Add the three options."""
    path = click.Path(path_type=Path)
    command = click.option("--overwrite", is_flag=True, help="Replace existing files, whoever wrote them.")(command)
    command = click.option("--html", type=path, help="Also write the result as a page, .html.")(command)
    return click.option("-o", "--output", type=path, help="Also write the result as a sheet, .xlsx.")(command)


def show(blocks: Iterable[Block]) -> None:
    """Print paragraphs, and tables with a line of space around them."""
    from xlmc.cli.printing import table

    spaced = True
    for each in blocks:
        if isinstance(each, str):
            say(paragraph(each))
            spaced = False
        else:
            if not spaced:
                say()
            table(each.title, each.headings, each.rows, right=each.right)
            spaced = True
