"""The largest, the smallest, the product of the numbers so far: blank while there are none.

Excel gives 0 for those of no numbers at all; 0 would count when more cells follow.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Final

import numpy as np

from xlmc.functions.facts import Facts
from xlmc.functions.math import aggregate
from xlmc.functions.registry import Cells, Function, Kind, row_of
from xlmc.functions.values import BLANK, ERROR, NUMBER, Value

__all__ = ["SO_FAR"]


def _so_far(cells: Value, of: str) -> Value:
    """What the function gives of a range, (n, r, c) -> (n,); blank where no cell is a number."""
    result = row_of(of, aggregate.__name__)((cells,))
    none = ~(cells.kinds == NUMBER).any(axis=(1, 2)) & (result.kinds < ERROR)
    return Value(np.where(none, 0.0, result.numbers), np.where(none, np.uint8(BLANK), result.kinds))


def _facts_of(name: str) -> Facts:
    return Facts(unrounded=row_of(name, aggregate.__name__).facts.unrounded)


SO_FAR: Final[Mapping[str, Function]] = {
    name: Function(f"{name} so far", (Cells,), partial(_so_far, of=name), Kind.ANY, facts=_facts_of(name))
    for name in ("MAX", "MIN", "PRODUCT")
}
"""By the name of Excel's function."""
