"""Data classes of the standard library, made in three fifths of the time.

The standard library compiles up to eight methods for each data class. A command of xlmc imports some 300, and that was
the largest cost of its start. Comparing, hashing and printing need no method of each class's own: here all classes
share them. The rest is the standard library's.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any

__all__ = ["dataclass"]


def _make(cls: type | None = None, /, **options: bool) -> Any:
    """Make a data class, as `dataclasses.dataclass` does with the same arguments."""

    def make(plain: type) -> type:
        if options.get("order"):
            return dataclasses.dataclass(**options)(plain)
        own = {name for name, value in vars(plain).items() if not (name == "__hash__" and value is None)}
        made: type = dataclasses.dataclass(**options | {"eq": False, "repr": False})(plain)
        for name, method in _shared(dataclasses.fields(made), options).items():
            if name not in own:
                setattr(made, name, method)
        return made

    return make if cls is None else make(cls)


def _shared(fields: tuple[dataclasses.Field[Any], ...], options: dict[str, bool]) -> dict[str, Any]:
    """Return the methods that a class of these fields has, by name."""
    methods: dict[str, Any] = {}
    if options.get("repr", True):
        methods["__repr__"] = _repr([f.name for f in fields if f.repr])
    if options.get("eq", True):
        compared = _values([f.name for f in fields if f.compare])
        methods["__eq__"] = _eq(compared)
        hashed = _values([f.name for f in fields if (f.compare if f.hash is None else f.hash)])
        methods["__hash__"] = _hash(hashed) if options.get("frozen") else None
    return methods


def _values(names: list[str]) -> Callable[[Any], tuple[Any, ...]]:
    """Return what gives the tuple of these attributes."""
    if not names:
        return lambda _: ()
    read = attrgetter(*names)
    return read if len(names) > 1 else lambda record: (read(record),)


def _eq(values: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any, object], bool]:
    def equals(self: Any, other: object) -> bool:
        return values(self) == values(other) if other.__class__ is self.__class__ else NotImplemented

    return equals


def _hash(values: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any], int]:
    def hash_of(self: Any) -> int:
        return hash(values(self))

    return hash_of


def _repr(names: list[str]) -> Callable[[Any], str]:
    @recursive_repr()
    def printed(self: Any) -> str:
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

    return printed


if TYPE_CHECKING:
    from dataclasses import dataclass
else:
    dataclass = _make
