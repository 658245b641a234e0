"""The vehicles of a template: a cell with the name of each, labels that show it, equations that read the same for two.

In any label, `«1»` stands for the name of vehicle 1. The workbook holds each name once, in the cell `vehicle_1`, and
writes such a label as a formula, so that a new name shows on every sheet. The phases of a skid have names in the same
way: `«phase 1»`, in the cell `phase_1`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields, replace

from templates.description import Equation

__all__ = [
    "FIRST",
    "SECOND",
    "for_both",
    "label_formula",
    "name_cell",
    "names_a_vehicle",
    "phase",
    "shown_label",
    "vehicle",
]

_CHOICE = re.compile(r"<([^<>|]*)\|([^<>|]*)>")
_NAME = re.compile(r"«((?:phase )?\d+)»")
_LONGEST = 255
"""Characters of one text in a formula, at most: Excel takes no longer one."""


def vehicle(j: int) -> str:
    """What stands in a label for the name of vehicle j, counted from 1."""
    return f"«{j}»"


FIRST, SECOND = vehicle(1), vehicle(2)


def phase(number: int) -> str:
    """What stands in a label for the name of a phase, counted from 1."""
    return f"«phase {number}»"


def name_cell(j: int, of: str = "vehicle") -> str:
    """The defined name of the cell that holds the name of vehicle j, or of phase j."""
    return f"{of}_{j}"


def names_a_vehicle(text: str) -> bool:
    """Whether a label holds the name of a vehicle, or of a phase."""
    return _NAME.search(text) is not None


def shown_label(text: str, vehicles: Sequence[str]) -> str:
    """A label as its cell shows it, where the vehicles, or the phases, are called so."""
    return _NAME.sub(lambda name: vehicles[int(name[1].removeprefix("phase ")) - 1], text)


def label_formula(text: str) -> str:
    """`«1» delta-V` -> `vehicle_1&" delta-V"`: a label with the name of a vehicle as a formula, without `=`."""
    parts = _NAME.split(text)
    message = [_cell(part) if index % 2 else _quoted(part) for index, part in enumerate(parts)]
    return "&".join(part for part in message if part)


def _cell(name: str) -> str:
    of, _, number = name.rpartition(" ")
    return name_cell(int(number), of or "vehicle")


def _quoted(text: str) -> str:
    pieces = (text[start : start + _LONGEST].replace('"', '""') for start in range(0, len(text), _LONGEST))
    return "&".join(f'"{piece}"' for piece in pieces)


def for_both(patterns: Iterable[Equation]) -> tuple[Equation, ...]:
    """Expand each pattern into an equation of vehicle 1 and one of vehicle 2; what is not a pattern stays as it is.

    In a pattern, `{j}` is the vehicle's number, `{k}` the other's, `{who}` its name, and `<a|b>` is a for vehicle 1 and
    b for vehicle 2. An equation is a pattern when its symbol holds `{j}`.
    """
    return tuple(equation for pattern in patterns for equation in _expanded(pattern))


def _expanded(pattern: Equation) -> Iterator[Equation]:
    if "{j}" not in pattern.symbol:
        yield pattern
        return
    for j in (1, 2):
        texts = {field.name: getattr(pattern, field.name) for field in fields(pattern)}
        yield replace(pattern, **{name: _filled(text, j) for name, text in texts.items() if isinstance(text, str)})


def _filled(text: str, j: int) -> str:
    chosen = _CHOICE.sub(lambda choice: choice[j], text)
    return chosen.format(j=j, k=3 - j, who=vehicle(j))
