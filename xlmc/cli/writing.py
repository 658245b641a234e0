"""How commands write files after hours of work: one that cannot be written costs neither the answer nor the others."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

import click

from xlmc.cli.terminal import say
from xlmc.errors import XlmcError

__all__ = ["NOT_WRITTEN", "Written", "write_files", "written_or_reported"]

NOT_WRITTEN = 2
"""Exit code where a file could not be written."""


class Written(NamedTuple):
    """What came of writing files: the paths of those that were written, and whether all were."""

    paths: list[Path]
    complete: bool

    def print_paths(self) -> None:
        """Print the paths of the files that were written."""
        for path in self.paths:
            say(f"Written: {path}")

    def check(self) -> None:
        """End the command with its exit code where one is missing."""
        if not self.complete:
            raise click.exceptions.Exit(NOT_WRITTEN)


def write_files(files: Iterable[tuple[Path, Callable[[], Path]]]) -> Written:
    """Write one file after the other; of each that cannot be written, say so."""
    result = [written_or_reported(path, write) for path, write in files]
    paths = [path for path in result if path is not None]
    return Written(paths, len(paths) == len(result))


def written_or_reported(path: Path, write: Callable[[], Path]) -> Path | None:
    """Return the path that was written to; None if it could not be written, which is reported later."""
    try:
        return write()
    except XlmcError as error:
        say(f"xlmc: {error}", err=True)
    except OSError as error:
        say(f"xlmc: {path}: the file cannot be written ({error.strerror or error}).", err=True)
    except Exception as error:  # a fault of xlmc's own in one output must not cost the others, nor the answer
        message = f"{type(error).__name__}: {error}"[:500]
        say(f"xlmc: {path}: xlmc has failed ({message}), and this file was not written. Please report it.", err=True)
    return None
