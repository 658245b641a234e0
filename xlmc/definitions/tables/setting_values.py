"""The numbers in the Value column of `xlmc_settings`."""

from __future__ import annotations

from xlmc.definitions.tables.fields import number_in
from xlmc.definitions.tables.tables import Row, as_text
from xlmc.definitions.tables.typed_numbers import typed_whole_number
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
    """The whole number in the row's Value, also as a text like `200,000` or `200k`.

    Raises:
        DefinitionError: there is something else in it, or a number outside `least` … `most`.
    """
    written = _whole_number_as_text(row, name)
    value = number_of(row, name) if written is None else written
    if not least <= value <= most or value != int(value):
        message = f"{name} must be a whole number from {least:,} to {most:,}, not {show(value)}"
        raise DefinitionError(message, where=row.cell("Value"), hint="Correct the number")
    return int(value)


def _whole_number_as_text(row: Row, name: str) -> int | None:
    """What is written in a cell of text; None where the cell holds something else."""
    text = row.content("Value").value
    if not isinstance(text, str):
        return None
    found = typed_whole_number(text)
    if found is None:
        message = f"{name} is {as_text(text)!r}, which is no whole number"
        raise DefinitionError(message, where=row.cell("Value"), hint="Type it like 200000, 200,000, 2e5 or 200k")
    return found
