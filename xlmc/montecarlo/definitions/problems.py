"""Mistakes and remarks, collected so that a person sees all of them at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import ParamSpec, TypeVar

from xlmc.errors import DefinitionError, Notice

__all__ = ["Findings"]

P = ParamSpec("P")
T = TypeVar("T")


@dataclass(slots=True)
class Findings:
    """What was found while reading; it only ever grows.

    Reading one thing raises a `DefinitionError`; where many are read, `recording` or `attempt` records it and carries
    on.
    """

    problems: list[DefinitionError] = field(default_factory=list)
    notices: list[Notice] = field(default_factory=list)
    _alike: dict[str, tuple[int, Notice, int]] = field(default_factory=dict)

    def problem(self, message: str, where: object, hint: str) -> None:
        self.problems.append(DefinitionError(message, where=where, hint=hint))

    def notice(self, message: str, where: object, *, alike: str = "") -> None:
        """Add a notice.

        Args:
            message: what it says.
            where: the cell it is about.
            alike: what may be so of many cells, as "text in Cell": the first is named, and how many more there are.
        """
        if alike in self._alike:
            place, first, more = self._alike[alike]
            self._alike[alike] = place, first, more + 1
            cells = "1 more cell" if more == 0 else f"{more + 1} more cells"
            self.notices[place] = Notice(f"{first.message} (so in {cells} of this column)", first.where)
            return
        self.notices.append(Notice(message, where))
        if alike:
            self._alike[alike] = len(self.notices) - 1, self.notices[-1], 0

    def add(self, others: Findings) -> None:
        """Take what was found elsewhere."""
        self.problems += others.problems
        self.notices += others.notices

    @contextmanager
    def recording(self) -> Iterator[None]:
        """Record a `DefinitionError` from within, and go on after it."""
        try:
            yield
        except DefinitionError as error:
            self.problems.append(error)

    def attempt(self, read: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T | None:
        """Return what `read` returns; None, and a problem, where it raises a `DefinitionError`."""
        with self.recording():
            return read(*args, **kwargs)
        return None
