"""Values out of JSON, each of the type that xlmc writes: an edited file is refused here, and not somewhere later."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import MISSING, fields, is_dataclass
from types import NoneType
from typing import Any, Final, TypeVar, get_args, get_origin, get_type_hints

__all__ = ["counts", "made", "mapping", "texts", "told", "whole"]

_LARGEST: Final = 2**63  # what a count never reaches

T = TypeVar("T")


def told(kept: bool, what: str) -> None:
    """Refuse what cannot be.

    Raises:
        ValueError: it cannot be.
    """
    if not kept:
        raise ValueError(what)


def made(kind: type[T], found: object, what: str) -> T:
    """An instance of a dataclass from its fields; those with a default may be missing. Lists become tuples.

    Raises:
        ValueError: a field is missing, is none of the dataclass's, or has another type than it must.
    """
    told(isinstance(found, dict), what)
    assert isinstance(found, dict)
    assert is_dataclass(kind)
    required = {each.name for each in fields(kind) if each.default is MISSING and each.default_factory is MISSING}
    hints = get_type_hints(kind)
    known = {each.name: hints[each.name] for each in fields(kind)}
    told(required <= found.keys(), f"{what} lacks {', '.join(sorted(required - found.keys()))}")
    told(found.keys() <= known.keys(), f"{what} has the unknown field {', '.join(sorted(found.keys() - known.keys()))}")
    given = {name: _typed(known[name], value, f"{what}, {name}") for name, value in found.items()}
    return kind(**given)


def mapping(found: object, what: str) -> dict[str, Any]:
    """A JSON object.

    Raises:
        ValueError: it is none.
    """
    told(isinstance(found, dict), what)
    assert isinstance(found, dict)
    return found


def counts(found: object, what: str) -> Counter[str]:
    """Name -> how many.

    Raises:
        ValueError: it is something else.
    """
    return Counter({name: whole(count, what) for name, count in mapping(found, what).items()})


def texts(found: object, what: str) -> tuple[str, ...]:
    """A list of texts.

    Raises:
        ValueError: it is something else.
    """
    told(isinstance(found, list) and all(isinstance(each, str) for each in found), what)
    assert isinstance(found, list)
    return tuple(found)


def whole(found: object, what: str) -> int:
    """A count, 0 or more.

    Raises:
        ValueError: it is none.
    """
    told(type(found) is int and 0 <= found < _LARGEST, what)
    assert isinstance(found, int)
    return found


def _typed(hint: Any, value: object, what: str) -> Any:
    """The value, where it has the type of an annotation."""
    origin, arguments = get_origin(hint), get_args(hint)
    if NoneType in arguments:
        other = next(each for each in arguments if each is not NoneType)
        return None if value is None else _typed(other, value, what)
    if origin is tuple:
        return _tuple(arguments, value, what)
    if origin is not None:  # Mapping[str, …]
        return {name: _typed(arguments[1], each, what) for name, each in mapping(value, what).items()}
    if is_dataclass(hint):
        return made(hint, value, what)  # type: ignore[arg-type]
    if hint is float:
        return _number(value, what)
    told(type(value) is hint, what)
    return value


def _tuple(kinds: tuple[Any, ...], value: object, what: str) -> tuple[Any, ...]:
    told(isinstance(value, list), what)
    assert isinstance(value, list)
    if kinds[1:] == (Ellipsis,):
        return tuple(_typed(kinds[0], each, what) for each in value)
    told(len(value) == len(kinds), what)
    return tuple(_typed(kind, each, what) for kind, each in zip(kinds, value, strict=True))


def _number(value: object, what: str) -> float | int:
    told(type(value) in (int, float), what)
    assert isinstance(value, int | float)
    told(abs(value) < _LARGEST if type(value) is int else math.isfinite(value), what)
    return value
