"""Texts as Excel counts them: in UTF-16 units, two for a character beyond the first 65,536."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Final

import numpy as np

__all__ = ["LONGEST", "fits_in_a_cell", "in_units", "units", "whole"]

LONGEST: Final = 32767
"""Units of a text in a cell; Excel makes none longer."""


def fits_in_a_cell(text: str) -> bool:
    """Whether Excel makes a text so long."""
    return len(text) <= LONGEST // 2 or (len(text) <= LONGEST and len(units(text)) <= LONGEST)


def units(text: str) -> str:
    """The text with a surrogate for each unit, so that Python counts as Excel does."""
    if text.isascii() or max(text) < "\U00010000":
        return text
    return "".join(map(chr, np.frombuffer(text.encode("utf-16-le", "surrogatepass"), "<u2")))


def whole(text: str) -> str:
    """The text with its surrogates joined again; half a pair is shown as unknown."""
    if text.isascii() or not any("\ud800" <= character < "\ue000" for character in text):
        return text
    return text.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")


def in_units(function: Callable[..., object]) -> Callable[..., object]:
    """The function, given its texts in units and its result joined again."""

    @wraps(function)
    def counted(*arguments: object) -> object:
        result = function(*(units(item) if isinstance(item, str) else item for item in arguments))
        return whole(result) if isinstance(result, str) else result

    return counted
