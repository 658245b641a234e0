"""One description, two editions: what differs between imperial and SI units is written side by side.

In any text, `[ft|m]` is ft in the imperial edition and m in the SI edition; a number that differs is a `Both`. A row
whose symbol comes out empty, such as `[in_per_ft|]` in SI, is left out of that edition.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from enum import Enum
from typing import Any, TypeVar

__all__ = ["Both", "Edition", "edition"]

_CHOICE = re.compile(r"\[([^\[\]|]*)\|([^\[\]|]*)\]")

T = TypeVar("T")


class Edition(Enum):
    """A system of units; the value is how the command line calls it."""

    IMPERIAL = "imperial"
    SI = "si"


@dataclass(frozen=True, slots=True)
class Both:
    """A number, or anything else, in both editions."""

    imperial: Any
    si: Any


def edition(described: T, units: Edition) -> T:
    """The description in one system of units, through all that it holds."""
    return _chosen(described, 1 if units is Edition.IMPERIAL else 2)  # type: ignore[no-any-return]


def _chosen(part: Any, place: int) -> Any:
    match part:
        case str():
            return _CHOICE.sub(lambda choice: choice[place], part)
        case Both():
            return _chosen(part.imperial if place == 1 else part.si, place)
        case tuple():
            made = (_chosen(each, place) for each in part)
            return tuple(each for each in made if getattr(each, "symbol", None) != "")
        case Mapping():
            return {_chosen(key, place): _chosen(value, place) for key, value in part.items()}
        case Enum():
            return part
    if is_dataclass(part) and not isinstance(part, type):
        return replace(part, **{field.name: _chosen(getattr(part, field.name), place) for field in fields(part)})
    return part
