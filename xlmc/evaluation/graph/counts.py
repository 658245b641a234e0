"""How many arguments a function takes. Excel refuses any other number as the formula is typed; xlmc names the cell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from xlmc.errors import FormulaError
from xlmc.functions.families import function_named

__all__ = ["MOST", "SPECIAL", "check_count", "limits"]

MOST: Final = 255

SPECIAL: Final[Mapping[str, tuple[int, int]]] = {
    "IF": (2, 3),
    "IFS": (2, MOST),
    "SWITCH": (3, MOST),
    "CHOOSE": (2, MOST),
    "IFERROR": (2, 2),
    "IFNA": (2, 2),
    "SINGLE": (1, 1),
    "OFFSET": (3, 5),
    "INDIRECT": (1, 2),
    "INDEX": (2, 4),
    "ROW": (0, 1),
    "COLUMN": (0, 1),
    "ROWS": (1, 1),
    "COLUMNS": (1, 1),
    "AREAS": (1, 1),
    "ISREF": (1, 1),
    "ISFORMULA": (1, 1),
    "FORMULATEXT": (1, 1),
    "SHEET": (0, 1),
    "SHEETS": (0, 1),
    "CELL": (1, 2),
    "ANCHORARRAY": (1, 1),
    "MAP": (2, MOST),
    "REDUCE": (2, 3),
    "SCAN": (2, 3),
    "BYROW": (2, 2),
    "BYCOL": (2, 2),
    "MAKEARRAY": (3, 3),
    "ISOMITTED": (1, 1),
    "PERCENTOF": (2, 2),
}
"""The fewest and the most arguments of functions that are lowered in a way of their own."""


def check_count(name: str, arguments: Sequence[object]) -> None:
    """Refuse too few and too many arguments; a function that nobody knows may have any.

    Raises:
        FormulaError: it takes another number.
    """
    found = limits(name)
    if found is not None and not found[0] <= len(arguments) <= found[1]:
        raise FormulaError(f"{name} has {_number(len(arguments))}; it takes {_range(*found)}")


def limits(name: str) -> tuple[int, int] | None:
    """The fewest and the most arguments; None of a function that nobody knows."""
    if name in SPECIAL:
        return SPECIAL[name]
    function = function_named(name)
    return None if function is None else function.arity()


def _number(count: int) -> str:
    return f"{count} argument{'s' * (count != 1)}"


def _range(fewest: int, most: int) -> str:
    if most == MOST:
        return f"{fewest} or more"
    return str(fewest) if fewest == most else f"{fewest} to {most}"
