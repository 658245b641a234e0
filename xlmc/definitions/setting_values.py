"""The numbers in the Value column of `xlmc_settings`."""

from __future__ import annotations

from xlmc.definitions.fields import number_in
from xlmc.definitions.tables import Row
from xlmc.distributions.base import show
from xlmc.errors import DefinitionError

__all__ = ["number_of", "whole_number"]


def number_of(row: Row, name: str) -> float:
    """The number in the row's Value.

    Raises:
        DefinitionError: there is something else in it.
    """
    return number_in(name, row.content("Value"), row.cell("Value"))


def whole_number(row: Row, name: str, least: int, most: int) -> int:
    """The whole number in the row's Value.

    Raises:
        DefinitionError: there is something else in it, or a number outside `least` … `most`.
    """
    value = number_of(row, name)
    if not least <= value <= most or value != int(value):
        message = f"{name} must be a whole number from {least:,} to {most:,}, not {show(value)}"
        raise DefinitionError(message, where=row.cell("Value"), hint="Correct the number")
    return int(value)
