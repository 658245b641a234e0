"""What stands for the empty cells at the end of a whole column, and what is said where nothing can."""

from __future__ import annotations

from functools import cache, partial
from typing import Final

import numpy as np

from xlmc.errors import FormulaError
from xlmc.functions import Function, Kind
from xlmc.functions.budget import TooLargeError
from xlmc.functions.registry import Number
from xlmc.functions.values import Floats

__all__ = ["at_the_last", "kept", "refused"]


_MESSAGE: Final = (
    "{} is given a whole column or row, or a range that goes on far beyond the last filled cell; xlmc cannot take all "
    "its empty cells there"
)
_HINT: Final = "name only the rows and columns that hold something"


def refused(name: str) -> FormulaError:
    """What a person is told of a function that cannot be given a whole column."""
    return FormulaError(_MESSAGE.format(name), hint=_HINT)


@cache
def kept(held: int, whole: int, zero_is_all: bool) -> Function:
    """Numbers of rows or columns beyond the `held` ones, as that of the last of them, if they are of the `whole`."""
    body = partial(_within, held=held, whole=whole, zero_is_all=zero_is_all)
    return Function(f"within {held} of {whole}", (Number,), body, Kind.NUMBER)


@cache
def at_the_last(held: int, whole: int) -> Function:
    """Numbers of rows or columns beyond the `held` ones, as that of the last of the `whole`."""
    return Function(f"{held} or {whole}", (Number,), partial(_of_whole, held=held, whole=whole), Kind.NUMBER)


def _of_whole(numbers: Floats, held: int, whole: int) -> Floats:
    return np.where(numbers > held, float(whole), numbers)


def _within(numbers: Floats, held: int, whole: int, zero_is_all: bool) -> Floats:
    if zero_is_all and (np.trunc(numbers) == 0).any():
        raise TooLargeError(_MESSAGE.format("INDEX with row or column 0"), hint=_HINT)
    return np.where(numbers < whole + 1, np.minimum(numbers, held), numbers)
