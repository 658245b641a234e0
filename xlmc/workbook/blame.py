"""Say which file a complaint is about."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from xlmc.errors import WorkbookError

__all__ = ["told_of"]


@contextmanager
def told_of(file: str) -> Iterator[None]:
    """Complaints from within that name no place of their own are told of `file`."""
    try:
        yield
    except WorkbookError as error:
        if error.where is not None:
            raise
        raise WorkbookError(error.message, where=file, hint=error.hint) from error
