"""Degrees of freedom, as Excel checks them."""

from __future__ import annotations

from typing import Final

import numpy as np

from xlmc.functions.values import Bools, Floats

__all__ = ["degrees_of_freedom"]

_MOST: Final = 1e10


def degrees_of_freedom(given: Floats) -> tuple[Bools, Floats]:
    """Whether these are degrees of freedom, from 1 to 10¹⁰, and how many: the whole number; 1 where they are not."""
    valid = (np.asarray(given) >= 1) & (given <= _MOST)
    return valid, np.floor(np.where(valid, given, 1.0))
