"""Rounding to a multiple whose sign does not matter, always the same way on the number line."""

from __future__ import annotations

import numpy as np

from xlmc.functions.math.rounding import ceiling_math, floor_math
from xlmc.functions.registry import Number, excel
from xlmc.functions.values import Floats

__all__: list[str] = []


@excel("CEILING.PRECISE", Number, Number(default=1.0), aliases=("ISO.CEILING", "ECMA.CEILING"))
def ceiling_precise(x: Floats, multiple: Floats) -> Floats:
    """Up to a multiple."""
    result: Floats = ceiling_math(x, multiple, np.zeros(1))
    return result


@excel("FLOOR.PRECISE", Number, Number(default=1.0))
def floor_precise(x: Floats, multiple: Floats) -> Floats:
    """Down to a multiple."""
    result: Floats = floor_math(x, multiple, np.zeros(1))
    return result
