"""Parts of texts by place and length. Places count from 1; fractions are dropped."""

from __future__ import annotations

import math

from xlmc.errors import ErrorCode
from xlmc.functions.per_element import per_element
from xlmc.functions.registry import Kind, Number, Text, excel
from xlmc.functions.text.utf16 import LONGEST, in_units

__all__: list[str] = []

# The functions with a B at the end count bytes in Chinese, Japanese and Korean; elsewhere they are the same.


@excel("LEN", Text, aliases=("LENB",))
@per_element
@in_units
def length(text: str) -> float:
    """How many characters a text has."""
    return float(len(text))


@excel("LEFT", Text, Number(default=1.0), returns=Kind.TEXT, aliases=("LEFTB",))
@per_element
@in_units
def left(text: str, count: float) -> object:
    """The first characters."""
    return ErrorCode.VALUE if count < 0 else text[: math.trunc(count)]


@excel("RIGHT", Text, Number(default=1.0), returns=Kind.TEXT, aliases=("RIGHTB",))
@per_element
@in_units
def right(text: str, count: float) -> object:
    """The last characters."""
    return ErrorCode.VALUE if count < 0 else text[max(len(text) - math.trunc(count), 0) :]


@excel("MID", Text, Number, Number, returns=Kind.TEXT, aliases=("MIDB",))
@per_element
@in_units
def middle(text: str, start: float, count: float) -> object:
    """So many characters from a place on."""
    if start < 1 or count < 0:
        return ErrorCode.VALUE
    first = math.trunc(start) - 1
    return text[first : first + math.trunc(count)]


@excel("REPLACE", Text, Number, Number, Text, returns=Kind.TEXT, aliases=("REPLACEB",))
@per_element
@in_units
def replace(text: str, start: float, count: float, new: str) -> object:
    """The text with so many characters from a place on replaced."""
    if start < 1 or count < 0:
        return ErrorCode.VALUE
    first = math.trunc(start) - 1
    result = f"{text[:first]}{new}{text[first + math.trunc(count) :]}"
    return result if len(result) <= LONGEST else ErrorCode.VALUE


@excel("REPT", Text, Number, returns=Kind.TEXT)
@per_element
@in_units
def repeat(text: str, count: float) -> object:
    """The text so many times over; `#VALUE!` beyond 32,767 characters."""
    times = math.trunc(count)
    if count < 0 or times * len(text) > LONGEST:
        return ErrorCode.VALUE
    return text * min(times, LONGEST)
