"""One pattern, two vehicles: most equations of an impact read the same for both."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import fields, replace

from templates.description import Equation

__all__ = ["for_both"]

_CHOICE = re.compile(r"<([^<>|]*)\|([^<>|]*)>")


def for_both(vehicles: tuple[str, str], patterns: Iterable[Equation]) -> tuple[Equation, ...]:
    """Expand each pattern into an equation of vehicle 1 and one of vehicle 2; what is not a pattern stays as it is.

    In a pattern, `{j}` is the vehicle's number, `{k}` the other's, `{who}` its name, and `<a|b>` is a for vehicle 1 and
    b for vehicle 2. An equation is a pattern when its symbol holds `{j}`.
    """
    return tuple(equation for pattern in patterns for equation in _expanded(vehicles, pattern))


def _expanded(vehicles: tuple[str, str], pattern: Equation) -> Iterator[Equation]:
    if "{j}" not in pattern.symbol:
        yield pattern
        return
    for j in (1, 2):
        texts = {field.name: getattr(pattern, field.name) for field in fields(pattern)}
        yield replace(
            pattern,
            **{name: _filled(text, j, vehicles[j - 1]) for name, text in texts.items() if isinstance(text, str)},
        )


def _filled(text: str, j: int, who: str) -> str:
    chosen = _CHOICE.sub(lambda choice: choice[j], text)
    return chosen.format(j=j, k=3 - j, who=who)
