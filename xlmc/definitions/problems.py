"""Mistakes and remarks, collected so that a person sees all of them at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ParamSpec, TypeVar

from xlmc.errors import DefinitionError, Notice

__all__ = ["Findings"]

P = ParamSpec("P")
T = TypeVar("T")


@dataclass(slots=True)
class Findings:
    """What was found while reading; it only ever grows.

    Reading one thing raises a `DefinitionError`; reading many goes through `attempt`, which records it and carries on.
    """

    problems: list[DefinitionError] = field(default_factory=list)
    notices: list[Notice] = field(default_factory=list)

    def problem(self, message: str, where: object, hint: str) -> None:
        self.problems.append(DefinitionError(message, where=where, hint=hint))

    def notice(self, message: str, where: object) -> None:
        self.notices.append(Notice(message, where))

    def attempt(self, read: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T | None:
        """What `read` returns; None, and a problem, where it raises a `DefinitionError`."""
        try:
            return read(*args, **kwargs)
        except DefinitionError as error:
            self.problems.append(error)
            return None
